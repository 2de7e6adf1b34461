//! Refine estimated parts by their joints, and find the tree over them: unassigned clusters get a part, and spurious parts go.
//!
//! The large faces of a thin plate feel its velocity across and two rotations, its edges the rest. They have nothing in common, so that the
//! search takes them for two parts. The joints tell that they are one.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};

use rand::Rng;
use rayon::prelude::*;

use super::assign::{assign, gain};
use super::tree::{Joints, tree_of_motions};
use crate::numerics::partition::{named_by_appearance, sizes};
use crate::stages::parameters::Parameters;
use crate::stages::rigid_parts::{
    MAX_RANK, MotionSubspace, RigidParts, Roots, opposite_pairs, similar, stratified, typical_size,
};
use crate::stages::sense::Tactile;
use crate::stages::tree::Edge;

/// Samples that similarity is computed from, spread over all.
const MAX_SAMPLES: usize = 2000;
/// Rank from which on a part is no piece of another: a cylinder feels its motion but its spin.
const WHOLE_RANK: usize = MAX_RANK - 1;
/// Unassigned clusters that are tried on parts, the largest: memory grows with the square of their number.
const MAX_CLUSTERS: usize = 40;

/// Sensors by their label.
type Members = BTreeMap<usize, Vec<usize>>;

/// The parts with each unassigned cluster assigned, and how they are joined.
///
/// A cluster is assigned to the part that the joints tell; if none does, each of its sensors to the part with the smallest
/// residual. In: M × T pressures, of any sign, whether negative ones are signal (`signed`), the parts and unassigned clusters of
/// their sensors, and the `parameters`. Out: parts without unassigned clusters, named by appearance, and their tree.
pub(crate) fn refine(
    tactile: &Tactile,
    signed: bool,
    parts: RigidParts,
    parameters: &Parameters,
    rng: &mut impl Rng,
) -> (RigidParts, Joints) {
    let (refined, names, motions) = refined(tactile, signed, parts, parameters);
    let joints = Joints::of_motions(&names, &motions, tactile.samples, parameters, rng);
    (refined, joints)
}

/// The part of each sensor and the tree of [`refine`], without the support of its edges.
pub(crate) fn refine_tree(
    tactile: &Tactile,
    signed: bool,
    parts: RigidParts,
    parameters: &Parameters,
) -> (Vec<usize>, Vec<Edge>) {
    let (refined, names, motions) = refined(tactile, signed, parts, parameters);
    (refined.labels, tree_of_motions(&names, &motions, tactile.samples, parameters))
}

/// The parts with each unassigned cluster assigned, and the label of each, rising, with its motion.
fn refined(
    tactile: &Tactile,
    signed: bool,
    mut parts: RigidParts,
    parameters: &Parameters,
) -> (RigidParts, Vec<usize>, Vec<MotionSubspace>) {
    let mut refinement = Refinement::new(tactile, signed, parameters);
    let mut assigned = refinement.assigned(&parts);
    while let Some(spurious) = refinement.spurious(&parts, &assigned) {
        (parts, assigned) = refinement.dissolved(&parts, spurious);
    }
    let Assigned { parts: mut refined, names, motions, .. } = assigned;
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

/// Parts whose unassigned clusters have been assigned.
struct Assigned {
    parts: RigidParts,
    /// Their labels.
    names: Vec<usize>,
    /// Their motions, with those of their clusters.
    motions: Vec<MotionSubspace>,
    /// What the tree says of joint speeds, in nats; 0 if no cluster was unassigned.
    information: f64,
}

/// What all sensors feel, and the motions that were learned from it.
struct Refinement<'a> {
    series: Vec<&'a [f32]>,
    signed: bool,
    roots: Roots,
    /// Motions by their sensors: most stay the same from one iteration to the next.
    known: BTreeMap<Vec<usize>, MotionSubspace>,
    /// The parameters of the search.
    parameters: Parameters,
}

impl<'a> Refinement<'a> {
    fn new(tactile: &'a Tactile, signed: bool, parameters: &Parameters) -> Self {
        let series: Vec<&[f32]> = tactile.series().collect();
        let samples: Vec<usize> = stratified(tactile.samples, MAX_SAMPLES).collect();
        Self {
            roots: Roots::at(&series, &samples, signed),
            signed,
            series,
            known: BTreeMap::new(),
            parameters: *parameters,
        }
    }

    /// T.
    fn samples(&self) -> usize {
        self.series.first().map_or(0, |series| series.len())
    }

