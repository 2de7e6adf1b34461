//! Sum the products of regressions in the lanes of registers: each lane sums observations of its own.

use pulp::Simd;

/// Responses of a regression.
#[derive(Clone, Copy)]
pub(super) struct Responses<S: Simd> {
    pub weight: S::f64s,
    /// The response times its weight.
    pub product: S::f64s,
}

/// The sums of regressions on K regressors, or shares of the sums of one, in each lane.
#[derive(Clone, Copy)]
pub(super) struct Sums<S: Simd, const K: usize> {
    /// Of products of two regressors, the second not after the first.
    pub squares: [[S::f64s; K]; K],
    /// Of products of a regressor with the response.
    pub products: [S::f64s; K],
}

impl<S: Simd, const K: usize> Sums<S, K> {
    #[inline(always)]
    pub(super) fn new(simd: S) -> Self {
        let none = simd.splat_f64s(0.0);
        Self { squares: [[none; K]; K], products: [none; K] }
    }

    /// Adds observations: their responses, and their regressors, which `load` puts into a register.
    #[inline(always)]
    pub(super) fn add<X>(
        &mut self,
        simd: S,
        responses: &[Responses<S>],
        regressors: &[[X; K]],
        load: impl Fn(&X) -> S::f64s,
    ) {
        // All rows of a triangle of K = 7 at once need more registers than most processors have. Each of four passes adds two rows.
        const { assert!(K <= 8) };
        self.add_rows::<X, 0>(simd, responses, regressors, &load);
        self.add_rows::<X, 1>(simd, responses, regressors, &load);
        self.add_rows::<X, 2>(simd, responses, regressors, &load);
        self.add_rows::<X, 3>(simd, responses, regressors, &load);
    }

    /// Adds to row A of the triangle, and to the row that is as far from the last. Two rows have K + 1 sums together, whatever A is.
    #[inline(always)]
    fn add_rows<X, const A: usize>(
        &mut self,
        simd: S,
        responses: &[Responses<S>],
        regressors: &[[X; K]],
        load: &impl Fn(&X) -> S::f64s,
    ) {
        if 2 * A >= K {
            return;
        }
        let z = K - 1 - A;
        let (mut low, mut high) = (self.squares[A], self.squares[z]);
        let [mut of_low, mut of_high] = [self.products[A], self.products[z]];
        for (response, regressors) in responses.iter().zip(regressors) {
            let mut x = [simd.splat_f64s(0.0); K];
            for b in 0..=z {
                x[b] = load(&regressors[b]);
            }
            let own = simd.mul_f64s(response.weight, x[z]);
            of_high = simd.mul_add_f64s(response.product, x[z], of_high);
            for b in 0..=z {
                high[b] = simd.mul_add_f64s(own, x[b], high[b]);
            }
            if A < z {
                let own = simd.mul_f64s(response.weight, x[A]);
                of_low = simd.mul_add_f64s(response.product, x[A], of_low);
                for b in 0..=A {
                    low[b] = simd.mul_add_f64s(own, x[b], low[b]);
                }
            }
        }
        (self.squares[z], self.products[z]) = (high, of_high);
        if A < z {
            (self.squares[A], self.products[A]) = (low, of_low);
        }
    }
}
