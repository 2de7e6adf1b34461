//! Take the square roots of pressures: linear measurements of the motion of a part.
//!
//! A sensor at l with the outward normal n feels ρ (ṗ · n)² while it moves outward, and nothing otherwise. Its normal velocity
//! ṗ · n is linear in the velocity and angular velocity of its part. So the root of a pressure is max(0, c · w), with loadings
//! c of the sensor and the motion w of the part. Pressures that are also negative (of an incompressible medium behind a
//! sensor, say) have roots with a sign, c · w.

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatRef, Par};
use rayon::prelude::*;

use super::medians::median;
use crate::stages::sense::Tactile;

/// Share of the largest root at a sample from which on a sensor feels something. A smaller root only says that c · w is no
/// more than it.
const FELT: f64 = 0.1;
/// Share of all absolute pressure from which on negative pressures are signal; less is taken as noise about 0.
const SIGNED: f64 = 0.01;

/// Factor that puts a value just below a threshold, also after it is rounded to single precision.
const BELOW: f64 = 1.0 - 1e-6;

/// What a sensor feels of a pressure: its size, but 0 of a negative one that is noise about 0 (not `signed`). NaN is no size or 0.
pub(super) fn size(pressure: f32, signed: bool) -> f32 {
    if signed { pressure.abs() } else { pressure.max(0.0) }
}

/// Roots of the pressures on some sensors at some samples.
pub(crate) struct Roots {
    /// Samples × sensors, √Pa, or normalised; NaN where a value is missing. It is then neither felt nor any bound: every comparison with
    /// NaN is false.
    pub values: Mat<f64>,
    /// At each sample, the least root that is felt.
    pub thresholds: Vec<f64>,
    /// Whether negative pressures are signal.
    pub signed: bool,
}

impl Roots {
    /// Of series of pressures, at these samples.
    pub(crate) fn at(series: &[&[f32]], samples: &[usize], signed: bool) -> Self {
        let root = |pressure: f32| match signed {
            _ if pressure.is_nan() => f64::NAN,
            true => f64::from(pressure.abs()).sqrt().copysign(f64::from(pressure)),
            false => f64::from(pressure.max(0.0)).sqrt(),
        };
        let values = Mat::from_fn(samples.len(), series.len(), |t, sensor| root(series[sensor][samples[t]]));
        Self::new(values, signed)
    }

    fn new(values: Mat<f64>, signed: bool) -> Self {
        let thresholds = if signed {
            vec![f64::NEG_INFINITY; values.nrows()]
        } else {
            let mut most = vec![0.0; values.nrows()];
            for sensor in 0..values.ncols() {
                let roots = values.col_as_slice(sensor);
                most.iter_mut().zip(roots).for_each(|(most, root)| *most = f64::max(*most, *root));
            }
            most.into_iter().map(|most| f64::max(FELT * most, f64::MIN_POSITIVE)).collect()
        };
        Self { values, thresholds, signed }
    }

    /// Of these sensors only.
    pub(crate) fn select(&self, sensors: &[usize]) -> Self {
        Self::new(columns(&self.values, sensors), self.signed)
    }

    /// In units of these scales, where they are above 0.
    pub(super) fn scaled(mut self, scales: &[f64]) -> Self {
        for (sensor, scale) in scales.iter().enumerate().filter(|(_, scale)| **scale > 0.0) {
            self.values.col_as_slice_mut(sensor).iter_mut().for_each(|root| *root /= scale);
        }
        Self::new(self.values, self.signed)
    }

    /// A root counts as felt from the floor on; another one only says that c · w is no more than the floor.
    pub(super) fn with_floor(mut self, floor: f64) -> Self {
        if self.signed || floor == 0.0 {
            return self;
        }
        self.thresholds.iter_mut().for_each(|least| *least = f64::max(*least, BELOW * floor));
        for sensor in 0..self.sensors() {
            // What is felt is above this, too.
            let roots = self.values.col_as_slice_mut(sensor).iter_mut();
            let least = BELOW * BELOW * floor;
            roots.filter(|root| **root < least).for_each(|root| *root = least);
        }
        self
    }

