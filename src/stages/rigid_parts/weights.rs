//! Weigh samples by how well they can be explained: feasible generalised least squares (Aitken 1936).
//!
//! Errors are not alike at all samples. A pressure over a time step has terms of second order in the turn of its part, which count most
//! where that turns fast. Noise counts most where little moves, and a stroke of contact lasts for a few samples. So the variance of a
//! sample is estimated by what many clusters leave of it, and its roots are divided accordingly.

use rayon::prelude::*;

use super::cluster::{Cluster, Felt};
use super::roots::divide_rows;

/// Divides what was felt at each sample by √(1 + σ²/τ), for the residual variance σ² that these clusters leave there, and the tolerance τ.
/// Then no sample leaves more than τ. Where the data are exact, next to nothing changes.
pub(super) fn weigh(felt: &mut Felt, clusters: &[Cluster]) {
    let residuals: Vec<Vec<[f64; 2]>> = clusters.par_iter().map(|own| by_sample(felt, own)).collect();
    let divisor = |t: usize| {
        let (sum, freedom) =
            residuals.iter().fold((0.0, 0.0), |(sum, freedom), own| (sum + own[t][0], freedom + own[t][1]));
        (1.0 + sum / f64::max(freedom, 1.0) / felt.tolerance).sqrt()
    };
    let divisors: Vec<f64> = (0..felt.sizes.len()).map(divisor).collect();
    felt.roots.divide(&divisors);
    divide_rows(&mut felt.completed, &divisors);
    felt.sizes.iter_mut().zip(&divisors).for_each(|(size, divisor)| *size *= divisor);
}

/// How evenly the residual of a cluster is spread over time, 0 to 1: the mean residual variance of the half of the samples that have less of
/// it, as a share of that of the other half. Samples without a degree of freedom do not count.
pub(super) fn calm_share(felt: &Felt, cluster: &Cluster) -> f64 {
    let told = by_sample(felt, cluster).into_iter().filter(|[_, freedom]| *freedom >= 1.0);
    let mut variances: Vec<f64> = told.map(|[sum, freedom]| sum / freedom).collect();
    variances.sort_unstable_by(f64::total_cmp);
    let (calm, other) = variances.split_at(variances.len() / 2);
    let mean = |of: &[f64]| of.iter().sum::<f64>() / of.len().max(1) as f64;
    mean(calm) / mean(other).max(f64::MIN_POSITIVE)
}

/// At each sample the residual sum of squares of the informative roots of a cluster, and its degrees of freedom: those beyond the k that
/// w takes.
fn by_sample(felt: &Felt, cluster: &Cluster) -> Vec<[f64; 2]> {
    let predicted = cluster.predicted();
    let at = |t: usize| {
        let (mut sum, mut informative) = (0.0, 0_usize);
        for (at, &sensor) in cluster.representatives.iter().enumerate() {
            let (root, predicted) = (felt.roots.values[(t, sensor)], predicted[(t, at)]);
            if root >= felt.roots.thresholds[t] || predicted > root {
                sum += (root - predicted).powi(2);
                informative += 1;
            }
        }
        [sum, informative.saturating_sub(cluster.rank()) as f64]
    };
    (0..felt.sizes.len()).map(at).collect()
}

#[cfg(test)]
mod tests;
