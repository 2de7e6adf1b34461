//! Hold a Gaussian component, evaluate its density and draw points from it (equations 5 and 11).

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

use super::augmented::Augmented;

/// A matrix that is positive definite in exact arithmetic, but not in floating point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("a positive definite matrix is no longer so after rounding")]
pub struct Rounding;

/// A multivariate Gaussian N(μ, Σ), kept by a root of its precision: |P x − P μ|² is all that its density
/// needs, and no system is solved for μ.
#[derive(Debug, Clone, PartialEq)]
pub struct Gaussian {
    /// Row i is (row i of P, −(P μ)_i), P lower triangular with Λ = Σ⁻¹ = Pᵀ P.
    rows: Augmented,
    /// Log density at the mean.
    pub log_peak: f64,
}

impl Gaussian {
    /// From the mean and a lower triangular root P of the precision, Λ = Pᵀ P.
    pub fn new(mean: DVector<f64>, root: DMatrix<f64>) -> Self {
        let dims = mean.len();
        let shift = &root * mean;
        let mut rows = Augmented::zeros(dims);
        for i in 0..dims {
            (0..=i).for_each(|j| rows.row_mut(i)[j] = root[(i, j)]);
            rows.row_mut(i)[dims] = -shift[i];
        }
        Self::from_rows(rows)
    }

    pub(super) fn from_rows(rows: Augmented) -> Self {
        let log_peak = rows.log_diagonal() - 0.5 * rows.dims as f64 * (2.0 * PI).ln();
        Self { rows, log_peak }
    }

    /// Row i of P, up to its diagonal, and −(P μ)_i.
    #[inline(always)]
    pub fn root_row(&self, i: usize) -> (&[f64], f64) {
        let row = self.rows.row(i);
        (&row[..=i], row[self.rows.dims])
    }

    /// log N(x; μ, Σ).
    pub fn log_density(&self, x: &[f64]) -> f64 {
        let square = |i: usize| {
            let (root, shift) = self.root_row(i);
            root.iter().zip(x).fold(shift, |sum, (root, x)| sum + root * x).powi(2)
        };
        self.log_peak - 0.5 * (0..x.len()).map(square).sum::<f64>()
    }

    /// P.
    fn root(&self) -> DMatrix<f64> {
        let dims = self.rows.dims;
        DMatrix::from_fn(dims, dims, |i, j| self.rows.row(i)[j])
    }

    /// x with P x − P μ = noise.
    fn unwhiten(&self, noise: DVector<f64>) -> DVector<f64> {
        let shift = DVector::from_iterator(noise.len(), self.rows.border());
        self.root().solve_lower_triangular(&(noise - shift)).expect("the diagonal of P is positive")
    }

    /// μ.
    pub fn mean(&self) -> DVector<f64> {
        self.unwhiten(DVector::zeros(self.rows.dims))
    }

    /// Λ, with the border −Λ μ.
    pub fn information(&self) -> Augmented {
        let mut information = Augmented::zeros(self.rows.dims);
        information.add_outer(self.rows.body());
        information
    }

    /// Λ.
    pub fn precision(&self) -> DMatrix<f64> {
        self.root().tr_mul(&self.root())
    }

    /// Σ, with the border μ.
    ///
    /// With U = Pᵀ, Σ = P⁻¹ P⁻ᵀ is the sum of the outer products of the rows of U⁻¹, and μ = P⁻¹ (P μ) that of the rows with
    /// P μ beside them.
    pub fn moments(&self) -> Augmented {
        let dims = self.rows.dims;
        let (mut root, mut inverse) = (Augmented::zeros(dims), Augmented::zeros(dims));
        for i in 0..dims {
            (0..=i).for_each(|j| root.row_mut(j)[i] = self.rows.row(i)[j]);
            inverse.row_mut(i)[i] = 1.0;
        }
        root.solve(&mut inverse);
        self.rows.border().enumerate().for_each(|(i, shift)| inverse.row_mut(i)[dims] = -shift);
        let mut moments = Augmented::zeros(dims);
        moments.add_outer(inverse.body());
        moments
    }

    /// Σ.
    pub fn covariance(&self) -> DMatrix<f64> {
        let (moments, dims) = (self.moments(), self.rows.dims);
        DMatrix::from_fn(dims, dims, |i, j| moments.row(i.min(j))[i.max(j)])
    }

    /// Draws a point.
    pub fn draw(&self, rng: &mut impl Rng) -> DVector<f64> {
        self.unwhiten(standard_normal(self.rows.dims, rng))
    }
}

/// d independent standard normal numbers.
pub fn standard_normal(dims: usize, rng: &mut impl Rng) -> DVector<f64> {
    DVector::from_fn(dims, |_, _| rng.sample(StandardNormal))
}
