//! Test the clusterings on maps whose clusters are known, and on maps that are degenerate.

use rand::RngExt;

use super::super::gmm::gmm;
use super::*;
use crate::numerics::partition::adjusted_rand_index;
use crate::numerics::rng::stream;
use crate::stages::mixture::standard_normal;

/// `parts` unit Gaussians of 20 points in 3 dimensions, `distance` apart on a line; and their labels.
fn blobs(parts: usize, distance: f64, seed: u64) -> (BodyMap, Vec<usize>) {
    let mut rng = stream(seed, 1, "blobs", 0);
    let labels: Vec<usize> = (0..20 * parts).map(|i| i % parts).collect();
    let point = |part: &usize| {
        let noise = standard_normal(3, &mut rng);
        [*part as f64 * distance + noise[0], noise[1], noise[2]]
    };
    (BodyMap { dims: 3, coordinates: labels.iter().flat_map(point).collect() }, labels)
}

/// Clusters by all three methods from the same seed.
fn all(map: &BodyMap, clusters: usize) -> [Vec<usize>; 3] {
    ClusteringMethod::ALL
        .map(|method| cluster(method, map, clusters, 10, &mut stream(1, 1, method.name(), 0)))
}

/// Number of labels that are used; all must be below `clusters`.
fn used(labels: &[usize], clusters: usize) -> usize {
    assert!(labels.iter().all(|label| *label < clusters));
    (0..clusters).filter(|k| labels.contains(k)).count()
}

#[test]
fn parts_that_are_far_apart_are_found_and_near_ones_are_not() {
    let (map, truth) = blobs(5, 12.0, 1);
    for labels in all(&map, 5) {
        assert_eq!(adjusted_rand_index(&labels, &truth), 1.0);
    }
    let (map, truth) = blobs(5, 0.5, 1);
    for labels in all(&map, 5) {
        assert!(adjusted_rand_index(&labels, &truth) < 0.5);
    }
}

#[test]
fn only_the_mixture_tells_a_long_part_from_a_round_one() {
    let mut rng = stream(1, 1, "long", 0);
    let truth: Vec<usize> = (0..200).map(|i| i % 2).collect();
    let point = |part: &usize| {
        let (x, y) = (rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0));
        if *part == 0 { [20.0 * x, y] } else { [x, y + 4.0] }
    };
    let map = BodyMap { dims: 2, coordinates: truth.iter().flat_map(point).collect() };
    let [ward, k_means, gmm] = all(&map, 2).map(|labels| adjusted_rand_index(&labels, &truth));
    assert!(gmm > 0.95 && ward < 0.8 && k_means < 0.8, "{ward} {k_means} {gmm}");
}

#[test]
fn the_same_seed_gives_the_same_labels_and_another_unit_or_origin_the_same_clusters() {
    let (map, _) = blobs(5, 2.0, 2);
    let first = all(&map, 5);
    assert_eq!(first, all(&map, 5));
    for unit in [1e-6, 1.0, 1e6] {
        let coordinates = map.coordinates.iter().map(|x| unit * (x + 3.0)).collect();
        for (one, other) in first.iter().zip(all(&BodyMap { dims: 3, coordinates }, 5)) {
            assert_eq!(adjusted_rand_index(one, &other), 1.0, "{unit}");
        }
    }
    let fit = |seed| gmm(&map, 5, 1, &mut stream(seed, 1, "gmm", 0));
    assert!((1..20).any(|seed| fit(seed) != fit(0)), "another seed starts elsewhere");
}

#[test]
fn more_restarts_are_never_worse() {
    let (map, _) = blobs(8, 2.0, 3);
    let (mut better_partition, mut better_fit) = (0, 0);
    for seed in 0..10 {
        let rng = || stream(seed, 1, "restarts", 0);
        let (one, many) = (k_means(&map, 8, 1, &mut rng()), k_means(&map, 8, 10, &mut rng()));
        assert!(many.inertia <= one.inertia);
        better_partition += usize::from(many.inertia < one.inertia);
        let (one, many) = (gmm(&map, 8, 1, &mut rng()), gmm(&map, 8, 10, &mut rng()));
        assert!(many.log_likelihood >= one.log_likelihood);
        better_fit += usize::from(many.log_likelihood > one.log_likelihood);
    }
    assert!(better_partition > 5 && better_fit > 5, "{better_partition} {better_fit}");
}

#[test]
fn points_that_coincide_share_a_cluster() {
    let two = BodyMap { dims: 2, coordinates: (0..12).flat_map(|i| [f64::from(i % 2), 0.1]).collect() };
    let one = BodyMap { dims: 3, coordinates: vec![0.1; 30] };
    for (map, different) in [(two, 2), (one, 1)] {
        for labels in all(&map, 5) {
            assert_eq!(used(&labels, 5), different);
            assert!((0..map.points()).all(|i| labels[i] == labels[i % different]));
        }
    }
}

#[test]
fn fewer_points_than_clusters_are_each_their_own() {
    for n in 0..4 {
        let map = BodyMap { dims: 2, coordinates: (0..2 * n).map(|x| (x * x) as f64).collect() };
        for labels in all(&map, 10) {
            assert_eq!((labels.len(), used(&labels, 10)), (n, n));
        }
    }
    let (map, _) = blobs(2, 5.0, 1);
    for method in ClusteringMethod::ALL {
        assert_eq!(cluster(method, &map, 0, 0, &mut stream(1, 1, "none", 0)), vec![0; 40]);
    }
}

#[test]
fn a_flat_map_and_thin_clusters_have_finite_likelihoods() {
    let mut rng = stream(1, 1, "thin", 0);
    // Five parts of 30 points in 15 dimensions, each along one line; ten components for five parts.
    let coordinates = (0..150)
        .flat_map(|i| {
            let along = rng.random_range(-1.0..1.0);
            (0..15).map(move |k| f64::from(u8::from(k == i % 5)) * (3.0 + along))
        })
        .collect();
    let map = BodyMap { dims: 15, coordinates };
    for clusters in [3, 5, 10, 100] {
        let fit = gmm(&map, clusters, 3, &mut stream(1, 1, "gmm", 0));
        assert!(fit.log_likelihood.is_finite());
        assert!(used(&fit.labels, clusters) > 1);
    }
    let truth: Vec<usize> = (0..150).map(|i| i % 5).collect();
    for labels in all(&map, 5) {
        assert_eq!(adjusted_rand_index(&labels, &truth), 1.0);
    }
}

#[test]
fn an_outlier_far_beyond_the_range_of_exponentials_is_a_cluster_of_its_own() {
    let (mut map, _) = blobs(2, 12.0, 4);
    map.coordinates[..3].copy_from_slice(&[0.0, 1e5, 0.0]);
    for labels in all(&map, 3) {
        assert_eq!(labels.iter().filter(|label| **label == labels[0]).count(), 1);
    }
}
