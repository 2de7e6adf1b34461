//! Complete censored roots: find the matrix of low rank whose positive part they are (Saul 2022), by the three-block algorithm
//! with extrapolation of Seraghiti, Awari, Vandaele, Porcelli and Gillis (2023).
//!
//! A root is max(0, c · w). The normal velocities c · w of all sensors have rank six for each part at most. While a sensor moves
//! outward, it feels what its velocity is. That the matrix has a low rank says what the velocity is elsewhere.

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatRef, Par};
use nalgebra::DMatrix;
use rayon::prelude::*;

use super::roots::{Roots, product};
use crate::numerics::eigen::largest;
use crate::numerics::interrupt;
use crate::numerics::simd::vectorised;

/// Largest rank. More than the motions of a body have does no harm.
const MAX_RANK: usize = 100;
/// Sensors, and samples, for each unit of rank at least: with fewer, anything fits.
pub(super) const MIN_PER_RANK: usize = 4;
/// Iterations.
const ITERATIONS: usize = 200;
/// Momentum: the first, the largest, and the least.
const MOMENTUM: [f32; 3] = [0.7, 0.95, 0.5];
/// Factors of the momentum: while the error falls, and when it rose.
const PACE: [f32; 2] = [1.05, 0.8];
/// Iterations from one check of the error to the next.
const CHECK: usize = 5;
/// What is added to the diagonal of a matrix that may be 0, so that it has a factor.
const LEAST: f64 = 1e-30;
/// Samples that one thread works on at once.
const BLOCK: usize = 128;

/// The normal velocities of sensors, completed.
pub(super) struct Completion {
    /// Samples × sensors: the roots where they are felt, and elsewhere what completes them.
    pub velocities: Mat<f64>,
    /// Sizes of the cosines between sensors, sensors × sensors, 0 to 1: high for two on one part. It is the shape interaction matrix of
    /// Costeira and Kanade (1998), each component weighted by how far it exceeds the ridge, and normalised.
    pub affinities: Mat<f64>,
}

impl Completion {
    /// Of roots that are scaled by sensor and by sample. The ridge of both factors is a share of the mean square of a root.
    pub(super) fn new(roots: &Roots, ridge: f64) -> Self {
        let (samples, sensors) = (roots.samples(), roots.sensors());
        let rank = (samples.min(sensors) / MIN_PER_RANK).clamp(1, MAX_RANK);
        let mut blocks = Block::all(roots);
        let mut loadings = start(&blocks, rank);
        let (mut momentum, mut step, mut before) = (MOMENTUM[0], 0.0, f64::INFINITY);
        for iteration in 0..ITERATIONS {
            interrupt::check();
            let next = updated(&mut blocks, loadings.as_ref(), step, ridge);
            blocks.par_iter_mut().for_each(|block| block.advance(next.as_ref()));
            step = momentum;
            if iteration % CHECK == 0 {
                let error = in_order(&blocks, Block::error).into_iter().sum::<f64>();
                if error > before {
                    (momentum, step) = (f32::max(MOMENTUM[2], momentum * PACE[1]), 0.0);
                } else {
                    momentum = f32::min(MOMENTUM[1], momentum * PACE[0]);
                }
                before = error;
            }
            loadings = orthonormal(next, &mut blocks);
        }
        let filled = in_order(&blocks, |block| block.filled(0.0));
        let velocity = |t: usize, sensor: usize| f64::from(filled[t / BLOCK][(t % BLOCK, sensor)]);
        Self {
            velocities: Mat::from_fn(samples, sensors, velocity),
            affinities: affinities(&blocks, loadings.as_ref(), ridge),
        }
    }
}

/// Some samples. All matrices but the scores are samples × sensors.
struct Block {
    roots: Mat<f32>,
    /// At each sample, the least root that is felt.
    thresholds: Vec<f32>,
    /// The product of both factors, and what it was before.
    estimate: Mat<f32>,
    last: Mat<f32>,
    /// The left factor, samples × rank.
    scores: Mat<f32>,
}

