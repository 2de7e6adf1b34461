//! Alternate least squares of a censored regression: the motion from the loadings, and the loadings from the motion.
//!
//! A root is informative if it is felt, or if c · w predicts that it should be. Each goes straight into the sums of its
//! regression, by vector instructions, so that no intermediate of the size samples × sensors is written.

use faer::{Mat, MatMut, MatRef};
use pulp::{Arch, Simd, WithSimd};

use super::regressions::{LANES, Regressions};
use crate::numerics::interrupt;

/// Roots of some sensors, samples × sensors, whose loadings c and motion w are updated in turn.
pub(crate) struct Als<'a> {
    /// All roots, by sensor.
    values: Vec<&'a [f64]>,
    /// At each sample, the least root that is felt; infinite after the last sample.
    thresholds: Vec<f64>,
    /// What roots that are not informative are taken for, by sensor, if for anything.
    completed: Vec<&'a [f64]>,
    /// The weight of a completed root.
    weight: f64,
}

impl<'a> Als<'a> {
    /// Of roots, samples × sensors, which are felt from the threshold of their sample on.
    pub(crate) fn new(values: MatRef<'a, f64>, thresholds: &[f64]) -> Self {
        let padded = [thresholds, &[f64::INFINITY; LANES]].concat();
        Self { values: by_sensor(values), thresholds: padded, completed: Vec::new(), weight: 0.0 }
    }

    /// The same, where each root that is not informative is taken for a completed one, with this weight.
    pub(super) fn with_completed(self, completed: MatRef<'a, f64>, weight: f64) -> Self {
        Self { completed: by_sensor(completed), weight, ..self }
    }

    /// Updates w at each sample by least squares over its informative roots, by w as it was.
    ///
    /// In: c, sensors × k. In and out: w, samples × k.
    pub(crate) fn update_motion(&self, loadings: MatRef<'_, f64>, motion: &mut Mat<f64>) {
        interrupt::check();
        let loadings = by_row(loadings);
        match motion.ncols() {
            0 => (),
            1 => Arch::new().dispatch(UpdateMotion::<1> { als: self, loadings: &loadings, motion }),
            2 => Arch::new().dispatch(UpdateMotion::<2> { als: self, loadings: &loadings, motion }),
            3 => Arch::new().dispatch(UpdateMotion::<3> { als: self, loadings: &loadings, motion }),
            4 => Arch::new().dispatch(UpdateMotion::<4> { als: self, loadings: &loadings, motion }),
            5 => Arch::new().dispatch(UpdateMotion::<5> { als: self, loadings: &loadings, motion }),
            6 => Arch::new().dispatch(UpdateMotion::<6> { als: self, loadings: &loadings, motion }),
            k => unreachable!("a motion subspace has rank six at most, not {k}"),
        }
    }

    /// Updates c of each sensor by least squares over its informative roots, by c as it was.
    ///
    /// In and out: c, sensors × k. In: w, samples × k.
    pub(super) fn update_loadings(&self, mut loadings: MatMut<'_, f64>, motion: &Mat<f64>) {
        let mut rows = by_row(loadings.as_ref());
        let k = motion.ncols();
        match k {
            0 => return,
            1 => Arch::new().dispatch(UpdateLoadings::<1> { als: self, loadings: &mut rows, motion }),
            2 => Arch::new().dispatch(UpdateLoadings::<2> { als: self, loadings: &mut rows, motion }),
            3 => Arch::new().dispatch(UpdateLoadings::<3> { als: self, loadings: &mut rows, motion }),
            4 => Arch::new().dispatch(UpdateLoadings::<4> { als: self, loadings: &mut rows, motion }),
            5 => Arch::new().dispatch(UpdateLoadings::<5> { als: self, loadings: &mut rows, motion }),
            6 => Arch::new().dispatch(UpdateLoadings::<6> { als: self, loadings: &mut rows, motion }),
            k => unreachable!("a motion subspace has rank six at most, not {k}"),
        }
        for (sensor, row) in rows.chunks(k).enumerate() {
            row.iter().enumerate().for_each(|(at, value)| loadings[(sensor, at)] = *value);
        }
    }

    /// Residual sum of squares of the informative roots, and its degrees of freedom: informative roots beyond the k that w
    /// takes. Both are averages over samples.
    pub(super) fn residual(&self, loadings: MatRef<'_, f64>, motion: &Mat<f64>) -> [f64; 2] {
        let work = Residual { als: self, loadings: &by_row(loadings), motion };
        Arch::new().dispatch(work).map(|sum| sum / motion.nrows() as f64)
    }

