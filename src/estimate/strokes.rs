//! Find recordings in which few sensors feel something at a time, as where something strokes the skin.
//!
//! In a fluid, a part that moves is felt by the half of its skin that moves outward, so where all parts move, half of the sensors feel
//! something. What strokes a skin is felt where it is. Rectified motions of rank six explain a stroke as well as a movement: a bump that
//! moves along a part is the positive part of a few changing functions of the place. So the residual does not tell.

use rayon::prelude::*;

use crate::stages::sense::Tactile;

/// Share of a sensor's mean pressure, beyond which it feels something.
const FELT: f64 = 1e-3;
/// Share of sensors that feel something at a time, on average, below which these are few. In 186 simulated and recorded movements of
/// the calibration it was 0.43 and more; in strokes of two widths over nine bodies 0.02 to 0.33. With sensors of 8 bits, which read 0 at low
/// speeds, it was 0.22 and more.
const FEW: f64 = 0.2;

/// Whether few sensors feel something at a time, at the samples at which any does. Meant for sensors without noise, and those of which noise
/// was set to 0. Missing values count neither way.
pub(super) fn few_at_a_time(tactile: &Tactile) -> bool {
    /// Samples that are looked at at once. It changes no result.
    const BLOCK: usize = 1024;
    let size = |pressure: &f32| Some(f64::from(pressure.abs())).filter(|size| !size.is_nan());
    let limit = |series: &[f32]| {
        let sizes = || series.iter().filter_map(size);
        FELT * (sizes().sum::<f64>() / sizes().count().max(1) as f64)
    };
    let series: Vec<&[f32]> = tactile.series().collect();
    let limits: Vec<f64> = series.par_iter().map(|series| limit(series)).collect();
    let counted = |first: usize| {
        let count = BLOCK.min(tactile.samples - first);
        let (mut known, mut felt) = (vec![0u64; count], vec![0u64; count]);
        for (series, limit) in series.iter().zip(&limits) {
            for (t, pressure) in series[first..first + count].iter().enumerate() {
                known[t] += u64::from(!pressure.is_nan());
                felt[t] += u64::from(f64::from(pressure.abs()) > *limit);
            }
        }
        let all = known.iter().zip(&felt).filter(|(_, felt)| **felt > 0).map(|(known, _)| known);
        [felt.iter().sum::<u64>(), all.sum()]
    };
    let firsts: Vec<usize> = (0..tactile.samples).step_by(BLOCK).collect();
    let [felt, all] =
        firsts.into_par_iter().map(counted).reduce(|| [0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
    (felt as f64) < FEW * all as f64
}

#[cfg(test)]
mod tests;
