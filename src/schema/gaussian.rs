//! Gaussian components: their normal-inverse-Wishart prior, its posterior, draws and marginal likelihood
//! (equations 8, 9, 16 and 17).
//!
//! The paper's Λ ~ W(V₀, ν₀), μ ~ N(m₀, (k₀ Λ)⁻¹) is the normal-inverse-Wishart with scale Ψ₀ = V₀⁻¹.
//! Formulas: Murphy (2007), "Conjugate Bayesian analysis of the Gaussian distribution", section 9. The
//! paper leaves the hyperparameters open; ours are Fraley & Raftery's (2007), as in mclust.

use std::f64::consts::PI;

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use rand::{Rng, RngExt};
use rand_distr::{ChiSquared, StandardNormal};

use super::points::{Points, Statistics};
use crate::settings::Schema;

/// A multivariate Gaussian N(μ, Σ), kept by a root of its precision.
#[derive(Debug, Clone, PartialEq)]
pub struct Gaussian {
    /// μ.
    pub mean: DVector<f64>,
    /// P, lower triangular, with Λ = Σ⁻¹ = Pᵀ P.
    root: DMatrix<f64>,
    /// The same by rows, each up to its diagonal.
    packed_root: Vec<f64>,
    /// Log density at the mean.
    pub log_peak: f64,
}

impl Gaussian {
    /// From the mean and a lower triangular root P of the precision, Λ = Pᵀ P.
    pub fn new(mean: DVector<f64>, root: DMatrix<f64>) -> Self {
        let dims = mean.len();
        let packed_root = (0..dims).flat_map(|i| (0..=i).map(move |j| (i, j))).map(|at| root[at]).collect();
        let log_det_root: f64 = (0..dims).map(|i| root[(i, i)].ln()).sum();
        let log_peak = log_det_root - 0.5 * dims as f64 * (2.0 * PI).ln();
        Self { mean, root, packed_root, log_peak }
    }

    /// Row i of P, up to its diagonal.
    #[inline(always)]
    pub fn root_row(&self, i: usize) -> &[f64] {
        &self.packed_root[i * (i + 1) / 2..][..=i]
    }

    /// log N(x; μ, Σ).
    pub fn log_density(&self, x: &DVector<f64>) -> f64 {
        self.log_peak - 0.5 * (&self.root * (x - &self.mean)).norm_squared()
    }

    /// Λ.
    pub fn precision(&self) -> DMatrix<f64> {
        self.root.tr_mul(&self.root)
    }

    /// Σ.
    pub fn covariance(&self) -> DMatrix<f64> {
        let identity = DMatrix::identity(self.mean.len(), self.mean.len());
        let inverse = self.root.solve_lower_triangular(&identity).expect("the diagonal of P is positive");
        &inverse * inverse.transpose()
    }

    /// Draws a point.
    pub fn draw(&self, rng: &mut impl Rng) -> DVector<f64> {
        let noise = standard_normal(self.mean.len(), rng);
        &self.mean + self.root.solve_lower_triangular(&noise).expect("the diagonal of P is positive")
    }
}

/// d independent standard normal numbers.
pub fn standard_normal(dims: usize, rng: &mut impl Rng) -> DVector<f64> {
    DVector::from_fn(dims, |_, _| rng.sample(StandardNormal))
}

/// NIW(m, k, Ψ, ν): Σ ~ inverse-Wishart(Ψ, ν), μ ~ N(m, Σ / k).
#[derive(Debug, Clone)]
pub struct NormalInverseWishart {
    /// m.
    pub mean: DVector<f64>,
    /// k > 0, in observations.
    pub mean_weight: f64,
    /// Ψ by its Cholesky factor.
    scale: Cholesky<f64, Dyn>,
    /// ν > d − 1.
    pub freedom: f64,
}