    /// For each sensor, the residual sum of squares of its informative roots, and their number.
    pub(crate) fn residuals(&self, loadings: MatRef<'_, f64>, motion: &Mat<f64>) -> Vec<[f64; 2]> {
        Arch::new().dispatch(Residuals { als: self, loadings: &by_row(loadings), motion })
    }

    /// Roots of a sensor at samples from `t` on, as many as a register holds.
    #[inline(always)]
    fn roots<S: Simd>(&self, simd: S, sensor: usize, t: usize) -> S::f64s {
        load(simd, self.values[sensor], t)
    }

    /// The informative ones of the roots of a sensor at samples from `t` on, where these are predicted.
    #[inline(always)]
    fn informative<S: Simd>(&self, simd: S, sensor: usize, t: usize, predicted: S::f64s) -> Informative<S> {
        let (root, threshold) = (self.roots(simd, sensor, t), load(simd, &self.thresholds, t));
        let is_felt = simd.greater_than_or_equal_f64s(root, threshold);
        let should_be = simd.greater_than_f64s(predicted, root);
        let is_informative = simd.or_m64s(is_felt, should_be);
        let none = simd.splat_f64s(0.0);
        let (weight, instead) = match self.completed.get(sensor) {
            // After the last sample, motion and roots are 0, and nothing is added.
            Some(completed) => (simd.splat_f64s(self.weight), load(simd, completed, t)),
            None => (none, none),
        };
        Informative {
            weight: simd.select_f64s(is_informative, simd.splat_f64s(1.0), weight),
            product: simd.select_f64s(is_informative, root, simd.mul_f64s(weight, instead)),
        }
    }

    /// The errors of the informative ones of these roots, 0 for others, and their weights.
    #[inline(always)]
    fn error<S: Simd>(
        &self,
        simd: S,
        sensor: usize,
        t: usize,
        c: &[f64],
        motion: &Mat<f64>,
    ) -> (S::f64s, S::f64s) {
        let mut predicted = simd.splat_f64s(0.0);
        for (at, c) in c.iter().enumerate() {
            let w = load(simd, motion.col_as_slice(at), t);
            predicted = simd.mul_add_f64s(simd.splat_f64s(*c), w, predicted);
        }
        let Informative { weight, product } = self.informative(simd, sensor, t, predicted);
        (simd.sub_f64s(product, simd.mul_f64s(weight, predicted)), weight)
    }
}

/// The informative ones of some roots.
struct Informative<S: Simd> {
    /// 1 where a root is informative; elsewhere 0, or the weight of a completed one.
    weight: S::f64s,
    /// The root times its weight.
    product: S::f64s,
}

fn by_sensor(values: MatRef<'_, f64>) -> Vec<&[f64]> {
    let column = |sensor| values.col(sensor).try_as_col_major().expect("roots are kept by sensor").as_slice();
    (0..values.ncols()).map(column).collect()
}

/// The sums of as many regressions on K regressors as a register holds.
struct Sums<S: Simd, const K: usize> {
    /// Of products of two regressors, the second not after the first.
    squares: [[S::f64s; K]; K],
    /// Of products of a regressor with the response.
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
    fn add(&mut self, simd: S, regressors: &[S::f64s; K], response: &Informative<S>) {
        for a in 0..K {
            let own = simd.mul_f64s(response.weight, regressors[a]);
            self.products[a] = simd.mul_add_f64s(response.product, regressors[a], self.products[a]);
            for b in 0..=a {
                self.squares[a][b] = simd.mul_add_f64s(own, regressors[b], self.squares[a][b]);
            }
        }
    }
}

/// [`Als::update_motion`] for k = K.
struct UpdateMotion<'a, const K: usize> {
    als: &'a Als<'a>,
    loadings: &'a [f64],
    motion: &'a mut Mat<f64>,
}

impl<const K: usize> WithSimd for UpdateMotion<'_, K> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { als, loadings, motion } = self;
        let samples = motion.nrows();
        for first in (0..samples).step_by(LANES) {
            let count = LANES.min(samples - first);
            let mut regressions = Regressions::<K>::new();
            for at in (0..count).step_by(S::F64_LANES) {
                let t = first + at;
                let w = motion_from::<S, K>(simd, motion, t);
                let mut sums = Sums::<S, K>::new(simd);
                for (sensor, c) in loadings.as_chunks::<K>().0.iter().enumerate() {
                    let c = splat(simd, c);
                    let response = als.informative(simd, sensor, t, dot(simd, &c, &w));
                    sums.add(simd, &c, &response);
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
                motion.col_as_slice_mut(a)[first..first + count].copy_from_slice(&found[..count]);
            }
        }
    }
}

