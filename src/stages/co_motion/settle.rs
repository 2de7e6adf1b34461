//! Find the tree over parts that were found, and by it the part of loose sets of sensors.

use std::collections::BTreeMap;

use rand::Rng;
use rayon::prelude::*;

use super::censored::Roots;
use super::faces::{alike, opposites};
use super::motion::{LEAST_COMPONENTS, Motion, is_signed, motion, spread};
use super::owners::owners;
use super::rigid::RigidParts;
use super::tree::{CoMotion, joined};
use crate::numerics::partition::named_by_appearance;
use crate::stages::sense::Tactile;

/// Times that likeness is read at, spread over all.
const TIMES: usize = 2000;
/// The share of a sensor's squares that its part may leave so that the tree is learned from it, or so many times what it leaves of
/// the sensor in the middle.
const TRUSTED: f64 = 0.02;
const TIMES_THE_MIDDLE: f64 = 3.0;
/// Sensors from which on a part may feel fewer than [`LEAST_COMPONENTS`].
const MANY: usize = 24;

/// The tree over the parts, once loose sets are on the part that they are on: the one that the joints tell, or else the one whose
/// motion leaves least of them.
///
/// In: M × T pressures, of any sign, and the parts and loose sets of their sensors. Out: parts without loose sets, and their tree.
pub fn settle(tactile: &Tactile, mut parts: RigidParts, rng: &mut impl Rng) -> (RigidParts, CoMotion) {
    let series: Vec<&[f32]> = tactile.series().collect();
    let times: Vec<usize> = spread(tactile.samples, TIMES).collect();
    let body =
        Body { roots: Roots::at(&series, &times, is_signed(tactile)), signed: is_signed(tactile), series };
    let (known, sets) = body.parts_and_sets(&mut parts);
    let (names, mut motions): (Vec<usize>, Vec<Motion>) = known.into_iter().unzip();
    let of_sets = body.motions(sets.values());
    let members: Vec<&[usize]> = sets.values().map(Vec::as_slice).collect();
    let found = owners(&motions, &of_sets, &opposites(&body.roots, &members), tactile.samples);
    let mut nodes: Vec<(usize, Motion)> = Vec::new();
    for ((set, sensors), (owner, own)) in sets.into_iter().zip(found.into_iter().zip(of_sets)) {
        if let Some(owner) = owner {
            motions[owner] = motions[owner].with(&own);
            give(&mut parts, &sensors, names[owner]);
        } else if sensors.iter().all(|&sensor| parts.next[sensor].is_some()) {
            for sensor in sensors {
                let (part, left) = parts.next[sensor].take().expect("it has a next part");
                (parts.labels[sensor], parts.left[sensor]) = (part, left);
            }
        } else {
            nodes.push((set, own));
        }
    }
    nodes.extend(names.into_iter().zip(motions));
    // Loose sets leave gaps in the labels.
    let labels = named_by_appearance(&parts.labels);
    let new: BTreeMap<usize, usize> = parts.labels.iter().copied().zip(labels.iter().copied()).collect();
    let mut nodes: Vec<(usize, Motion)> =
        nodes.into_iter().filter_map(|(name, own)| Some((*new.get(&name)?, own))).collect();
    nodes.sort_by_key(|node| node.0);
    for next in &mut parts.next {
        *next = next.and_then(|(part, left)| Some((*new.get(&part)?, left)));
    }
    (parts.labels, parts.loose) = (labels, Vec::new());
    let (names, motions): (Vec<usize>, Vec<Motion>) = nodes.into_iter().unzip();
    let tree = joined(&names, &motions, tactile.samples, rng);
    (parts, tree)
}

/// Makes sensors a part's.
fn give(parts: &mut RigidParts, sensors: &[usize], part: usize) {
    for &sensor in sensors {
        parts.labels[sensor] = part;
        parts.next[sensor] = parts.next[sensor].filter(|(next, _)| *next != part);
    }
}

/// What all sensors feel.
struct Body<'a> {
    series: Vec<&'a [f32]>,
    signed: bool,
    roots: Roots,
}

impl Body<'_> {
    fn motions<'b>(&self, sets: impl Iterator<Item = &'b Vec<usize>>) -> Vec<Motion> {
        let own = |sensors: &Vec<usize>| -> Vec<&[f32]> {
            sensors.iter().map(|&sensor| self.series[sensor]).collect()
        };
        let sets: Vec<Vec<&[f32]>> = sets.map(own).collect();
        sets.par_iter().map(|series| motion(series, None, self.signed)).collect()
    }

    /// The motions of all parts that feel enough, from the sensors that they explain; and the sensors of loose sets.
    fn parts_and_sets(
        &self,
        parts: &mut RigidParts,
    ) -> (BTreeMap<usize, Motion>, BTreeMap<usize, Vec<usize>>) {
        let (mut known, mut sets): (BTreeMap<usize, Vec<usize>>, BTreeMap<usize, Vec<usize>>) =
            Default::default();
        for (sensor, (label, is_trusted)) in parts.labels.iter().zip(trusted(parts)).enumerate() {
            if parts.loose.contains(label) {
                sets.entry(*label).or_default().push(sensor);
            } else if is_trusted {
                known.entry(*label).or_default().push(sensor);
            }
        }
        let motions = self.motions(known.values());
        let is_weak = |(sensors, own): (&Vec<usize>, &Motion)| {
            sensors.len() < MANY && own.components < LEAST_COMPONENTS
        };
        let weak: Vec<usize> = known
            .iter()
            .zip(&motions)
            .filter(|((_, sensors), own)| is_weak((sensors, own)))
            .map(|(at, _)| *at.0)
            .collect();
        let mut motions: BTreeMap<usize, Motion> = known.into_keys().zip(motions).collect();
        if weak.len() < motions.len() {
            let mut name = parts.labels.iter().max().map_or(0, |last| last + 1);
            for part in weak {
                motions.remove(&part);
                let own: Vec<usize> =
                    (0..parts.labels.len()).filter(|at| parts.labels[*at] == part).collect();
                for set in alike(&self.roots, &own) {
                    give(parts, &set, name);
                    sets.insert(name, set);
                    name += 1;
                }
            }
        }
        // What was next to a part that is none any more has no next part.
        for next in &mut parts.next {
            *next = next.filter(|(part, _)| motions.contains_key(part));
        }
        (motions, sets)
    }
}

/// Whether the motion of its set explains each sensor. Others may be on another part, and would bring that one's motion.
fn trusted(parts: &RigidParts) -> Vec<bool> {
    let middle = |part: usize| {
        let own = parts.labels.iter().zip(&parts.left).filter(|(label, _)| **label == part);
        let mut left: Vec<f64> = own.map(|(_, left)| *left).collect();
        left.sort_by(f64::total_cmp);
        left[left.len() / 2]
    };
    let count = parts.labels.iter().max().map_or(0, |last| last + 1);
    let most: Vec<f64> = (0..count).map(|part| f64::max(TRUSTED, TIMES_THE_MIDDLE * middle(part))).collect();
    parts.labels.iter().zip(&parts.left).map(|(part, left)| *left <= most[*part]).collect()
}
