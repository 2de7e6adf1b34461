//! Test how new the states of a movement are.

use std::f64::consts::TAU;

use rand::RngExt;

use super::*;
use crate::numerics::rng::stream;

/// What 60 sensors feel while their velocities are these functions of time, plus noise of this size.
fn felt(noise: f64, velocity: impl Fn(usize, f64) -> f64) -> Tactile {
    let mut rng = stream(1, 1, "novelty", 0);
    let pressures = (0..60).flat_map(|sensor| {
        (0..2000)
            .map(|t| velocity(sensor, t as f64 / 10.0) + noise * rng.random_range(-1.0..1.0))
            .collect::<Vec<f64>>()
    });
    Tactile { samples: 2000, pressures: pressures.map(|v| v.max(0.0).powi(2) as f32).collect() }
}

fn of(tactile: &Tactile) -> f64 {
    novelty(tactile, false, &(0..60).collect::<Vec<usize>>())
}

#[test]
fn a_rhythm_repeats_itself_at_any_speed() {
    let steady = felt(0.0, |sensor, t| (t - sensor as f64).sin());
    // Each period takes longer than the one before, and is slower.
    let slower = felt(0.0, |sensor, t| (20.0 * (1.0 + t).ln() - sensor as f64).sin() / (1.0 + t));
    assert!(of(&steady) < 1e-3 && of(&slower) < 1e-3, "{} {}", of(&steady), of(&slower));
}

#[test]
fn a_loop_of_states_that_are_much_alike_repeats_itself() {
    // The squared cosine of two states is 0.88 at least, and a movement that only goes on is new.
    let going = |t: f64, sensor: usize| 2.0 + 0.5 * (t + sensor as f64).sin();
    let alike = felt(0.0, |sensor, t| going(TAU * t / 20.0, sensor));
    let onward = felt(0.0, |sensor, t| going(TAU * t / 500.0, sensor));
    assert!(of(&alike) < 1e-3 && of(&onward) > 0.02, "{} {}", of(&alike), of(&onward));
}

#[test]
fn movements_that_differ_are_new() {
    let several = felt(0.0, |sensor, t| {
        (0..6).map(|own| (t * (1.0 + own as f64).sqrt() + (own * sensor) as f64).sin()).sum()
    });
    let noisy = felt(0.2, |sensor, t| (t - sensor as f64).sin());
    assert!(of(&several) > 0.03 && of(&noisy) > 5e-3, "{} {}", of(&several), of(&noisy));
}

#[test]
fn a_loop_may_consist_of_many_motions() {
    // Every ten seconds the same: at one frequency, and at thirty of random phases.
    let one = felt(0.0, |sensor, t| (TAU * t / 10.0 - sensor as f64).sin());
    let phase = |sensor: usize, own: usize| ((1 + own * own) * (3 + sensor)) as f64;
    let rich = felt(0.0, |sensor, t| {
        (1..30).map(|own| (TAU * own as f64 * t / 10.0 - phase(sensor, own)).sin()).sum()
    });
    let few = |tactile: &Tactile| has_few_motions(tactile, false, &(0..60).collect::<Vec<usize>>());
    let few_of_some = |tactile: &Tactile| has_few_motions(tactile, false, &(0..20).collect::<Vec<usize>>());
    assert!(of(&one) < 1e-3 && of(&rich) < 1e-3, "{} {}", of(&one), of(&rich));
    assert!(few(&one) && !few(&rich) && few_of_some(&one) && !few_of_some(&rich));
}

#[test]
fn one_state_or_none_is_not_said_to_repeat() {
    assert_eq!(of(&felt(0.0, |sensor, _| sensor as f64)), 1.0);
    assert_eq!(of(&felt(0.0, |_, _| 0.0)), 1.0);
}
