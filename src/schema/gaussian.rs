//! Gaussian components: their normal-inverse-Wishart prior, its posterior, draws and marginal likelihood
//! (equations 8, 9, 16 and 17).
//!
//! The paper's Λ ~ W(V₀, ν₀), μ ~ N(m₀, (k₀ Λ)⁻¹) is the normal-inverse-Wishart with scale Ψ₀ = V₀⁻¹.
//! Formulas: Murphy (2007), "Conjugate Bayesian analysis of the Gaussian distribution", section 9. The
//! paper leaves the hyperparameters open; ours are Fraley & Raftery's (2007), as in mclust.

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};
use rand::{Rng, RngExt};
use rand_distr::{ChiSquared, StandardNormal};

use super::bordered::Bordered;
use super::points::{Points, Statistics};
use crate::settings::Schema;

/// A multivariate Gaussian N(μ, Σ), kept by a root of its precision: |P x − P μ|² is all that its density
/// needs, and no system is solved for μ.
#[derive(Debug, Clone, PartialEq)]
pub struct Gaussian {
    /// Row i is (row i of P, −(P μ)_i), P lower triangular with Λ = Σ⁻¹ = Pᵀ P.
    rows: Bordered,
    /// Log density at the mean.
    pub log_peak: f64,
}

impl Gaussian {
    /// From the mean and a lower triangular root P of the precision, Λ = Pᵀ P.
    pub fn new(mean: DVector<f64>, root: DMatrix<f64>) -> Self {
        let dims = mean.len();
        let shift = &root * mean;
        let mut rows = Bordered::zeros(dims);
        for i in 0..dims {
            (0..=i).for_each(|j| rows.row_mut(i)[j] = root[(i, j)]);
            rows.row_mut(i)[dims] = -shift[i];
        }
        Self::from_rows(rows)
    }

    fn from_rows(rows: Bordered) -> Self {
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
    pub fn information(&self) -> Bordered {
        let mut information = Bordered::zeros(self.rows.dims);
        information.add_outer(self.rows.body());
        information
    }

    /// Λ.
    pub fn precision(&self) -> DMatrix<f64> {
        self.root().tr_mul(&self.root())
    }

    /// Σ.
    pub fn covariance(&self) -> DMatrix<f64> {
        let identity = DMatrix::identity(self.rows.dims, self.rows.dims);
        let inverse = self.root().solve_lower_triangular(&identity).expect("the diagonal of P is positive");
        &inverse * inverse.transpose()
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

/// NIW(m, k, Ψ, ν): Σ ~ inverse-Wishart(Ψ, ν), μ ~ N(m, Σ / k).
#[derive(Debug, Clone)]
pub struct NormalInverseWishart {
    /// Ψ + k m mᵀ, with the border k m and the corner k: to these a point x adds (x, 1)(x, 1)ᵀ.
    moments: Bordered,
    /// U, upper triangular, with Ψ = Uᵀ U.
    scale: Bordered,
    /// ν > d − 1.
    pub freedom: f64,
}

/// A mixture that cannot be computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MixtureError {
    /// Matrices beyond any memory.
    #[error(
        "schema.components = {components} in {dims} dimensions take matrices of more than 10 million numbers; use fewer \
         of either"
    )]
    TooManyNumbers {
        /// K.
        components: usize,
        /// d.
        dims: usize,
    },
    /// Results beyond any memory.
    #[error(
        "{draws} draws of {points} points are more than 1 billion labels; keep fewer (schema.chains, schema.sweeps, \
         schema.keep)"
    )]
    TooManyLabels {
        /// Draws that are kept.
        draws: usize,
        /// n.
        points: usize,
    },
    /// A matrix that is positive definite but for rounding.
    #[error(
        "a component is so flat that rounding leaves nothing of it; raise schema.scale, schema.extra_freedom or \
         schema.mean_weight, or use fewer dimensions"
    )]
    Rounding,
    /// Numbers so large or small that their products are none.
    #[error("the points spread over {0:e}, which is beyond what can be computed with; rescale them")]
    Scale(f64),
    /// The points span fewer than d dimensions.
    #[error(
        "the {points} points span fewer than {dims} dimensions, so the prior has no scale there; use fewer dimensions"
    )]
    Flat {
        /// n.
        points: usize,
        /// d.
        dims: usize,
    },
}

impl NormalInverseWishart {
    /// From m, k, Ψ and ν; `None` if Ψ is not positive definite.
    pub fn new(mean: DVector<f64>, mean_weight: f64, scale: DMatrix<f64>, freedom: f64) -> Option<Self> {
        let dims = mean.len();
        debug_assert!(mean_weight > 0.0 && freedom > dims as f64 - 1.0);
        let mean = mean.push(1.0);
        let mut moments = Bordered::zeros(dims);
        for i in 0..=dims {
            for j in i..=dims {
                let scale = if j < dims { scale[(i, j)] } else { 0.0 };
                moments.row_mut(i)[j] = scale + mean_weight * mean[i] * mean[j];
            }
        }
        Self::from_moments(moments, freedom)
    }