    /// The root mean square of each sensor.
    pub(super) fn scales(&self) -> Vec<f64> {
        let scale = |sensor| {
            let roots = self.values.col_as_slice(sensor).iter().filter(|root| !root.is_nan());
            let (sum, count) = roots.fold((0.0, 0), |(sum, count), root| (sum + root * root, count + 1));
            (sum / f64::from(count.max(1))).sqrt()
        };
        (0..self.sensors()).map(scale).collect()
    }

    /// The root mean square of the roots at each sample, but no less than a tenth of the median.
    pub(super) fn sizes(&self) -> Vec<f64> {
        /// Size that a sample counts as at least, as a share of the median size.
        const LEAST: f64 = 0.1;
        let mut sums = vec![(0.0, 0); self.samples()];
        for sensor in 0..self.sensors() {
            let roots = self.values.col_as_slice(sensor);
            let known = sums.iter_mut().zip(roots).filter(|(_, root)| !root.is_nan());
            known.for_each(|((sum, count), root)| (*sum, *count) = (*sum + root * root, *count + 1));
        }
        let size = |(sum, count): (f64, i32)| (sum / f64::from(count.max(1))).sqrt();
        let sizes: Vec<f64> = sums.into_iter().map(size).collect();
        let least = f64::max(f64::MIN_POSITIVE, LEAST * median(sizes.clone()));
        sizes.into_iter().map(|size| size.max(least)).collect()
    }

    /// Divided by the size at each sample. A root above the floor counts as felt; another one only says that c · w is no more than
    /// the floor.
    pub(super) fn equalised(mut self, sizes: &[f64], floor: f64) -> Self {
        let least = f64::from(f32::MIN_POSITIVE);
        let threshold =
            |size: &f64| if self.signed { f64::NEG_INFINITY } else { f64::max(BELOW * floor / size, least) };
        self.thresholds = sizes.iter().map(threshold).collect();
        for sensor in 0..self.sensors() {
            let roots = self.values.col_as_slice_mut(sensor);
            for ((root, size), threshold) in roots.iter_mut().zip(sizes).zip(&self.thresholds) {
                *root /= size;
                if *root < *threshold && floor > 0.0 {
                    *root = BELOW * threshold;
                }
            }
        }
        self
    }

    /// Divides the roots at each sample, and their threshold.
    pub(super) fn divide(&mut self, divisors: &[f64]) {
        divide_rows(&mut self.values, divisors);
        self.thresholds.iter_mut().zip(divisors).for_each(|(least, divisor)| *least /= divisor);
    }

    /// Of these sensors only, felt from the same thresholds on.
    pub(super) fn select_as_they_are(&self, sensors: &[usize]) -> Self {
        let values = columns(&self.values, sensors);
        Self { values, thresholds: self.thresholds.clone(), signed: self.signed }
    }

    /// At how many samples a sensor feels something.
    pub(super) fn felt_samples(&self, sensor: usize) -> usize {
        let both = self.values.col_as_slice(sensor).iter().zip(&self.thresholds);
        both.filter(|(root, least)| root >= least).count()
    }

    /// Whether a value is missing.
    fn has_gaps(&self) -> bool {
        (0..self.sensors()).any(|sensor| self.values.col_as_slice(sensor).iter().any(|root| root.is_nan()))
    }

    /// The roots, with 0 where a value is missing.
    pub(super) fn filled(&self) -> Mat<f64> {
        known(&self.values)
    }

    /// The sum of all roots, and of their squares.
    pub(crate) fn sums(&self) -> [f64; 2] {
        let sums = |values: &Mat<f64>| [values.sum(), values.squared_norm_l2()];
        if self.has_gaps() { sums(&self.filled()) } else { sums(&self.values) }
    }

    /// Averages over samples: of the products of two sensors' roots, sensors × sensors, and of each sensor's roots. Of those at which
    /// both have a value.
    pub(crate) fn moments(&self) -> (Mat<f64>, Vec<f64>) {
        if self.has_gaps() {
            let filled = self.filled();
            let is_known = |t, sensor| f64::from(u8::from(!self.values[(t, sensor)].is_nan()));
            let known = Mat::from_fn(self.samples(), self.sensors(), is_known);
            let counts = product(known.transpose(), known.as_ref());
            let sums = product(filled.transpose(), filled.as_ref());
            let average = |i, j| sums[(i, j)] / f64::max(1.0, counts[(i, j)]);
            let mean = |at| filled.col_as_slice(at).iter().sum::<f64>() / f64::max(1.0, counts[(at, at)]);
            let means = (0..self.sensors()).map(mean).collect();
            return (Mat::from_fn(self.sensors(), self.sensors(), average), means);
        }
        let share = 1.0 / self.samples().max(1) as f64;
        let mean = |sensor| self.values.col_as_slice(sensor).iter().sum::<f64>() * share;
        let means = (0..self.sensors()).map(mean).collect();
        (product(self.values.transpose(), self.values.as_ref()) * faer::Scale(share), means)
    }