/// [`Als::update_loadings`] for k = K.
struct UpdateLoadings<'a, const K: usize> {
    als: &'a Als<'a>,
    loadings: &'a mut [f64],
    motion: &'a Mat<f64>,
}

impl<const K: usize> WithSimd for UpdateLoadings<'_, K> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { als, loadings, motion } = self;
        let rows = loadings.as_chunks_mut::<K>().0;
        for (first, rows) in (0..).step_by(LANES).zip(rows.chunks_mut(LANES)) {
            let mut regressions = Regressions::<K>::new();
            for (lane, row) in rows.iter().enumerate() {
                let c = splat(simd, row);
                let mut sums = Sums::<S, K>::new(simd);
                for t in (0..motion.nrows()).step_by(S::F64_LANES) {
                    let w = motion_from::<S, K>(simd, motion, t);
                    let response = als.informative(simd, first + lane, t, dot(simd, &c, &w));
                    sums.add(simd, &w, &response);
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

/// [`Als::residual`], summed over samples.
struct Residual<'a> {
    als: &'a Als<'a>,
    loadings: &'a [f64],
    motion: &'a Mat<f64>,
}

impl WithSimd for Residual<'_> {
    type Output = [f64; 2];

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> [f64; 2] {
        let Self { als, loadings, motion } = self;
        let (samples, k) = (motion.nrows(), motion.ncols());
        let none = simd.splat_f64s(0.0);
        let rank = simd.splat_f64s(k as f64);
        let [mut residuals, mut freedoms] = [none; 2];
        for t in (0..samples).step_by(S::F64_LANES) {
            let [mut residual, mut informative] = [none; 2];
            for (sensor, c) in loadings.chunks(k.max(1)).enumerate() {
                let (error, weight) = als.error(simd, sensor, t, c, motion);
                residual = simd.mul_add_f64s(error, error, residual);
                informative = simd.add_f64s(informative, weight);
            }
            residuals = simd.add_f64s(residuals, residual);
            freedoms = simd.add_f64s(freedoms, simd.max_f64s(none, simd.sub_f64s(informative, rank)));
        }
        [simd.reduce_sum_f64s(residuals), simd.reduce_sum_f64s(freedoms)]
    }
}

/// [`Als::residuals`].
struct Residuals<'a> {
    als: &'a Als<'a>,
    loadings: &'a [f64],
    motion: &'a Mat<f64>,
}

impl WithSimd for Residuals<'_> {
    type Output = Vec<[f64; 2]>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Vec<[f64; 2]> {
        let Self { als, loadings, motion } = self;
        let none = simd.splat_f64s(0.0);
        let mut found = Vec::with_capacity(als.values.len());
        for (sensor, c) in loadings.chunks(motion.ncols().max(1)).enumerate() {
            let [mut residual, mut informative] = [none; 2];
            for t in (0..motion.nrows()).step_by(S::F64_LANES) {
                let (error, weight) = als.error(simd, sensor, t, c, motion);
                residual = simd.mul_add_f64s(error, error, residual);
                informative = simd.add_f64s(informative, weight);
            }
            found.push([simd.reduce_sum_f64s(residual), simd.reduce_sum_f64s(informative)]);
        }
        found
    }
}

/// c of each sensor, one after the other.
fn by_row(loadings: MatRef<'_, f64>) -> Vec<f64> {
    let k = loadings.ncols();
    (0..loadings.nrows()).flat_map(|sensor| (0..k).map(move |at| loadings[(sensor, at)])).collect()
}

/// w at samples from `t` on, as many as a register holds.
#[inline(always)]
fn motion_from<S: Simd, const K: usize>(simd: S, motion: &Mat<f64>, t: usize) -> [S::f64s; K] {
    let mut w = [simd.splat_f64s(0.0); K];
    for (at, w) in w.iter_mut().enumerate() {
        *w = load(simd, motion.col_as_slice(at), t);
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

/// Numbers from an index on, as many as a register holds; 0 after the last.
#[inline(always)]
fn load<S: Simd>(simd: S, numbers: &[f64], from: usize) -> S::f64s {
    let rest = &numbers[from..];
    match S::as_simd_f64s(rest).0.first() {
        Some(whole) => *whole,
        None => simd.partial_load_f64s(rest),
    }
}

/// Stores numbers from an index on.
#[inline(always)]
fn store<S: Simd>(to: &mut [f64; LANES], from: usize, numbers: S::f64s) {
    S::as_mut_simd_f64s(&mut to[from..]).0[0] = numbers;
}

#[cfg(test)]
mod tests;