    fn from_moments(moments: Bordered, freedom: f64) -> Option<Self> {
        let mut scale = moments.clone();
        scale.eliminate_border();
        Some(Self { moments, scale: scale.factor()?, freedom })
    }

    /// m.
    pub fn mean(&self) -> DVector<f64> {
        let weight = self.mean_weight();
        DVector::from_iterator(self.moments.dims, self.moments.border().map(|b| b / weight))
    }

    /// k > 0, in observations.
    pub fn mean_weight(&self) -> f64 {
        self.moments.corner()
    }

    /// The prior of Fraley & Raftery (2007), section 3.2: m₀ the mean of the points, k₀ = 0.01, ν₀ = d + 2,
    /// Ψ₀ = covariance / K^(2/d); k₀, ν₀ − d, K and a factor on Ψ₀ are settings.
    ///
    /// # Errors
    /// [`MixtureError::Flat`] if the covariance is singular.
    pub fn fraley_raftery(points: &Points, settings: &Schema) -> Result<Self, MixtureError> {
        let dims = points.dims;
        let shrink = settings.scale / (settings.components as f64).powf(2.0 / dims as f64);
        let covariance = points.covariance();
        // A relative bound: the Cholesky factorisation alone would let rounding pass for spread.
        let spread = covariance.diagonal().max();
        let deviation = spread.sqrt();
        if spread > 0.0 && !(1e-50..=1e50).contains(&deviation) {
            return Err(MixtureError::Scale(deviation));
        }
        let flat = !covariance
            .clone()
            .cholesky()
            .is_some_and(|root| root.l_dirty().diagonal().min().powi(2) > 1e-12 * spread);
        let prior = Self::new(
            DVector::zeros(dims),
            settings.mean_weight,
            covariance * shrink,
            dims as f64 + settings.extra_freedom,
        );
        if flat {
            return Err(MixtureError::Flat { points: points.count, dims });
        }
        prior.ok_or(MixtureError::Rounding)
    }

    /// The posterior given points with these statistics: again normal-inverse-Wishart (Murphy, 250–254).
    ///
    /// # Errors
    /// [`MixtureError::Rounding`] if its scale, which is positive definite, is not so in floating point.
    pub fn posterior(&self, data: &Statistics) -> Result<Self, MixtureError> {
        let mut moments = self.moments.clone();
        moments.add(&data.moments);
        Self::from_moments(moments, self.freedom + data.count()).ok_or(MixtureError::Rounding)
    }

    /// Draws (μ, Σ).
    ///
    /// Λ is Wishart(Ψ⁻¹, ν) by Bartlett's decomposition: with Ψ = Uᵀ U and B upper triangular,
    /// B_ii² ~ χ²(ν − d + i) and normal above, Λ = U⁻¹ B Bᵀ U⁻ᵀ, so that Pᵀ = U⁻¹ B is upper triangular.
    /// μ = m + P⁻¹ z / √k with z standard normal, so that P μ = P m + z / √k.
    pub fn draw(&self, rng: &mut impl Rng) -> Gaussian {
        let dims = self.scale.dims;
        let mut columns = Bordered::zeros(dims);
        for i in 0..dims {
            let row = columns.row_mut(i);
            let freedom = self.freedom - dims as f64 + (i + 1) as f64;
            let square: f64 = rng.sample(ChiSquared::new(freedom).expect("ν > d − 1"));
            // The smallest normal number stands for an underflow to zero, which has no logarithm.
            row[i] = square.max(f64::MIN_POSITIVE).sqrt();
            row[i + 1..dims].fill_with(|| rng.sample(StandardNormal));
        }
        self.scale.solve(&mut columns);
        let mut rows = Bordered::zeros(dims);
        let spread = 1.0 / self.mean_weight().sqrt();
        let mean = self.mean();
        for i in 0..dims {
            let row = rows.row_mut(i);
            let mut shift = spread * rng.sample::<f64, _>(StandardNormal);
            for j in 0..=i {
                row[j] = columns.row(j)[i];
                shift += row[j] * mean[j];
            }
            row[dims] = -shift;
        }
        Gaussian::from_rows(rows)
    }

    /// Log marginal likelihood of points with these statistics, μ and Σ integrated out (Murphy, 266).
    ///
    /// # Errors
    /// As for [`Self::posterior`].
    pub fn log_marginal(&self, data: &Statistics) -> Result<f64, MixtureError> {
        let posterior = self.posterior(data)?;
        let dims = self.scale.dims as f64;
        let weights = 0.5 * dims * (self.mean_weight() / posterior.mean_weight()).ln();
        Ok(self.log_mass() - posterior.log_mass() - 0.5 * data.count() * dims * PI.ln() + weights)
    }

    /// (ν / 2) log |Ψ| − log Γ_d(ν / 2) up to a constant that depends on d alone.
    fn log_mass(&self) -> f64 {
        let log_det = 2.0 * self.scale.log_diagonal();
        let log_gamma: f64 =
            (0..self.scale.dims).map(|i| libm::lgamma((self.freedom - i as f64) / 2.0)).sum();
        0.5 * self.freedom * log_det - log_gamma
    }
}

#[cfg(test)]
mod tests;