    /// Number of sensors.
    pub(crate) fn sensors(&self) -> usize {
        self.values.ncols()
    }

    /// Number of samples.
    pub(crate) fn samples(&self) -> usize {
        self.values.nrows()
    }

    /// Whether nothing is felt.
    pub(crate) fn is_empty(&self) -> bool {
        let is_nothing = |root: &f64| *root == 0.0 || root.is_nan();
        (0..self.sensors()).all(|sensor| self.values.col_as_slice(sensor).iter().all(is_nothing))
    }

    /// Each sensor's root minus that of the sensor that feels least at the same samples: linear in w without censoring, if the
    /// two are opposite to each other and never feel at the same sample. 0 where either has no value.
    pub(crate) fn differences(&self) -> Mat<f64> {
        let has_gaps = self.has_gaps();
        let filled = has_gaps.then(|| self.filled());
        let values = filled.as_ref().unwrap_or(&self.values);
        let together = product(values.transpose(), values.as_ref());
        let opposite = |sensor: usize| {
            let alive = (0..self.sensors()).filter(|other| together[(*other, *other)] > 0.0);
            let likeness = |other: usize| together[(sensor, other)] / together[(other, other)].sqrt();
            alive.min_by(|a, b| likeness(*a).total_cmp(&likeness(*b))).unwrap_or(sensor)
        };
        let opposites: Vec<usize> = (0..self.sensors()).map(opposite).collect();
        let differences = &self.values - columns(&self.values, &opposites);
        if has_gaps { known(&differences) } else { differences }
    }
}

/// The product of two matrices on one thread, whatever faer's global setting: sums depend on the number of threads.
pub(super) fn product(left: MatRef<'_, f64>, right: MatRef<'_, f64>) -> Mat<f64> {
    let mut product = Mat::zeros(left.nrows(), right.ncols());
    matmul(product.as_mut(), Accum::Replace, left, right, 1.0, Par::Seq);
    product
}

/// A matrix with 0 in place of NaN.
fn known(matrix: &Mat<f64>) -> Mat<f64> {
    let known = |value: f64| if value.is_nan() { 0.0 } else { value };
    Mat::from_fn(matrix.nrows(), matrix.ncols(), |row, column| known(matrix[(row, column)]))
}

/// Divides each row.
pub(super) fn divide_rows(matrix: &mut Mat<f64>, divisors: &[f64]) {
    for column in 0..matrix.ncols() {
        matrix
            .col_as_slice_mut(column)
            .iter_mut()
            .zip(divisors)
            .for_each(|(value, divisor)| *value /= divisor);
    }
}

/// Some columns.
pub(super) fn columns(matrix: &Mat<f64>, which: &[usize]) -> Mat<f64> {
    let mut some = Mat::zeros(matrix.nrows(), which.len());
    for (at, &column) in which.iter().enumerate() {
        some.col_as_slice_mut(at).copy_from_slice(matrix.col_as_slice(column));
    }
    some
}

/// Whether negative pressures are signal, not noise about 0.
pub(crate) fn is_signed(tactile: &Tactile) -> bool {
    let sums = |series: &[f32]| {
        series.iter().fold((0.0, 0.0), |(below, all), pressure| {
            let size = if pressure.is_nan() { 0.0 } else { f64::from(pressure.abs()) };
            (if *pressure < 0.0 { below + size } else { below }, all + size)
        })
    };
    let sums: Vec<(f64, f64)> = tactile.pressures.par_chunks_exact(tactile.samples).map(sums).collect();
    let (below, all) = sums.into_iter().fold((0.0, 0.0), |a, b| (a.0 + b.0, a.1 + b.1));
    below > SIGNED * all
}
