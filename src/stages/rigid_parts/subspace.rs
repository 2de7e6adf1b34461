//! Estimate the motion subspace of a part from the pressures on its sensors: its rank, and a basis over all samples.

use faer::Mat;
use rayon::prelude::*;

use super::factorisation::Fit;
use super::roots::{Roots, size};
use super::stratified::stratified;

/// Sensors that are used, spread over all: enough for rank six.
const MAX_SENSORS: usize = 256;
/// Samples that c is learned from, spread over all at which anything is felt.
const MAX_SAMPLES: usize = 2000;
/// Iterations in which c and w are found.
const ITERATIONS: usize = 16;
/// Share of what the best rank explains that a lower rank may leave unexplained.
const NEGLIGIBLE: f64 = 0.01;
/// Rank from which on the sensors of a face say something of how a part rotates. The end of a thin cylinder has rank one.
pub(super) const ROTATION_RANK: usize = 3;

/// The motion subspace of a part: a basis of it, which is the motion of the part up to a linear map.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MotionSubspace {
    /// k, at most six if it is that of one cluster of sensors; 0 if these feel nothing.
    pub rank: usize,
    /// w, T × k, by sample; each component has a mean square of about 1. NaN at a sample at which fewer than k sensors have
    /// a value.
    pub basis: Vec<f64>,
}

/// Loadings c of sensors, and what is known of their roots.
pub(super) struct Loadings {
    /// Sensors × k, of roots in units of the scales. Each component of w has a variance of 1.
    pub values: Mat<f64>,
    /// The unit of each sensor's roots, √Pa.
    pub scales: Vec<f64>,
    /// Standard deviation of what c · w leaves of a root, in these units.
    pub deviation: f64,
    /// The least root that is felt, in these units.
    pub floor: f64,
}

impl MotionSubspace {
    /// Of the sensors of a cluster, from their series of T pressures, NaN where one is missing.
    ///
    /// The rank is the lowest that explains nearly what the best one does. `signed` says whether negative pressures are signal.
    pub(crate) fn of_cluster(series: &[&[f32]], signed: bool) -> Self {
        let series: Vec<&[f32]> =
            stratified(series.len(), MAX_SENSORS).map(|sensor| series[sensor]).collect();
        let Some(fit) = learn(&Roots::at(&series, &felt_samples(&series, signed, MAX_SAMPLES), signed))
        else {
            return Self { rank: 0, basis: Vec::new() };
        };
        let loadings = fit.loadings();
        let found = Self::from_roots(&series, loadings.ncols(), &|samples| {
            Roots::at(&series, samples, signed).motion(loadings)
        });
        found.with_unit_size()
    }

    /// From given loadings c of sensors, and their series of T pressures, NaN where one is missing.
    pub(super) fn of_loadings(series: &[&[f32]], given: &Loadings, signed: bool) -> Self {
        let k = given.values.ncols();
        Self::from_roots(series, k, &|samples| {
            let roots = Roots::at(series, samples, signed).scaled(&given.scales).with_floor(given.floor);
            roots.likely_motion(&given.values, given.deviation)
        })
    }

    /// In units in which each component has a mean square of 1, as [`Self::of_loadings`] gives it: so that motions of faces of any size,
    /// and pressures in any unit, count alike.
    fn with_unit_size(mut self) -> Self {
        let k = self.rank;
        let mut sums = vec![(0.0, 0_usize); k];
        for w in self.basis.chunks(k).filter(|w| !w[0].is_nan()) {
            sums.iter_mut().zip(w).for_each(|((sum, count), w)| (*sum, *count) = (*sum + w * w, *count + 1));
        }
        let size = |&(sum, count): &(f64, usize)| (sum / count.max(1) as f64).sqrt();
        let sizes: Vec<f64> = sums.iter().map(size).collect();
        for w in self.basis.chunks_mut(k) {
            w.iter_mut().zip(&sizes).filter(|(_, size)| **size > 0.0).for_each(|(w, size)| *w /= size);
        }
        self
    }

    /// Of rank k, where `motion` gives w at some samples.
    fn from_roots(series: &[&[f32]], k: usize, motion: &(dyn Fn(&[usize]) -> Vec<f64> + Sync)) -> Self {
        /// Samples whose roots are in memory at once. It changes no result.
        const BLOCK: usize = 240;
        let samples = series.first().map_or(0, |series| series.len());
        let has_gaps = series.par_iter().any(|series| series.iter().any(|pressure| pressure.is_nan()));
        let is_known = |t: usize| series.iter().filter(|series| !series[t].is_nan()).count() >= k;
        let mut basis = vec![0.0; samples * k];
        basis.par_chunks_mut(BLOCK * k).enumerate().for_each(|(block, values)| {
            let samples: Vec<usize> = (block * BLOCK..block * BLOCK + values.len() / k).collect();
            values.copy_from_slice(&motion(&samples));
            if has_gaps {
                let unknown = samples.iter().zip(values.chunks_mut(k)).filter(|(t, _)| !is_known(**t));
                unknown.for_each(|(_, w)| w.fill(f64::NAN));
            }
        });
        Self { rank: k, basis }
    }

    /// w at a sample.
    pub(crate) fn at(&self, t: usize) -> &[f64] {
        &self.basis[t * self.rank..][..self.rank]
    }

    /// The sum of this subspace and another one at the same samples; components that both have count twice.
    pub(crate) fn with(&self, other: &Self) -> Self {
        if self.rank == 0 || other.rank == 0 {
            return if self.rank == 0 { other.clone() } else { self.clone() };
        }
        let samples = self.basis.len() / self.rank;
        let basis = (0..samples).flat_map(|t| [self.at(t), other.at(t)].concat()).collect();
        Self { rank: self.rank + other.rank, basis }
    }
}

/// At most so many samples, spread over those at which a sensor feels anything. `signed`: whether negative pressures are signal.
pub(super) fn felt_samples(series: &[&[f32]], signed: bool, most: usize) -> Vec<usize> {
    let samples = series.first().map_or(0, |series| series.len());
    let felt: Vec<usize> = (0..samples)
        .into_par_iter()
        .filter(|t| series.iter().any(|series| size(series[*t], signed) > 0.0))
        .collect();
    stratified(felt.len(), most).map(|at| felt[at]).collect()
}

/// c and w; `None` if nothing is felt.
fn learn(roots: &Roots) -> Option<Fit> {
    if roots.is_empty() {
        return None;
    }
    let start = roots.start();
    let most = start.max_rank();
    let with = |k: usize| {
        let fit = roots.fit(&start, k, ITERATIONS);
        (roots.total_residual(&fit), fit)
    };
    let fits: Vec<(f64, Fit)> = (1..=most).into_par_iter().map(with).collect();
    let least = fits.iter().map(|(residual, _)| *residual).fold(f64::INFINITY, f64::min);
    fits.into_iter().find(|(residual, _)| residual - least <= NEGLIGIBLE * (1.0 - least)).map(|(_, fit)| fit)
}

#[cfg(test)]
mod tests;
