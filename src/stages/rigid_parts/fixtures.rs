//! Pressures on a sensor of known loadings, and how well a motion is found, for tests.

use nalgebra::DMatrix;

/// The pressures on a sensor with loadings c, while its part moves by w, T × k by sample.
pub(crate) fn sensor_series<'a>(w: &'a [f64], c: &'a [f64]) -> impl Iterator<Item = f32> + 'a {
    let root = move |w: &[f64]| w.iter().zip(c).map(|(w, c)| w * c).sum::<f64>();
    w.chunks(c.len()).map(move |w| root(w).max(0.0).powi(2) as f32)
}

/// The share of the squares of the true motion, T × k by sample, that no linear map of the found one, of this rank, explains.
pub(super) fn unexplained(w: &[f64], (found, rank): (&[f64], usize)) -> f64 {
    let samples = found.len() / rank;
    let w = DMatrix::from_row_slice(samples, w.len() / samples, w);
    let x = DMatrix::from_row_slice(samples, rank, found);
    let fitted = &x * x.clone().svd(true, true).solve(&w, 1e-12).unwrap();
    (&w - fitted).norm_squared() / w.norm_squared()
}
