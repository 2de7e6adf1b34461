//! Test which readings at rest are found.

use super::*;

/// Eight sensors that feel something at every other sample. Otherwise they read this much, and up to 13 times the scatter more.
fn found(rest: impl Fn(usize) -> f32, scatter: f32, signed: bool) -> bool {
    let samples = 40;
    let pressure = |sensor: usize, t: usize| match (t + sensor) % 2 {
        0 => 10.0 + ((7 * t + 13 * sensor) % 29) as f32,
        _ => rest(sensor) + scatter * ((11 * t) % 13) as f32,
    };
    let pressures = (0..8).flat_map(|sensor| (0..samples).map(move |t| (sensor, t)));
    has_offset(
        &Tactile { samples, pressures: pressures.map(|(sensor, t)| pressure(sensor, t)).collect() },
        signed,
    )
}

#[test]
fn readings_at_rest_other_than_0_are_found_unless_they_are_few() {
    for signed in [false, true] {
        assert!(!found(|_| 0.0, 0.0, signed));
        assert!(found(|_| 0.01, 0.0, signed));
        assert!(found(|sensor| if sensor < 3 { 0.01 } else { 0.0 }, 0.0, signed));
        assert!(!found(|sensor| if sensor < 2 { 0.01 } else { 0.0 }, 0.0, signed));
    }
}

#[test]
fn below_0_they_count_if_negative_values_do() {
    assert!(found(|_| -0.5, 0.0, true));
    assert!(!found(|_| -0.5, 0.0, false));
}

#[test]
fn with_noise_they_are_found_above_it() {
    assert!(found(|_| 1.0, 0.02, false));
    // As much noise about 0.
    assert!(!found(|_| -0.12, 0.02, false));
}
