//! Factorise the roots of the pressures on a rigid part into loadings of sensors and motion: a censored regression (Tobin 1958)
//! whose regressors are unknown, too.
//!
//! A root is max(0, c · w). [Alternating least squares](Als) finds c and w over the informative roots: those that are felt, and
//! those that c · w predicts but that are not felt. The start is the principal components of differences between sensors that
//! never feel at the same sample, which are opposite to each other. Roots with a sign are not censored, and their principal
//! components are w. Motion that no sensor feels, such as the spin of a cylinder, is not in w. w is known up to a linear map,
//! which does not matter.

use faer::Mat;

use super::als::Als;
use super::roots::{Roots, product};
use crate::numerics::eigen::largest;

/// Largest rank of a motion subspace: velocity and angular velocity of a rigid body are six numbers.
pub(crate) const MAX_RANK: usize = 6;
/// Iterations in which w is found from given c: each updates which roots are informative.
const ITERATIONS: usize = 4;
/// Share of the largest eigenvalue of cᵀ c from which on an axis counts as spanned.
const SPANNED: f64 = 1e-12;

/// c of some sensors and w at some samples, up to six components by descending variance: where the iterations start.
pub(crate) struct Start {
    /// Sensors × components.
    loadings: Mat<f64>,
    /// Samples × components.
    motion: Mat<f64>,
}

/// c of some sensors and w at some samples.
pub(crate) struct Fit {
    /// Sensors × k; the columns are orthonormal.
    loadings: Mat<f64>,
    /// Samples × k.
    motion: Mat<f64>,
}

impl Start {
    /// Largest rank that can be fitted, at most [`MAX_RANK`].
    pub(crate) fn max_rank(&self) -> usize {
        self.loadings.ncols()
    }
}

impl Fit {
    /// c, sensors × k; the columns are orthonormal.
    pub(crate) fn loadings(&self) -> &Mat<f64> {
        &self.loadings
    }
}

impl Roots {
    /// Where the iterations start: the principal components of series that are linear in the motion.
    pub(crate) fn start(&self) -> Start {
        let linear = if self.signed { self.filled() } else { self.differences() };
        let loadings = principal_axes(&linear, MAX_RANK);
        Start { motion: product(linear.as_ref(), loadings.as_ref()), loadings }
    }

    /// Finds c and w of a rank, at most that of the start, in so many iterations.
    pub(crate) fn fit(&self, start: &Start, rank: usize, iterations: usize) -> Fit {
        let iterations = if self.signed { 1 } else { iterations };
        let mut loadings = start.loadings.subcols(0, rank).to_owned();
        let mut motion = start.motion.subcols(0, rank).to_owned();
        let als = Als::new(self.values.as_ref(), &self.thresholds);
        for _ in 0..iterations {
            als.update_motion(loadings.as_ref(), &mut motion);
            als.update_loadings(loadings.as_mut(), &motion);
            orthonormalise(&mut loadings, &mut motion);
        }
        als.update_motion(loadings.as_ref(), &mut motion);
        Fit { loadings, motion }
    }

    /// Residual sum of squares of a fit over all roots that are known, as a share of their sum of squares.
    pub(crate) fn total_residual(&self, fit: &Fit) -> f64 {
        self.residuals_of_samples(fit).iter().sum::<f64>() / self.sums()[1]
    }

    /// Residual sum of squares of a fit at each sample.
    pub(crate) fn residuals_of_samples(&self, fit: &Fit) -> Vec<f64> {
        let mut residuals = vec![0.0; self.samples()];
        let predictions = product(fit.motion.as_ref(), fit.loadings.transpose());
        for sensor in 0..self.sensors() {
            let own = predictions.col_as_slice(sensor).iter().zip(self.values.col_as_slice(sensor));
            for (residual, (prediction, root)) in residuals.iter_mut().zip(own) {
                if !root.is_nan() {
                    *residual += (root - self.censored(*prediction)).powi(2);
                }
            }
        }
        residuals
    }

    /// The root that c · w gives.
    fn censored(&self, prediction: f64) -> f64 {
        if self.signed { prediction } else { prediction.max(0.0) }
    }

