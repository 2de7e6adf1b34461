//! Test the motion subspace of given sensors.

use nalgebra::DMatrix;
use rand::RngExt;

use super::super::fixtures::unexplained;
use super::*;
use crate::numerics::rng::stream;

/// A smooth random motion of rank k, and the pressures on sensors with random c: T × k, and M series.
fn felt(k: usize, sensors: usize, signed: bool) -> (DMatrix<f64>, Vec<Vec<f32>>) {
    let samples = 3000;
    let mut rng = stream(1, 1, "felt", k);
    let mut normal = || (0..12).map(|_| rng.random_range(-0.5..0.5)).sum::<f64>();
    let mut w = DMatrix::zeros(samples, k);
    for t in 1..samples {
        for at in 0..k {
            w[(t, at)] = 0.9 * w[(t - 1, at)] + normal() / (1.0 + at as f64);
        }
    }
    let c: DMatrix<f64> = DMatrix::from_fn(k, sensors, |_, _| normal());
    let roots = &w * &c;
    let pressure =
        |root: &f64| if signed { (root * root.abs()) as f32 } else { root.max(0.0).powi(2) as f32 };
    let series = roots.column_iter().map(|root| root.iter().map(pressure).collect()).collect();
    (w, series)
}

#[test]
fn a_motion_is_recovered_up_to_a_linear_map() {
    for (k, signed) in [(2, false), (4, false), (6, false), (4, true)] {
        let (w, series) = felt(k, 40, signed);
        let series: Vec<&[f32]> = series.iter().map(Vec::as_slice).collect();
        let found = MotionSubspace::of_cluster(&series, signed);
        let error = unexplained(w.transpose().as_slice(), (&found.basis, found.rank));
        assert!(error < 0.05, "k = {k}, signed {signed}: {error}");
    }
}

#[test]
fn the_data_choose_the_rank() {
    for (k, signed) in [(2, false), (3, false), (4, true)] {
        let (_, series) = felt(k, 40, signed);
        let series: Vec<&[f32]> = series.iter().map(Vec::as_slice).collect();
        assert_eq!(MotionSubspace::of_cluster(&series, signed).rank, k);
    }
}

#[test]
fn no_touch_is_no_motion() {
    let still = [0.0_f32; 50];
    assert_eq!(MotionSubspace::of_cluster(&[&still, &still], false).rank, 0);
    assert_eq!(MotionSubspace::of_cluster(&[], false).rank, 0);
    // A single sensor that feels something at a single sample.
    let mut once = still;
    once[49] = 1.0;
    let found = MotionSubspace::of_cluster(&[&once], false);
    assert!(found.basis.iter().all(|value| value.is_finite()));
}
