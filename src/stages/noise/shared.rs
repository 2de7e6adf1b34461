//! Tell whether sensors share the signs of their second differences: what several sensors feel at once is movement, however rough.
//!
//! Sensors of one part feel the same jerks, such as those of a motor or of the jitter of motion capture, and noise comes to each
//! sensor by itself. Signs are compared, not values, for these are large at a few samples and small at most.

use rayon::prelude::*;

use crate::numerics::simd::vectorised;
use crate::stages::sense::Tactile;

/// Mean product of two sensors' signs from which on they are shared. That of independent noise is 0 but for chance: a standard
/// deviation of 0.1 for the fewest samples.
pub(super) const SHARED: f64 = 0.4;
/// Second differences other than 0 that a sensor, and two that are compared, must have: fewer tell nothing of noise.
pub(super) const MIN_DIFFERENCES: u32 = 100;
/// Samples that are looked at, from the first on.
const MAX_SAMPLES: usize = 20_000;

/// The signs of the second differences of a sensor, a bit for each.
pub(super) struct Signs {
    /// Whether a difference is other than 0, and known.
    some: Vec<u64>,
    /// Whether it is above 0.
    above: Vec<u64>,
}

impl Signs {
    /// Of each sensor.
    pub(super) fn of(tactile: &Tactile) -> Vec<Self> {
        let own = |series: &[f32]| {
            let count = MAX_SAMPLES.min(series.len());
            let differences: Vec<f32> =
                series[..count].windows(3).map(|three| three[0] - 2.0 * three[1] + three[2]).collect();
            let bits = |is: fn(f32) -> bool| -> Vec<u64> {
                let word =
                    |own: &[f32]| own.iter().rev().fold(0, |word, value| word << 1 | u64::from(is(*value)));
                differences.chunks(64).map(word).collect()
            };
            Self { some: bits(|value| value.abs() > 0.0), above: bits(|value| value > 0.0) }
        };
        tactile.pressures.par_chunks_exact(tactile.samples).map(own).collect()
    }

    /// Whether the signs of another sensor are much the same, or the opposite.
    pub(super) fn are_shared_with(&self, other: &Self) -> bool {
        let (mut count, mut alike) = (0, 0);
        vectorised(
            #[inline(always)]
            || {
                for at in 0..self.some.len() {
                    let both = self.some[at] & other.some[at];
                    count += both.count_ones();
                    alike += (both & !(self.above[at] ^ other.above[at])).count_ones();
                }
            },
        );
        let mean = 2.0 * f64::from(alike) / f64::from(count.max(1)) - 1.0;
        count >= MIN_DIFFERENCES && mean.abs() >= SHARED
    }
}
