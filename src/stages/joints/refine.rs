//! Refine estimated parts by their joints, and find the tree over them: unassigned clusters get a part, and spurious parts go.

use std::cmp::Reverse;
use std::collections::BTreeMap;

use rand::Rng;
use rayon::prelude::*;

use super::assign::{assign, gain};
use super::tree::{Joints, tree_of_motions};
use crate::numerics::partition::{named_by_appearance, sizes};
use crate::stages::rigid_parts::{
    MotionSubspace, RigidParts, Roots, opposite_pairs, similar, stratified, typical_size,
};
use crate::stages::sense::Tactile;
use crate::stages::tree::Edge;

/// Samples that similarity is computed from, spread over all.
const MAX_SAMPLES: usize = 2000;
/// Information, in nats, that the tree must gain by merging a small part with another, so that the part is spurious.
const SPURIOUS: f64 = 0.5;
/// Rank from which on a part is no piece of another: a cylinder feels its motion but its spin.
const WHOLE_RANK: usize = 5;
/// Unassigned clusters that are tried on parts, the largest: memory grows with the square of their number.
const MAX_CLUSTERS: usize = 40;

/// Sensors by their label.
type Members = BTreeMap<usize, Vec<usize>>;

/// The parts with each unassigned cluster assigned, and how they are joined.
///
/// A cluster is assigned to the part that the joints tell; if none does, each of its sensors to the part with the smallest
/// residual. In: M × T pressures, of any sign, whether negative ones are signal (`signed`), and the parts and unassigned clusters of
/// their sensors. Out: parts without unassigned clusters, named by appearance, and their tree.
pub(crate) fn refine(
    tactile: &Tactile,
    signed: bool,
    parts: RigidParts,
    rng: &mut impl Rng,
) -> (RigidParts, Joints) {
    let (refined, names, motions) = refined(tactile, signed, parts);
    let joints = Joints::of_motions(&names, &motions, tactile.samples, rng);
    (refined, joints)
}

/// The part of each sensor and the tree of [`refine`], without the support of its edges.
pub(crate) fn refine_tree(tactile: &Tactile, signed: bool, parts: RigidParts) -> (Vec<usize>, Vec<Edge>) {
    let (refined, names, motions) = refined(tactile, signed, parts);
    (refined.labels, tree_of_motions(&names, &motions, tactile.samples))
}

/// The parts with each unassigned cluster assigned, and the label of each, rising, with its motion.
fn refined(
    tactile: &Tactile,
    signed: bool,
    mut parts: RigidParts,
) -> (RigidParts, Vec<usize>, Vec<MotionSubspace>) {
    let mut refinement = Refinement::new(tactile, signed);
    let (mut refined, names, motions) = loop {
        let mut refined = parts.clone();
        let (names, motions) = refinement.assigned(&mut refined);
        let Some(spurious) = refinement.spurious(&parts, &names, &motions) else {
            break (refined, names, motions);
        };
        refinement.dissolve(&mut parts, spurious);
    };
    // Unassigned clusters leave gaps in the labels.
    let labels = named_by_appearance(&refined.labels);
    let new: BTreeMap<usize, usize> = refined.labels.iter().copied().zip(labels.iter().copied()).collect();
    let named = |(name, own): (usize, MotionSubspace)| Some((*new.get(&name)?, own));
    let nodes: BTreeMap<usize, MotionSubspace> = names.into_iter().zip(motions).filter_map(named).collect();
    for others in &mut refined.alternatives {
        *others = others.iter().filter_map(|(part, residual)| Some((*new.get(part)?, *residual))).collect();
    }
    (refined.labels, refined.unassigned) = (labels, Vec::new());
    // They are of the labels before.
    refined.motions.clear();
    let (names, motions) = nodes.into_iter().unzip();
    (refined, names, motions)
}

/// The largest clusters, and the sensors of the others.
fn largest(clusters: Members) -> (Members, Vec<Vec<usize>>) {
    let mut order: Vec<(usize, Vec<usize>)> = clusters.into_iter().collect();
    order.sort_by_key(|(_, sensors)| Reverse(sensors.len()));
    let rest = order.split_off(order.len().min(MAX_CLUSTERS));
    (order.into_iter().collect(), rest.into_iter().map(|(_, sensors)| sensors).collect())
}

/// Assigns each sensor to the part with the smallest residual, or to this part if there is no other.
fn assign_by_residual(parts: &mut RigidParts, sensors: &[usize], part: usize) {
    for &sensor in sensors {
        let residual = parts.residuals[sensor];
        let others = &mut parts.alternatives[sensor];
        let best = if others.is_empty() { (part, residual) } else { others.remove(0) };
        (parts.labels[sensor], parts.residuals[sensor]) = best;
    }
}

/// Assigns sensors to a part.
fn assign_to(parts: &mut RigidParts, sensors: &[usize], part: usize) {
    for &sensor in sensors {
        parts.labels[sensor] = part;
        parts.alternatives[sensor].retain(|(other, _)| *other != part);
    }
}

