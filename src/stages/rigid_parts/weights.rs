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
mod tests {
    use faer::Mat;
    use rand::RngExt;

    use super::super::cluster::LEAST_TOLERANCE;
    use super::super::medians::median;
    use super::super::roots::product;
    use super::super::testing::felt_of;
    use super::*;
    use crate::numerics::rng::stream;

    /// What 30 sensors of one part feel at 600 samples, of which every tenth has an error of this size.
    fn felt(error: f64) -> Felt {
        let mut rng = stream(7, 1, "weights", 0);
        let mut uniform = |rows, columns| Mat::from_fn(rows, columns, |_, _| rng.random_range(-1.0_f64..1.0));
        let exact = product(uniform(600, 4).as_ref(), uniform(4, 30).as_ref());
        let errors = uniform(600, 30);
        let values = Mat::from_fn(600, 30, |t, sensor| {
            let own = if t % 10 == 0 { error * errors[(t, sensor)] } else { 0.0 };
            exact[(t, sensor)] + own
        });
        felt_of(&values).0
    }

    fn converged(felt: &Felt) -> Cluster {
        Cluster::converged(felt, (0..30).collect())
    }

    #[test]
    fn samples_with_an_error_weigh_less() {
        let mut felt = felt(0.3);
        let before = converged(&felt);
        weigh(&mut felt, std::slice::from_ref(&before));
        let typical = |wrong: bool| {
            median((0..600).filter(|t| (t % 10 == 0) == wrong).map(|t| felt.sizes[t]).collect())
        };
        assert!(typical(true) > 3.0 && typical(false) < 1.3, "{} and {}", typical(true), typical(false));
        let after = converged(&felt);
        assert!(before.variance() > 3.0 * LEAST_TOLERANCE, "{}", before.variance());
        assert!(after.variance() < 0.5 * LEAST_TOLERANCE, "{}", after.variance());
        let root = felt.roots.values[(10, 0)] * felt.sizes[10];
        assert!(
            (root - super::tests::felt(0.3).roots.values[(10, 0)]).abs() < 1e-12,
            "the true size is kept"
        );
    }

    #[test]
    fn an_error_of_few_samples_is_spread_unevenly_and_that_of_all_is_not() {
        let share = |felt: &Felt| calm_share(felt, &converged(felt));
        let few = share(&felt(0.3));
        // As large at every sample.
        let mut rng = stream(8, 1, "weights", 0);
        let mut uniform = |rows, columns| Mat::from_fn(rows, columns, |_, _| rng.random_range(-1.0_f64..1.0));
        let exact = product(uniform(600, 4).as_ref(), uniform(4, 30).as_ref());
        let all = share(&felt_of(&(exact + uniform(600, 30) * faer::Scale(0.1))).0);
        assert!(few < 0.05 && (0.3..1.0).contains(&all), "{few} and {all}");
    }

    #[test]
    fn exact_samples_stay_as_they_are() {
        let mut felt = felt(0.0);
        let exact = converged(&felt);
        weigh(&mut felt, &[exact]);
        assert!(felt.sizes.iter().all(|size| *size < 1.01), "{:?}", felt.sizes);
    }
}
