//! Update and draw the parameters of a Gaussian component under a normal-inverse-Wishart prior (equations 9, 10, 16 and
//! 17).
//!
//! The paper's Λ ~ W(V₀, ν₀), μ ~ N(m₀, (k₀ Λ)⁻¹) is the normal-inverse-Wishart with scale Ψ₀ = V₀⁻¹.
//! Formulas: Murphy (2007), "Conjugate Bayesian analysis of the Gaussian distribution", section 9.

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};
use rand::{Rng, RngExt};
use rand_distr::{ChiSquared, StandardNormal};
use serde::{Deserialize, Serialize};

use super::augmented::Augmented;
use super::gaussian::{Gaussian, Rounding, standard_normal};
use super::points::SufficientStatistics;

/// The covariance of μ.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MeanCovariance {
    /// Ψ⁻¹ / k, which is no normal-inverse-Wishart: what the first author's code computes.
    InverseScale,
    /// Σ / k, as in equations 10 and 16.
    Component,
}

/// NIW(m, k, Ψ, ν): Σ ~ inverse-Wishart(Ψ, ν), μ ~ N(m, Σ / k).
#[derive(Debug, Clone)]
pub struct NormalInverseWishart {
    /// Ψ + k m mᵀ, with the border k m and the corner k: to these a point x adds (x, 1)(x, 1)ᵀ.
    moments: Augmented,
    /// U, upper triangular, with Ψ = Uᵀ U.
    scale: Augmented,
    /// ν > d − 1, degrees of freedom.
    pub degrees_of_freedom: f64,
}

impl NormalInverseWishart {
    /// The distribution with parameters m (d), k, Ψ (d × d) and ν; `None` if Ψ is not positive definite.
    pub fn new(
        mean: DVector<f64>,
        mean_weight: f64,
        scale: DMatrix<f64>,
        degrees_of_freedom: f64,
    ) -> Option<Self> {
        let dims = mean.len();
        debug_assert!(mean_weight > 0.0 && degrees_of_freedom > dims as f64 - 1.0);
        let mean = mean.push(1.0);
        let mut moments = Augmented::zeros(dims);
        for i in 0..=dims {
            for j in i..=dims {
                let scale = if j < dims { scale[(i, j)] } else { 0.0 };
                moments.row_mut(i)[j] = scale + mean_weight * mean[i] * mean[j];
            }
        }
        Self::from_moments(moments, degrees_of_freedom)
    }

    fn from_moments(moments: Augmented, degrees_of_freedom: f64) -> Option<Self> {
        let mut scale = moments.clone();
        scale.eliminate_border();
        Some(Self { moments, scale: scale.factor()?, degrees_of_freedom })
    }

    /// m.
    pub fn mean(&self) -> DVector<f64> {
        let weight = self.mean_weight();
        DVector::from_iterator(self.moments.dims, self.moments.border().map(|b| b / weight))
    }

    /// Ψ (d × d).
    pub fn scale(&self) -> DMatrix<f64> {
        let root = DMatrix::from_fn(self.scale.dims, self.scale.dims, |i, j| {
            if i <= j { self.scale.row(i)[j] } else { 0.0 }
        });
        root.tr_mul(&root)
    }

    /// The same distribution with Ψ⁻¹ for Ψ; `None` if that is not positive definite in floating point.
    pub fn with_inverse_scale(&self) -> Option<Self> {
        let inverse = self.scale().cholesky()?.inverse();
        Self::new(self.mean(), self.mean_weight(), inverse, self.degrees_of_freedom)
    }

    /// k > 0, in observations.
    pub fn mean_weight(&self) -> f64 {
        self.moments.corner()
    }

    /// The posterior given points with these statistics: again normal-inverse-Wishart (Murphy, 250–254).
    ///
    /// # Errors
    /// [`Rounding`] if its scale, which is positive definite, is not so in floating point.
    pub fn posterior(&self, data: &SufficientStatistics) -> Result<Self, Rounding> {
        let mut moments = self.moments.clone();
        moments.add(&data.moments);
        Self::from_moments(moments, self.degrees_of_freedom + data.count()).ok_or(Rounding)
    }

    /// Draws (μ, Σ).
    ///
    /// Λ is Wishart(Ψ⁻¹, ν) by Bartlett's decomposition: with Ψ = Uᵀ U and B upper triangular,
    /// B_ii² ~ χ²(ν − d + i) and normal above, Λ = U⁻¹ B Bᵀ U⁻ᵀ, so that Pᵀ = U⁻¹ B is upper triangular.
    /// μ = m + P⁻¹ z / √k with z standard normal, so that P μ = P m + z / √k.
    pub fn draw(&self, rng: &mut impl Rng) -> Gaussian {
        self.draw_with(MeanCovariance::Component, rng)
    }

