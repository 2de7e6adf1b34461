//! Alternate least squares of a censored regression: the motion from the loadings, and the loadings from the motion.
//!
//! A root is informative if it is felt, or if c · w predicts that it should be. Each goes straight into the sums of its
//! regression, by vector instructions, so that no intermediate of the size samples × sensors is written.

use faer::{Mat, MatMut, MatRef};
use pulp::{Arch, Simd, WithSimd};

use self::series::{Sensor, Series};
use self::sums::{Responses, Sums};
use super::regressions::{LANES, Regressions};
use crate::numerics::interrupt;

mod series;
mod sums;

/// Samples whose motion stays in the fastest memory while it is summed for one sensor after the other. It changes no result.
const BLOCK: usize = 256;

/// Runs work that is compiled for each rank of a motion subspace. At rank 0, gives the default value.
macro_rules! with_rank {
    ($rank:expr, $work:ident { $($field:ident: $value:expr),* }) => {
        match $rank {
            0 => Default::default(),
            1 => Arch::new().dispatch($work::<1> { $($field: $value),* }),
            2 => Arch::new().dispatch($work::<2> { $($field: $value),* }),
            3 => Arch::new().dispatch($work::<3> { $($field: $value),* }),
            4 => Arch::new().dispatch($work::<4> { $($field: $value),* }),
            5 => Arch::new().dispatch($work::<5> { $($field: $value),* }),
            6 => Arch::new().dispatch($work::<6> { $($field: $value),* }),
            7 => Arch::new().dispatch($work::<7> { $($field: $value),* }),
            rank => unreachable!("a motion has rank six at most, and one more on its way, not {rank}"),
        }
    };
}

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
        with_rank!(motion.ncols(), UpdateMotion { als: self, loadings: &by_row(loadings), motion: motion });
    }

    /// Updates c of each sensor by least squares over its informative roots, by c as it was.
    ///
    /// In and out: c, sensors × k. In: w, samples × k.
    pub(super) fn update_loadings(&self, mut loadings: MatMut<'_, f64>, motion: &Mat<f64>) {
        let (mut rows, rank) = (by_row(loadings.as_ref()), motion.ncols());
        with_rank!(rank, UpdateLoadings { als: self, loadings: &mut rows, motion: motion });
        for (sensor, row) in rows.chunks(rank.max(1)).enumerate() {
            row.iter().enumerate().for_each(|(at, value)| loadings[(sensor, at)] = *value);
        }
    }

    /// Residual sum of squares of the informative roots, and its degrees of freedom: informative roots beyond the k that w
    /// takes. Both are averages over samples.
    pub(super) fn residual(&self, loadings: MatRef<'_, f64>, motion: &Mat<f64>) -> [f64; 2] {
        let sums: [f64; 2] =
            with_rank!(motion.ncols(), Residual { als: self, loadings: &by_row(loadings), motion: motion });
        sums.map(|sum| sum / motion.nrows() as f64)
    }

    /// For each sensor, the residual sum of squares of its informative roots, and their number.
    pub(crate) fn residuals(&self, loadings: MatRef<'_, f64>, motion: &Mat<f64>) -> Vec<[f64; 2]> {
        with_rank!(motion.ncols(), Residuals { als: self, loadings: &by_row(loadings), motion: motion })
    }

    /// Replaces roots that are not felt by what is predicted, but by no more than the root. A missing root is replaced by any prediction.
    ///
    /// In: c, sensors × k; w, samples × k. In and out: roots, samples × sensors.
    pub(super) fn complete(&self, loadings: MatRef<'_, f64>, motion: &Mat<f64>, roots: &mut Mat<f64>) {
        with_rank!(
            motion.ncols(),
            Complete { als: self, loadings: &by_row(loadings), motion: motion, roots: roots }
        );
    }

    /// What each sensor felt at so many samples, with c of as many sensors.
    #[inline(always)]
    fn sensors<S: Simd>(&self, simd: S, loadings: usize, samples: usize) -> Vec<Sensor<'_, S>> {
        assert_eq!(self.values.len(), loadings, "each sensor has a row of loadings");
        let mut sensors = Vec::with_capacity(loadings);
        for (at, roots) in self.values.iter().enumerate() {
            assert_eq!(roots.len(), samples, "each sample has a motion");
            let completed = self.completed.get(at).copied().unwrap_or_default();
            sensors.push(Sensor { roots: Series::new(simd, roots), completed: Series::new(simd, completed) });
        }
        sensors
    }

    /// At each sample, the threshold; and the weight of a completed root.
    #[inline(always)]
    fn limits<S: Simd>(&self, simd: S) -> impl Fn(usize) -> [S::f64s; 2] {
        // Infinite after the last sample, where motion and roots are 0: nothing is added there.
        let (thresholds, weight) = (Series::<S>::new(simd, &self.thresholds), simd.splat_f64s(self.weight));
        #[inline(always)]
        move |register| [thresholds.at(register), weight]
    }
}