    /// The motions of clusters, by their sensors: as the search found them, or else learned from these.
    fn motions(&mut self, parts: &RigidParts, clusters: &Members) -> Vec<MotionSubspace> {
        let found = |sensors: &Vec<usize>| {
            let series: Vec<&[f32]> = sensors.iter().map(|&sensor| self.series[sensor]).collect();
            (sensors.clone(), MotionSubspace::of_cluster(&series, self.signed))
        };
        let new: Vec<&Vec<usize>> = clusters
            .iter()
            .filter(|(label, own)| !parts.motions.contains_key(label) && !self.known.contains_key(*own))
            .map(|(_, own)| own)
            .collect();
        self.known.extend(new.into_par_iter().map(found).collect::<Vec<_>>());
        let motion = |(label, own)| parts.motions.get(label).unwrap_or_else(|| &self.known[own]).clone();
        clusters.iter().map(motion).collect()
    }

    /// Assigns the unassigned clusters.
    fn assigned(&mut self, parts: &RigidParts) -> Assigned {
        let mut parts = parts.clone();
        let (known, clusters) = parts_and_unassigned(&parts);
        let (clusters, rest) = largest(clusters);
        let mut motions = self.motions(&parts, &known);
        let mut names: Vec<usize> = known.into_keys().collect();
        let of_clusters = self.motions(&parts, &clusters);
        let members: Vec<&[usize]> = clusters.values().map(Vec::as_slice).collect();
        let pairs = opposite_pairs(&self.roots, &members);
        let (found, information) = assign(&motions, &of_clusters, &pairs, self.samples(), &self.parameters);
        if names.is_empty() {
            names.extend(clusters.keys());
            motions.extend(of_clusters);
        } else {
            for (sensors, (part, own)) in clusters.values().zip(found.into_iter().zip(of_clusters)) {
                let Some(part) = part else {
                    assign_by_residual(&mut parts, sensors, names[0]);
                    continue;
                };
                motions[part] = motions[part].with(&own);
                assign_to(&mut parts, sensors, names[part]);
            }
        }
        rest.iter().for_each(|sensors| assign_by_residual(&mut parts, sensors, names[0]));
        Assigned { parts, names, motions, information }
    }

    /// Of the small parts of low rank, the one by whose merging the tree gains most information, if that is much. In: parts, and the same
    /// with their clusters assigned.
    fn spurious(&self, parts: &RigidParts, assigned: &Assigned) -> Option<usize> {
        let Assigned { names, motions, .. } = assigned;
        let sizes = sizes(&parts.labels);
        let own: Vec<usize> = names.iter().map(|name| sizes[name]).collect();
        let small = typical_size(own.clone()).div_ceil(2);
        let can_be = |at: &usize| {
            own[*at] < small && motions[*at].rank < WHOLE_RANK && !parts.unassigned.contains(&names[*at])
        };
        let places = if names.len() > 2 { 0..names.len() } else { 0..0 };
        let gains = places.filter(can_be).map(|at| (gain(motions, at, self.samples(), &self.parameters), at));
        let most = gains.reduce(|most, other| if other.0 > most.0 { other } else { most });
        most.filter(|(gain, _)| *gain > self.parameters.min_merge_gain).map(|(_, at)| names[at])
    }

    /// The parts without one, and the same with its sensors assigned: as one cluster, whose motion they tell best together, or, if the tree
    /// then says much more, in clusters that feel the same.
    fn dissolved(&mut self, parts: &RigidParts, part: usize) -> (RigidParts, Assigned) {
        let own: Vec<usize> = (0..parts.labels.len()).filter(|at| parts.labels[*at] == part).collect();
        let pieces = similar(&self.roots, &own);
        let whole = unassigned(parts, part, std::slice::from_ref(&own));
        let of_whole = self.assigned(&whole);
        if pieces.len() < 2 {
            return (whole, of_whole);
        }
        let pieces = unassigned(parts, part, &pieces);
        let of_pieces = self.assigned(&pieces);
        let takers: BTreeSet<usize> = own.iter().map(|&sensor| of_pieces.parts.labels[sensor]).collect();
        let least = self.parameters.min_merge_gain * (takers.len() as f64 - 1.0);
        if of_pieces.information > of_whole.information + least {
            (pieces, of_pieces)
        } else {
            (whole, of_whole)
        }
    }
}

/// The parts without one, whose sensors are unassigned, in these clusters.
fn unassigned(parts: &RigidParts, part: usize, clusters: &[Vec<usize>]) -> RigidParts {
    let mut parts = parts.clone();
    let motion = parts.motions.remove(&part);
    let first = parts.labels.iter().chain(&parts.unassigned).max().map_or(0, |last| last + 1);
    for (label, cluster) in (first..).zip(clusters) {
        cluster.iter().for_each(|&sensor| parts.residuals[sensor] = 0.0);
        assign_to(&mut parts, cluster, label);
        parts.unassigned.push(label);
    }
    if clusters.len() == 1 {
        parts.motions.extend(motion.map(|motion| (first, motion)));
    }
    for others in &mut parts.alternatives {
        others.retain(|(other, _)| *other != part);
    }
    parts
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
