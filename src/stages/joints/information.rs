//! Measure what the motions of two parts say of each other: mutual information of Gaussian variables, in nats.
//!
//! A joint shows in two ways. Both of its parts feel the speed of one point, however it bends. And as far as it does not bend, the motion
//! of one part is a linear map of that of the other; parts that are further apart in the tree lose some of it with each joint between them.
//! Over all trees, that of most information is the most likely one (Chow and Liu 1968). That holds if joints move independently of
//! each other. Where they are coordinated, as in a walk, opposite limbs share more than neighbours do; only speeds tell the truth
//! then. Few samples share much by coordination and by chance, and many samples less. So what is shared linearly counts with a weight that
//! grows with the number of samples.
//!
//! A hinge shares more than the speed of one point: that of every point on its axis, and the velocity along it. Parts whose hinges are
//! parallel have nearly the same velocity along them, however far apart they are in the tree. The speed of that alone can agree as well as
//! that of a joint. So all that the quadratic forms of two motions share is counted, too, with the same weight.

use nalgebra::DMatrix;

use super::correlation::{Common, factor_with_ridge, whitened};

/// Unexplained share of a joint's squared speed below which a joint tells hardly any more.
const NEGLIGIBLE: f64 = 1e-3;
/// Samples at which all that two motions share has half of its weight, beside the speed of their joint.
const HALF_WEIGHT: f64 = 1e4;
/// What is added to the variances of components, as a share of their mean: those of hardly any variance are noise.
const RIDGE: f64 = 1e-3;

/// Of squared joint speeds of this correlation, 0 to 1: −½ ln(1 − r²), but for a share that is negligible; 0 if they have nothing in common.
pub(super) fn of_speeds(correlation: f64) -> f64 {
    -0.5 * ((1.0 - correlation * correlation + NEGLIGIBLE) / (1.0 + NEGLIGIBLE)).ln()
}

/// Of a joint, from what the quadratic forms of the motions of its parts have in common over so many samples, and their linear mutual
/// information, nats.
pub(super) fn of_joint(common: &Common, linear: f64, samples: usize) -> f64 {
    let quadratic: f64 = common.canonical.iter().copied().map(of_speeds).sum();
    let weight = samples as f64 / (samples as f64 + HALF_WEIGHT);
    of_speeds(common.correlation) + weight * (linear + quadratic)
}

/// The motion of a part as a Gaussian variable about 0.
pub(super) struct Gaussian {
    /// The lower Cholesky factor of its moments, with a ridge.
    factor: DMatrix<f64>,
}

impl Gaussian {
    /// From sums over samples of the products of its components, k × k; `None` if the part feels nothing.
    pub(super) fn new(mut moments: DMatrix<f64>) -> Option<Self> {
        let factor = factor_with_ridge(&mut moments, RIDGE)?;
        Some(Self { factor })
    }
}

/// Of two motions, from sums over samples of the products of a component of each: −½ ln det(1 − R Rᵀ), where R has the correlations of
/// the whitened components; 0 where a part feels nothing.
pub(super) fn mutual_information(
    first: &Option<Gaussian>,
    second: &Option<Gaussian>,
    products: &DMatrix<f64>,
) -> f64 {
    let (Some(first), Some(second)) = (first, second) else { return 0.0 };
    let r = whitened(&first.factor, &second.factor, products);
    let left = DMatrix::identity(r.ncols(), r.ncols()) - r.transpose() * &r;
    left.cholesky().map_or(0.0, |left| -left.l_dirty().diagonal().iter().map(|own| own.ln()).sum::<f64>())
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use crate::numerics::rng::stream;

    /// The information between two variables, samples × components.
    fn between(x: &DMatrix<f64>, y: &DMatrix<f64>) -> f64 {
        let own = |values: &DMatrix<f64>| Gaussian::new(values.transpose() * values);
        mutual_information(&own(x), &own(y), &(x.transpose() * y))
    }

    /// Independent values about 0, of one variance.
    fn noise(number: usize, components: usize) -> DMatrix<f64> {
        let mut rng = stream(1, 1, "information", number);
        DMatrix::from_fn(20_000, components, |_, _| rng.random_range(-1.0..1.0))
    }

    #[test]
    fn information_is_that_of_the_canonical_correlations() {
        let (x, e) = (noise(0, 2), noise(1, 2));
        // The first components correlate at 0.6, and the second do not.
        let mixed =
            DMatrix::from_fn(
                20_000,
                2,
                |t, at| {
                    if at == 0 { 0.6 * x[(t, 0)] + 0.8 * e[(t, 0)] } else { e[(t, 1)] }
                },
            );
        let expected = -0.5 * (1.0_f64 - 0.36).ln();
        assert!((between(&x, &mixed) - expected).abs() < 0.01, "{}", between(&x, &mixed));
        // No linear map of a motion changes it, but for the ridge.
        let map = DMatrix::from_row_slice(2, 2, &[2.0, 0.3, -1.0, 1.5]);
        assert!((between(&(&x * map), &mixed) - expected).abs() < 0.01);
    }

    #[test]
    fn a_neighbour_tells_more_than_its_neighbour() {
        let first = noise(0, 3);
        let second = &first + noise(1, 3) * 0.4;
        let third = &second + noise(2, 3) * 0.4;
        assert!(between(&first, &second) > 1.2 * between(&first, &third));
        assert!(between(&second, &third) > 1.2 * between(&first, &third));
    }

    #[test]
    fn equal_motions_tell_a_finite_amount_and_no_motion_tells_nothing() {
        let x = noise(0, 3);
        assert!((3.0..20.0).contains(&between(&x, &x)), "{}", between(&x, &x));
        assert_eq!(between(&x, &DMatrix::zeros(20_000, 2)), 0.0);
        assert_eq!(between(&x, &DMatrix::zeros(20_000, 0)), 0.0);
    }

    #[test]
    fn more_of_a_joints_speed_tells_more() {
        let found: Vec<f64> = [0.0, 0.5, 0.99, 1.0].map(of_speeds).to_vec();
        assert!(found.is_sorted() && found[0] == 0.0 && found[3] < 3.5, "{found:?}");
    }
}