/// The series of each sensor, of samples × sensors.
pub(super) fn by_sensor(values: MatRef<'_, f64>) -> Vec<&[f64]> {
    let column = |sensor| values.col(sensor).try_as_col_major().expect("roots are kept by sensor").as_slice();
    (0..values.ncols()).map(column).collect()
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
        let (samples, rows) = (motion.nrows(), loadings.as_chunks::<K>().0);
        let (sensors, limits) = (als.sensors(simd, rows.len(), samples), als.limits(simd));
        let moved = motion_of::<S, K>(simd, motion);
        let mut responses = no_responses(simd, rows.len());
        for first in (0..samples).step_by(LANES) {
            let count = LANES.min(samples - first);
            let mut regressions = Regressions::<K>::new();
            for at in (0..count).step_by(S::F64_LANES) {
                let register = (first + at) / S::F64_LANES;
                let (limits, w) = (limits(register), &moved[register]);
                for ((sensor, c), response) in sensors.iter().zip(rows).zip(&mut responses) {
                    *response = sensor.responses(simd, register, limits, dot(simd, &splat(simd, c), w));
                }
                let mut sums = Sums::<S, K>::new(simd);
                sums.add(
                    simd,
                    &responses,
                    rows,
                    #[inline(always)]
                    |c| simd.splat_f64s(*c),
                );
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
        let (sensors, limits) = (als.sensors(simd, rows.len(), motion.nrows()), als.limits(simd));
        let moved = motion_of::<S, K>(simd, motion);
        let block = BLOCK / S::F64_LANES;
        let mut responses = no_responses(simd, block);
        for (sensors, rows) in sensors.chunks(LANES).zip(rows.chunks_mut(LANES)) {
            let mut regressions = Regressions::<K>::new();
            let mut sums = vec![Sums::<S, K>::new(simd); rows.len()];
            for (number, moved) in moved.chunks(block).enumerate() {
                for ((sensor, row), sums) in sensors.iter().zip(&*rows).zip(&mut sums) {
                    let c = splat(simd, row);
                    for ((register, w), response) in (number * block..).zip(moved).zip(&mut responses) {
                        *response = sensor.responses(simd, register, limits(register), dot(simd, &c, w));
                    }
                    sums.add(
                        simd,
                        &responses[..moved.len()],
                        moved,
                        #[inline(always)]
                        |w| *w,
                    );
                }
            }
            for (lane, sums) in sums.iter().enumerate() {
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

/// [`Als::residual`] for k = K, summed over samples.
struct Residual<'a, const K: usize> {
    als: &'a Als<'a>,
    loadings: &'a [f64],
    motion: &'a Mat<f64>,
}

impl<const K: usize> WithSimd for Residual<'_, K> {
    type Output = [f64; 2];

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> [f64; 2] {
        let Self { als, loadings, motion } = self;
        let rows = loadings.as_chunks::<K>().0;
        let (sensors, limits) = (als.sensors(simd, rows.len(), motion.nrows()), als.limits(simd));
        let (none, rank) = (simd.splat_f64s(0.0), simd.splat_f64s(K as f64));
        let [mut residuals, mut freedoms] = [none; 2];
        for (register, w) in motion_of::<S, K>(simd, motion).iter().enumerate() {
            let limits = limits(register);
            let [mut residual, mut informative] = [none; 2];
            for (sensor, c) in sensors.iter().zip(rows) {
                let (error, weight) = sensor.error(simd, register, limits, dot(simd, &splat(simd, c), w));
                residual = simd.mul_add_f64s(error, error, residual);
                informative = simd.add_f64s(informative, weight);
            }
            residuals = simd.add_f64s(residuals, residual);
            freedoms = simd.add_f64s(freedoms, simd.max_f64s(none, simd.sub_f64s(informative, rank)));
        }
        [simd.reduce_sum_f64s(residuals), simd.reduce_sum_f64s(freedoms)]
    }
}

/// [`Als::residuals`] for k = K.
struct Residuals<'a, const K: usize> {
    als: &'a Als<'a>,
    loadings: &'a [f64],
    motion: &'a Mat<f64>,
}

impl<const K: usize> WithSimd for Residuals<'_, K> {
    type Output = Vec<[f64; 2]>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Vec<[f64; 2]> {
        let Self { als, loadings, motion } = self;
        let rows = loadings.as_chunks::<K>().0;
        let (sensors, limits) = (als.sensors(simd, rows.len(), motion.nrows()), als.limits(simd));
        let moved = motion_of::<S, K>(simd, motion);
        let none = simd.splat_f64s(0.0);
        let mut found = Vec::with_capacity(sensors.len());
        for (sensor, c) in sensors.iter().zip(rows) {
            let c = splat(simd, c);
            let [mut residual, mut informative] = [none; 2];
            for (register, w) in moved.iter().enumerate() {
                let (error, weight) = sensor.error(simd, register, limits(register), dot(simd, &c, w));
                residual = simd.mul_add_f64s(error, error, residual);
                informative = simd.add_f64s(informative, weight);
            }
            found.push([simd.reduce_sum_f64s(residual), simd.reduce_sum_f64s(informative)]);
        }
        found
    }
}

/// [`Als::complete`] for k = K.
struct Complete<'a, const K: usize> {
    als: &'a Als<'a>,
    loadings: &'a [f64],
    motion: &'a Mat<f64>,
    roots: &'a mut Mat<f64>,
}

