//! Split samples into a slower and a faster half, by how much some sensors move.

use faer::Mat;

use super::cluster::{Cluster, Felt};
use super::medians::median;
use super::roots::{Roots, columns};

/// The variance that one motion of these sensors leaves in the slower half of the samples, as a share of that in the faster half.
///
/// A pressure over a time step has terms of second order in the turn of its part. No motion of rank six explains them, and they vanish
/// in slow samples: the share is about a tenth. What two parts move against each other, and noise, do not.
pub(super) fn slow_share(felt: &Felt, sensors: &[usize]) -> f64 {
    let [slow, fast] = halves(felt, sensors).map(|half| {
        let all = (0..half.roots.sensors()).collect();
        Cluster::learned_longer(&half, all).variance()
    });
    slow / fast.max(f64::MIN_POSITIVE)
}

/// What these sensors felt at the samples at which the sum of their squares, in true size, is below the median, and at the others.
fn halves(felt: &Felt, sensors: &[usize]) -> [Felt; 2] {
    let own = columns(&felt.roots.values, sensors);
    let speed = |t: usize| {
        let known = (0..own.ncols()).map(|sensor| own[(t, sensor)]).filter(|root| !root.is_nan());
        felt.sizes[t] * known.map(|root| root * root).sum::<f64>().sqrt()
    };
    let speeds: Vec<f64> = (0..own.nrows()).map(speed).collect();
    let middle = median(speeds.clone());
    let completed = columns(&felt.completed, sensors);
    [false, true].map(|is_fast| {
        let samples: Vec<usize> = (0..speeds.len()).filter(|&t| (speeds[t] >= middle) == is_fast).collect();
        let at = |values: &Mat<f64>| {
            Mat::from_fn(samples.len(), values.ncols(), |t, sensor| values[(samples[t], sensor)])
        };
        let of = |numbers: &[f64]| samples.iter().map(|&t| numbers[t]).collect();
        let roots =
            Roots { values: at(&own), thresholds: of(&felt.roots.thresholds), signed: felt.roots.signed };
        let memory = felt.memory.clone();
        Felt { roots, completed: at(&completed), sizes: of(&felt.sizes), memory, ..*felt }
    })
}

#[cfg(test)]
mod tests;
