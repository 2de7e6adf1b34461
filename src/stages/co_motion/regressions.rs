//! Solve many small regressions at once, from their normal equations.

use faer::{Mat, MatMut, MatRef};

use crate::numerics::simd::vectorised;

/// Most regressors.
pub const MAX_REGRESSORS: usize = 6;
/// Weight of nothing beside what is known, where that leaves a regression undetermined.
const RIDGE: f64 = 1e-6;
/// Regressions that are solved at once.
const LANES: usize = 32;
/// A number of each of these.
type Lanes = [f64; LANES];

/// Products of each two numbers of a row, the second not after the first: n × k becomes n × k (k + 1) / 2.
///
/// Weighted sums of these are the squares of normal equations.
pub fn pairs(rows: MatRef<'_, f64>) -> Mat<f64> {
    let mut products = Mat::zeros(rows.nrows(), place(rows.ncols(), 0));
    for a in 0..rows.ncols() {
        for b in 0..=a {
            for row in 0..rows.nrows() {
                products[(row, place(a, b))] = rows[(row, a)] * rows[(row, b)];
            }
        }
    }
    products
}

/// The place of a pair.
const fn place(a: usize, b: usize) -> usize {
    a * (a + 1) / 2 + b
}

/// The coefficients of regressions: nearly 0 where the equations leave them open.
///
/// In: sums of squares by [pair](pairs), and sums of products with what is explained, n × k, where the coefficients replace them.
pub fn solve(squares: MatRef<'_, f64>, mut products: MatMut<'_, f64>) {
    for first in (0..products.nrows()).step_by(LANES) {
        let count = LANES.min(products.nrows() - first);
        let k = products.ncols();
        let mut factor = [[0.0; LANES]; place(MAX_REGRESSORS, 0)];
        let mut found = [[0.0; LANES]; MAX_REGRESSORS];
        for (at, lanes) in factor[..place(k, 0)].iter_mut().enumerate() {
            lanes[..count].iter_mut().enumerate().for_each(|(lane, own)| *own = squares[(first + lane, at)]);
        }
        for (at, lanes) in found[..k].iter_mut().enumerate() {
            lanes[..count].iter_mut().enumerate().for_each(|(lane, own)| *own = products[(first + lane, at)]);
        }
        vectorised(
            #[inline(always)]
            || cholesky(&mut factor, &mut found, k),
        );
        for (at, lanes) in found[..k].iter().enumerate() {
            lanes[..count].iter().enumerate().for_each(|(lane, own)| products[(first + lane, at)] = *own);
        }
    }
}

/// Solves by the factors of Cholesky.
#[inline(always)]
fn cholesky(factor: &mut [Lanes], found: &mut [Lanes], k: usize) {
    let mut ridge = [0.0; LANES];
    for a in 0..k {
        each(&mut ridge, |lane, sum| sum + factor[place(a, a)][lane]);
    }
    each(&mut ridge, |_, sum| if sum > 0.0 { RIDGE * sum / k as f64 } else { 1.0 });
    let mut fails = [0.0; LANES];
    let mut inverse = [[0.0; LANES]; MAX_REGRESSORS];
    for a in 0..k {
        for b in 0..a {
            let mut rest = factor[place(a, b)];
            for c in 0..b {
                each(&mut rest, |lane, rest| {
                    (-factor[place(a, c)][lane]).mul_add(factor[place(b, c)][lane], rest)
                });
            }
            each(&mut rest, |lane, rest| rest * inverse[b][lane]);
            factor[place(a, b)] = rest;
        }
        let mut rest = factor[place(a, a)];
        each(&mut rest, |lane, rest| rest + ridge[lane]);
        for c in 0..a {
            each(&mut rest, |lane, rest| {
                (-factor[place(a, c)][lane]).mul_add(factor[place(a, c)][lane], rest)
            });
        }
        each(&mut fails, |lane, fails| if rest[lane] > 0.0 { fails } else { 1.0 });
        each(&mut inverse[a], |lane, _| if rest[lane] > 0.0 { 1.0 / rest[lane].sqrt() } else { 1.0 });
    }
    for a in 0..k {
        let mut rest = found[a];
        for b in 0..a {
            each(&mut rest, |lane, rest| (-factor[place(a, b)][lane]).mul_add(found[b][lane], rest));
        }
        each(&mut rest, |lane, rest| rest * inverse[a][lane]);
        found[a] = rest;
    }
    for a in (0..k).rev() {
        let mut rest = found[a];
        for b in a + 1..k {
            each(&mut rest, |lane, rest| (-factor[place(b, a)][lane]).mul_add(found[b][lane], rest));
        }
        each(&mut rest, |lane, rest| if fails[lane] > 0.0 { 0.0 } else { rest * inverse[a][lane] });
        found[a] = rest;
    }
}

/// Changes the number of each regression.
#[inline(always)]
fn each(numbers: &mut Lanes, change: impl Fn(usize, f64) -> f64) {
    for (lane, number) in numbers.iter_mut().enumerate() {
        *number = change(lane, *number);
    }
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use crate::numerics::rng::stream;

    #[test]
    fn coefficients_are_found_again() {
        let mut rng = stream(1, 1, "regressions", 0);
        for (n, k) in [(1, 1), (33, 3), (70, 6)] {
            let truth = Mat::from_fn(n, k, |_, _| rng.random_range(-1.0..1.0));
            let mut squares = Mat::zeros(n, place(k, 0));
            let mut products = Mat::zeros(n, k);
            for _ in 0..20 {
                let x = Mat::from_fn(n, k, |_, _| rng.random_range(-1.0..1.0));
                squares += pairs(x.as_ref());
                for row in 0..n {
                    let y: f64 = (0..k).map(|at| x[(row, at)] * truth[(row, at)]).sum();
                    (0..k).for_each(|at| products[(row, at)] += x[(row, at)] * y);
                }
            }
            solve(squares.as_ref(), products.as_mut());
            assert!((products - truth).norm_max() < 1e-4, "{n} regressions of {k}");
        }
    }

    #[test]
    fn what_is_not_determined_is_nearly_nothing() {
        let one = Mat::from_fn(2, 2, |row, _| row as f64);
        let mut products = Mat::from_fn(2, 2, |row, _| 2.0 * row as f64);
        solve(pairs(one.as_ref()).as_ref(), products.as_mut());
        // Nothing is known of the first, and only the sum of both coefficients of the second.
        assert_eq!(products.row(0).norm_max(), 0.0);
        assert!((products[(1, 0)] - 1.0).abs() < 1e-5 && (products[(1, 1)] - 1.0).abs() < 1e-5);
    }
}
