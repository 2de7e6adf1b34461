//! Choose the prior of the components from the settings and the body map; the paper leaves it open.

use nalgebra::{DMatrix, DVector};

use super::error::InferenceError;
use super::settings::{Prior, Schema};
use crate::stages::mixture::{NormalInverseWishart, Points};

/// The prior NIW(m₀, k₀, Ψ₀, ν₀). m₀ is the mean of the points; k₀ and ν₀ − d are `schema.mean_weight` and `schema.extra_freedom`. Ψ₀ is
/// `schema.scale` times one of these:
///
/// * covariance / K^(2/d): Fraley & Raftery (2007), section 3.2, who take k₀ = 0.01 and ν₀ = d + 2;
/// * the identity: the first author's code, with k₀ = 0.1 and ν₀ = d + 1, so that the unit of the map matters;
/// * the inverse covariance: a comment in that code suggests 10 times it.
///
/// # Errors
/// [`InferenceError::Flat`] if the covariance is singular where the scale needs it, [`InferenceError::Scale`] if the
/// points spread too far to compute with.
pub fn prior(points: &Points, settings: &Schema) -> Result<NormalInverseWishart, InferenceError> {
    let dims = points.dims;
    let covariance = points.covariance();
    // A relative bound: the Cholesky factorisation alone would let rounding pass for spread.
    let spread = covariance.diagonal().max();
    let deviation = spread.sqrt();
    if spread > 0.0 && !(1e-50..=1e50).contains(&deviation) {
        return Err(InferenceError::Scale(deviation));
    }
    let root =
        covariance.clone().cholesky().filter(|root| root.l_dirty().diagonal().min().powi(2) > 1e-12 * spread);
    let flat = InferenceError::Flat { points: points.count, dims };
    let scale = match settings.prior {
        Prior::FraleyRaftery => {
            root.map(|_| covariance * (settings.scale / (settings.components as f64).powf(2.0 / dims as f64)))
        }
        Prior::Identity => Some(DMatrix::identity(dims, dims) * settings.scale),
        Prior::InverseCovariance => root.map(|root| root.inverse() * settings.scale),
    };
    let freedom = dims as f64 + settings.extra_freedom;
    NormalInverseWishart::new(DVector::zeros(dims), settings.mean_weight, scale.ok_or(flat)?, freedom)
        .ok_or(InferenceError::Rounding)
}
