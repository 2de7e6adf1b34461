use super::*;

fn edge(support: f64, right: bool) -> EdgeRow {
    EdgeRow {
        body: "star".to_owned(),
        kind: None,
        coordination: 0.5,
        movement: 1,
        samples: 1000,
        noise: 0.0,
        support,
        right,
    }
}

#[test]
fn edges_count_in_the_bin_of_their_support() {
    let edges = [edge(1.0, true), edge(1.0, false), edge(0.9975, true), edge(0.5, true)];
    let edges: Vec<&EdgeRow> = edges.iter().collect();
    let bins = BINS.map(|(low, high)| bin(&edges, low, high));
    assert_eq!([&bins[0], &bins[2], &bins[3]], ["–"; 3]);
    assert!(bins[1].starts_with("50.0 % → 100 % (") && bins[1].ends_with(" of 1"), "{bins:?}");
    assert!(bins[4].starts_with("99.8 % → 100 % (") && bins[4].ends_with(" of 1"), "{bins:?}");
    assert!(bins[5].starts_with("100 % → 50.0 % (") && bins[5].ends_with(" of 2"), "{bins:?}");
}
