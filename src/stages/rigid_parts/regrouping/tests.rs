//! Test that faces of two boxes on a hinge come to their own boxes, and that right clusters stay.

use rand::RngExt;

use super::super::testing::{hinged_boxes, pair, pairs};
use super::*;
use crate::numerics::rng::stream;

/// The sensors of clusters after they were regrouped, if they were; with those in none.
fn regrouped(clusters: &[&[(usize, usize)]]) -> Option<Vec<Vec<usize>>> {
    regrouped_with(true, clusters)
}

/// The same, with sensors in none or without.
fn regrouped_with(rest: bool, clusters: &[&[(usize, usize)]]) -> Option<Vec<Vec<usize>>> {
    let mut search = hinged_boxes(6);
    search.rest_takes_part = rest;
    let clusters: Vec<Cluster> = clusters.iter().map(|own| Cluster::new(&search.felt, pairs(own))).collect();
    let found = search.regrouped(&clusters)?;
    let mut found: Vec<Vec<usize>> = found.into_iter().map(|own| own.sensors).collect();
    found.sort();
    Some(found)
}

#[test]
fn faces_along_a_hinge_come_to_their_own_boxes() {
    let boxes = vec![pairs(&[(0, 0), (0, 1), (0, 2)]), pairs(&[(1, 0), (1, 1), (1, 2)])];
    // The faces along the hinge were merged first, since they feel one velocity.
    let found = regrouped(&[&[(0, 0), (1, 0)], &[(0, 1), (0, 2)], &[(1, 1), (1, 2)]]);
    assert_eq!(found, Some(boxes.clone()));
    // Or each is with a face of its own box, and the others are alone.
    let found = regrouped(&[&[(0, 0), (1, 0)], &[(0, 1)], &[(0, 2)], &[(1, 1), (1, 2)]]);
    assert_eq!(found, Some(boxes));
}

#[test]
fn a_box_whose_faces_are_in_no_cluster_is_found() {
    let boxes = vec![pairs(&[(0, 0), (0, 1), (0, 2)]), pairs(&[(1, 0), (1, 1), (1, 2)])];
    let found = regrouped(&[&[(0, 0), (1, 0)], &[(0, 1), (0, 2)]]);
    assert_eq!(found, Some(boxes.clone()));
    // It has no face in a cluster at all.
    let found = regrouped(&[&[(0, 0), (0, 1), (0, 2)]]);
    assert_eq!(found, Some(boxes));
    // Before sensors in none take part, it is not.
    assert_eq!(regrouped_with(false, &[&[(0, 0), (0, 1), (0, 2)]]), None);
}

#[test]
fn boxes_stay() {
    assert_eq!(regrouped(&[&[(0, 0), (0, 1), (0, 2)], &[(1, 0), (1, 1), (1, 2)]]), None);
}

#[test]
fn a_cluster_of_two_boxes_is_divided_into_its_flat_faces() {
    let search = hinged_boxes(6);
    let cluster = Cluster::new(&search.felt, pairs(&[(0, 0), (1, 0)]));
    let mut found = search.flat_faces(&cluster);
    found.sort();
    assert_eq!(found, [pair(0, 0), pair(1, 0)]);
}

#[test]
fn vectors_of_one_subspace_are_a_group_and_few_are_none() {
    let mut rng = stream(5, 1, "regrouping", 1);
    let mut vectors = |count: usize, places: [usize; 3]| -> Vec<Vec<f64>> {
        let mut vector = || {
            let mut own = vec![0.0; 6];
            places.iter().for_each(|&at| own[at] = rng.random_range(-1.0..1.0));
            own
        };
        (0..count).map(|_| vector()).collect()
    };
    let all = [vectors(6, [0, 1, 2]), vectors(9, [2, 3, 4]), vectors(4, [0, 4, 5])].concat();
    assert_eq!(flats(&all, 1e-3), [(6..15).collect::<Vec<_>>(), (0..6).collect()]);
    assert!(flats(&[], 1e-3).is_empty() && flats(&vec![vec![0.0; 6]; 9], 1e-3).is_empty());
}
