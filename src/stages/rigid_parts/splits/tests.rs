//! Test that faces of two boxes are split, and those of one box are not, even if only a third face links them.

use super::super::testing::{hinged_boxes, pair, pairs};
use super::*;

/// The sensors of clusters after one was split, of boxes with so many degrees of freedom.
fn split(degrees: usize, sensors: Vec<usize>) -> Vec<Vec<usize>> {
    let mut search = hinged_boxes(degrees);
    let cluster = Cluster::new(&search.felt, sensors);
    let mut found: Vec<Vec<usize>> = search.split(vec![cluster]).into_iter().map(|own| own.sensors).collect();
    found.sort();
    found
}

#[test]
fn faces_of_two_boxes_are_split() {
    assert_eq!(split(6, pairs(&[(0, 1), (1, 1)])), [pair(0, 1), pair(1, 1)]);
}

#[test]
fn faces_that_only_a_third_one_links_stay() {
    // A box that does not turn about axis 2: its faces along axes 0 and 1 have nothing in common, but each shares a rotation with the third.
    let own = [pairs(&[(0, 0), (0, 1)]), pair(0, 2)[..8].to_vec()].concat();
    assert_eq!(split(5, own.clone()), [own]);
    assert_eq!(split(5, pairs(&[(0, 0), (0, 1)])), [pair(0, 0), pair(0, 1)]);
}

#[test]
fn a_cluster_that_stays_leaves_no_trace() {
    let mut search = hinged_boxes(5);
    let own = [pairs(&[(0, 0), (0, 1)]), pair(0, 2)[..8].to_vec()].concat();
    let before = search.felt.completed.clone();
    let cluster = Cluster::new(&search.felt, own);
    assert_eq!(search.split(vec![cluster]).len(), 1);
    assert_eq!(search.felt.completed, before);
}
