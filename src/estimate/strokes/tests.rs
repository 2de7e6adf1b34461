//! Test how many sensors at a time are few.

use super::*;

/// Whether they are few where this share of 20 sensors feels something at every other sample, each time others.
fn few(sensors: usize, value: impl Fn(usize, usize) -> f32) -> bool {
    let samples = 60;
    let pressure = |sensor: usize, t: usize| {
        let feels = t.is_multiple_of(2) && (sensor + 7 * t) % 20 < sensors;
        if feels { value(sensor, t) } else { 0.0 }
    };
    let all = (0..20).flat_map(|sensor| (0..samples).map(move |t| (sensor, t)));
    few_at_a_time(&Tactile { samples, pressures: all.map(|(sensor, t)| pressure(sensor, t)).collect() })
}

#[test]
fn half_of_the_sensors_are_not_few_and_a_tenth_are_whatever_they_read() {
    let values: [fn(usize, usize) -> f32; 2] =
        [|_, _| 1.0, |sensor, t| 10f32.powi((sensor % 5) as i32 - (t % 3) as i32)];
    for value in values {
        assert!(!few(10, value) && !few(5, value) && few(2, value));
    }
}

#[test]
fn negative_values_are_felt_and_missing_ones_are_not_known() {
    assert!(!few(10, |_, t| if t.is_multiple_of(4) { -1.0 } else { 1.0 }));
    assert!(!few(10, |sensor, _| if sensor.is_multiple_of(2) { f32::NAN } else { 1.0 }));
    assert!(few(2, |sensor, _| if sensor.is_multiple_of(2) { f32::NAN } else { 1.0 }));
}

#[test]
fn where_nothing_is_felt_none_are_few() {
    assert!(!few(0, |_, _| 1.0));
}
