//! Take noise off the pressures of sensors, and count as no touch what it explains.
//!
//! In: [`Tactile`] pressures of sensors that all change, NaN where one is missing. Out: the same, smoothed where a sensor has noise, with 0 where a
//! pressure is within it.
//!
//! Noise that is new at each sample shows in the second differences of a sensor, p(t−1) − 2p(t) + p(t+1), by four marks, and all of
//! them have to be seen:
//!
//! * It never rests. Nearly all differences are other than 0, 7 of 8 even where values below 0 are cut; a sensor that now and then
//!   is on the lee side of its part has fewer.
//! * It has one size. Of Gaussian noise, the median absolute difference is 2.1 times the lower quartile. Touch, which is
//!   nothing for a while and then grows large, has all sizes.
//! * It has no memory. Two differences that share no sample, three samples apart, have the same sign half the time; of a smooth
//!   movement, or of one that rings from step to step, they have it more often.
//! * It comes to each sensor by itself. What several sensors share is movement, however rough.
//!
//! On the body of the paper with 120 sensors, at p = 0 and 0.9, of 300 to 15,000 samples, and signed or not (seeds 11 to 13), no sensor
//! without noise has the first three marks, and every sensor with noise of 0.01 or 0.1 of its root mean square has them. Any one alone
//! fails: where joints rest for long, few differences are left, and they may well have one size.
//!
//! The median is 1.0 to 1.2 standard deviations of the noise where values below 0 are cut, and 1.65 where they are not.

mod shared;
mod smooth;
mod smooth_gaps;

use rayon::prelude::*;

use self::shared::{MIN_DIFFERENCES, SHARED, Signs};
use self::smooth::smooth;
use self::smooth_gaps::smooth_gaps;
use crate::stages::sense::Tactile;

/// Largest ratio of the median to the lower quartile of absolute differences that is noise.
const MAX_MEDIAN_TO_QUARTILE: f64 = 4.0;
/// The least share of the differences that are other than 0, if it is noise.
const MIN_NONZERO_SHARE: f64 = 0.75;
/// How far the share of equal signs may lie from a half: the mean product of signs is twice as much.
const MAX_SIGN_IMBALANCE: f64 = SHARED / 2.0;
/// Noise seldom exceeds so many times its median absolute second difference.
const NOISE_LIMIT: f32 = 4.0;
/// A sensor of which fewer than one sample in so many exceeds its noise has levels, such as on and off, and no noise.
const MIN_SIGNAL_ONE_IN: usize = 1000;

/// The pressures above the noise, and how many sensors have noise.
pub fn above_noise(mut tactile: Tactile) -> (Tactile, usize) {
    let samples = tactile.samples;
    let mut sizes: Vec<Option<f32>> = tactile.pressures.par_chunks_exact(samples).map(size).collect();
    if sizes.iter().any(Option::is_some) {
        let signs = Signs::of(&tactile);
        let is_shared = |sensor: usize| {
            (0..signs.len()).any(|other| other != sensor && signs[sensor].are_shared_with(&signs[other]))
        };
        sizes = (0..sizes.len())
            .into_par_iter()
            .map(|sensor| sizes[sensor].filter(|_| !is_shared(sensor)))
            .collect();
    }
    let cut = |(series, size): (&mut [f32], &Option<f32>)| {
        let Some(size) = size else { return 0 };
        if series.iter().any(|pressure| pressure.is_nan()) {
            smooth_gaps(series, *size);
        } else {
            smooth(series, *size);
        }
        1
    };
    let noisy = tactile.pressures.par_chunks_exact_mut(samples).zip(&sizes).map(cut).sum();
    (tactile, noisy)
}

/// The median absolute second difference of a series with noise; `None` if it has none.
fn size(series: &[f32]) -> Option<f32> {
    // A difference that touches a gap is NaN, and is left out below.
    let differences: Vec<f32> = series.windows(3).map(|three| three[0] - 2.0 * three[1] + three[2]).collect();
    let known = differences.iter().filter(|difference| !difference.is_nan()).count();
    let mut sizes: Vec<f32> =
        differences.iter().map(|difference| difference.abs()).filter(|size| *size > 0.0).collect();
    if sizes.len() < MIN_DIFFERENCES as usize || (sizes.len() as f64) < MIN_NONZERO_SHARE * known as f64 {
        return None;
    }
    let (pairs, alike) = differences
        .windows(4)
        .map(|four| four[0] * four[3])
        .filter(|product| product.abs() > 0.0)
        .fold((0, 0), |(pairs, alike), product| (pairs + 1, alike + usize::from(product > 0.0)));
    // With a gap at every sixth sample, no two differences tell whether noise has a memory.
    if pairs == 0 || (alike as f64 / f64::from(pairs) - 0.5).abs() > MAX_SIGN_IMBALANCE {
        return None;
    }
    let middle = sizes.len() / 2;
    let (below, &mut size, _) = sizes.select_nth_unstable_by(middle, f32::total_cmp);
    let quartile = *below.select_nth_unstable_by(middle / 2, f32::total_cmp).1;
    let left = series.iter().filter(|pressure| pressure.abs() >= NOISE_LIMIT * size).count();
    let all = series.iter().filter(|pressure| !pressure.is_nan()).count();
    (f64::from(size) < MAX_MEDIAN_TO_QUARTILE * f64::from(quartile) && left * MIN_SIGNAL_ONE_IN >= all)
        .then_some(size)
}

#[cfg(test)]
mod tests;