    /// w at all samples from given c of these sensors, sensors × k: T × k, by sample.
    pub(super) fn motion(&self, loadings: &Mat<f64>) -> Vec<f64> {
        by_sample(&self.motion_of(loadings))
    }

    /// The most likely w at all samples from given c, as [`motion`](Self::motion) gives it: w is standard normal, and the errors of
    /// roots have this standard deviation.
    pub(super) fn likely_motion(&self, loadings: &Mat<f64>, deviation: f64) -> Vec<f64> {
        let (sensors, k) = loadings.shape();
        // What is known of w is one more observation of 0 for each component. It counts where it is predicted to exceed its root, as
        // one of ±w always is; with signs, each counts.
        let deviations: &[f64] = if self.signed { &[deviation] } else { &[deviation, -deviation] };
        let more = k * deviations.len();
        let with = |i: usize, at: usize| match i.checked_sub(sensors) {
            None => loadings[(i, at)],
            Some(more) if more % k == at => deviations[more / k],
            Some(_) => 0.0,
        };
        let values =
            Mat::from_fn(
                self.samples(),
                sensors + more,
                |t, i| {
                    if i < sensors { self.values[(t, i)] } else { 0.0 }
                },
            );
        let roots = Self { values, thresholds: self.thresholds.clone(), signed: self.signed };
        by_sample(&roots.motion_of(&Mat::from_fn(sensors + more, k, with)))
    }

    fn motion_of(&self, loadings: &Mat<f64>) -> Mat<f64> {
        let mut motion = Mat::zeros(self.samples(), loadings.ncols());
        let als = Als::new(self.values.as_ref(), &self.thresholds);
        (0..ITERATIONS).for_each(|_| als.update_motion(loadings.as_ref(), &mut motion));
        motion
    }
}

fn by_sample(motion: &Mat<f64>) -> Vec<f64> {
    (0..motion.nrows()).flat_map(|t| (0..motion.ncols()).map(move |at| motion[(t, at)])).collect()
}

/// So many principal axes of some columns, or as many as there are, by descending variance.
pub(super) fn principal_axes(columns: &Mat<f64>, count: usize) -> Mat<f64> {
    let squares = product(columns.transpose(), columns.as_ref());
    largest(squares.as_ref(), count)
        .map_or_else(|_| Mat::identity(squares.nrows(), count.min(squares.nrows())), |eigen| eigen.vectors)
}

/// Makes the columns of c orthonormal along its principal axes, and rotates w with it.
pub(super) fn orthonormalise(loadings: &mut Mat<f64>, motion: &mut Mat<f64>) {
    let squares = product(loadings.transpose(), loadings.as_ref());
    let Ok(eigen) = largest(squares.as_ref(), loadings.ncols()) else { return };
    let least = SPANNED * eigen.values[0];
    let rotation = |scale: &dyn Fn(f64) -> f64| {
        Mat::from_fn(eigen.vectors.nrows(), eigen.vectors.ncols(), |row, at| {
            let value = eigen.values[at];
            if value > least { eigen.vectors[(row, at)] * scale(value.sqrt()) } else { 0.0 }
        })
    };
    *loadings = product(loadings.as_ref(), rotation(&f64::recip).as_ref());
    *motion = product(motion.as_ref(), rotation(&|span| span).as_ref());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_likely_motion_is_that_of_a_ridge_regression() {
        // One component, two sensors: w = c · r / (c · c + deviation²).
        let values = Mat::from_fn(1, 2, |_, sensor| [1.0, 3.0][sensor]);
        let roots = Roots { values, thresholds: vec![0.1], signed: false };
        let loadings = Mat::from_fn(2, 1, |sensor, _| [0.5, 1.0][sensor]);
        let found = roots.likely_motion(&loadings, 2.0);
        assert!((found[0] - 3.5 / (1.25 + 4.0)).abs() < 1e-6, "{found:?}");
        assert!((roots.likely_motion(&loadings, 0.0)[0] - 3.5 / 1.25).abs() < 1e-6);
        let signed = Roots { signed: true, thresholds: vec![f64::NEG_INFINITY], ..roots };
        assert!((signed.likely_motion(&loadings, 2.0)[0] - found[0]).abs() < 1e-6);
    }
}
