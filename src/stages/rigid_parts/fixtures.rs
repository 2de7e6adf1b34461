//! Pressures on a sensor of known loadings, for tests.

/// The pressures on a sensor with loadings c, while its part moves by w, T × k by sample.
pub(crate) fn sensor_series<'a>(w: &'a [f64], c: &'a [f64]) -> impl Iterator<Item = f32> + 'a {
    let root = move |w: &[f64]| w.iter().zip(c).map(|(w, c)| w * c).sum::<f64>();
    w.chunks(c.len()).map(move |w| root(w).max(0.0).powi(2) as f32)
}
