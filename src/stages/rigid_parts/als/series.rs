//! Read series of numbers as registers.

use pulp::Simd;

use super::sums::Responses;

/// Numbers as registers: whole ones, and the last, with 0 after the last number.
pub(super) struct Series<'a, S: Simd> {
    whole: &'a [S::f64s],
    last: S::f64s,
}

impl<'a, S: Simd> Series<'a, S> {
    #[inline(always)]
    pub(super) fn new(simd: S, numbers: &'a [f64]) -> Self {
        let (whole, last) = S::as_simd_f64s(numbers);
        Self { whole, last: simd.partial_load_f64s(last) }
    }

    #[inline(always)]
    pub(super) fn at(&self, register: usize) -> S::f64s {
        *self.whole.get(register).unwrap_or(&self.last)
    }
}

/// The roots of a sensor, and what those are taken for that are not informative.
pub(super) struct Sensor<'a, S: Simd> {
    pub roots: Series<'a, S>,
    /// Empty if nothing completes them, which reads as 0.
    pub completed: Series<'a, S>,
}

impl<S: Simd> Sensor<'_, S> {
    /// What completes roots that are not felt: what is predicted, but no more than the root. Others keep what they have.
    #[inline(always)]
    pub(super) fn completed(
        &self,
        simd: S,
        register: usize,
        threshold: S::f64s,
        [predicted, own]: [S::f64s; 2],
    ) -> S::f64s {
        let root = self.roots.at(register);
        let is_felt = simd.greater_than_or_equal_f64s(root, threshold);
        let is_bound = simd.greater_than_f64s(predicted, root);
        simd.select_f64s(is_felt, own, simd.select_f64s(is_bound, root, predicted))
    }

    /// The responses of roots that c · w predicts so, and that are felt from a threshold on. Informative ones have a weight of 1, and
    /// others are the completed ones with their weight.
    #[inline(always)]
    pub(super) fn responses(
        &self,
        simd: S,
        register: usize,
        [threshold, weight]: [S::f64s; 2],
        predicted: S::f64s,
    ) -> Responses<S> {
        let root = self.roots.at(register);
        let is_felt = simd.greater_than_or_equal_f64s(root, threshold);
        let should_be = simd.greater_than_f64s(predicted, root);
        let is_informative = simd.or_m64s(is_felt, should_be);
        let instead = simd.mul_f64s(weight, self.completed.at(register));
        Responses {
            weight: simd.select_f64s(is_informative, simd.splat_f64s(1.0), weight),
            product: simd.select_f64s(is_informative, root, instead),
        }
    }

    /// The errors of informative roots, 0 for others, and the weights of all. In: as for [`Sensor::responses`].
    #[inline(always)]
    pub(super) fn error(
        &self,
        simd: S,
        register: usize,
        limits: [S::f64s; 2],
        predicted: S::f64s,
    ) -> (S::f64s, S::f64s) {
        let Responses { weight, product } = self.responses(simd, register, limits, predicted);
        (simd.sub_f64s(product, simd.mul_f64s(weight, predicted)), weight)
    }
}
