//! Solve many small least-squares problems at once: their normal equations, by Cholesky factors, one problem a lane.

use crate::numerics::simd::vectorised;

/// Ridge, as a share of the mean square of the regressors: it decides where a regression is underdetermined.
pub(super) const RIDGE: f64 = 1e-7;
/// Regressions that are solved at once, one in each lane. It changes no result.
pub(super) const LANES: usize = 32;
/// One number of each regression.
type Lanes = [f64; LANES];

/// Normal equations of regressions on K regressors.
pub(super) struct Regressions<const K: usize> {
    /// Sums of the products of two regressors, the second not after the first.
    pub squares: [[Lanes; K]; K],
    /// Sums of the products of a regressor with the response; the coefficients, once they are solved.
    pub products: [Lanes; K],
}

impl<const K: usize> Regressions<K> {
    /// Without any observation.
    pub(super) fn new() -> Self {
        Self { squares: [[[0.0; LANES]; K]; K], products: [[0.0; LANES]; K] }
    }

    /// Replaces the products by the coefficients, which are nearly 0 where the equations are singular.
    pub(super) fn solve(&mut self) {
        let Self { squares, products } = self;
        vectorised(
            #[inline(always)]
            || cholesky(squares, products),
        );
    }
}

/// Solves by Cholesky factors.
#[inline(always)]
#[expect(clippy::needless_range_loop, reason = "rows and columns of a triangle")]
fn cholesky<const K: usize>(factor: &mut [[Lanes; K]; K], found: &mut [Lanes; K]) {
    let mut ridge = [0.0; LANES];
    for a in 0..K {
        each(&mut ridge, |lane, sum| sum + factor[a][a][lane]);
    }
    each(&mut ridge, |_, sum| if sum > 0.0 { RIDGE * sum / K as f64 } else { 1.0 });
    let mut fails = [0.0; LANES];
    let mut inverse = [[0.0; LANES]; K];
    for a in 0..K {
        for b in 0..a {
            let mut rest = factor[a][b];
            for c in 0..b {
                each(&mut rest, |lane, rest| (-factor[a][c][lane]).mul_add(factor[b][c][lane], rest));
            }
            each(&mut rest, |lane, rest| rest * inverse[b][lane]);
            factor[a][b] = rest;
        }
        let mut rest = factor[a][a];
        each(&mut rest, |lane, rest| rest + ridge[lane]);
        for c in 0..a {
            each(&mut rest, |lane, rest| (-factor[a][c][lane]).mul_add(factor[a][c][lane], rest));
        }
        each(&mut fails, |lane, fails| if rest[lane] > 0.0 { fails } else { 1.0 });
        each(&mut inverse[a], |lane, _| if rest[lane] > 0.0 { 1.0 / rest[lane].sqrt() } else { 1.0 });
    }
    for a in 0..K {
        let mut rest = found[a];
        for b in 0..a {
            each(&mut rest, |lane, rest| (-factor[a][b][lane]).mul_add(found[b][lane], rest));
        }
        each(&mut rest, |lane, rest| rest * inverse[a][lane]);
        found[a] = rest;
    }
    for a in (0..K).rev() {
        let mut rest = found[a];
        for b in a + 1..K {
            each(&mut rest, |lane, rest| (-factor[b][a][lane]).mul_add(found[b][lane], rest));
        }
        each(&mut rest, |lane, rest| if fails[lane] > 0.0 { 0.0 } else { rest * inverse[a][lane] });
        found[a] = rest;
    }
}

/// Changes the number in each lane.
#[inline(always)]
fn each(numbers: &mut Lanes, change: impl Fn(usize, f64) -> f64) {
    for (lane, number) in numbers.iter_mut().enumerate() {
        *number = change(lane, *number);
    }
}

#[cfg(test)]
mod tests;