/// A prior that cannot be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PriorError {
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
        debug_assert!(mean_weight > 0.0 && freedom > mean.len() as f64 - 1.0);
        Some(Self { mean, mean_weight, scale: scale.cholesky()?, freedom })
    }

    /// The prior of Fraley & Raftery (2007), section 3.2: m₀ the mean of the points, k₀ = 0.01, ν₀ = d + 2,
    /// Ψ₀ = covariance / K^(2/d); k₀, ν₀ − d, K and a factor on Ψ₀ are settings.
    ///
    /// # Errors
    /// [`PriorError::Flat`] if the covariance is singular.
    pub fn fraley_raftery(points: &Points, settings: &Schema) -> Result<Self, PriorError> {
        let dims = points.dims;
        let shrink = settings.scale / (settings.components as f64).powf(2.0 / dims as f64);
        let covariance = points.covariance();
        // A relative bound: the Cholesky factorisation alone would let rounding pass for spread.
        let spread = covariance.diagonal().max();
        let deviation = spread.sqrt();
        if spread > 0.0 && !(1e-50..=1e50).contains(&deviation) {
            return Err(PriorError::Scale(deviation));
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
        prior.filter(|_| !flat).ok_or(PriorError::Flat { points: points.count, dims })
    }

    /// The posterior given points with these statistics: again normal-inverse-Wishart (Murphy, 250–254).
    pub fn posterior(&self, data: &Statistics) -> Self {
        let weight = self.mean_weight + data.count;
        let mean = (self.mean_weight * &self.mean + &data.sum) / weight;
        // The lower triangles alone; Cholesky reads no more.
        let lower = self.scale.l_dirty().lower_triangle();
        let mut scale = &lower * lower.transpose() + &data.outer;
        scale.ger(self.mean_weight, &self.mean, &self.mean, 1.0);
        scale.ger(-weight, &mean, &mean, 1.0);
        let scale = scale.cholesky().expect("a positive definite scale plus a scatter is positive definite");
        Self { mean, mean_weight: weight, scale, freedom: self.freedom + data.count }
    }

    /// Draws (μ, Σ).
    ///
    /// Λ is Wishart(Ψ⁻¹, ν) by Bartlett's decomposition: with Ψ = L Lᵀ and B upper triangular,
    /// B_ii² ~ χ²(ν − d + i) and normal above, Λ = L⁻ᵀ B Bᵀ L⁻¹, so that P = Bᵀ L⁻¹ is lower triangular.
    pub fn draw(&self, rng: &mut impl Rng) -> Gaussian {
        let dims = self.mean.len();
        let mut root = DMatrix::zeros(dims, dims);
        for i in 0..dims {
            let freedom = self.freedom - dims as f64 + (i + 1) as f64;
            let square: f64 = rng.sample(ChiSquared::new(freedom).expect("ν > d − 1"));
            // The smallest normal number stands for an underflow to zero, which has no logarithm.
            root[(i, i)] = square.max(f64::MIN_POSITIVE).sqrt();
            for j in i + 1..dims {
                root[(i, j)] = rng.sample(StandardNormal);
            }
        }
        self.scale.l_dirty().tr_solve_lower_triangular_mut(&mut root);
        let root = root.transpose();
        let noise = standard_normal(dims, rng) / self.mean_weight.sqrt();
        let offset = root.solve_lower_triangular(&noise).expect("the diagonal of P is positive");
        Gaussian::new(&self.mean + offset, root)
    }

    /// Log marginal likelihood of points with these statistics, μ and Σ integrated out (Murphy, 266).
    pub fn log_marginal(&self, data: &Statistics) -> f64 {
        let posterior = self.posterior(data);
        let dims = self.mean.len() as f64;
        self.log_mass() - posterior.log_mass() - 0.5 * data.count * dims * PI.ln()
            + 0.5 * dims * (self.mean_weight / posterior.mean_weight).ln()
    }

    /// (ν / 2) log |Ψ| − log Γ_d(ν / 2) up to a constant that depends on d alone.
    fn log_mass(&self) -> f64 {
        let log_det = 2.0 * self.scale.l_dirty().diagonal().iter().map(|x| x.ln()).sum::<f64>();
        let log_gamma: f64 =
            (0..self.mean.len()).map(|i| libm::lgamma((self.freedom - i as f64) / 2.0)).sum();
        0.5 * self.freedom * log_det - log_gamma
    }
}

#[cfg(test)]
mod tests;
