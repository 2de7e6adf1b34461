//! The algebra of loadings c, sensors × k, and of the motion w that goes with them, samples × k.

use faer::Mat;
use nalgebra::DMatrix;

use super::roots::product;
use crate::numerics::eigen::largest;

/// c of the same c · w, for which the components of w are uncorrelated, and each has a variance of 1.
pub(super) fn whitened(loadings: &Mat<f64>, motion: &Mat<f64>) -> Mat<f64> {
    /// Of the mean square of w.
    const RIDGE: f64 = 1e-12;
    let k = loadings.ncols();
    let scatter = product(motion.transpose(), motion.as_ref());
    let ridge = f64::MIN_POSITIVE + RIDGE * (0..k).map(|at| scatter[(at, at)]).sum::<f64>();
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
    /// As a share of the mean square.
    const RIDGE: f64 = 1e-7;
    let k = squares.nrows();
    let trace: f64 = (0..k).map(|at| squares[(at, at)]).sum();
    let ridge = RIDGE * trace / k as f64 + f64::MIN_POSITIVE;
    let matrix = DMatrix::from_fn(k, k, |i, j| squares[(i, j)] + if i == j { ridge } else { 0.0 });
    let Some(factor) = matrix.cholesky() else { return Mat::zeros(products.nrows(), k) };
    let inverse = factor.inverse();
    product(products.as_ref(), Mat::from_fn(k, k, |i, j| inverse[(i, j)]).as_ref())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sensor_that_spans_a_component_alone_has_a_leverage_of_one() {
        // Eight sensors of a plane, and one that alone feels a third direction.
        let loadings = Mat::from_fn(9, 3, |sensor, at| {
            let angle = sensor as f64;
            match (sensor, at) {
                (8, _) => [0.3, -0.2, 0.1][at],
                (_, 2) => 0.0,
                _ => [angle.cos(), angle.sin()][at],
            }
        });
        let found = leverages(&loadings);
        assert!((found[8] - 1.0).abs() < 1e-4, "{found:?}");
        assert!(found[..8].iter().all(|leverage| *leverage < 0.5), "{found:?}");
        assert!((found.iter().sum::<f64>() - 3.0).abs() < 1e-4, "they add up to the rank: {found:?}");
    }

    #[test]
    fn whitened_loadings_give_the_same_roots() {
        let loadings = Mat::from_fn(5, 2, |i, j| (i as f64 + 1.0) * (j as f64 - 0.3));
        let motion = Mat::from_fn(50, 2, |t, j| ((t * (j + 2)) as f64).sin() * (j as f64 + 0.5));
        let found = whitened(&loadings, &motion);
        let covariance = |loadings: &Mat<f64>, middle: Mat<f64>| {
            product(product(loadings.as_ref(), middle.as_ref()).as_ref(), loadings.transpose())
        };
        let scatter = product(motion.transpose(), motion.as_ref()) * faer::Scale(1.0 / 50.0);
        let error = covariance(&found, Mat::identity(2, 2)) - covariance(&loadings, scatter);
        assert!(error.norm_max() < 1e-9);
    }
}
