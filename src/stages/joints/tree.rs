//! Estimate the tree over parts, the tree of most information between them (Chow and Liu 1968), and the bootstrap support of its edges
//! (Felsenstein 1985).

use std::collections::BTreeMap;

use nalgebra::DMatrix;
use rand::{Rng, RngExt};
use rayon::prelude::*;

use super::moments::{Dependence, Moments};
use crate::numerics::partition::Connected;
use crate::stages::parameters::Parameters;
use crate::stages::rigid_parts::{MAX_RANK, MotionSubspace, motions_of_parts};
use crate::stages::sense::Tactile;
use crate::stages::tree::{Edge, prim};

/// Most blocks of samples that are drawn with replacement.
const BLOCKS: usize = 50;
/// Fewest samples of a block: longer than speeds are correlated in time. Only recordings of fewer than 200 samples have shorter blocks.
const BLOCK_SAMPLES: usize = 100;
/// Number of trees over resampled blocks.
const RESAMPLES: usize = 400;

/// A pair of parts.
#[derive(Debug, Clone, PartialEq)]
pub struct Pair {
    /// Label of one part.
    pub part: usize,
    /// Label of the other, which is larger.
    pub other: usize,
    /// Cosine over samples between a squared speed that one part feels and one that the other feels, the largest that was found, 0 to 1: high
    /// if they share a joint. A lower bound: iterations may miss the largest.
    pub correlation: f64,
    /// Information of a joint between them, in nats: that of its speeds, and all else that their motions share, linear and quadratic, with
    /// a weight that grows with the number of samples. The tree has the most (Chow and Liu 1968).
    pub information: f64,
    /// Bootstrap support, given the parts: share of resampled trees that join the two, 0 to 1.
    pub support: f64,
    /// Whether the tree joins them.
    pub in_tree: bool,
}

/// Two parts that resampled trees join in the place of a joint: they connect the same parts of the body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rival {
    /// Label of one part.
    pub part: usize,
    /// Label of the other, which is larger.
    pub other: usize,
    /// Share of resampled trees that lack the joint and join these two instead, 0 to 1.
    pub support: f64,
}

/// How the parts of a body are joined.
#[derive(Debug, Clone, PartialEq)]
pub struct Joints {
    /// The rank of the motion subspace of each part, by the label of the part: six at most, and 0 for a part that feels nothing.
    pub ranks: BTreeMap<usize, usize>,
    /// The tree between labels of parts: one edge fewer than parts. Which part is the root says nothing.
    pub tree: Vec<Edge>,
    /// For each edge of the tree, what resampled trees have most often in its place, if any lacks it.
    pub rivals: Vec<Option<Rival>>,
    /// All pairs of parts, by their labels.
    pub pairs: Vec<Pair>,
}

impl Joints {
    /// The bootstrap support of an edge of the tree, 0 to 1, given the parts; [`Repeats`](crate::estimate::Repeats) also repeat the search
    /// for parts. It is 0 for parts that are not there.
    pub fn support(&self, edge: &Edge) -> f64 {
        let (a, b) = (edge.child.min(edge.parent), edge.child.max(edge.parent));
        let pair = self.pairs.iter().find(|pair| (pair.part, pair.other) == (a, b));
        pair.map_or(0.0, |pair| pair.support)
    }

    /// The tree over parts with these labels, rising, from their motions at the same samples.
    pub(super) fn of_motions(
        labels: &[usize],
        motions: &[MotionSubspace],
        samples: usize,
        parameters: &Parameters,
        rng: &mut impl Rng,
    ) -> Self {
        let moments = Moments::new(motions, samples, blocks(samples), parameters);
        let Dependence { correlations, information } = moments.dependence();
        let tree = maximum_spanning_tree(&information);
        let mut times_joined = DMatrix::<usize>::zeros(labels.len(), labels.len());
        let resampled = resampled_trees(&moments, rng);
        for edge in resampled.iter().flatten() {
            times_joined[(edge.child.min(edge.parent), edge.child.max(edge.parent))] += 1;
        }
        let pairs = (0..labels.len()).flat_map(|a| (a + 1..labels.len()).map(move |b| (a, b)));
        let is_edge = |a: usize, b: usize| {
            tree.iter().any(|edge| [(a, b), (b, a)].contains(&(edge.child, edge.parent)))
        };
        // Edges without information tie: only the order of the parts chooses among them. So their support is 0.
        let support = |a: usize, b: usize| {
            if information[(a, b)] > 0.0 { times_joined[(a, b)] as f64 / RESAMPLES as f64 } else { 0.0 }
        };
        let pair = |(a, b): (usize, usize)| Pair {
            part: labels[a],
            other: labels[b],
            correlation: correlations[(a, b)],
            information: information[(a, b)],
            support: support(a, b),
            in_tree: is_edge(a, b),
        };
        let rival = |at: usize| {
            let (a, b, times) = most_often_instead(&tree, at, &resampled)?;
            Some(Rival { part: labels[a], other: labels[b], support: times as f64 / RESAMPLES as f64 })
        };
        Self {
            rivals: (0..tree.len()).map(rival).collect(),
            pairs: pairs.map(pair).collect(),
            tree: labelled(&tree, labels),
            ranks: labels.iter().zip(motions).map(|(&part, motion)| (part, motion.rank)).collect(),
        }
    }
}

