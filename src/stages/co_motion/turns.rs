//! The turns of a censored regression: find w from c, and c from w, by the roots that say something.
//!
//! What a root says goes straight into the sums of its regression, by vector instructions, so that nothing of times × sensors is
//! written.

use faer::{Mat, MatMut, MatRef};
use pulp::{Arch, Simd, WithSimd};

use super::regressions::{LANES, Regressions};

/// Roots of some sensors: times × sensors.
pub struct Turns<'a> {
    /// All roots, by sensor.
    values: Vec<&'a [f64]>,
    /// At each time, that from which on a root is felt; none is after the last time.
    felt: Vec<f64>,
}

impl<'a> Turns<'a> {
    /// On roots, times × sensors, of which those that are no less than `felt` at their time are felt.
    pub fn new(values: MatRef<'a, f64>, felt: &[f64]) -> Self {
        let column =
            |sensor| values.col(sensor).try_as_col_major().expect("roots are kept by sensor").as_slice();
        let padded = [felt, &[f64::INFINITY; LANES]].concat();
        Self { values: (0..values.ncols()).map(column).collect(), felt: padded }
    }

    /// w at all times by least squares over the sensors that feel something, and those that should by w as it was.
    ///
    /// In: c, sensors × k. In and out: w, times × k.
    pub fn move_all(&self, loadings: MatRef<'_, f64>, motions: &mut Mat<f64>) {
        let loadings = by_row(loadings);
        match motions.ncols() {
            0 => (),
            1 => Arch::new().dispatch(Move::<1> { turns: self, loadings: &loadings, motions }),
            2 => Arch::new().dispatch(Move::<2> { turns: self, loadings: &loadings, motions }),
            3 => Arch::new().dispatch(Move::<3> { turns: self, loadings: &loadings, motions }),
            4 => Arch::new().dispatch(Move::<4> { turns: self, loadings: &loadings, motions }),
            5 => Arch::new().dispatch(Move::<5> { turns: self, loadings: &loadings, motions }),
            6 => Arch::new().dispatch(Move::<6> { turns: self, loadings: &loadings, motions }),
            k => unreachable!("a motion has at most six numbers, not {k}"),
        }
    }

    /// c of all sensors by least squares over the times at which each feels something, or should by c as it was.
    ///
    /// In and out: c, sensors × k. In: w, times × k.
    pub fn load_all(&self, mut loadings: MatMut<'_, f64>, motions: &Mat<f64>) {
        let mut rows = by_row(loadings.as_ref());
        let k = motions.ncols();
        match k {
            0 => return,
            1 => Arch::new().dispatch(Load::<1> { turns: self, loadings: &mut rows, motions }),
            2 => Arch::new().dispatch(Load::<2> { turns: self, loadings: &mut rows, motions }),
            3 => Arch::new().dispatch(Load::<3> { turns: self, loadings: &mut rows, motions }),
            4 => Arch::new().dispatch(Load::<4> { turns: self, loadings: &mut rows, motions }),
            5 => Arch::new().dispatch(Load::<5> { turns: self, loadings: &mut rows, motions }),
            6 => Arch::new().dispatch(Load::<6> { turns: self, loadings: &mut rows, motions }),
            k => unreachable!("a motion has at most six numbers, not {k}"),
        }
        for (sensor, row) in rows.chunks(k).enumerate() {
            row.iter().enumerate().for_each(|(at, value)| loadings[(sensor, at)] = *value);
        }
    }

    /// The squares that roots which say something leave, at each time on the mean, and how many such roots a time has beyond the
    /// k that w takes, on the mean.
    pub fn residual_and_spare(&self, loadings: MatRef<'_, f64>, motions: &Mat<f64>) -> [f64; 2] {
        let work = Left { turns: self, loadings: &by_row(loadings), motions };
        Arch::new().dispatch(work).map(|sum| sum / motions.nrows() as f64)
    }

    /// Roots of a sensor at times from `t` on, as many as a register holds.
    #[inline(always)]
    fn roots<S: Simd>(&self, simd: S, sensor: usize, t: usize) -> S::f64s {
        load(simd, self.values[sensor], t)
    }