    /// Draws (μ, Σ) with another covariance of μ: μ = m + U⁻¹ z / √k has the covariance Ψ⁻¹ / k.
    pub fn draw_with(&self, mean_covariance: MeanCovariance, rng: &mut impl Rng) -> Gaussian {
        let dims = self.scale.dims;
        let mut columns = Augmented::zeros(dims);
        for i in 0..dims {
            let row = columns.row_mut(i);
            let degrees_of_freedom = self.degrees_of_freedom - dims as f64 + (i + 1) as f64;
            let square: f64 = rng.sample(ChiSquared::new(degrees_of_freedom).expect("ν > d − 1"));
            // The smallest normal number stands for an underflow to zero, which has no logarithm.
            row[i] = square.max(f64::MIN_POSITIVE).sqrt();
            row[i + 1..dims].fill_with(|| rng.sample(StandardNormal));
        }
        self.scale.solve(&mut columns);
        let mut rows = Augmented::zeros(dims);
        let spread = 1.0 / self.mean_weight().sqrt();
        let mut mean = self.mean();
        if mean_covariance == MeanCovariance::InverseScale {
            let mut offset = standard_normal(dims, rng) * spread;
            self.scale.solve_vector(offset.as_mut_slice());
            mean += offset;
        }
        for i in 0..dims {
            let row = rows.row_mut(i);
            let mut shift = match mean_covariance {
                MeanCovariance::Component => spread * rng.sample::<f64, _>(StandardNormal),
                MeanCovariance::InverseScale => 0.0,
            };
            for j in 0..=i {
                row[j] = columns.row(j)[i];
                shift += row[j] * mean[j];
            }
            row[dims] = -shift;
        }
        Gaussian::from_rows(rows)
    }

    /// The distribution of a further point (Murphy, 258).
    pub fn predictive(&self) -> Predictive {
        let dims = self.scale.dims;
        let (weight, freedom) = (self.mean_weight(), self.degrees_of_freedom - dims as f64 + 1.0);
        let root = (freedom * weight / (weight + 1.0)).sqrt();
        let mut columns = Augmented::zeros(dims);
        (0..dims).for_each(|i| columns.row_mut(i)[i] = root);
        self.scale.solve(&mut columns);
        let root = DMatrix::from_fn(dims, dims, |i, j| columns.row(j)[i]);
        Predictive { gaussian: Gaussian::new(self.mean(), root), degrees_of_freedom: freedom }
    }

    /// Log marginal likelihood of points with these statistics, μ and Σ integrated out (Murphy, 266).
    ///
    /// # Errors
    /// As for [`Self::posterior`].
    pub fn log_marginal(&self, data: &SufficientStatistics) -> Result<f64, Rounding> {
        let posterior = self.posterior(data)?;
        let dims = self.scale.dims as f64;
        let weights = 0.5 * dims * (self.mean_weight() / posterior.mean_weight()).ln();
        Ok(self.log_mass() - posterior.log_mass() - 0.5 * data.count() * dims * PI.ln() + weights)
    }

    /// (ν / 2) log |Ψ| − log Γ_d(ν / 2) up to a constant that depends on d alone.
    fn log_mass(&self) -> f64 {
        let log_det = 2.0 * self.scale.log_diagonal();
        let log_gamma: f64 =
            (0..self.scale.dims).map(|i| libm::lgamma((self.degrees_of_freedom - i as f64) / 2.0)).sum();
        0.5 * self.degrees_of_freedom * log_det - log_gamma
    }
}

/// The t distribution of a point of a component whose Gaussian is integrated out.
#[derive(Debug, Clone)]
pub struct Predictive {
    /// A Gaussian of the same location and scale.
    pub gaussian: Gaussian,
    /// ν − d + 1 > 0.
    pub degrees_of_freedom: f64,
}

impl Predictive {
    /// Log density at x.
    pub fn log_density(&self, x: &[f64]) -> f64 {
        let (dims, freedom) = (x.len() as f64, self.degrees_of_freedom);
        let square = 2.0 * (self.gaussian.log_peak - self.gaussian.log_density(x));
        let constant = libm::lgamma((freedom + dims) / 2.0) - libm::lgamma(freedom / 2.0)
            + 0.5 * dims * (2.0 / freedom).ln();
        self.gaussian.log_peak + constant - 0.5 * (freedom + dims) * (square / freedom).ln_1p()
    }
}

#[cfg(test)]
mod tests;
