//! Improve a body map step by step, by majorisation (SMACOF), until its stress hardly changes.
//!
//! De Leeuw (1977), "Applications of convex analysis to multidimensional scaling"; Borg & Groenen, Modern
//! Multidimensional Scaling (2nd edition, 2005), chapters 8 and 9. Metric scaling fits the distances within the map
//! to those given; nonmetric scaling (Kruskal 1964) to disparities, which only have the order of those given.
//! Raw stress, the sum over pairs of (disparity − distance within the map)², never rises from step to step. A map of d
//! dimensions is not the first d columns of a larger one, nor are its columns principal axes.
//!
//! Nothing is drawn: the map that is improved decides the result. Each row is summed in a fixed order, so that the
//! number of threads does not change a bit.

use std::array::from_fn;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::coordinates::BodyMap;
use super::guttman::Guttman;
use super::monotone::Monotone;
use crate::numerics::interrupt;
use crate::numerics::simd::vectorised;
use crate::stages::distance::Distances;

/// The iteration ends when a step lowers raw stress by less than this share: as many steps again as are allowed would
/// then lower it by some 0.03 % more.
const TOLERANCE: f64 = 1e-6;
/// Maximum number of steps. Maps of 840 sensors reach it: the first 300 steps in 14 dimensions lower raw stress to 7 %,
/// and 300 more would lower that by another 1 %.
const MAX_STEPS: usize = 300;

/// Coordinates that are summed at once.
const LANES: usize = 8;

/// What the distances within a map are fitted to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fit {
    /// The distances themselves.
    Metric,
    /// Numbers that rise as the distances do.
    Nonmetric,
}

/// How well a map fits, before and after.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Improvement {
    /// d of the map.
    pub dimension: usize,
    /// Stress-1 of the map that was improved, see [`Majorisation::stress`].
    pub start: f64,
    /// Stress-1 of the result.
    pub stress: f64,
    /// Steps taken.
    pub steps: usize,
}

/// Improves the map `start` (n × d) until its stress hardly changes; returns the new map and its stress. The points of
/// `start` must not all coincide.
pub fn smacof(distances: &Distances, start: BodyMap, fit: Fit) -> (BodyMap, Improvement) {
    let begin = Majorisation::new(distances, start, fit);
    let (dimension, start) = (begin.map.dims, begin.stress());
    let (end, steps) = match fit {
        Fit::Metric => metric(begin),
        Fit::Nonmetric => nonmetric(begin),
    };
    let stress = end.stress();
    (end.map, Improvement { dimension, start, stress, steps })
}

/// Whether a step is the last.
fn is_last(before: f64, after: f64) -> bool {
    before - after <= TOLERANCE * before
}

/// Steps that compute each pair of points once; what they lower, the next one says.
fn metric(begin: Majorisation) -> (Majorisation, usize) {
    let mut state = Guttman::new(begin.distances, &begin.map);
    let (mut before, mut steps) = (state.step(), 1);
    let mut map = state.map();
    while steps < MAX_STEPS {
        let after = state.step();
        if is_last(before, after) {
            break;
        }
        (before, map) = (after, state.map());
        steps += 1;
    }
    (Majorisation::new(begin.distances, map, Fit::Metric), steps)
}

fn nonmetric(mut state: Majorisation) -> (Majorisation, usize) {
    let mut steps = 0;
    while steps < MAX_STEPS {
        let before = state.raw_stress();
        state.step();
        steps += 1;
        if is_last(before, state.raw_stress()) {
            break;
        }
    }
    (state, steps)
}

/// A map on its way to less stress.
#[derive(Debug)]
pub struct Majorisation<'a> {
    distances: &'a Distances,
    map: BodyMap,
    /// n × n: Euclidean distances within the map.
    within: Vec<f64>,
    /// What they are fitted to, if it is not the distances.
    monotone: Option<Monotone>,
}

impl<'a> Majorisation<'a> {
    /// Prepares the first step from `map`. The distances must be finite and symmetric, and of as many points as the map.
    pub fn new(distances: &'a Distances, map: BodyMap, fit: Fit) -> Self {
        let within = euclidean(&map);
        let squares = || sum_over_pairs(&within, &within, map.points(), |a, b| a * b);
        let monotone = (fit == Fit::Nonmetric).then(|| Monotone::new(distances, &within, squares()));
        Self { distances, map, within, monotone }
    }

    /// The Guttman transform, x_i ← Σ_j (d̂_ij / d_ij)(x_i − x_j) / n, and then the disparities of the new map. Metric scaling has one of
    /// its own, in `guttman.rs`; tests hold both equal.
    ///
    /// Points that coincide do not move each other, as Borg & Groenen (2005, chapter 8) have it.
    pub fn step(&mut self) {
        interrupt::check();
        let (n, dims) = (self.map.points(), self.map.dims);
        let (old, disparities) = (Blocks::new(&self.map), self.disparities());
        let mut new = vec![0.0; n * dims];
        new.par_chunks_exact_mut(dims).enumerate().for_each_init(
            || vec![0.0; n],
            |weights, (i, moved)| {
                let pairs = disparities[i * n..][..n].iter().zip(&self.within[i * n..][..n]);
                vectorised(
                    #[inline(always)]
                    || {
                        for (weight, (disparity, within)) in weights.iter_mut().zip(pairs.clone()) {
                            *weight = if *within > 0.0 { disparity / within } else { 0.0 };
                        }
                    },
                );
                for (moved, points) in moved.chunks_mut(LANES).zip(old.0.chunks_exact(n)) {
                    let mut sums = [0.0; LANES];
                    vectorised(
                        #[inline(always)]
                        || pull(&mut sums, points[i], weights, points),
                    );
                    moved.iter_mut().zip(sums).for_each(|(moved, sum)| *moved = sum / n as f64);
                }
            },
        );
        self.map.coordinates = new;
        // In place: pages given back and taken anew would take longer than the distances.
        euclidean_into(&mut self.within, &self.map);
        if let Some(monotone) = &mut self.monotone {
            monotone.fit(&self.within);
        }
    }

