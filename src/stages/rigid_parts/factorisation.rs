//! Factorise the roots of the pressures on a rigid part into loadings of sensors and motion: a censored regression (Tobin 1958)
//! whose regressors are unknown, too.
//!
//! A root is max(0, c · w). [Alternating least squares](Als) finds c and w over the informative roots: those that are felt, and
//! those that c · w predicts but that are not felt. The start is the principal components of differences between sensors that
//! never feel at the same sample, which are opposite to each other. Roots with a sign are not censored, and their principal
//! components are w. Motion that no sensor feels, such as the spin of a cylinder, is not in w. w is known up to a linear map,
//! which does not matter.

use faer::Mat;
use rayon::prelude::*;

use super::als::Als;
use super::roots::{Roots, product};
use crate::numerics::eigen::largest;

/// Largest rank of a motion subspace: velocity and angular velocity of a rigid body are six numbers.
pub(crate) const MAX_RANK: usize = 6;
/// Iterations in which c is found from given w, or w from given c: each updates which roots are informative.
const ITERATIONS: usize = 4;
/// Share of the largest eigenvalue of cᵀ c from which on an axis counts as spanned.
const SPANNED: f64 = 1e-12;
/// Sensors whose residuals one thread finds at once.
const SENSORS: usize = 64;

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
    /// Residual sum of squares of the informative roots, on average over samples.
    pub residual: f64,
    /// Degrees of freedom of that residual: informative roots beyond the k that w takes, on average over samples.
    pub freedom: f64,
}

impl Start {
    /// Largest rank that can be fitted, at most [`MAX_RANK`].
    pub(crate) fn max_rank(&self) -> usize {
        self.loadings.ncols()
    }
}

impl Fit {
    /// k, the rank of the motion subspace.
    pub(crate) fn rank(&self) -> usize {
        self.loadings.ncols()
    }

    /// Number of sensors.
    pub(crate) fn sensors(&self) -> usize {
        self.loadings.nrows()
    }

    /// Number of samples.
    pub(crate) fn samples(&self) -> usize {
        self.motion.nrows()
    }

    /// The sum of w wᵀ over samples, k × k.
    pub(crate) fn scatter(&self) -> Mat<f64> {
        product(self.motion.transpose(), self.motion.as_ref())
    }
}

impl Roots {
    /// Where the iterations start: the principal components of series that are linear in the motion.
    pub(crate) fn start(&self) -> Start {
        let linear = if self.signed { self.values.clone() } else { self.differences() };
        let loadings = principal_axes(&product(linear.transpose(), linear.as_ref()));
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
        let [residual, freedom] = als.residual(loadings.as_ref(), &motion);
        Fit { residual, freedom, loadings, motion }
    }

    /// Residual sum of squares of a fit over all roots, as a share of their sum of squares.
    pub(crate) fn total_residual(&self, fit: &Fit) -> f64 {
        self.residuals_of_samples(fit).iter().sum::<f64>() / self.values.squared_norm_l2()
    }

    /// Residual sum of squares of a fit at each sample.
    pub(crate) fn residuals_of_samples(&self, fit: &Fit) -> Vec<f64> {
        let mut residuals = vec![0.0; self.samples()];
        let predictions = product(fit.motion.as_ref(), fit.loadings.transpose());
        for sensor in 0..self.sensors() {
            let own = predictions.col_as_slice(sensor).iter().zip(self.values.col_as_slice(sensor));
            for (residual, (prediction, root)) in residuals.iter_mut().zip(own) {
                *residual += (root - self.censored(*prediction)).powi(2);
            }
        }
        residuals
    }

    /// The root that c · w gives.
    fn censored(&self, prediction: f64) -> f64 {
        if self.signed { prediction } else { prediction.max(0.0) }
    }

    /// w at all samples from given c, of a fit to the same sensors at other samples: T × k, by sample.
    pub(crate) fn motion(&self, fit: &Fit) -> Vec<f64> {
        let k = fit.rank();
        let mut motion = Mat::zeros(self.samples(), k);
        let als = Als::new(self.values.as_ref(), &self.thresholds);
        (0..ITERATIONS).for_each(|_| als.update_motion(fit.loadings.as_ref(), &mut motion));
        (0..self.samples()).flat_map(|t| (0..k).map(move |at| (t, at))).map(|at| motion[at]).collect()
    }

    /// The best c of each sensor for w of a fit to any sensors at these samples: sensors × k.
    pub(crate) fn loadings(&self, fit: &Fit) -> Mat<f64> {
        self.some_loadings(fit, 0, self.sensors())
    }

    /// The same of so many sensors from one on.
    fn some_loadings(&self, fit: &Fit, first: usize, count: usize) -> Mat<f64> {
        let mut loadings = Mat::zeros(count, fit.rank());
        let als = Als::new(self.values.subcols(first, count), &self.thresholds);
        (0..ITERATIONS).for_each(|_| als.update_loadings(loadings.as_mut(), &fit.motion));
        loadings
    }

    /// Residual variance of each sensor with its best c, as a share of its mean square, for w of a fit to any sensors at these
    /// samples; 1 if it feels nothing.
    pub(crate) fn residuals(&self, fit: &Fit) -> Vec<f64> {
        let firsts: Vec<usize> = (0..self.sensors()).step_by(SENSORS).collect();
        let residuals = |sensor: usize| {
            let count = SENSORS.min(self.sensors() - sensor);
            let loadings = self.some_loadings(fit, sensor, count);
            let predictions = product(fit.motion.as_ref(), loadings.transpose());
            let share = |at: usize| {
                let roots = self.values.col_as_slice(sensor + at);
                let all: f64 = roots.iter().map(|root| root * root).sum();
                let both = roots.iter().zip(predictions.col_as_slice(at));
                let residual: f64 =
                    both.map(|(root, prediction)| (root - self.censored(*prediction)).powi(2)).sum();
                if all > 0.0 { residual / all } else { 1.0 }
            };
            (0..count).map(share).collect::<Vec<f64>>()
        };
        firsts.into_par_iter().flat_map(residuals).collect()
    }
}

/// The first eigenvectors, by descending eigenvalue.
fn principal_axes(squares: &Mat<f64>) -> Mat<f64> {
    largest(squares.as_ref(), MAX_RANK)
        .map_or_else(|_| Mat::identity(squares.nrows(), MAX_RANK.min(squares.nrows())), |eigen| eigen.vectors)
}

/// Makes the columns of c orthonormal along its principal axes, and rotates w with it.
fn orthonormalise(loadings: &mut Mat<f64>, motion: &mut Mat<f64>) {
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
