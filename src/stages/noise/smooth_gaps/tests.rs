//! Test how series with gaps are smoothed.

use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};

use super::super::smooth::smooth;
use super::*;
use crate::numerics::rng::stream;

#[test]
fn gaps_stay_and_the_rest_is_smoothed_nearly_as_without_them() {
    let rng = &mut stream(1, 1, "noise", 1);
    let truth = |t: usize| 20.0 * (0.02 * t as f64).sin().max(0.0);
    let noisy: Vec<f32> =
        (0..5000).map(|t| (truth(t) + Distribution::<f64>::sample(&StandardNormal, rng)) as f32).collect();
    let holes: Vec<f32> =
        noisy.iter().map(|value| if rng.random_bool(0.2) { f32::NAN } else { *value }).collect();
    let error = |found: &[f32]| {
        let known = found.iter().enumerate().filter(|(t, value)| !value.is_nan() && truth(*t) > 5.0);
        let squares: Vec<f64> = known.map(|(t, value)| (f64::from(*value) - truth(t)).powi(2)).collect();
        (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
    };
    let (mut whole, mut found) = (noisy.clone(), holes.clone());
    smooth(&mut whole, 1.65);
    smooth_gaps(&mut found, 1.65);
    assert!(found.iter().zip(&holes).all(|(found, before)| found.is_nan() == before.is_nan()));
    assert!(error(&found) < 1.2 * error(&whole) && error(&found) < 0.6 * error(&noisy), "{}", error(&found));
    // Without gaps, it is the same line.
    let mut same = noisy;
    smooth_gaps(&mut same, 1.65);
    assert!(same.iter().zip(&whole).all(|(one, other)| (one - other).abs() < 1e-3));
}