    /// The map, in the unit of the distances; its mean is the origin from the first step on.
    pub fn map(&self) -> &BodyMap {
        &self.map
    }

    /// n × n, what the distances within the map are fitted to: the distances, or disparities, whose sum of
    /// squares is that of the distances within the map of the beginning.
    fn disparities(&self) -> &[f64] {
        self.monotone.as_ref().map_or(&self.distances.values, |monotone| &monotone.disparities)
    }

    /// Sum over pairs of (disparity − distance within the map)², which no step makes larger but for rounding.
    pub fn raw_stress(&self) -> f64 {
        let squared = |disparity: f64, within: f64| (disparity - within).powi(2);
        sum_over_pairs(self.disparities(), &self.within, self.map.points(), squared)
    }

    /// Stress-1 (Kruskal 1964): √(Σ (d̂ − d)² / Σ d²) over the distances d within the map. d̂ is what is nearest to d
    /// of all multiples of the given distances or, in nonmetric scaling, of all numbers in their order. So it lies
    /// between 0 and 1, does not depend on the scale of the map, and no step makes it larger either.
    pub fn stress(&self) -> f64 {
        let (given, within, n) = (&self.distances.values, &self.within, self.map.points());
        let product = |a: f64, b: f64| a * b;
        let residual = match &self.monotone {
            Some(monotone) => monotone.residual,
            None => {
                let squares = sum_over_pairs(given, given, n, product);
                let multiple =
                    if squares > 0.0 { sum_over_pairs(given, within, n, product) / squares } else { 0.0 };
                sum_over_pairs(given, within, n, |given, within| (multiple * given - within).powi(2))
            }
        };
        let squares = sum_over_pairs(within, within, n, product);
        if squares > 0.0 { (residual / squares).sqrt() } else { 0.0 }
    }
}

/// The coordinates of all points, [`LANES`] of each at a time, with 0 beyond the last one.
struct Blocks(Vec<[f64; LANES]>);

impl Blocks {
    fn new(map: &BodyMap) -> Self {
        let block = |first: usize, point: &[f64]| {
            let own = &point[first..point.len().min(first + LANES)];
            from_fn(|lane| own.get(lane).copied().unwrap_or(0.0))
        };
        let firsts = (0..map.dims).step_by(LANES);
        Self(
            firsts
                .flat_map(|first| {
                    map.coordinates.chunks_exact(map.dims).map(move |point| block(first, point))
                })
                .collect(),
        )
    }
}

/// Adds Σ_j weight_j (x − x_j).
#[inline(always)]
fn pull(sums: &mut [f64; LANES], own: [f64; LANES], weights: &[f64], points: &[[f64; LANES]]) {
    // A copy, which the compiler knows not to overlap with anything.
    let mut kept = *sums;
    for (weight, point) in weights.iter().zip(points) {
        for lane in 0..LANES {
            kept[lane] += weight * (own[lane] - point[lane]);
        }
    }
    *sums = kept;
}

/// n × n: Euclidean distances within a map; exactly symmetric.
pub(super) fn euclidean(map: &BodyMap) -> Vec<f64> {
    let mut within = vec![0.0; map.points().pow(2)];
    euclidean_into(&mut within, map);
    within
}

/// Puts the distances within a map in place of these.
fn euclidean_into(within: &mut [f64], map: &BodyMap) {
    let (n, dims) = (map.points(), map.dims);
    // By columns, so that the inner loop goes over points and becomes vector instructions.
    let columns: Vec<f64> =
        (0..dims).flat_map(|k| map.coordinates.iter().skip(k).step_by(dims).copied()).collect();
    within.par_chunks_exact_mut(n).enumerate().for_each(|(i, row)| {
        vectorised(
            #[inline(always)]
            || {
                row.fill(0.0);
                for column in columns.chunks_exact(n) {
                    let own = column[i];
                    row.iter_mut().zip(column).for_each(|(sum, x)| *sum += (own - x) * (own - x));
                }
                row.iter_mut().for_each(|square| *square = square.sqrt());
            },
        );
    });
}

/// Sum over pairs i < j of a term of the entries of two symmetric n × n matrices, which is 0 on their diagonals.
fn sum_over_pairs(first: &[f64], second: &[f64], n: usize, term: impl Fn(f64, f64) -> f64 + Sync) -> f64 {
    let rows = first.par_chunks_exact(n).zip(second.par_chunks_exact(n));
    let sums = rows.map(|(first, second)| first.iter().zip(second).map(|(a, b)| term(*a, *b)).sum::<f64>());
    sums.collect::<Vec<_>>().iter().sum::<f64>() / 2.0
}

#[cfg(test)]
mod tests;
