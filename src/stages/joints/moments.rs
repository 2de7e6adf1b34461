//! Sum the products of quadratic monomials of all motions over blocks of samples: all that correlations and their bootstrap need.

use nalgebra::DMatrix;
use rayon::prelude::*;

use super::correlation::{QuadraticForms, correlation};
use crate::numerics::interrupt;
use crate::stages::rigid_parts::MotionSubspace;

/// Weight of a sample at which the whole body hardly moves, in units of its mean square.
const REST: f64 = 1e-3;

/// Sums over samples of the products of all quadratic monomials of all motions, by blocks of samples.
#[derive(Debug, Clone)]
pub(super) struct Moments {
    /// Where the monomials of each part begin, and where the last end.
    starts: Vec<usize>,
    /// For each block, monomials × monomials.
    blocks: Vec<DMatrix<f64>>,
}

impl Moments {
    /// Of the motions of all parts at the same T samples, in blocks of nearly equal length.
    ///
    /// A monomial is w_i w_j divided by the root of the whole body's Σ |w|² at the sample, so that fast movements count in
    /// proportion to speed, not to its square.
    pub(super) fn new(motions: &[MotionSubspace], samples: usize, blocks: usize) -> Self {
        let mut starts = vec![0];
        for MotionSubspace { rank: k, .. } in motions {
            starts.push(starts[starts.len() - 1] + k * (k + 1) / 2);
        }
        let all = starts[motions.len()];
        let scales = scales(motions, samples);
        let block = |at: usize| {
            let samples = at * samples / blocks..(at + 1) * samples / blocks;
            let mut monomials = DMatrix::zeros(samples.len(), all);
            // The others stay 0.
            for (row, t) in samples.enumerate().filter(|(_, t)| scales[*t] > 0.0) {
                let mut column = 0;
                for motion in motions {
                    let w = motion.at(t);
                    for i in 0..w.len() {
                        for j in i..w.len() {
                            monomials[(row, column)] = scales[t] * w[i] * w[j];
                            column += 1;
                        }
                    }
                }
            }
            monomials.transpose() * &monomials
        };
        let moves = scales.iter().any(|scale| *scale > 0.0);
        let blocks = if moves { (0..blocks).into_par_iter().map(block).collect() } else { Vec::new() };
        Self { starts, blocks }
    }

    /// Number of blocks; none if nothing moves.
    pub(super) fn blocks(&self) -> usize {
        self.blocks.len()
    }

    /// The [`correlation`] of each pair of parts over all samples: parts × parts, 0 to 1, symmetric, 1 on the diagonal.
    pub(super) fn correlations(&self) -> DMatrix<f64> {
        self.resampled_correlations(&vec![1; self.blocks()])
    }

    /// The same over a bootstrap resample that has each block so many times.
    pub(super) fn resampled_correlations(&self, counts: &[usize]) -> DMatrix<f64> {
        interrupt::check();
        let moments = self.sum(counts);
        let parts = self.starts.len() - 1;
        let length = |part: usize| self.starts[part + 1] - self.starts[part];
        let block = |a: usize, b: usize| {
            moments.view((self.starts[a], self.starts[b]), (length(a), length(b))).into_owned()
        };
        let rank = |part: usize| (0..).find(|k| k * (k + 1) / 2 == length(part)).expect("whole");
        let forms: Vec<_> =
            (0..parts).map(|part| QuadraticForms::new(monomials(rank(part)), block(part, part))).collect();
        let mut correlations = DMatrix::identity(parts, parts);
        for (a, b) in (0..parts).flat_map(|a| (a + 1..parts).map(move |b| (a, b))) {
            correlations[(a, b)] = correlation(&forms[a], &forms[b], &block(a, b));
            correlations[(b, a)] = correlations[(a, b)];
        }
        correlations
    }

    /// The sum over blocks, each counted so many times.
    fn sum(&self, counts: &[usize]) -> DMatrix<f64> {
        let all = self.starts[self.starts.len() - 1];
        let mut sum = DMatrix::zeros(all, all);
        for (block, &count) in self.blocks.iter().zip(counts).filter(|(_, count)| **count > 0) {
            sum.zip_apply(block, |sum, moment| *sum += moment * count as f64);
        }
        sum
    }
}

/// The monomials of k components, as pairs of which the second is not before the first.
pub(super) fn monomials(k: usize) -> Vec<(usize, usize)> {
    (0..k).flat_map(|i| (i..k).map(move |j| (i, j))).collect()
}

/// The factor of the monomials at each sample: one over the root of the whole body's Σ |w|² there and of its mean; 0 if nothing
/// moves, or the motion of a part is not known there.
pub(super) fn scales(motions: &[MotionSubspace], samples: usize) -> Vec<f64> {
    let energy = |t: usize| -> f64 { motions.iter().flat_map(|motion| motion.at(t)).map(|w| w * w).sum() };
    let energies: Vec<f64> = (0..samples).into_par_iter().map(energy).collect();
    let known = energies.iter().filter(|energy| !energy.is_nan());
    let (sum, count) = known.fold((0.0, 0_usize), |(sum, count), energy| (sum + energy, count + 1));
    let mean = sum / count.max(1) as f64;
    let scale = |energy: f64| {
        if mean > 0.0 && !energy.is_nan() { 1.0 / (mean * (energy + REST * mean)).sqrt() } else { 0.0 }
    };
    energies.into_iter().map(scale).collect()
}

#[cfg(test)]
mod tests;
