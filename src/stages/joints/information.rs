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
use crate::stages::parameters::Parameters;

/// Of two variables of this correlation, 0 to 1, such as the squared speeds of a joint: −½ ln(1 − r²), but for a share that is `negligible`; 0 if they have nothing in common.
pub(crate) fn of_correlation(correlation: f64, negligible: f64) -> f64 {
    -0.5 * ((1.0 - correlation * correlation + negligible) / (1.0 + negligible)).ln()
}

/// Of a joint, from what the quadratic forms of the motions of its parts have in common over so many samples, and their linear mutual
/// information, nats.
pub(super) fn of_joint(common: &Common, linear: f64, samples: usize, parameters: &Parameters) -> f64 {
    let of_correlation = |correlation| of_correlation(correlation, parameters.min_unexplained);
    let quadratic: f64 = common.canonical.iter().copied().map(of_correlation).sum();
    let weight = samples as f64 / (samples as f64 + parameters.half_weight_samples);
    of_correlation(common.correlation) + weight * (linear + quadratic)
}

/// The motion of a part as a Gaussian variable about 0.
pub(super) struct Gaussian {
    /// The lower Cholesky factor of its moments, with a ridge.
    factor: DMatrix<f64>,
}

impl Gaussian {
    /// From sums over samples of the products of its components, k × k; `None` if the part feels nothing.
    pub(super) fn new(mut moments: DMatrix<f64>, ridge: f64) -> Option<Self> {
        let factor = factor_with_ridge(&mut moments, ridge)?;
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
mod tests;
