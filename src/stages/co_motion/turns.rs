//! The turns of a censored regression: find w from c, and c from w, by the roots that say something.

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatMut, MatRef, Par};

use super::regressions::{pairs, solve};
use crate::numerics::simd::vectorised;

/// Times that are worked on at once, so that they stay near the processor.
const BLOCK: usize = 256;

/// Roots of some sensors, and room for what they say of a motion: times × sensors.
pub struct Turns<'a> {
    /// All roots.
    values: MatRef<'a, f64>,
    /// At each time, that from which on a root is felt.
    felt: &'a [f64],
    /// c · w, at as many times as are worked on at once.
    reach: Mat<f64>,
    /// 1 where a root says something: it is felt, or should be. 0 elsewhere.
    tells: Mat<f64>,
    /// The roots that say something. 0 elsewhere.
    told: Mat<f64>,
}

impl<'a> Turns<'a> {
    /// On roots, times × sensors, of which those that are no less than `felt` at their time are felt.
    pub fn new(values: MatRef<'a, f64>, felt: &'a [f64]) -> Self {
        let room = || Mat::zeros(BLOCK.min(values.nrows()), values.ncols());
        Self { values, felt, reach: room(), tells: room(), told: room() }
    }

    /// w at all times by least squares over the sensors that feel something, and those that should by w as it was.
    ///
    /// In: c, sensors × k. In and out: w, times × k.
    pub fn move_all(&mut self, loadings: MatRef<'_, f64>, mut motions: MatMut<'_, f64>) {
        let of_loadings = pairs(loadings);
        let mut squares = Mat::zeros(BLOCK, of_loadings.ncols());
        for (first, count) in blocks(self.values.nrows()) {
            self.find(first, count, loadings, motions.as_ref());
            let mut squares = squares.subrows_mut(0, count);
            let mut found = motions.as_mut().subrows_mut(first, count);
            product(squares.as_mut(), self.tells.subrows(0, count), of_loadings.as_ref(), Accum::Replace);
            product(found.as_mut(), self.told.subrows(0, count), loadings, Accum::Replace);
            solve(squares.as_ref(), found);
        }
    }

    /// c of all sensors by least squares over the times at which each feels something, or should by c as it was.
    ///
    /// In and out: c, sensors × k. In: w, times × k, and its [pairs].
    pub fn load_all(
        &mut self,
        mut loadings: MatMut<'_, f64>,
        motions: MatRef<'_, f64>,
        of_motions: MatRef<'_, f64>,
    ) {
        let mut squares = Mat::zeros(loadings.nrows(), of_motions.ncols());
        let mut products = Mat::zeros(loadings.nrows(), loadings.ncols());
        for (first, count) in blocks(self.values.nrows()) {
            self.find(first, count, loadings.as_ref(), motions);
            let (tells, told) = (self.tells.subrows(0, count), self.told.subrows(0, count));
            product(squares.as_mut(), tells.transpose(), of_motions.subrows(first, count), Accum::Add);
            product(products.as_mut(), told.transpose(), motions.subrows(first, count), Accum::Add);
        }
        solve(squares.as_ref(), products.as_mut());
        loadings.copy_from(&products);
    }

    /// The squares that roots which say something leave, at each time on the mean, and how many such roots a time has beyond the
    /// k that w takes, on the mean.
    pub fn residual_and_spare(&mut self, loadings: MatRef<'_, f64>, motions: MatRef<'_, f64>) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for (first, count) in blocks(self.values.nrows()) {
            self.find(first, count, loadings, motions);
            let mut at_times = vec![[0.0; 2]; count];
            for sensor in 0..loadings.nrows() {
                let found = self.told.col_as_slice(sensor).iter().zip(self.tells.col_as_slice(sensor));
                let found = found.zip(self.reach.col_as_slice(sensor));
                for ([residual, telling], ((told, tells), reach)) in at_times.iter_mut().zip(found) {
                    *residual += tells * (told - reach).powi(2);
                    *telling += tells;
                }
            }
            for [residual, telling] in at_times {
                sums[0] += residual;
                sums[1] += f64::max(0.0, telling - loadings.ncols() as f64);
            }
        }
        sums.map(|sum| sum / self.values.nrows() as f64)
    }

    /// What roots say at some times.
    fn find(&mut self, first: usize, count: usize, loadings: MatRef<'_, f64>, motions: MatRef<'_, f64>) {
        let reach = self.reach.subrows_mut(0, count);
        product(reach, motions.subrows(first, count), loadings.transpose(), Accum::Replace);
        let felt = &self.felt[first..first + count];
        for sensor in 0..loadings.nrows() {
            let own =
                self.values.col(sensor).try_as_col_major().expect("roots are kept by sensor").as_slice();
            let own = &own[first..first + count];
            let reach = self.reach.col_as_slice(sensor);
            let tells = self.tells.col_as_slice_mut(sensor);
            let told = self.told.col_as_slice_mut(sensor);
            vectorised(
                #[inline(always)]
                || {
                    let found = tells.iter_mut().zip(told.iter_mut());
                    for ((tells, told), ((root, felt), reach)) in found.zip(own.iter().zip(felt).zip(reach)) {
                        *tells = if (root >= felt) | (reach > root) { 1.0 } else { 0.0 };
                        *told = *tells * root;
                    }
                },
            );
        }
    }
}

/// A product by one thread, so that its sums have one order.
fn product(to: MatMut<'_, f64>, left: MatRef<'_, f64>, right: MatRef<'_, f64>, how: Accum) {
    matmul(to, how, left, right, 1.0, Par::Seq);
}

/// The first time and the number of times of each block.
fn blocks(times: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..times).step_by(BLOCK).map(move |first| (first, BLOCK.min(times - first)))
}