    /// What roots say at some times.
    #[inline(always)]
    fn find<S: Simd>(&self, simd: S, root: S::f64s, felt: S::f64s, reach: S::f64s) -> Said<S> {
        let is_felt = simd.greater_than_or_equal_f64s(root, felt);
        let should_be = simd.greater_than_f64s(reach, root);
        let says = simd.or_m64s(is_felt, should_be);
        let none = simd.splat_f64s(0.0);
        Said {
            tells: simd.select_f64s(says, simd.splat_f64s(1.0), none),
            told: simd.select_f64s(says, root, none),
        }
    }
}

/// What roots say.
struct Said<S: Simd> {
    /// 1 where a root says something: it is felt, or should be. 0 elsewhere.
    tells: S::f64s,
    /// The roots that say something. 0 elsewhere.
    told: S::f64s,
}

/// The sums of as many regressions on K numbers as a register holds.
struct Sums<S: Simd, const K: usize> {
    /// Of products of two regressors, the second not after the first.
    squares: [[S::f64s; K]; K],
    /// Of products of a regressor with what is explained.
    products: [S::f64s; K],
}

impl<S: Simd, const K: usize> Sums<S, K> {
    #[inline(always)]
    fn new(simd: S) -> Self {
        let none = simd.splat_f64s(0.0);
        Self { squares: [[none; K]; K], products: [none; K] }
    }

    #[inline(always)]
    #[expect(clippy::needless_range_loop, reason = "rows and columns of a triangle")]
    fn add(&mut self, simd: S, regressors: &[S::f64s; K], said: &Said<S>) {
        for a in 0..K {
            let own = simd.mul_f64s(said.tells, regressors[a]);
            self.products[a] = simd.mul_add_f64s(said.told, regressors[a], self.products[a]);
            for b in 0..=a {
                self.squares[a][b] = simd.mul_add_f64s(own, regressors[b], self.squares[a][b]);
            }
        }
    }
}

/// [`Turns::move_all`] for k = K.
struct Move<'a, const K: usize> {
    turns: &'a Turns<'a>,
    loadings: &'a [f64],
    motions: &'a mut Mat<f64>,
}

impl<const K: usize> WithSimd for Move<'_, K> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { turns, loadings, motions } = self;
        let times = motions.nrows();
        for first in (0..times).step_by(LANES) {
            let count = LANES.min(times - first);
            let mut regressions = Regressions::<K>::new();
            for at in (0..count).step_by(S::F64_LANES) {
                let t = first + at;
                let w = moved::<S, K>(simd, motions, t);
                let felt = load(simd, &turns.felt, t);
                let mut sums = Sums::<S, K>::new(simd);
                for (sensor, c) in loadings.as_chunks::<K>().0.iter().enumerate() {
                    let c = splat(simd, c);
                    let root = turns.roots(simd, sensor, t);
                    let said = turns.find(simd, root, felt, dot(simd, &c, &w));
                    sums.add(simd, &c, &said);
                }
                for a in 0..K {
                    store::<S>(&mut regressions.products[a], at, sums.products[a]);
                    for b in 0..=a {
                        store::<S>(&mut regressions.squares[a][b], at, sums.squares[a][b]);
                    }
                }
            }
            regressions.solve();
            for (a, found) in regressions.products.iter().enumerate() {
                motions.col_as_slice_mut(a)[first..first + count].copy_from_slice(&found[..count]);
            }
        }
    }
}

/// [`Turns::load_all`] for k = K.
struct Load<'a, const K: usize> {
    turns: &'a Turns<'a>,
    loadings: &'a mut [f64],
    motions: &'a Mat<f64>,
}

impl<const K: usize> WithSimd for Load<'_, K> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { turns, loadings, motions } = self;
        let rows = loadings.as_chunks_mut::<K>().0;
        for (first, rows) in (0..).step_by(LANES).zip(rows.chunks_mut(LANES)) {
            let mut regressions = Regressions::<K>::new();
            for (lane, row) in rows.iter().enumerate() {
                let c = splat(simd, row);
                let mut sums = Sums::<S, K>::new(simd);
                for t in (0..motions.nrows()).step_by(S::F64_LANES) {
                    let w = moved::<S, K>(simd, motions, t);
                    let felt = load(simd, &turns.felt, t);
                    let root = turns.roots(simd, first + lane, t);
                    let said = turns.find(simd, root, felt, dot(simd, &c, &w));
                    sums.add(simd, &w, &said);
                }
                for a in 0..K {
                    regressions.products[a][lane] = simd.reduce_sum_f64s(sums.products[a]);
                    for b in 0..=a {
                        regressions.squares[a][b][lane] = simd.reduce_sum_f64s(sums.squares[a][b]);
                    }
                }
            }
            regressions.solve();
            for (lane, row) in rows.iter_mut().enumerate() {
                (0..K).for_each(|a| row[a] = regressions.products[a][lane]);
            }
        }
    }
}

