//! Find recordings in which few sensors feel something at a time, as where something strokes the skin.
//!
//! In a fluid, a part that moves is felt by the half of its skin that moves outward, so where all parts move, half of the sensors feel
//! something. What strokes a skin is felt where it is. Rectified motions of rank six explain a stroke as well as a movement: a bump that
//! moves along a part is the positive part of a few changing functions of the place. So the residual does not tell.

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
    let mut is_felt = vec![false; tactile.samples];
    let (mut known, mut felt) = (vec![0u32; tactile.samples], 0u64);
    for series in tactile.series() {
        let sizes = || series.iter().enumerate().filter(|(_, pressure)| !pressure.is_nan());
        let sizes = || sizes().map(|(t, pressure)| (t, f64::from(pressure.abs())));
        let mean = sizes().map(|(_, size)| size).sum::<f64>() / sizes().count().max(1) as f64;
        for (t, size) in sizes() {
            known[t] += 1;
            if size > FELT * mean {
                is_felt[t] = true;
                felt += 1;
            }
        }
    }
    let all: u64 =
        known.iter().zip(&is_felt).filter(|(_, is_felt)| **is_felt).map(|(count, _)| u64::from(*count)).sum();
    (felt as f64) < FEW * all as f64
}

#[cfg(test)]
mod tests;
