//! The algebra of loadings c, sensors × k, and of the motion w that goes with them, samples × k.

use faer::Mat;
use nalgebra::DMatrix;

use super::regressions::RIDGE;
use super::roots::product;
use crate::numerics::eigen::largest;

/// c of the same c · w, for which the components of w are uncorrelated, and each has a variance of 1.
pub(super) fn whitened(loadings: &Mat<f64>, motion: &Mat<f64>) -> Mat<f64> {
    /// Variance that is added to each component of w, as a share of the sum of all: it only gives the matrix a factor.
    const LEAST: f64 = 1e-12;
    let k = loadings.ncols();
    let scatter = product(motion.transpose(), motion.as_ref());
    let ridge = f64::MIN_POSITIVE + LEAST * (0..k).map(|at| scatter[(at, at)]).sum::<f64>();
    let covariance = DMatrix::from_fn(k, k, |i, j| {
        (scatter[(i.max(j), i.min(j))] + if i == j { ridge } else { 0.0 }) / motion.nrows() as f64
    });
    let Some(factor) = covariance.cholesky() else { return Mat::zeros(loadings.nrows(), k) };
    let factor = factor.unpack();
    product(loadings.as_ref(), Mat::from_fn(k, k, |i, j| factor[(i, j)]).as_ref())
}

/// Leverage of each sensor: the share of what it feels that its own c explains, c (Σ c cᵀ)⁻¹ cᵀ (Hoaglin and Welsch 1978).
pub(super) fn leverages(loadings: &Mat<f64>) -> Vec<f64> {
    let squares = product(loadings.transpose(), loadings.as_ref());
    let spread = solved(&squares, loadings);
    let leverage =
        |sensor| (0..loadings.ncols()).map(|at| loadings[(sensor, at)] * spread[(sensor, at)]).sum();
    (0..loadings.nrows()).map(leverage).collect()
}

/// Variances along the principal axes of c wᵀ, from c for which each component of w has a variance of 1.
pub(super) fn components(whitened: &Mat<f64>) -> Vec<f64> {
    let squares = product(whitened.transpose(), whitened.as_ref());
    largest(squares.as_ref(), whitened.ncols())
        .map_or_else(|_| Vec::new(), |eigen| eigen.values.iter().map(|value| value.max(0.0)).collect())
}

/// X of X A = B for a symmetric A, k × k, with a ridge.
pub(super) fn solved(squares: &Mat<f64>, products: &Mat<f64>) -> Mat<f64> {
    let k = squares.nrows();
    let trace: f64 = (0..k).map(|at| squares[(at, at)]).sum();
    let ridge = RIDGE * trace / k as f64 + f64::MIN_POSITIVE;
    let matrix = DMatrix::from_fn(k, k, |i, j| squares[(i, j)] + if i == j { ridge } else { 0.0 });
    let Some(factor) = matrix.cholesky() else { return Mat::zeros(products.nrows(), k) };
    let inverse = factor.inverse();
    product(products.as_ref(), Mat::from_fn(k, k, |i, j| inverse[(i, j)]).as_ref())
}

#[cfg(test)]
mod tests;
