//! Draw simulations with replacement, and tell from what a statistic is of each resample how sure it is (bootstrap).
//!
//! Observations of one simulation share its body map and are not independent, so the simulation is the unit that is drawn.

use rand::{Rng, RngExt};
use rayon::prelude::*;
use statrs::distribution::{ContinuousCDF, Normal};

use super::statistics::{Estimate, quantile, spread, student};

/// Draws as many of `count` units as there are, with replacement.
fn resample(count: usize, rng: &mut impl Rng) -> Vec<usize> {
    (0..count).map(|_| rng.random_range(0..count)).collect()
}

/// Draws clusters of these sizes, and of each that is drawn as many of its members as it has: the cluster and the member in it.
fn resample_clusters(sizes: &[usize], rng: &mut impl Rng) -> Vec<(usize, usize)> {
    let mut drawn = Vec::new();
    for _ in sizes {
        let cluster = rng.random_range(0..sizes.len());
        drawn.extend(resample(sizes[cluster], rng).into_iter().map(|member| (cluster, member)));
    }
    drawn
}

/// The statistic of each of `count` resamples of clusters and of their members, ascending; see [`resample_clusters`].
pub(crate) fn of_clusters(
    sizes: &[usize],
    count: usize,
    rng: &mut impl Rng,
    statistic: impl Fn(&[(usize, usize)]) -> f64,
) -> Vec<f64> {
    let mut values: Vec<f64> = (0..count).map(|_| statistic(&resample_clusters(sizes, rng))).collect();
    values.sort_by(f64::total_cmp);
    values
}

/// Resamples of simulations, the same for every estimate of an experiment.
#[derive(Debug, Clone)]
pub(crate) struct Resamples {
    /// The simulations that were drawn, counted from 0; a row a resample.
    drawn: Vec<Vec<usize>>,
}

impl Resamples {
    /// `count` resamples of so many simulations; none of one simulation, which is the same however often it is drawn.
    pub(crate) fn new(simulations: usize, count: usize, rng: &mut impl Rng) -> Self {
        let count = if simulations > 1 { count } else { 0 };
        Self { drawn: (0..count).map(|_| resample(simulations, rng)).collect() }
    }

    /// The statistic of each resample, ascending, without those that have none.
    pub(crate) fn values(&self, statistic: impl Fn(&[usize]) -> Option<f64> + Sync) -> Vec<f64> {
        let mut values: Vec<f64> = self.drawn.par_iter().filter_map(|drawn| statistic(drawn)).collect();
        values.sort_by(f64::total_cmp);
        values
    }

    /// `pooled`, an estimate over the observations of all simulations, with what the simulations differ by:
    /// `groups` holds the sum and the number of observations of each.
    ///
    /// The interval is the expanded percentile interval of Hesterberg (2015), which makes up for what a
    /// percentile interval lacks with few simulations; and it is never narrower than the one of `pooled`,
    /// which would hold if all observations were independent.
    ///
    /// # Panics
    /// If there are not as many groups as simulations.
    pub(crate) fn clustered(&self, pooled: Estimate, groups: &[(f64, usize)]) -> Estimate {
        let values: Vec<f64> =
            groups.iter().filter(|group| group.1 > 0).map(|group| group.0 / group.1 as f64).collect();
        let simulations = values.len();
        // Samples of simulations of their own are independent: their interval stands.
        let alone = simulations < 2 || groups.iter().all(|group| group.1 < 2);
        let Some((low, high)) = pooled.interval.filter(|_| !alone) else {
            return Estimate { simulations, ..pooled };
        };
        let means = self.values(|drawn| mean_of(drawn, groups));
        let (least, most) = percentile_interval(&means, simulations);
        Estimate {
            interval: Some((low.min(least), high.max(most))),
            simulations,
            spread: spread(&values),
            ..pooled
        }
    }

    /// The difference of two estimates over the same simulations, the second minus the first, each with the sum and
    /// the number of observations of each simulation.
    ///
    /// Simulations are drawn in pairs, since they share what the two have in common: the interval is the expanded
    /// percentile interval of the differences. It is never narrower than that of two estimates whose observations are all
    /// independent, by Zou & Donner (2008) from the intervals given. `None` if either has no value.
    pub(crate) fn difference(
        &self,
        (first, groups): (Estimate, &[(f64, usize)]),
        (second, others): (Estimate, &[(f64, usize)]),
    ) -> Estimate {
        let (Some(a), Some(b)) = (first.value, second.value) else { return Estimate::default() };
        let simulations = groups.iter().zip(others).filter(|(one, other)| one.1 > 0 && other.1 > 0).count();
        let difference = Estimate { value: Some(b - a), n: second.n, simulations, ..Estimate::default() };
        let Some(((a_low, a_high), (b_low, b_high))) = first.interval.zip(second.interval) else {
            return difference;
        };
        let (mut low, mut high) =
            (b - a - (b - b_low).hypot(a_high - a), b - a + (b_high - b).hypot(a - a_low));
        if simulations > 1 {
            let differences = self.values(|drawn| Some(mean_of(drawn, others)? - mean_of(drawn, groups)?));
            let (least, most) = percentile_interval(&differences, simulations);
            (low, high) = (low.min(least), high.max(most));
        }
        Estimate { interval: Some((low, high)), ..difference }
    }
}

/// The mean over the observations of the simulations that were drawn; `None` without an observation.
fn mean_of(drawn: &[usize], groups: &[(f64, usize)]) -> Option<f64> {
    assert_eq!(drawn.len(), groups.len(), "a group for each simulation");
    let mut times = vec![0.0; groups.len()];
    drawn.iter().for_each(|&simulation| times[simulation] += 1.0);
    let (sum, n) = times
        .iter()
        .zip(groups)
        .fold((0.0, 0.0), |(sum, n), (times, group)| (sum + times * group.0, n + times * group.1 as f64));
    (n > 0.0).then(|| sum / n)
}

/// The expanded percentile interval (Hesterberg 2015) of the `sorted` values of resamples of so many simulations, more
/// than one.
pub(crate) fn percentile_interval(sorted: &[f64], simulations: usize) -> (f64, f64) {
    let widened = (simulations as f64 / (simulations - 1) as f64).sqrt() * student(simulations);
    let tail = Normal::standard().cdf(-widened);
    (quantile(sorted, tail), quantile(sorted, 1.0 - tail))
}

#[cfg(test)]
mod tests;