/// What all sensors feel, and the motions that were learned from it.
struct Refinement<'a> {
    series: Vec<&'a [f32]>,
    signed: bool,
    roots: Roots,
    /// Motions by their sensors: most stay the same from one iteration to the next.
    known: BTreeMap<Vec<usize>, MotionSubspace>,
}

impl<'a> Refinement<'a> {
    fn new(tactile: &'a Tactile, signed: bool) -> Self {
        let series: Vec<&[f32]> = tactile.series().collect();
        let samples: Vec<usize> = stratified(tactile.samples, MAX_SAMPLES).collect();
        Self { roots: Roots::at(&series, &samples, signed), signed, series, known: BTreeMap::new() }
    }

    /// T.
    fn samples(&self) -> usize {
        self.series.first().map_or(0, |series| series.len())
    }

    fn motions(&mut self, clusters: &[&Vec<usize>]) -> Vec<MotionSubspace> {
        let found = |sensors: &Vec<usize>| {
            let series: Vec<&[f32]> = sensors.iter().map(|&sensor| self.series[sensor]).collect();
            (sensors.clone(), MotionSubspace::of_cluster(&series, self.signed))
        };
        let new = clusters.par_iter().filter(|sensors| !self.known.contains_key(**sensors));
        let new: Vec<(Vec<usize>, MotionSubspace)> = new.map(|sensors| found(sensors)).collect();
        self.known.extend(new);
        clusters.iter().map(|sensors| self.known[*sensors].clone()).collect()
    }

    /// Assigns the unassigned clusters. Out: the labels of the parts, and their motions with those of their clusters.
    fn assigned(&mut self, parts: &mut RigidParts) -> (Vec<usize>, Vec<MotionSubspace>) {
        let (known, clusters) = parts_and_unassigned(parts);
        let (clusters, rest) = largest(clusters);
        let learned: Vec<&Vec<usize>> =
            known.iter().filter(|(part, _)| !parts.motions.contains_key(part)).map(|(_, own)| own).collect();
        let mut learned = self.motions(&learned).into_iter();
        let mut motions: Vec<MotionSubspace> = known
            .keys()
            .map(|part| parts.motions.get(part).cloned().or_else(|| learned.next()).expect("learned"))
            .collect();
        let mut names: Vec<usize> = known.into_keys().collect();
        let of_clusters = self.motions(&clusters.values().collect::<Vec<_>>());
        let members: Vec<&[usize]> = clusters.values().map(Vec::as_slice).collect();
        let pairs = opposite_pairs(&self.roots, &members);
        let found = assign(&motions, &of_clusters, &pairs, self.samples());
        if names.is_empty() {
            names.extend(clusters.keys());
            motions.extend(of_clusters);
        } else {
            for (sensors, (part, own)) in clusters.values().zip(found.into_iter().zip(of_clusters)) {
                let Some(part) = part else {
                    assign_by_residual(parts, sensors, names[0]);
                    continue;
                };
                motions[part] = motions[part].with(&own);
                assign_to(parts, sensors, names[part]);
            }
        }
        rest.iter().for_each(|sensors| assign_by_residual(parts, sensors, names[0]));
        (names, motions)
    }

    /// Of the small parts of low rank, the one by whose merging the tree gains most information, if that is much.
    fn spurious(&self, parts: &RigidParts, names: &[usize], motions: &[MotionSubspace]) -> Option<usize> {
        let sizes = sizes(&parts.labels);
        let own: Vec<usize> = names.iter().map(|name| sizes[name]).collect();
        let small = typical_size(own.clone()).div_ceil(2);
        let can_be = |at: &usize| {
            own[*at] < small && motions[*at].rank < WHOLE_RANK && !parts.unassigned.contains(&names[*at])
        };
        let places = if names.len() > 2 { 0..names.len() } else { 0..0 };
        let gains = places.filter(can_be).map(|at| (gain(motions, at, self.samples()), at));
        let most = gains.reduce(|most, other| if other.0 > most.0 { other } else { most });
        most.filter(|(gain, _)| *gain > SPURIOUS).map(|(_, at)| names[at])
    }

    /// Makes a part unassigned clusters of sensors that feel the same.
    fn dissolve(&self, parts: &mut RigidParts, part: usize) {
        parts.motions.remove(&part);
        let own: Vec<usize> = (0..parts.labels.len()).filter(|at| parts.labels[*at] == part).collect();
        own.iter().for_each(|&sensor| parts.residuals[sensor] = 0.0);
        for cluster in similar(&self.roots, &own) {
            let name = parts.labels.iter().chain(&parts.unassigned).max().map_or(0, |last| last + 1);
            assign_to(parts, &cluster, name);
            parts.unassigned.push(name);
        }
        for others in &mut parts.alternatives {
            others.retain(|(other, _)| *other != part);
        }
    }
}

/// The sensors of parts, and those of unassigned clusters.
fn parts_and_unassigned(parts: &RigidParts) -> (Members, Members) {
    let (mut known, mut unassigned) = (Members::new(), Members::new());
    for (sensor, label) in parts.labels.iter().enumerate() {
        let members = if parts.unassigned.contains(label) { &mut unassigned } else { &mut known };
        members.entry(*label).or_default().push(sensor);
    }
    (known, unassigned)
}

#[cfg(test)]
mod tests;