/// [`Turns::residual_and_spare`], summed over times.
struct Left<'a> {
    turns: &'a Turns<'a>,
    loadings: &'a [f64],
    motions: &'a Mat<f64>,
}

impl WithSimd for Left<'_> {
    type Output = [f64; 2];

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> [f64; 2] {
        let Self { turns, loadings, motions } = self;
        let (times, k) = (motions.nrows(), motions.ncols());
        let none = simd.splat_f64s(0.0);
        let taken = simd.splat_f64s(k as f64);
        let [mut residuals, mut spares] = [none; 2];
        for t in (0..times).step_by(S::F64_LANES) {
            let felt = load(simd, &turns.felt, t);
            let [mut residual, mut telling] = [none; 2];
            for (sensor, c) in loadings.chunks(k.max(1)).enumerate() {
                let mut reach = none;
                for (at, c) in c.iter().enumerate() {
                    let w = load(simd, motions.col_as_slice(at), t);
                    reach = simd.mul_add_f64s(simd.splat_f64s(*c), w, reach);
                }
                let said = turns.find(simd, turns.roots(simd, sensor, t), felt, reach);
                let off = simd.sub_f64s(said.told, simd.mul_f64s(said.tells, reach));
                residual = simd.mul_add_f64s(off, off, residual);
                telling = simd.add_f64s(telling, said.tells);
            }
            residuals = simd.add_f64s(residuals, residual);
            spares = simd.add_f64s(spares, simd.max_f64s(none, simd.sub_f64s(telling, taken)));
        }
        [simd.reduce_sum_f64s(residuals), simd.reduce_sum_f64s(spares)]
    }
}

/// c of each sensor, one after the other.
fn by_row(loadings: MatRef<'_, f64>) -> Vec<f64> {
    let k = loadings.ncols();
    (0..loadings.nrows()).flat_map(|sensor| (0..k).map(move |at| loadings[(sensor, at)])).collect()
}

/// w at times from `t` on, as many as a register holds.
#[inline(always)]
fn moved<S: Simd, const K: usize>(simd: S, motions: &Mat<f64>, t: usize) -> [S::f64s; K] {
    let mut w = [simd.splat_f64s(0.0); K];
    for (at, w) in w.iter_mut().enumerate() {
        *w = load(simd, motions.col_as_slice(at), t);
    }
    w
}

/// Each number in all lanes of a register. By a loop, for `map` is not inlined.
#[inline(always)]
fn splat<S: Simd, const K: usize>(simd: S, c: &[f64; K]) -> [S::f64s; K] {
    let mut all = [simd.splat_f64s(0.0); K];
    for (all, c) in all.iter_mut().zip(c) {
        *all = simd.splat_f64s(*c);
    }
    all
}

/// c · w.
#[inline(always)]
fn dot<S: Simd, const K: usize>(simd: S, c: &[S::f64s; K], w: &[S::f64s; K]) -> S::f64s {
    let mut sum = simd.mul_f64s(c[0], w[0]);
    for at in 1..K {
        sum = simd.mul_add_f64s(c[at], w[at], sum);
    }
    sum
}

/// Numbers from a place on, as many as a register holds; 0 after the last.
#[inline(always)]
fn load<S: Simd>(simd: S, numbers: &[f64], from: usize) -> S::f64s {
    let rest = &numbers[from..];
    match S::as_simd_f64s(rest).0.first() {
        Some(whole) => *whole,
        None => simd.partial_load_f64s(rest),
    }
}

