//! Assign unassigned clusters of sensors to parts, by the joints.
//!
//! The ends of a cylinder alone feel its motion along its axis, and its side alone the rest. Nothing in these two motions says
//! that they are of one part. But both parts of a joint feel its speed, and each needs all of its own motion for it. So a
//! cluster is on the part whose joint speeds correlate better with those of its neighbours once it has the motion of the cluster.
//!
//! In: motions of parts, and of unassigned clusters, at the same samples. Out: the part of each cluster, where a joint tells it.

use nalgebra::DMatrix;
use rayon::prelude::*;

use super::cross_moments::{CrossMoments, Extended};
use super::information::of_correlation;
use super::tree::maximum_spanning_tree;
use crate::stages::parameters::Parameters;
use crate::stages::rigid_parts::MotionSubspace;

/// How many times more the tree must gain by an assignment than by a later move to another part.
const ASSIGNMENT_TO_MOVE: f64 = 5.0;
/// Most times that moves of all clusters are tried.
const MAX_SWEEPS: usize = 3;

/// The part of each unassigned cluster, by its place among `parts`; `None` where no joint gains by it. Also what the tree then says of joint
/// speeds, in nats; 0 if there is nothing to assign.
///
/// `pairs` are clusters that may be the two ends of one part, which gain most together. Greedily, the cluster or pair by which
/// the tree gains most information is assigned, as long as that is more than `min_assignment_gain`. Then each is tried on the other parts.
pub(super) fn assign(
    parts: &[MotionSubspace],
    unassigned: &[MotionSubspace],
    pairs: &[(usize, usize)],
    samples: usize,
    parameters: &Parameters,
) -> (Vec<Option<usize>>, f64) {
    let mut assigned = vec![None; unassigned.len()];
    if parts.len() < 2 || unassigned.is_empty() {
        return (assigned, 0.0);
    }
    let moments = CrossMoments::new(parts, unassigned, samples, parameters);
    let mut tree = Assignment::new(&moments);
    let ends =
        (0..unassigned.len()).map(|cluster| vec![cluster]).chain(pairs.iter().map(|&(a, b)| vec![a, b]));
    let trials = ends.flat_map(|clusters| (0..parts.len()).map(move |part| (clusters.clone(), part)));
    let trials: Vec<(Vec<usize>, usize)> = trials.collect();
    let mut trials: Vec<Trial> =
        trials.into_par_iter().map(|(clusters, part)| tree.trial(clusters, part)).collect();
    loop {
        let found: Vec<f64> = trials.par_iter().map(|trial| tree.information_with(trial)).collect();
        let Some((at, information)) = largest(found.into_iter()) else { break };
        if information <= tree.information + parameters.min_assignment_gain {
            break;
        }
        let best = trials.swap_remove(at);
        let part = best.part;
        best.clusters.iter().for_each(|&cluster| assigned[cluster] = Some(part));
        trials.retain(|trial| !trial.clusters.iter().any(|cluster| best.clusters.contains(cluster)));
        tree.accept(best);
        trials.par_iter_mut().for_each(|trial| {
            if trial.part == part {
                *trial = tree.trial(std::mem::take(&mut trial.clusters), part);
            } else {
                trial.correlations[part] = moments.correlation(&trial.extended, &tree.parts[part]);
            }
        });
    }
    for _ in 0..MAX_SWEEPS {
        let before = assigned.clone();
        for (cluster, part) in assigned.iter_mut().enumerate() {
            if let Some(part) = part {
                *part = tree.moved(cluster, *part);
            }
        }
        if assigned == before {
            break;
        }
    }
    (assigned, tree.information)
}

/// Information, in nats, that the tree over the other parts gains if one is merged with the part that gains most by it.
pub(super) fn gain(parts: &[MotionSubspace], at: usize, samples: usize, parameters: &Parameters) -> f64 {
    let others: Vec<MotionSubspace> =
        parts.iter().enumerate().filter(|(place, _)| *place != at).map(|(_, own)| own.clone()).collect();
    let moments = CrossMoments::new(&others, &parts[at..=at], samples, parameters);
    let tree = Assignment::new(&moments);
    let with = |part: usize| tree.information_with(&tree.trial(vec![0], part)) - tree.information;
    (0..others.len()).into_par_iter().map(with).reduce(|| f64::NEG_INFINITY, f64::max)
}

/// The first of the largest numbers, and its place.
fn largest(values: impl Iterator<Item = f64>) -> Option<(usize, f64)> {
    values.enumerate().reduce(|best, other| if other.1 > best.1 { other } else { best })
}

