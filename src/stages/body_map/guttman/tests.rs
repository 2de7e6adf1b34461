//! Test a step of majorisation against the plain formula.

use rand::RngExt;

use super::*;
use crate::numerics::rng::stream;

#[test]
fn points_that_coincide_on_the_map_do_not_move_each_other_to_infinity() {
    let values = (0..81).map(|at| f64::from(at / 9 - at % 9).abs()).collect();
    let distances = Distances { sensors: 9, values };
    let mut state = Guttman::new(&distances, &BodyMap { dims: 2, coordinates: vec![0.5; 18] });
    for _ in 0..3 {
        state.step();
    }
    assert!(state.map().coordinates.iter().all(|x| x.is_finite()));
}

#[test]
fn points_close_to_each_other_and_far_from_the_origin_move_as_precisely() {
    let (n, dims) = (19, 3);
    let mut rng = stream(1, 1, "close", 0);
    // Differences of powers of two are exact.
    let coordinates: Vec<f64> =
        (0..n * dims).map(|_| 1024.0 + f64::from(rng.random_range(-64..64)) / 1024.0).collect();
    let between = |i: usize, j: usize| if i == j { 0.0 } else { 1.0 + ((i + j) % 3) as f64 };
    let values = (0..n * n).map(|at| between(at / n, at % n)).collect();
    let distances = Distances { sensors: n, values };
    let mut state = Guttman::new(&distances, &BodyMap { dims, coordinates: coordinates.clone() });
    let stress = state.step();
    let moved = state.map();
    let x = |i: usize, k: usize| coordinates[i * dims + k];
    let within = |i: usize, j: usize| (0..dims).map(|k| (x(i, k) - x(j, k)).powi(2)).sum::<f64>().sqrt();
    let mut expected = 0.0;
    for i in 0..n {
        for k in 0..dims {
            let pull = |j: usize| between(i, j) / within(i, j) * (x(i, k) - x(j, k));
            let own = (0..n).filter(|j| *j != i).map(pull).sum::<f64>() / n as f64;
            // Sums of 1,024 times the ratios, of some 100, are rounded.
            assert!((moved.coordinates[i * dims + k] - own).abs() < 1e-9 * own.abs().max(1.0));
        }
        expected += (0..i).map(|j| (between(i, j) - within(i, j)).powi(2)).sum::<f64>();
    }
    assert!((stress - expected).abs() < 1e-12 * expected);
}