/// Puts numbers from a place on.
#[inline(always)]
fn store<S: Simd>(to: &mut [f64; LANES], from: usize, numbers: S::f64s) {
    S::as_mut_simd_f64s(&mut to[from..]).0[0] = numbers;
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use crate::numerics::rng::stream;

    /// Roots, c and w of random numbers, and from which root on one is felt at each time.
    fn example(times: usize, k: usize, signed: bool) -> (Mat<f64>, Vec<f64>, Mat<f64>, Mat<f64>) {
        let mut rng = stream(1, 1, "turns", times * 10 + k);
        let mut random = |rows, columns| Mat::from_fn(rows, columns, |_, _| rng.random_range(-1.0_f64..1.0));
        let (values, loadings, motions) = (random(times, 9), random(9, k), random(times, k));
        if signed {
            return (values, vec![f64::NEG_INFINITY; times], loadings, motions);
        }
        let values = Mat::from_fn(times, 9, |t, sensor| f64::max(0.0, values[(t, sensor)]));
        (values, vec![0.1; times], loadings, motions)
    }

    /// Squares and products of what a root says, added to those of `x`.
    fn add(sums: &mut (Mat<f64>, Mat<f64>), x: &[f64], says: bool, root: f64) {
        for (a, own) in x.iter().enumerate().filter(|_| says) {
            x.iter().enumerate().for_each(|(b, other)| sums.0[(a, b)] += own * other);
            sums.1[(a, 0)] += own * root;
        }
    }

    #[test]
    fn a_turn_is_what_plain_sums_give_at_any_number_of_times() {
        for (times, signed) in [(1, false), (31, false), (33, true), (37, false), (70, true)] {
            for k in 1..=6 {
                let (values, felt, loadings, motions) = example(times, k, signed);
                let turns = Turns::new(values.as_ref(), &felt);
                let row = |of: &Mat<f64>, at: usize| -> Vec<f64> { (0..k).map(|a| of[(at, a)]).collect() };
                let reach = |t: usize, sensor: usize| -> f64 {
                    row(&loadings, sensor).iter().zip(row(&motions, t)).map(|(c, w)| c * w).sum()
                };
                let says = |t: usize, sensor: usize| {
                    values[(t, sensor)] >= felt[t] || reach(t, sensor) > values[(t, sensor)]
                };
                let is_solved = |(squares, products): &(Mat<f64>, Mat<f64>), found: Vec<f64>| {
                    let found = Mat::from_fn(k, 1, |a, _| found[a]);
                    let off = squares * &found - products;
                    // The ridge takes a little.
                    assert!(off.norm_max() < 1e-4 * (1.0 + found.norm_max()) * (1.0 + squares.norm_max()));
                };
                let mut moved = motions.clone();
                turns.move_all(loadings.as_ref(), &mut moved);
                for t in 0..times {
                    let mut sums = (Mat::zeros(k, k), Mat::zeros(k, 1));
                    (0..9).for_each(|sensor| {
                        add(&mut sums, &row(&loadings, sensor), says(t, sensor), values[(t, sensor)]);
                    });
                    is_solved(&sums, row(&moved, t));
                }
                let mut loaded = loadings.clone();
                turns.load_all(loaded.as_mut(), &motions);
                let mut left = [0.0; 2];
                for sensor in 0..9 {
                    let mut sums = (Mat::zeros(k, k), Mat::zeros(k, 1));
                    (0..times).for_each(|t| {
                        add(&mut sums, &row(&motions, t), says(t, sensor), values[(t, sensor)]);
                    });
                    is_solved(&sums, row(&loaded, sensor));
                }
                for t in 0..times {
                    let telling: Vec<usize> = (0..9).filter(|sensor| says(t, *sensor)).collect();
                    left[0] +=
                        telling.iter().map(|&at| (values[(t, at)] - reach(t, at)).powi(2)).sum::<f64>();
                    left[1] += f64::max(0.0, telling.len() as f64 - k as f64);
                }
                let found = turns.residual_and_spare(loadings.as_ref(), &motions);
                let is_near = |a: f64, b: f64| (a - b / times as f64).abs() < 1e-12 * (1.0 + b);
                assert!(is_near(found[0], left[0]) && is_near(found[1], left[1]), "{times} {k} {signed}");
            }
        }
    }
}
