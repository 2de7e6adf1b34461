//! What it takes to encode the motion of a cluster: the term ln det(I + Σ c cᵀ / tolerance) of its description length.

use faer::Mat;
use nalgebra::SMatrix;

use super::factorisation::MAX_RANK;
use super::roots::Roots;

/// ln det(I + scale · Σ c cᵀ cov(w)) on average over samples, where the sum is over the roots at a sample, and one that is not felt
/// counts `censored`, and one that is missing nothing. In: the roots of some sensors, and their c, for which each component of w has a variance of 1.
pub(super) fn log_determinant(roots: &Roots, whitened: &Mat<f64>, scale: f64, censored: f64) -> f64 {
    let k = whitened.ncols();
    let row = |sensor| std::array::from_fn(|at| if at < k { whitened[(sensor, at)] } else { 0.0 });
    let rows: Vec<[f64; MAX_RANK]> = (0..whitened.nrows()).map(row).collect();
    let of_sample = |t: usize| {
        let mut matrix = [[0.0; MAX_RANK]; MAX_RANK];
        for (sensor, c) in rows.iter().enumerate() {
            let root = roots.values[(t, sensor)];
            let told = if root.is_nan() { 0.0 } else { censored };
            let weight = if root >= roots.thresholds[t] { scale } else { scale * told };
            for (i, row) in matrix.iter_mut().enumerate() {
                (0..=i).for_each(|j| row[j] += weight * c[i] * c[j]);
            }
        }
        log_determinant_with_identity(matrix)
    };
    (0..roots.samples()).map(of_sample).sum::<f64>() / roots.samples() as f64
}

/// ln det(I + A) of a positive semidefinite A, of which the lower triangle is given.
fn log_determinant_with_identity(matrix: [[f64; MAX_RANK]; MAX_RANK]) -> f64 {
    let matrix =
        SMatrix::identity() + SMatrix::<f64, MAX_RANK, MAX_RANK>::from_fn(|i, j| matrix[i.max(j)][i.min(j)]);
    matrix.cholesky().map_or(f64::INFINITY, |factor| factor.ln_determinant())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_felt_tells_more_of_the_motion() {
        // Two sensors of one component, of which the second is felt at one of two samples.
        let values = Mat::from_fn(2, 2, |t, sensor| if (t, sensor) == (1, 1) { 0.0 } else { 1.0 });
        let roots = Roots { values, thresholds: vec![0.5; 2], signed: false };
        let found = log_determinant(&roots, &Mat::from_fn(2, 1, |sensor, _| [1.0, 2.0][sensor]), 10.0, 0.02);
        let expected = ((1.0_f64 + 10.0 * 5.0).ln() + (1.0_f64 + 10.0 * (1.0 + 0.02 * 4.0)).ln()) / 2.0;
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        // A = x xᵀ + 3 y yᵀ for orthogonal x and y.
        let (x, y) = ([1.0, 2.0, 0.0, 0.0, 0.0, 0.0], [2.0, -1.0, 0.0, 0.0, 1.0, 0.0]);
        let matrix = std::array::from_fn(|i| std::array::from_fn(|j| x[i] * x[j] + 3.0 * y[i] * y[j]));
        assert!((log_determinant_with_identity(matrix) - (6.0_f64 * 19.0).ln()).abs() < 1e-12);
    }
}