/// Clusters that are tried on a part.
struct Trial {
    clusters: Vec<usize>,
    part: usize,
    /// The part with them, and with those that it has.
    extended: Extended,
    /// Its correlation with each other part.
    correlations: Vec<f64>,
}

/// All parts with the clusters that are assigned to them.
struct Assignment<'a> {
    moments: &'a CrossMoments,
    parts: Vec<Extended>,
    correlations: DMatrix<f64>,
    /// That of the tree.
    information: f64,
}

impl<'a> Assignment<'a> {
    fn new(moments: &'a CrossMoments) -> Self {
        let count = moments.parts();
        let parts: Vec<Extended> = (0..count).map(|part| moments.extended(part, Vec::new())).collect();
        let mut correlations = DMatrix::identity(count, count);
        for (a, b) in (0..count).flat_map(|a| (a + 1..count).map(move |b| (a, b))) {
            correlations[(a, b)] = moments.correlation(&parts[a], &parts[b]);
            correlations[(b, a)] = correlations[(a, b)];
        }
        let mut own = Self { moments, parts, correlations, information: 0.0 };
        own.information = own.information_of(&own.correlations);
        own
    }

    fn trial(&self, clusters: Vec<usize>, part: usize) -> Trial {
        let extended =
            self.moments.extended(part, [self.parts[part].clusters.as_slice(), &clusters].concat());
        Trial { correlations: self.correlations_of(part, &extended, None), clusters, part, extended }
    }

    /// The correlations of a part with all others, if it were `extended` and, where it is given, another part as in `changed`.
    fn correlations_of(
        &self,
        part: usize,
        extended: &Extended,
        changed: Option<(usize, &Extended)>,
    ) -> Vec<f64> {
        let with = |other: usize| {
            let theirs = changed.filter(|(at, _)| *at == other).map_or(&self.parts[other], |(_, own)| own);
            if other == part { 1.0 } else { self.moments.correlation(extended, theirs) }
        };
        (0..self.parts.len()).map(with).collect()
    }

    /// What the edges of the maximum spanning tree over parts with these correlations say of joint speeds, in nats.
    fn information_of(&self, correlations: &DMatrix<f64>) -> f64 {
        let least = self.moments.parameters.min_unexplained;
        let edges = maximum_spanning_tree(correlations);
        edges.iter().map(|edge| of_correlation(correlations[(edge.child, edge.parent)], least)).sum()
    }

    /// The information of the tree with a trial.
    fn information_with(&self, trial: &Trial) -> f64 {
        self.information_of(&replaced(&self.correlations, trial.part, &trial.correlations))
    }

    fn accept(&mut self, trial: Trial) {
        self.correlations = replaced(&self.correlations, trial.part, &trial.correlations);
        self.information = self.information_of(&self.correlations);
        self.parts[trial.part] = trial.extended;
    }

    /// The part of an assigned cluster after it has been tried on all others.
    fn moved(&mut self, cluster: usize, from: usize) -> usize {
        let rest = self.parts[from].clusters.iter().copied().filter(|other| *other != cluster).collect();
        let without = self.moments.extended(from, rest);
        let base = replaced(&self.correlations, from, &self.correlations_of(from, &without, None));
        let moved = |part: usize| {
            let extended =
                self.moments.extended(part, [self.parts[part].clusters.as_slice(), &[cluster]].concat());
            let own = self.correlations_of(part, &extended, Some((from, &without)));
            (part, extended, replaced(&base, part, &own))
        };
        let others: Vec<usize> = (0..self.parts.len()).filter(|part| *part != from).collect();
        let mut found: Vec<(usize, Extended, DMatrix<f64>)> = others.into_par_iter().map(moved).collect();
        let least = self.moments.parameters.min_assignment_gain / ASSIGNMENT_TO_MOVE;
        let best = largest(found.iter().map(|(.., correlations)| self.information_of(correlations)));
        let Some((at, information)) = best.filter(|(_, sum)| *sum > self.information + least) else {
            return from;
        };
        let (part, extended, correlations) = found.swap_remove(at);
        (self.parts[from], self.parts[part]) = (without, extended);
        (self.correlations, self.information) = (correlations, information);
        part
    }
}

/// The correlations, with other ones of a part.
fn replaced(correlations: &DMatrix<f64>, part: usize, own: &[f64]) -> DMatrix<f64> {
    let mut changed = correlations.clone();
    for (other, &value) in own.iter().enumerate() {
        (changed[(part, other)], changed[(other, part)]) = (value, value);
    }
    changed
}

#[cfg(test)]
mod tests;