/// Estimates how given parts are joined, from the pressures on their sensors.
///
/// In: M × T pressures of any sign, NaN where one is missing; whether negative ones are signal (`signed`), not noise about 0; and for
/// each of the M sensors the label of its part, any number, or `None` for a sensor to be left out. `rank`, 1 to 6, is the rank of the
/// motion subspace of each part, at most one less than it has sensors; without it, the data choose one for each. Also the `parameters`. Out: the tree, and for each pair of parts their correlation and the bootstrap support of an edge between them. The same
/// input and state of `rng` give the same bytes, whatever the number of threads.
///
/// # Panics
/// If there is not one label for each sensor, `rank` is not 1 to 6, or T is 0.
pub fn joints(
    tactile: &Tactile,
    signed: bool,
    labels: &[Option<usize>],
    rank: Option<usize>,
    parameters: &Parameters,
    rng: &mut impl Rng,
) -> Joints {
    let (parts, motions) = parts_and_motions(tactile, signed, labels, rank, parameters);
    Joints::of_motions(&parts, &motions, tactile.samples, parameters, rng)
}

/// The tree of [`joints`] without its support: of a short recording, the bootstrap takes most of the time.
pub(crate) fn joint_tree(tactile: &Tactile, signed: bool, labels: &[Option<usize>]) -> Vec<Edge> {
    let parameters = &Parameters::default();
    let (parts, motions) = parts_and_motions(tactile, signed, labels, None, parameters);
    tree_of_motions(&parts, &motions, tactile.samples, parameters)
}

/// The tree over parts with these labels, rising, from their motions at the same samples, without its support.
pub(super) fn tree_of_motions(
    labels: &[usize],
    motions: &[MotionSubspace],
    samples: usize,
    parameters: &Parameters,
) -> Vec<Edge> {
    let moments = Moments::new(motions, samples, blocks(samples), parameters);
    labelled(&maximum_spanning_tree(&moments.dependence().information), labels)
}

/// The labels of the parts, rising, and the motion of each.
fn parts_and_motions(
    tactile: &Tactile,
    signed: bool,
    labels: &[Option<usize>],
    rank: Option<usize>,
    parameters: &Parameters,
) -> (Vec<usize>, Vec<MotionSubspace>) {
    assert_eq!(labels.len(), tactile.sensors(), "a part for each sensor");
    assert!(rank.is_none_or(|rank| (1..=MAX_RANK).contains(&rank)), "a rank from 1 to {MAX_RANK}");
    motions_of_parts(tactile, signed, labels, rank, parameters).into_iter().unzip()
}

/// Number of blocks that so many samples are cut into, to be drawn with replacement.
pub(crate) fn blocks(samples: usize) -> usize {
    (samples / BLOCK_SAMPLES).clamp(2, BLOCKS)
}

/// A tree over places in a list, over the labels there.
fn labelled(tree: &[Edge], labels: &[usize]) -> Vec<Edge> {
    tree.iter().map(|edge| Edge { child: labels[edge.child], parent: labels[edge.parent] }).collect()
}

/// The pair that most of the other trees have in the place of an edge, and how many: of those that lack it, the pair that joins the two sides
/// of the tree without it. The first of those that are as frequent.
fn most_often_instead(tree: &[Edge], at: usize, others: &[Vec<Edge>]) -> Option<(usize, usize, usize)> {
    let ends = |edge: &Edge| (edge.child.min(edge.parent), edge.child.max(edge.parent));
    let own = ends(&tree[at]);
    let mut connected = Connected::new(tree.len() + 1);
    tree.iter().filter(|edge| ends(edge) != own).for_each(|edge| {
        connected.connect(edge.child, edge.parent);
    });
    let side: Vec<usize> = (0..=tree.len()).map(|node| connected.representative(node)).collect();
    let mut times: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    for other in others.iter().filter(|other| other.iter().all(|edge| ends(edge) != own)) {
        let crosses = |edge: &&Edge| side[edge.child] != side[edge.parent];
        other.iter().filter(crosses).for_each(|edge| *times.entry(ends(edge)).or_default() += 1);
    }
    times.into_iter().rev().max_by_key(|(_, times)| *times).map(|((a, b), times)| (a, b, times))
}

/// The tree of greatest total weight.
pub(super) fn maximum_spanning_tree(weights: &DMatrix<f64>) -> Vec<Edge> {
    let nodes: Vec<usize> = (0..weights.nrows()).collect();
    prim(&nodes, |child, parent| -weights[(child, parent)])
}

/// Trees over blocks of samples drawn with replacement.
fn resampled_trees(moments: &Moments, rng: &mut impl Rng) -> Vec<Vec<Edge>> {
    let blocks = moments.blocks();
    let mut draw = || {
        let mut counts = vec![0; blocks];
        (0..blocks).for_each(|_| counts[rng.random_range(0..blocks)] += 1);
        counts
    };
    let counts: Vec<Vec<usize>> = (0..RESAMPLES).map(|_| draw()).collect();
    counts.par_iter().map(|counts| maximum_spanning_tree(&moments.resampled(counts).information)).collect()
}

#[cfg(test)]
mod tests;