impl<const K: usize> WithSimd for Complete<'_, K> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { als, loadings, motion, roots } = self;
        let rows = loadings.as_chunks::<K>().0;
        let (sensors, limits) = (als.sensors(simd, rows.len(), motion.nrows()), als.limits(simd));
        let moved = motion_of::<S, K>(simd, motion);
        for (at, (sensor, c)) in sensors.iter().zip(rows).enumerate() {
            let c = splat(simd, c);
            let (whole, last) = S::as_mut_simd_f64s(roots.col_as_slice_mut(at));
            for (register, w) in moved.iter().enumerate() {
                let (threshold, predicted) = (limits(register)[0], dot(simd, &c, w));
                match whole.get_mut(register) {
                    Some(own) => *own = sensor.completed(simd, register, threshold, [predicted, *own]),
                    None => {
                        let own = simd.partial_load_f64s(last);
                        let all = sensor.completed(simd, register, threshold, [predicted, own]);
                        simd.partial_store_f64s(last, all);
                    }
                }
            }
        }
    }
}

#[inline(always)]
fn no_responses<S: Simd>(simd: S, count: usize) -> Vec<Responses<S>> {
    let none = simd.splat_f64s(0.0);
    vec![Responses { weight: none, product: none }; count]
}

/// c of each sensor, one after the other.
fn by_row(loadings: MatRef<'_, f64>) -> Vec<f64> {
    let k = loadings.ncols();
    (0..loadings.nrows()).flat_map(|sensor| (0..k).map(move |at| loadings[(sensor, at)])).collect()
}

/// w as registers.
#[inline(always)]
fn motion_of<S: Simd, const K: usize>(simd: S, motion: &Mat<f64>) -> Vec<[S::f64s; K]> {
    let mut all = vec![[simd.splat_f64s(0.0); K]; motion.nrows().div_ceil(S::F64_LANES)];
    for a in 0..K {
        let series = Series::<S>::new(simd, motion.col_as_slice(a));
        for (register, w) in all.iter_mut().enumerate() {
            w[a] = series.at(register);
        }
    }
    all
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

/// Stores numbers from an index on.
#[inline(always)]
fn store<S: Simd>(to: &mut [f64; LANES], from: usize, numbers: S::f64s) {
    S::as_mut_simd_f64s(&mut to[from..]).0[0] = numbers;
}

#[cfg(test)]
mod tests;
