use super::*;

#[test]
fn trees_follow_the_nearest_sensors_and_the_information() {
    // Three parts of two sensors; the first and the last are nearest by one pair, the middle one shares most on the mean.
    let distance = |a: usize, b: usize| match (a.min(b), a.max(b)) {
        (i, j) if i == j => 0.0,
        (0, 1) | (2, 3) | (4, 5) => 0.1,
        (1, 4) => 0.2,
        (0 | 1, 4 | 5) => 1.9,
        (0 | 1, 2 | 3) => 0.5,
        _ => 0.6,
    };
    let values = (0..6).flat_map(|a| (0..6).map(move |b| distance(a, b))).collect();
    let symbols = Symbols { samples: 4, levels: 2, values: [0, 0, 1, 1].repeat(6) };
    let labels = [0, 0, 1, 1, 2, 2];
    let [nearest, chow_liu] = trees(&labels, &Distances { sensors: 6, values }, &symbols);
    let pairs = |tree: &[Edge]| {
        let mut pairs: Vec<_> =
            tree.iter().map(|edge| (edge.child.min(edge.parent), edge.child.max(edge.parent))).collect();
        pairs.sort_unstable();
        pairs
    };
    assert_eq!(pairs(&nearest), [(0, 1), (0, 2)]);
    assert_eq!(pairs(&chow_liu), [(0, 1), (1, 2)]);
    assert!((entropy(&[0, 0, 1, 1], 2) - 1.0).abs() < 1e-12);
}
