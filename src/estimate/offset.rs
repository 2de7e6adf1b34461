//! Find sensors that do not read 0 at rest: their reading there was not subtracted.
//!
//! A sensor that moves inward reads what it reads at rest, and of opposite sensors one always moves inward. So without noise, the reading at
//! rest is the least value of a sensor, and one of the most frequent. With noise, values at rest scatter about it. If it is above 0 by more
//! than the noise, nearly all values are.

use rayon::prelude::*;

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
    let own = |series: &[f32]| {
        let known = || {
            let known = series.iter().copied().filter(|pressure| !pressure.is_nan());
            known.map(|pressure| if signed { pressure } else { pressure.max(0.0) })
        };
        let least = known().fold(f32::INFINITY, f32::min);
        let (count, at_least) = (known().count(), known().filter(|pressure| *pressure == least).count());
        let elsewhere = usize::from(least != 0.0 && at_least as f64 >= AT_REST * count as f64);
        [elsewhere, known().filter(|pressure| *pressure > 0.0).count(), count]
    };
    let sums = tactile.pressures.par_chunks_exact(tactile.samples).map(own);
    let [elsewhere, above, all] = sums.reduce(|| [0; 3], |a, b| [a[0] + b[0], a[1] + b[1], a[2] + b[2]]);
    elsewhere as f64 > MOST * tactile.sensors() as f64 || !signed && above as f64 > ABOVE * all as f64
}

#[cfg(test)]
mod tests;
