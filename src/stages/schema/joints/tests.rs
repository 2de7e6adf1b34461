//! Test the likelihood of joints.

use nalgebra::DMatrix;

use super::*;
use crate::numerics::rng::stream;
use crate::numerics::testing::{ALPHA, ks_one_sample};
use crate::stages::mixture::NormalInverseWishart;

/// N(mean, deviation²) in one dimension.
fn scalar_gaussian(mean: f64, deviation: f64) -> Gaussian {
    Gaussian::new(DVector::from_element(1, mean), DMatrix::from_element(1, 1, 1.0 / deviation))
}

/// Integral over the real line of N(q; s) N(q; c) from −∞ to `end`, by the midpoint rule.
fn product_mass(s: &Gaussian, c: &Gaussian, end: f64) -> f64 {
    const STEP: f64 = 1e-3;
    let density = |q: f64| (-cost(&DVector::from_element(1, q), s, c, 0.0)).exp();
    let steps = ((end + 10.0) / STEP) as usize;
    (0..steps).map(|i| density(-10.0 + (i as f64 + 0.5) * STEP) * STEP).sum()
}

#[test]
fn a_joint_follows_the_product_of_both_densities_and_not_one_alone() {
    let (s, c) = (scalar_gaussian(1.0, 0.5), scalar_gaussian(-0.4, 1.2));
    let mut rng = stream(1, 1, "joint", 0);
    let draws: Vec<f64> =
        (0..4000).map(|_| draw_between(&s.information(), &c.information(), &mut rng).unwrap()[0]).collect();
    let total = product_mass(&s, &c, 10.0);
    assert!(ks_one_sample(&draws, |q| product_mass(&s, &c, q) / total) > ALPHA);
    // The broken twin forgets the parent.
    let alone: Vec<f64> = (0..4000).map(|_| s.draw(&mut rng)[0]).collect();
    assert!(ks_one_sample(&alone, |q| product_mass(&s, &c, q) / total) < ALPHA);
}

#[test]
fn the_collapsed_cost_is_the_integral_over_the_joint() {
    let (s, c) = (scalar_gaussian(1.0, 0.5), scalar_gaussian(-0.4, 1.2));
    let integral = product_mass(&s, &c, 10.0);
    assert!((collapsed_cost(&s.moments(), &c.moments()).unwrap() + integral.ln()).abs() < 1e-9);
}

#[test]
fn the_collapsed_cost_agrees_with_the_density_in_more_dimensions() {
    let mut rng = stream(1, 1, "collapsed", 0);
    for dims in [3, 9, 14] {
        let prior = NormalInverseWishart::new(
            DVector::zeros(dims),
            0.5,
            DMatrix::identity(dims, dims),
            dims as f64 + 2.0,
        );
        let [s, c] = [0; 2].map(|_| prior.as_ref().unwrap().draw(&mut rng));
        let covariance: DMatrix<f64> =
            [&s, &c].map(|gaussian| gaussian.precision().cholesky().unwrap().inverse()).iter().sum();
        let offset = s.mean() - c.mean();
        let square = offset.dot(&(covariance.clone().cholesky().unwrap().inverse() * &offset));
        let expected = 0.5 * (square + covariance.determinant().ln() + dims as f64 * (2.0 * PI).ln());
        let found = collapsed_cost(&s.moments(), &c.moments()).unwrap();
        assert!((found - expected).abs() < 1e-9 * expected.abs().max(1.0), "d = {dims}: {found}, {expected}");
    }
}
