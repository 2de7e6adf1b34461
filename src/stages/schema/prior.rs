//! Choose the prior of the components from the body map (Fraley & Raftery 2007), which the paper leaves open.

use nalgebra::DVector;

use super::error::InferenceError;
use super::settings::Schema;
use crate::stages::mixture::{NormalInverseWishart, Points};

/// The prior of Fraley & Raftery (2007), section 3.2: m₀ the mean of the points, k₀ = 0.01, ν₀ = d + 2,
/// Ψ₀ = covariance / K^(2/d); k₀, ν₀ − d, K and a factor on Ψ₀ are settings.
///
/// # Errors
/// [`InferenceError::Flat`] if the covariance is singular.
pub fn fraley_raftery(points: &Points, settings: &Schema) -> Result<NormalInverseWishart, InferenceError> {
    let dims = points.dims;
    let shrink = settings.scale / (settings.components as f64).powf(2.0 / dims as f64);
    let covariance = points.covariance();
    // A relative bound: the Cholesky factorisation alone would let rounding pass for spread.
    let spread = covariance.diagonal().max();
    let deviation = spread.sqrt();
    if spread > 0.0 && !(1e-50..=1e50).contains(&deviation) {
        return Err(InferenceError::Scale(deviation));
    }
    let flat = !covariance
        .clone()
        .cholesky()
        .is_some_and(|root| root.l_dirty().diagonal().min().powi(2) > 1e-12 * spread);
    let prior = NormalInverseWishart::new(
        DVector::zeros(dims),
        settings.mean_weight,
        covariance * shrink,
        dims as f64 + settings.extra_freedom,
    );
    if flat {
        return Err(InferenceError::Flat { points: points.count, dims });
    }
    prior.ok_or(InferenceError::Rounding)
}
