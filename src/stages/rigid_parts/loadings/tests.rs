//! Test the algebra of loadings.

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
