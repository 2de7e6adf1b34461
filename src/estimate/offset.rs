//! Find sensors that do not read 0 at rest: their reading there was not subtracted.
//!
//! A sensor that moves inward reads what it reads at rest, and of opposite sensors one always moves inward. So without noise, the reading at
//! rest is the least value of a sensor, and one of the most frequent. With noise, values at rest scatter about it. If it is above 0 by more
//! than the noise, nearly all values are.

use crate::stages::sense::Tactile;

/// Share of the samples from which on the least value of a sensor is its reading at rest.
const AT_REST: f64 = 0.1;
/// Share of sensors that rest at another value than 0, beyond which these are no single faults.
const MOST: f64 = 0.25;
/// Share of values above 0, beyond which sensors do not read 0 at rest. In 155 simulated and recorded movements of the calibration, at most 76 %
/// were above it (docs/estimate.md).
const ABOVE: f64 = 0.9;

/// Whether sensors of a recording do not read 0 at rest. `signed`: whether negative values count; if not, they are 0.
pub(super) fn has_offset(tactile: &Tactile, signed: bool) -> bool {
    let (mut elsewhere, mut above, mut all) = (0, 0, 0);
    for series in tactile.series() {
        let known = || {
            let known = series.iter().copied().filter(|pressure| !pressure.is_nan());
            known.map(|pressure| if signed { pressure } else { pressure.max(0.0) })
        };
        let least = known().fold(f32::INFINITY, f32::min);
        let (count, at_least) = (known().count(), known().filter(|pressure| *pressure == least).count());
        elsewhere += usize::from(least != 0.0 && at_least as f64 >= AT_REST * count as f64);
        above += known().filter(|pressure| *pressure > 0.0).count();
        all += count;
    }
    elsewhere as f64 > MOST * tactile.sensors() as f64 || !signed && above as f64 > ABOVE * all as f64
}

#[cfg(test)]
mod tests {
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
}
