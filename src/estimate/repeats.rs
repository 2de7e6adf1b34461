//! Estimate again and again from resampled times, and count what is found again: the bootstrap of the whole search (Felsenstein 1985).
//!
//! The support of an edge takes the parts as given. A repeat searches for the parts anew, so that it also shows which of them, and
//! which sensors, depend on the times that were recorded.

use std::cmp::Reverse;
use std::collections::BTreeMap;

use rand::{Rng, RngExt};

use super::{Estimate, searched};
use crate::numerics::partition::sizes;
use crate::recording::Recording;
use crate::stages::joints::{blocks, refine_tree};
use crate::stages::parameters::Parameters;
use crate::stages::rigid_parts::{MIN_SENSORS, rigid_parts, stratified};
use crate::stages::sense::Tactile;
use crate::stages::tree::Edge;
use crate::stages::usable::usable_with;

/// Most samples of a repeat, spread over all that were drawn: a bound on memory.
const MAX_SAMPLES: usize = 20_000;

/// How often sensors, parts and joints are found again from resampled times. Shares are 0 to 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Repeats {
    /// How many times parts and tree were estimated again.
    pub count: usize,
    /// For each sensor of the recording, the share of repeats that have its part, and the sensor on it. One that feels nothing at the times
    /// of a repeat is not found again.
    pub sensors: Vec<f64>,
    /// For each part, the share of repeats that have it: its counterpart and it have more than half of their sensors in common.
    pub parts: BTreeMap<usize, f64>,
    /// For each edge of the tree, the share of repeats that have both of its parts and join them.
    pub tree: Vec<f64>,
}

/// Finds parts and tree `count` times from blocks of time, drawn with replacement, and compares with what was found. Calls `tick`
/// after each. The same recording and state of `rng` give the same numbers, whatever the number of threads.
///
/// # Panics
/// If `count` is 0.
pub fn repeats(
    recording: &Recording,
    found: &Estimate,
    count: usize,
    parameters: &Parameters,
    rng: &mut impl Rng,
    tick: &dyn Fn(),
) -> Repeats {
    assert!(count > 0, "at least one repeat");
    let (labels, tree) = (&found.parts.labels, &found.joints.tree);
    let mut sensors = vec![0; labels.len()];
    let mut parts: BTreeMap<usize, usize> = labels.iter().map(|label| (*label, 0)).collect();
    let mut edges = vec![0; tree.len()];
    for _ in 0..count {
        let (other, other_tree) =
            found_again(resampled(&recording.tactile, rng), recording.signed, parameters);
        let same = Matching::new(labels, &other);
        for (at, times) in sensors.iter_mut().enumerate() {
            let is_on_it = other[at].is_some() && same.to.get(&labels[at]) == other[at].as_ref();
            *times += usize::from(is_on_it && same.has(labels[at]));
        }
        for (part, times) in &mut parts {
            *times += usize::from(same.has(*part));
        }
        for (edge, times) in tree.iter().zip(&mut edges) {
            *times += usize::from(same.has_joint(edge, &other_tree));
        }
        tick();
    }
    let share = |times: usize| times as f64 / count as f64;
    Repeats {
        count,
        sensors: sensors.into_iter().map(share).collect(),
        parts: parts.into_iter().map(|(part, times)| (part, share(times))).collect(),
        tree: edges.into_iter().map(share).collect(),
    }
}

/// The part of each sensor, or `None` if it tells nothing, and the tree. Too few sensors have no parts.
fn found_again(tactile: Tactile, signed: bool, parameters: &Parameters) -> (Vec<Option<usize>>, Vec<Edge>) {
    let mut labels = vec![None; tactile.sensors()];
    // Saturated values of the recording are missing already.
    let usable = usable_with(tactile, true);
    if usable.sensors.len() < MIN_SENSORS {
        return (labels, Vec::new());
    }
    let parts = rigid_parts(&usable.tactile, signed, &searched(&usable.tactile), parameters);
    let (found, tree) = refine_tree(&usable.tactile, signed, parts, parameters);
    for (sensor, label) in usable.sensors.into_iter().zip(found) {
        labels[sensor] = Some(label);
    }
    (labels, tree)
}

/// As many samples, or [`MAX_SAMPLES`] of them, of blocks that are drawn with replacement.
fn resampled(tactile: &Tactile, rng: &mut impl Rng) -> Tactile {
    let count = blocks(tactile.samples);
    let limit = |block: usize| block * tactile.samples / count;
    let drawn: Vec<usize> = (0..count)
        .map(|_| rng.random_range(0..count))
        .flat_map(|block| limit(block)..limit(block + 1))
        .collect();
    let samples: Vec<usize> = stratified(drawn.len(), MAX_SAMPLES).map(|at| drawn[at]).collect();
    let own = |series: &[f32]| samples.iter().map(|&t| series[t]).collect::<Vec<f32>>();
    Tactile { samples: samples.len(), pressures: tactile.series().flat_map(own).collect() }
}

/// Which part of one partition is which of another, one to one: those with the most sensors in common first. Sensors that have no part in
/// the other one do not count.
struct Matching {
    to: BTreeMap<usize, usize>,
    /// Those that have more than half of all sensors of both in common with their counterpart.
    alike: Vec<usize>,
}

impl Matching {
    fn new(labels: &[usize], other: &[Option<usize>]) -> Self {
        let both: Vec<(usize, usize)> =
            labels.iter().zip(other).filter_map(|(own, other)| Some((*own, (*other)?))).collect();
        let (own, others): (Vec<usize>, Vec<usize>) = both.iter().copied().unzip();
        let (ours, theirs) = (sizes(&own), sizes(&others));
        let mut common: Vec<((usize, usize), usize)> = sizes(&both).into_iter().collect();
        common.sort_by_key(|(_, count)| Reverse(*count));
        let (mut to, mut taken, mut alike) = (BTreeMap::new(), Vec::new(), Vec::new());
        for ((part, counterpart), count) in common {
            if to.contains_key(&part) || taken.contains(&counterpart) {
                continue;
            }
            to.insert(part, counterpart);
            taken.push(counterpart);
            if 2 * count > ours[&part] + theirs[&counterpart] - count {
                alike.push(part);
            }
        }
        Self { to, alike }
    }

    fn has(&self, part: usize) -> bool {
        self.alike.contains(&part)
    }

    /// Whether the other tree joins the counterparts of both parts of an edge.
    fn has_joint(&self, edge: &Edge, other: &[Edge]) -> bool {
        if !self.has(edge.child) || !self.has(edge.parent) {
            return false;
        }
        let [a, b] = [edge.child, edge.parent].map(|part| self.to[&part]);
        other.iter().any(|edge| [(a, b), (b, a)].contains(&(edge.child, edge.parent)))
    }
}

#[cfg(test)]
mod tests;