impl Block {
    /// All of them. What is not felt begins a little below 0, and what is missing at 0.
    fn all(roots: &Roots) -> Vec<Self> {
        let mean = roots.sums()[0] / (roots.samples() * roots.sensors()) as f64;
        let firsts: Vec<usize> = (0..roots.samples()).step_by(BLOCK).collect();
        let block = |first: usize| {
            let count = BLOCK.min(roots.samples() - first);
            let own = roots.values.subrows(first, count);
            let is_felt = |t: usize, sensor: usize| own[(t, sensor)] >= roots.thresholds[first + t];
            let begin = |t, sensor| match own[(t, sensor)] {
                root if root.is_nan() => 0.0,
                root => (if is_felt(t, sensor) { root } else { -mean }) as f32,
            };
            let estimate = Mat::from_fn(count, own.ncols(), begin);
            Self {
                roots: Mat::from_fn(count, own.ncols(), |t, sensor| own[(t, sensor)] as f32),
                thresholds: (0..count).map(|t| roots.thresholds[first + t] as f32).collect(),
                last: estimate.clone(),
                estimate,
                scores: Mat::zeros(0, 0),
            }
        };
        firsts.into_par_iter().map(block).collect()
    }

    /// A root where it is felt, and else the extrapolated estimate, which is no more than the root; any, where this is missing.
    fn filled(&self, step: f32) -> Mat<f32> {
        let mut filled = Mat::zeros(self.roots.nrows(), self.roots.ncols());
        vectorised(
            #[inline(always)]
            || {
                for sensor in 0..self.roots.ncols() {
                    let estimates =
                        self.estimate.col_as_slice(sensor).iter().zip(self.last.col_as_slice(sensor));
                    let roots = self.roots.col_as_slice(sensor).iter().zip(&self.thresholds);
                    let to = filled.col_as_slice_mut(sensor).iter_mut();
                    for ((to, (estimate, last)), (root, least)) in to.zip(estimates).zip(roots) {
                        let ahead = estimate + step * (estimate - last);
                        *to = if root >= least { *root } else { ahead.min(*root) };
                    }
                }
            },
        );
        filled
    }

    /// Replaces the estimate by the product of both factors.
    fn advance(&mut self, loadings: MatRef<'_, f32>) {
        std::mem::swap(&mut self.estimate, &mut self.last);
        matmul(
            self.estimate.as_mut(),
            Accum::Replace,
            self.scores.as_ref(),
            loadings.transpose(),
            1.0,
            Par::Seq,
        );
    }

    /// The squared error of the estimate.
    fn error(&self) -> f64 {
        let own = |sensor: usize| {
            let both = self.roots.col_as_slice(sensor).iter().zip(self.estimate.col_as_slice(sensor));
            let error = |((root, estimate), least): ((&f32, &f32), &f32)| {
                if root >= least { (estimate - root).powi(2) } else { f32::max(0.0, estimate - root).powi(2) }
            };
            f64::from(both.zip(&self.thresholds).map(error).sum::<f32>())
        };
        (0..self.roots.ncols()).map(own).sum()
    }
}

/// Of each block, in their order.
fn in_order<T: Send>(blocks: &[Block], of: impl Fn(&Block) -> T + Sync + Send) -> Vec<T> {
    blocks.par_iter().map(of).collect()
}

/// The first right factor, sensors × rank: principal axes of what the blocks begin with.
fn start(blocks: &[Block], rank: usize) -> Mat<f32> {
    let squares = in_order(blocks, |block| times(block.estimate.transpose(), block.estimate.as_ref()));
    let sum = sum(squares);
    let squares = Mat::from_fn(sum.nrows(), sum.ncols(), |i, j| f64::from(sum[(i.max(j), i.min(j))]));
    match largest(squares.as_ref(), rank) {
        Ok(eigen) => single(&eigen.vectors),
        Err(_) => Mat::identity(squares.nrows(), rank),
    }
}

