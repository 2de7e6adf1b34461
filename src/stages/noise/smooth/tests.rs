//! Test that noise goes and steps stay.

use rand_distr::{Distribution, StandardNormal};

use super::*;
use crate::numerics::rng::stream;

#[test]
fn noise_goes_and_steps_stay() {
    let rng = &mut stream(1, 1, "noise", 0);
    // Begins at once each 50 samples, and fades; every second time nothing is felt.
    let moves = |t: usize| (t / 50).is_multiple_of(2);
    let touch = |t: usize| if moves(t) { 20.0 * (-((t % 50) as f64) / 17.0).exp() } else { 0.0 };
    let truth: Vec<f64> = (0..5000).map(touch).collect();
    let mut error = || -> f64 { StandardNormal.sample(rng) };
    let noisy: Vec<f32> = truth.iter().map(|pressure| (pressure + error()).max(0.0) as f32).collect();
    let mut found = noisy.clone();
    smooth(&mut found, 1.1);
    let off = |found: &[f32], some: &dyn Fn(usize) -> bool| {
        let squares = (0..truth.len()).filter(|t| some(*t)).map(|t| (f64::from(found[t]) - truth[t]).powi(2));
        (squares.sum::<f64>() / (0..truth.len()).filter(|t| some(*t)).count() as f64).sqrt()
    };
    let early = |t: usize| moves(t) && t % 50 < 30;
    assert!(off(&found, &early) < 0.6 * off(&noisy, &early), "{}", off(&found, &early));
    assert!(off(&found, &|t| t % 100 == 0) < 1.5, "a step is not blurred");
    let rests = (0..truth.len()).filter(|t| !moves(*t));
    let felt = rests.clone().filter(|t| found[*t] > 0.0).count();
    assert!(felt * 100 < rests.count(), "{felt}");
}

#[test]
fn a_series_too_short_for_a_line_keeps_what_is_above_the_noise() {
    let mut few = [10.0, 1.0, 0.0, 9.0];
    smooth(&mut few, 1.0);
    assert_eq!(few, [10.0, 0.0, 0.0, 9.0]);
}
