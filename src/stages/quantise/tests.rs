//! Test how pressures become levels.

use rand::RngExt;

use super::*;
use crate::numerics::rng::stream;

fn symbols(pressures: &[f32], sensors: usize, scheme: Scheme, levels: usize) -> Vec<u8> {
    let tactile = Tactile { samples: pressures.len() / sensors, pressures: pressures.to_vec() };
    quantise(&tactile, &Quantise { scheme, levels }).values
}

#[test]
fn positive_values_are_shared_equally() {
    let pressures = [0.0, 5.0, 1.0, 0.0, 6.0, 2.0, 4.0, 3.0];
    assert_eq!(symbols(&pressures, 1, Scheme::PerSensor, 4), [0, 3, 1, 0, 3, 1, 2, 2]);
}

#[test]
fn thresholds_are_quantiles_of_the_sorted_values() {
    let mut rng = stream(1, 1, "pressures", 0);
    for (count, levels) in [(0, 4), (1, 4), (2, 4), (3, 9), (40, 256), (1000, 2), (1000, 3), (1001, 8)] {
        let pressures: Vec<f32> = (0..count).map(|_| rng.random_range(-2..40) as f32 / 4.0).collect();
        let mut sorted: Vec<f32> = pressures.iter().copied().filter(|pressure| *pressure > 0.0).collect();
        sorted.sort_by(f32::total_cmp);
        let rank = |level: usize| (sorted.len() * level).div_ceil(levels - 1);
        let quantiles = (1..levels - 1).filter(|&level| rank(level) > 0).map(|level| sorted[rank(level) - 1]);
        let expected: Vec<f32> = std::iter::once(0.0).chain(quantiles).collect();
        assert_eq!(equal_frequency(&pressures, levels), expected, "{count} values, {levels} levels");
    }
}

#[test]
fn equal_values_stay_together_however_many_they_are() {
    let pressures = [2.0, 2.0, 2.0, 2.0, 2.0, 9.0];
    assert_eq!(symbols(&pressures, 1, Scheme::PerSensor, 4), [1, 1, 1, 1, 1, 3]);
}

#[test]
fn pooled_thresholds_are_common_to_all_sensors() {
    let pressures = [1.0, 2.0, 3.0, 10.0, 20.0, 30.0];
    assert_eq!(symbols(&pressures, 2, Scheme::PerSensor, 4), [1, 2, 3, 1, 2, 3]);
    assert_eq!(symbols(&pressures, 2, Scheme::Pooled, 4), [1, 1, 2, 2, 3, 3]);
}

#[test]
fn levels_of_equal_width_span_the_range() {
    assert_eq!(symbols(&[0.0, 1.0, 2.5, 5.0, 7.6, 10.0], 1, Scheme::EqualWidth, 4), [0, 0, 0, 1, 3, 3]);
}

#[test]
fn a_constant_sensor_is_reported() {
    let tactile = Tactile { samples: 3, pressures: vec![0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 7.0, 7.0, 7.0] };
    let symbols = quantise(&tactile, &Quantise { scheme: Scheme::PerSensor, levels: 3 });
    assert_eq!(symbols.constant_sensors(), [0, 2]);
}

#[test]
fn heavy_tails_fill_equal_frequency_levels_and_not_those_of_equal_width() {
    let pressures: Vec<f32> = (1..=1000).map(|i| (1000.0 / i as f32).powi(3)).collect();
    let share_of_largest = |scheme| {
        let symbols = symbols(&pressures, 1, scheme, 4);
        (0..4).map(|level| symbols.iter().filter(|&&s| s == level).count()).max().unwrap()
    };
    assert!(share_of_largest(Scheme::PerSensor) <= 334);
    assert!(share_of_largest(Scheme::EqualWidth) >= 990);
}
