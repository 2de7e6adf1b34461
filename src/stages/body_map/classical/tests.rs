//! Test classical scaling.

use rand::RngExt;

use super::*;
use crate::numerics::rng::stream;

fn distances(n: usize, between: impl Fn(usize, usize) -> f64) -> Distances {
    let values = (0..n * n).map(|at| between(at / n, at % n)).collect();
    Distances { sensors: n, values }
}

fn euclidean(map: &BodyMap, i: usize, j: usize) -> f64 {
    let row = |i: usize| &map.coordinates[i * map.dims..][..map.dims];
    row(i).iter().zip(row(j)).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

fn scaling(n: usize, dims: usize, between: impl Fn(usize, usize) -> f64) -> ClassicalScaling {
    ClassicalScaling::new(&distances(n, between), dims).unwrap()
}

/// Both few enough points for the whole decomposition and so many that only its largest part is found.
#[test]
fn a_planted_configuration_is_recovered_up_to_rigid_motion() {
    for n in [20, 150] {
        let mut rng = stream(1, 1, "planted", 0);
        let planted =
            BodyMap { dims: 3, coordinates: (0..3 * n).map(|_| rng.random_range(-1.0..1.0)).collect() };
        let scaling = scaling(n, 5, |i, j| euclidean(&planted, i, j));
        assert_eq!(scaling.positive(), 3);
        assert!((scaling.agreement(3) - 1.0).abs() < 1e-12 && scaling.agreement(2) < 0.9);
        let found = scaling.coordinates(3).unwrap();
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            assert!((euclidean(&found, i, j) - euclidean(&planted, i, j)).abs() < 1e-10);
        }
        for dims in [4, 5, 6, 1000] {
            let expected = MapError::TooManyDimensions { dims, sensors: n, positive: 3 };
            assert_eq!(scaling.coordinates(dims).unwrap_err(), expected);
        }
    }
}

/// City-block distances, which are not Euclidean: the same map as from all eigenvectors.
#[test]
fn a_map_does_not_depend_on_how_many_dimensions_were_asked_for() {
    let (n, mut rng) = (200, stream(1, 1, "city block", 0));
    let points: Vec<f64> = (0..n * 20).map(|at| rng.random_range(-1.0..1.0) / (1 + at % 20) as f64).collect();
    let pairs = |i: usize, j: usize| points[20 * i..][..20].iter().zip(&points[20 * j..][..20]);
    let distances = distances(n, |i, j| pairs(i, j).map(|(a, b)| (a - b).abs()).sum());
    let all = ClassicalScaling::new(&distances, n).unwrap();
    assert_eq!(all.eigenvalues.len(), n);
    assert!(all.eigenvalues[n - 1] < -0.01 * all.eigenvalues[0]);
    assert!((all.agreement(n) - 1.0).abs() < 1e-12);
    let positive = all.positive();
    let refused = MapError::TooManyDimensions { dims: n, sensors: n, positive };
    assert_eq!(all.coordinates(n).unwrap_err(), refused);
    assert_eq!(all.coordinates(positive).unwrap().dims, positive);
    for dims in [1, 3, 15] {
        let few = ClassicalScaling::new(&distances, dims).unwrap();
        assert!((few.agreement(dims) - all.agreement(dims)).abs() < 1e-12);
        let (found, expected) = (few.coordinates(dims).unwrap(), all.coordinates(dims).unwrap());
        let off = found.coordinates.iter().zip(&expected.coordinates).map(|(a, b)| (a - b).abs());
        assert!(off.fold(0.0, f64::max) < 1e-9, "{dims} dimensions");
    }
}

#[test]
fn fewer_dimensions_are_the_first_columns() {
    let scaling = scaling(6, 4, |i, j| (i as f64 - j as f64).abs().sqrt());
    let (two, four) = (scaling.coordinates(2).unwrap(), scaling.coordinates(4).unwrap());
    for i in 0..6 {
        assert_eq!(two.coordinates[2 * i..][..2], four.coordinates[4 * i..][..2]);
    }
    assert!(scaling.eigenvalues.windows(2).all(|pair| pair[0] >= pair[1]));
}

#[test]
fn distances_that_are_not_euclidean_are_not_wholly_agreed_with() {
    // Four points, three of them pairwise at 2, all at 1 from the fourth: no such points exist. Two
    // eigenvalues are 2, one is −1/4.
    let star = scaling(4, 2, |i, j| if i == j { 0.0 } else { [1.0, 2.0][usize::from(i * j > 0)] });
    assert!((star.agreement(2) - 8.0 / (8.0 + 1.0 / 16.0)).abs() < 1e-12);
}

/// A regular simplex spans all dimensions there are, each as much as any other.
#[test]
fn equal_distances_span_all_dimensions() {
    for n in [2, 3, 200] {
        let scaling = scaling(n, 15, |i, j| f64::from(u8::from(i != j)));
        assert_eq!(scaling.positive(), 15.min(n - 1));
        let map = scaling.coordinates(scaling.positive()).unwrap();
        assert!((scaling.agreement(1) - 1.0 / (n - 1) as f64).abs() < 1e-12);
        if n <= 15 {
            assert!((euclidean(&map, 0, 1) - 1.0).abs() < 1e-12);
            assert!(scaling.coordinates(n).is_err());
        }
    }
}

#[test]
fn distances_whose_squares_are_no_numbers_are_refused() {
    for scale in [1e-200, 1e200, f64::MAX] {
        let values = vec![0.0, scale, scale, 0.0];
        let refused = ClassicalScaling::new(&Distances { sensors: 2, values }, 1).unwrap_err();
        assert_eq!(refused, MapError::Scale(scale));
    }
    let any = scaling(3, usize::MAX, |i, j| (i as f64 - j as f64).abs());
    assert_eq!(any.eigenvalues.len(), 3);
}

#[test]
fn equal_sensors_span_nothing() {
    for n in [1, 3, 150] {
        let scaling = scaling(n, 1, |_, _| 0.0);
        assert_eq!((scaling.positive(), scaling.agreement(1)), (0, 0.0));
        assert_eq!(scaling.coordinates(1).unwrap_err(), MapError::NoDifference(n));
    }
}