/// Updates the scores of all blocks, and then the right factor, sensors × rank.
fn updated(blocks: &mut [Block], loadings: MatRef<'_, f32>, step: f32, share: f64) -> Mat<f32> {
    let samples: usize = blocks.iter().map(|block| block.roots.nrows()).sum();
    let shrink = (1.0 / (1.0 + share)) as f32;
    let sums = |block: &mut Block| {
        let filled = block.filled(step);
        block.scores = times(filled.as_ref(), loadings) * faer::Scale(shrink);
        (
            times(filled.transpose(), block.scores.as_ref()),
            times(block.scores.transpose(), block.scores.as_ref()),
        )
    };
    let (products, squares): (Vec<Mat<f32>>, Vec<Mat<f32>>) = blocks.par_iter_mut().map(sums).unzip();
    let ridge = DMatrix::from_diagonal_element(loadings.ncols(), loadings.ncols(), share * samples as f64);
    let inverse = (double(&sum(squares)) + ridge).cholesky().expect("a ridge makes it positive").inverse();
    times(sum(products).as_ref(), single_of(&inverse).as_ref())
}

/// The right factor with orthonormal columns; the scores keep the product as it is.
fn orthonormal(loadings: Mat<f32>, blocks: &mut [Block]) -> Mat<f32> {
    let squares = double(&times(loadings.transpose(), loadings.as_ref()));
    let ridge = DMatrix::from_diagonal_element(
        squares.nrows(),
        squares.nrows(),
        f64::from(f32::EPSILON) * squares.trace() + LEAST,
    );
    let factor = (squares + ridge).cholesky().expect("a ridge makes it positive").unpack();
    let inverse = factor.clone().try_inverse().expect("a factor is regular").transpose();
    let factor = single_of(&factor);
    blocks.par_iter_mut().for_each(|block| block.scores = times(block.scores.as_ref(), factor.as_ref()));
    times(loadings.as_ref(), single_of(&inverse).as_ref())
}

/// Sizes of the cosines between sensors.
fn affinities(blocks: &[Block], loadings: MatRef<'_, f32>, share: f64) -> Mat<f64> {
    let samples: usize = blocks.iter().map(|block| block.roots.nrows()).sum();
    let (sensors, rank) = loadings.shape();
    let squares =
        double(&sum(in_order(blocks, |block| times(block.scores.transpose(), block.scores.as_ref()))))
            / samples as f64;
    // Half of the sensors move outward at a time.
    let ridge = DMatrix::from_diagonal_element(rank, rank, 0.5 * share * sensors as f64);
    let weights = (&squares + ridge).cholesky().expect("a ridge makes it positive").solve(&squares);
    let loadings = Mat::from_fn(sensors, rank, |sensor, at| f64::from(loadings[(sensor, at)]));
    let weights = Mat::from_fn(rank, rank, |i, j| 0.5 * (weights[(i, j)] + weights[(j, i)]));
    let inner = product(product(loadings.as_ref(), weights.as_ref()).as_ref(), loadings.transpose());
    let lengths: Vec<f64> =
        (0..sensors).map(|sensor| inner[(sensor, sensor)].max(0.0).sqrt() + 1e-12).collect();
    Mat::from_fn(sensors, sensors, |i, j| {
        (inner[(i.max(j), i.min(j))] / (lengths[i] * lengths[j])).abs().min(1.0)
    })
}

/// The product of two matrices on one thread: sums depend on the number of threads.
fn times(left: MatRef<'_, f32>, right: MatRef<'_, f32>) -> Mat<f32> {
    let mut product = Mat::zeros(left.nrows(), right.ncols());
    matmul(product.as_mut(), Accum::Replace, left, right, 1.0, Par::Seq);
    product
}

/// The sum of matrices, in their order.
fn sum(matrices: Vec<Mat<f32>>) -> Mat<f32> {
    matrices.into_iter().reduce(|sum, next| sum + next).expect("there are blocks")
}

fn double(matrix: &Mat<f32>) -> DMatrix<f64> {
    DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| f64::from(matrix[(i, j)]))
}

fn single_of(matrix: &DMatrix<f64>) -> Mat<f32> {
    Mat::from_fn(matrix.nrows(), matrix.ncols(), |i, j| matrix[(i, j)] as f32)
}

fn single(matrix: &Mat<f64>) -> Mat<f32> {
    Mat::from_fn(matrix.nrows(), matrix.ncols(), |i, j| matrix[(i, j)] as f32)
}

#[cfg(test)]
mod tests;
