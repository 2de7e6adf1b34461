//! Sample the latent joint between two Gaussian components, and weigh that edge of the tree (equations 13, 14, 18 and
//! 22).
//!
//! A joint q is a point that both components generate, so it is drawn from the product of their
//! densities, and it is data of both when they are updated.

use std::f64::consts::PI;

use nalgebra::DVector;
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

use crate::stages::mixture::{Augmented, Gaussian, Rounding};

/// Draws q from the normalised product N(q; μ_s, Σ_s) N(q; μ_c, Σ_c) (equation 18), a Gaussian with
/// precision Λ_s + Λ_c, given the [information](Gaussian::information) of both.
///
/// With Λ_s + Λ_c = Uᵀ U its mean is U⁻¹ U⁻ᵀ (Λ_s μ_s + Λ_c μ_c).
///
/// # Errors
/// [`Rounding`] if the sum is not positive definite in floating point.
pub fn draw_between(s: &Augmented, c: &Augmented, rng: &mut impl Rng) -> Result<DVector<f64>, Rounding> {
    let mut sum = s.clone();
    sum.add(c);
    let factor = sum.factor().ok_or(Rounding)?;
    let whitened = factor.border().map(|border| rng.sample::<f64, _>(StandardNormal) - border);
    let mut q = DVector::from_iterator(factor.dims, whitened);
    factor.solve_vector(q.as_mut_slice());
    Ok(q)
}

/// −log (N(q; μ_s, Σ_s) N(q; μ_c, Σ_c)), the quadratic cost of equation 22; where `floor` is positive, it is added to
/// both densities.
pub fn cost(q: &DVector<f64>, s: &Gaussian, c: &Gaussian, floor: f64) -> f64 {
    let log_density = |gaussian: &Gaussian| {
        let log = gaussian.log_density(q.as_slice());
        if floor > 0.0 { (log.exp() + floor).ln() } else { log }
    };
    -log_density(s) - log_density(c)
}

/// The cost of equation 22 with the joint q integrated out: −log N(μ_s; μ_c, Σ_s + Σ_c), given the
/// [moments](Gaussian::moments) of both, which all edges of a component share.
///
/// With Σ_s + Σ_c = Uᵀ U and w = U⁻ᵀ (μ_s − μ_c) it is |w|² / 2 + log |U| + d log(2π) / 2.
///
/// # Errors
/// [`Rounding`] if the sum is not positive definite in floating point.
pub fn collapsed_cost(s: &Augmented, c: &Augmented) -> Result<f64, Rounding> {
    let dims = s.dims;
    let mut sum = s.clone();
    sum.add(c);
    for (i, (mean_s, mean_c)) in s.border().zip(c.border()).enumerate() {
        sum.row_mut(i)[dims] = mean_s - mean_c;
    }
    let factor = sum.factor().ok_or(Rounding)?;
    let square: f64 = factor.border().map(|w| w * w).sum();
    Ok(0.5 * (square + dims as f64 * (2.0 * PI).ln()) + factor.log_diagonal())
}

#[cfg(test)]
mod tests {
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
        let draws: Vec<f64> = (0..4000)
            .map(|_| draw_between(&s.information(), &c.information(), &mut rng).unwrap()[0])
            .collect();
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
            assert!(
                (found - expected).abs() < 1e-9 * expected.abs().max(1.0),
                "d = {dims}: {found}, {expected}"
            );
        }
    }
}
