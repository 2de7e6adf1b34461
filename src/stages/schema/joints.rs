//! Sample the latent joint between two Gaussian components, and weigh that edge of the tree (equations 13, 14, 18 and
//! 22).
//!
//! A joint q is a point that both components generate, so it is drawn from the product of their
//! densities, and it is data of both when they are updated.

use std::f64::consts::PI;

use nalgebra::DVector;
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

use crate::stages::mixture::{Augmented, Gaussian, Rounding};

/// Draws q from the normalised product N(q; μ_s, Σ_s) N(q; μ_c, Σ_c) (equation 18), a Gaussian with
/// precision Λ_s + Λ_c, given the [information](Gaussian::information) of both.
///
/// With Λ_s + Λ_c = Uᵀ U its mean is U⁻¹ U⁻ᵀ (Λ_s μ_s + Λ_c μ_c).
///
/// # Errors
/// [`Rounding`] if the sum is not positive definite in floating point.
pub fn draw_between(s: &Augmented, c: &Augmented, rng: &mut impl Rng) -> Result<DVector<f64>, Rounding> {
    let mut sum = s.clone();
    sum.add(c);
    let factor = sum.factor().ok_or(Rounding)?;
    let whitened = factor.border().map(|border| rng.sample::<f64, _>(StandardNormal) - border);
    let mut q = DVector::from_iterator(factor.dims, whitened);
    factor.solve_vector(q.as_mut_slice());
    Ok(q)
}

/// −log (N(q; μ_s, Σ_s) N(q; μ_c, Σ_c)), the quadratic cost of equation 22; where `floor` is positive, it is added to
/// both densities.
pub fn cost(q: &DVector<f64>, s: &Gaussian, c: &Gaussian, floor: f64) -> f64 {
    let log_density = |gaussian: &Gaussian| {
        let log = gaussian.log_density(q.as_slice());
        if floor > 0.0 { (log.exp() + floor).ln() } else { log }
    };
    -log_density(s) - log_density(c)
}

/// The cost of equation 22 with the joint q integrated out: −log N(μ_s; μ_c, Σ_s + Σ_c), given the
/// [moments](Gaussian::moments) of both, which all edges of a component share.
///
/// With Σ_s + Σ_c = Uᵀ U and w = U⁻ᵀ (μ_s − μ_c) it is |w|² / 2 + log |U| + d log(2π) / 2.
///
/// # Errors
/// [`Rounding`] if the sum is not positive definite in floating point.
pub fn collapsed_cost(s: &Augmented, c: &Augmented) -> Result<f64, Rounding> {
    let dims = s.dims;
    let mut sum = s.clone();
    sum.add(c);
    for (i, (mean_s, mean_c)) in s.border().zip(c.border()).enumerate() {
        sum.row_mut(i)[dims] = mean_s - mean_c;
    }
    let factor = sum.factor().ok_or(Rounding)?;
    let square: f64 = factor.border().map(|w| w * w).sum();
    Ok(0.5 * (square + dims as f64 * (2.0 * PI).ln()) + factor.log_diagonal())
}

#[cfg(test)]
mod tests;
