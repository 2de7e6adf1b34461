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
use crate::stages::rigid_parts::{rigid_parts, stratified};
use crate::stages::sense::Tactile;
use crate::stages::tree::Edge;

/// Most samples of a repeat, spread over all that were drawn: a bound on memory.
const MAX_SAMPLES: usize = 20_000;

/// How often sensors, parts and joints are found again from resampled times. Shares are 0 to 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Repeats {
    /// How many times parts and tree were estimated again.
    pub count: usize,
    /// For each sensor of the recording, the share of repeats in which it is on the same part.
    pub sensors: Vec<f64>,
    /// For each part, the share of repeats that have it: one of their parts has more than half of all sensors of both.
    pub parts: BTreeMap<usize, f64>,
    /// For each edge of the tree, the share of repeats that have both of its parts and join them.
    pub tree: Vec<f64>,
}

/// Estimates parts and tree `count` times from blocks of time, drawn with replacement, and compares with what was found. Calls `tick`
/// after each. The same recording and state of `rng` give the same numbers, whatever the number of threads.
pub fn repeats(
    recording: &Recording,
    found: &Estimate,
    count: usize,
    rng: &mut impl Rng,
    tick: &dyn Fn(),
) -> Repeats {
    let (labels, tree) = (&found.parts.labels, &found.joints.tree);
    let mut sensors = vec![0; labels.len()];
    let mut parts: BTreeMap<usize, usize> = labels.iter().map(|label| (*label, 0)).collect();
    let mut edges = vec![0; tree.len()];
    for _ in 0..count {
        let tactile = resampled(&recording.tactile, rng);
        let again = rigid_parts(&tactile, recording.signed, &searched(&tactile));
        let (other, other_tree) = refine_tree(&tactile, recording.signed, again);
        let same = Matching::new(labels, &other);
        for (at, times) in sensors.iter_mut().enumerate() {
            *times += usize::from(same.to.get(&labels[at]) == Some(&other[at]));
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

/// Which part of one partition is which of another, one to one: those with the most sensors in common first.
struct Matching {
    to: BTreeMap<usize, usize>,
    /// Those of the first partition that have more than half of the sensors of both in common with their counterpart.
    alike: Vec<usize>,
}

impl Matching {
    fn new(labels: &[usize], other: &[usize]) -> Self {
        let (ours, theirs) = (sizes(labels), sizes(other));
        let both: Vec<(usize, usize)> = labels.iter().copied().zip(other.iter().copied()).collect();
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
mod tests {
    use super::*;
    use crate::numerics::rng::stream;

    #[test]
    fn parts_have_counterparts_by_their_sensors_whatever_they_are_called() {
        let same = Matching::new(&[0, 0, 0, 1, 1, 1, 2, 2], &[4, 4, 4, 0, 0, 0, 7, 0]);
        assert_eq!(same.to, [(0, 4), (1, 0), (2, 7)].into());
        // Part 2 has one of the two sensors of both in common: just half.
        assert_eq!(same.alike, [0, 1]);
        let joined = |child, parent| same.has_joint(&Edge { child: 0, parent: 1 }, &[Edge { child, parent }]);
        assert!(joined(4, 0) && joined(0, 4) && !joined(7, 0));
        assert!(!same.has_joint(&Edge { child: 2, parent: 1 }, &[Edge { child: 7, parent: 0 }]));
    }

    #[test]
    fn times_are_drawn_in_blocks_for_all_sensors_alike() {
        let pressures =
            (0..2).flat_map(|sensor| (0..1000).map(move |t| (1000 * sensor + t) as f32)).collect();
        let tactile = Tactile { samples: 1000, pressures };
        let drawn = resampled(&tactile, &mut stream(1, 1, "repeats", 0));
        assert_eq!(drawn.samples, 1000);
        let series: Vec<&[f32]> = drawn.series().collect();
        assert!(series[0].iter().zip(series[1]).all(|(first, second)| second - first == 1000.0));
        let jumps = series[0].windows(2).filter(|pair| pair[1] - pair[0] != 1.0).count();
        assert!((1..10).contains(&jumps), "{jumps}");
        let mut times: Vec<f32> = series[0].to_vec();
        times.sort_by(f32::total_cmp);
        times.dedup();
        assert!(times.len() < 1000 && times.len().is_multiple_of(100), "{}", times.len());
    }
}
