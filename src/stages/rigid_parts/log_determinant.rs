//! What it takes to encode the motion of a cluster: the term ln det(I + Σ c cᵀ / tolerance) of its description length.

use faer::Mat;
use nalgebra::SMatrix;

use super::factorisation::MAX_RANK;
use super::roots::Roots;

/// Numbers on the diagonal of a matrix and below it, row by row.
const TRIANGLE: usize = MAX_RANK * (MAX_RANK + 1) / 2;

/// ln det(I + scale · Σ c cᵀ cov(w)) on average over samples, where the sum is over the roots at a sample, and one that is not felt
/// counts `censored`, and one that is missing nothing. In: the roots of some sensors, and their c, for which each component of w has a variance of 1.
pub(super) fn log_determinant(roots: &Roots, whitened: &Mat<f64>, scale: f64, censored: f64) -> f64 {
    let [felt, other] = [scale, scale * censored].map(|weight| terms(whitened, weight));
    let of_sample = |t: usize| {
        let mut sums = [0.0; TRIANGLE];
        for (sensor, (felt, other)) in felt.iter().zip(&other).enumerate() {
            let root = roots.values[(t, sensor)];
            if !root.is_nan() {
                let terms = if root >= roots.thresholds[t] { felt } else { other };
                sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
            }
        }
        log_determinant_with_identity(&sums)
    };
    (0..roots.samples()).map(of_sample).sum::<f64>() / roots.samples() as f64
}

/// The triangle of weight · c cᵀ for each sensor.
fn terms(whitened: &Mat<f64>, weight: f64) -> Vec<[f64; TRIANGLE]> {
    let of_sensor = |sensor| {
        let mut terms = [0.0; TRIANGLE];
        // A motion that has one component more, on its way out of a minimum, is learned again without; no description length of it is used.
        for i in 0..whitened.ncols().min(MAX_RANK) {
            for j in 0..=i {
                terms[place(i, j)] = weight * whitened[(sensor, i)] * whitened[(sensor, j)];
            }
        }
        terms
    };
    (0..whitened.nrows()).map(of_sensor).collect()
}

/// Where a triangle has an element of row i and column j ≤ i.
fn place(i: usize, j: usize) -> usize {
    i * (i + 1) / 2 + j
}

/// ln det(I + A) of a positive semidefinite A, of which the triangle is given.
fn log_determinant_with_identity(triangle: &[f64; TRIANGLE]) -> f64 {
    let matrix = SMatrix::<f64, MAX_RANK, MAX_RANK>::from_fn(|i, j| triangle[place(i.max(j), i.min(j))]);
    (SMatrix::identity() + matrix).cholesky().map_or(f64::INFINITY, |factor| factor.ln_determinant())
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
        let mut triangle = [0.0; TRIANGLE];
        for i in 0..MAX_RANK {
            (0..=i).for_each(|j| triangle[place(i, j)] = x[i] * x[j] + 3.0 * y[i] * y[j]);
        }
        assert!((log_determinant_with_identity(&triangle) - (6.0_f64 * 19.0).ln()).abs() < 1e-12);
    }
}
