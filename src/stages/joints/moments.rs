//! Sum the products of components and of quadratic monomials of all motions over blocks of samples: all that the tree and its
//! bootstrap need.

use nalgebra::DMatrix;
use rayon::prelude::*;

use super::correlation::{QuadraticForms, common};
use super::information::{Gaussian, mutual_information, of_joint};
use crate::numerics::interrupt;
use crate::stages::parameters::Parameters;
use crate::stages::rigid_parts::MotionSubspace;

/// Weight of a sample at which the whole body hardly moves, in units of its mean square.
const REST: f64 = 1e-3;

/// What the motions of all parts say of each other: sums of products over blocks of samples.
#[derive(Debug, Clone)]
pub(super) struct Moments {
    /// Of the components w_i of all motions.
    components: Products,
    /// Of their quadratic monomials w_i w_j.
    monomials: Products,
    /// Number of samples.
    samples: usize,
    /// The parameters of the search.
    parameters: Parameters,
}

/// How much each part has to do with each other one: parts × parts, symmetric.
pub(super) struct Dependence {
    /// [`Common::correlation`](super::correlation::Common) of the squared speeds of a joint, 0 to 1; 1 on the diagonal.
    pub correlations: DMatrix<f64>,
    /// [`information`](super::information) of a joint, nats; 0 on the diagonal.
    pub information: DMatrix<f64>,
}

impl Moments {
    /// Of the motions of all parts at the same T samples, in blocks of nearly equal length.
    ///
    /// The components of a sample are divided by the fourth root of the whole body's Σ |w|² there. So monomials are divided by its
    /// root, and fast movements count in proportion to speed, not to its square.
    pub(super) fn new(
        motions: &[MotionSubspace],
        samples: usize,
        blocks: usize,
        parameters: &Parameters,
    ) -> Self {
        let ranks: Vec<usize> = motions.iter().map(|motion| motion.rank).collect();
        let scales = scales(motions, samples);
        let blocks = if scales.iter().any(|scale| *scale > 0.0) { blocks } else { 0 };
        let components = |t: usize| motions.iter().flat_map(move |motion| motion.at(t).iter().copied());
        let monomials = |t: usize| {
            motions.iter().flat_map(move |motion| {
                let w = motion.at(t);
                (0..w.len()).flat_map(move |i| (i..w.len()).map(move |j| w[i] * w[j]))
            })
        };
        // A sample that counts nothing may have an unknown motion.
        let scaled = |scale: f64| move |value: f64| if scale > 0.0 { scale * value } else { 0.0 };
        let lengths = ranks.iter().map(|k| k * (k + 1) / 2);
        Self {
            monomials: Products::new(lengths, samples, blocks, |t| monomials(t).map(scaled(scales[t]))),
            components: Products::new(ranks.iter().copied(), samples, blocks, |t| {
                components(t).map(scaled(scales[t].sqrt()))
            }),
            samples,
            parameters: *parameters,
        }
    }

    /// Number of blocks; none if nothing moves.
    pub(super) fn blocks(&self) -> usize {
        self.monomials.blocks.len()
    }

    /// What the motions say over all samples.
    pub(super) fn dependence(&self) -> Dependence {
        self.resampled(&vec![1; self.blocks()])
    }

    /// The same over a bootstrap resample that has each block so many times.
    pub(super) fn resampled(&self, counts: &[usize]) -> Dependence {
        interrupt::check();
        let (linear, quadratic) = (self.components.sum(counts), self.monomials.sum(counts));
        let parts = self.components.starts.len() - 1;
        let own = |part: usize| {
            let pairs = monomials(self.components.length(part));
            let forms = self.monomials.of(&quadratic, part, part);
            let forms = QuadraticForms::new(pairs, forms, self.parameters.monomial_ridge);
            (forms, Gaussian::new(self.components.of(&linear, part, part), self.parameters.component_ridge))
        };
        let own: Vec<_> = (0..parts).map(own).collect();
        let (mut correlations, mut information) =
            (DMatrix::identity(parts, parts), DMatrix::zeros(parts, parts));
        for (a, b) in (0..parts).flat_map(|a| (a + 1..parts).map(move |b| (a, b))) {
            let found = common(&own[a].0, &own[b].0, &self.monomials.of(&quadratic, a, b));
            let shared = mutual_information(&own[a].1, &own[b].1, &self.components.of(&linear, a, b));
            for at in [(a, b), (b, a)] {
                correlations[at] = found.correlation;
                information[at] = of_joint(&found, shared, self.samples, &self.parameters);
            }
        }
        Dependence { correlations, information }
    }
}

/// Sums over samples of the products of all features of all parts, by blocks of samples.
#[derive(Debug, Clone)]
struct Products {
    /// Where the features of each part begin, and where the last end.
    starts: Vec<usize>,
    /// For each block, features × features.
    blocks: Vec<DMatrix<f64>>,
}

impl Products {
    /// Of so many features of each part. `features` are those of all parts at a sample.
    fn new<F: Iterator<Item = f64>>(
        lengths: impl Iterator<Item = usize>,
        samples: usize,
        blocks: usize,
        features: impl Fn(usize) -> F + Sync,
    ) -> Self {
        let mut starts = vec![0];
        lengths.for_each(|length| starts.push(starts[starts.len() - 1] + length));
        let all = starts[starts.len() - 1];
        let block = |at: usize| {
            let samples = at * samples / blocks..(at + 1) * samples / blocks;
            let values = DMatrix::from_iterator(all, samples.len(), samples.flat_map(&features));
            &values * values.transpose()
        };
        Self { starts, blocks: (0..blocks).into_par_iter().map(block).collect() }
    }

    /// Number of features of a part.
    fn length(&self, part: usize) -> usize {
        self.starts[part + 1] - self.starts[part]
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

    /// Of such a sum, the products of the features of two parts.
    fn of(&self, sum: &DMatrix<f64>, a: usize, b: usize) -> DMatrix<f64> {
        sum.view((self.starts[a], self.starts[b]), (self.length(a), self.length(b))).into_owned()
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
