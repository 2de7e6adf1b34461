//! Test that sensors in no cluster join the one that they are of, and none if none explains them.

use super::super::testing::{hinged_boxes, pairs};
use super::*;

/// The sensors of clusters once others have joined them.
fn joined(clusters: &[&[usize]]) -> Vec<Vec<usize>> {
    let mut search = hinged_boxes(6);
    let clusters = clusters.iter().map(|own| Cluster::new(&search.felt, own.to_vec())).collect();
    search.with_rest(clusters).into_iter().map(|own| own.sensors).collect()
}

#[test]
fn a_sensor_joins_the_cluster_that_explains_it_best() {
    let boxes = [0, 1].map(|part| pairs(&[(part, 0), (part, 1), (part, 2)]));
    // All but the first three sensors of each pair of faces of the first box.
    let most: Vec<usize> = boxes[0].iter().copied().filter(|sensor| sensor % 10 >= 3).collect();
    assert_eq!(joined(&[&most, &boxes[1]]), boxes);
}

#[test]
fn a_sensor_that_none_explains_much_better_stays_in_none() {
    // Both halves of the first box explain as little of the second.
    let half = |side: usize| -> Vec<usize> {
        pairs(&[(0, 0), (0, 1), (0, 2)]).into_iter().filter(|sensor| sensor % 10 / 5 == side).collect()
    };
    let halves = [half(0), half(1)];
    assert_eq!(joined(&[&halves[0], &halves[1]]), halves);
}
