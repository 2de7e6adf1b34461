//! Estimate the parts and the tree of any body from touch alone: the stages for one's own robot, composed.

use rand::Rng;

use crate::stages::co_motion::{CoMotion, RigidParts, is_signed, rigid_parts, settle, spread};
use crate::stages::distance::{Distances, information_metric};
use crate::stages::quantise::{Quantise, quantise};
use crate::stages::sense::Tactile;

/// Sensors whose distances are computed, spread over all.
const MAX_SENSORS: usize = 800;
/// Samples that distances are computed from, spread over all.
const MAX_SAMPLES: usize = 20_000;

/// What was found.
#[derive(Debug)]
pub struct Estimate {
    /// The part of each sensor.
    pub parts: RigidParts,
    /// The tree over the parts.
    pub tree: CoMotion,
    /// The sensors whose distances were computed, rising.
    pub mapped: Vec<usize>,
    /// Their distances.
    pub distances: Distances,
}

/// Estimates the parts and the tree.
///
/// In: M × T pressures of at least [`MIN_SENSORS`](crate::stages::co_motion::MIN_SENSORS) sensors, which all change. Calls `tick` after each of the three steps: distances, parts, tree.
pub fn estimate(tactile: &Tactile, levels: &Quantise, rng: &mut impl Rng, tick: &dyn Fn()) -> Estimate {
    let (sensors, distances) = distances(tactile, levels);
    tick();
    let parts = rigid_parts(tactile, &sensors, &distances);
    tick();
    let (parts, tree) = settle(tactile, parts, rng);
    tick();
    Estimate { parts, tree, mapped: sensors, distances }
}

/// Some sensors, spread over all and rising, and their distances.
pub fn distances(tactile: &Tactile, levels: &Quantise) -> (Vec<usize>, Distances) {
    let sensors: Vec<usize> = spread(tactile.sensors(), MAX_SENSORS).collect();
    let distances = information_metric(&quantise(&excerpt(tactile, &sensors), levels));
    (sensors, distances)
}

/// Pressures of some sensors at some samples, made positive in the same order: each sensor's minus its smallest negative one.
fn excerpt(tactile: &Tactile, sensors: &[usize]) -> Tactile {
    let times: Vec<usize> = spread(tactile.samples, MAX_SAMPLES).collect();
    let signed = is_signed(tactile);
    let series: Vec<&[f32]> = tactile.series().collect();
    let own = |&sensor: &usize| {
        let own: Vec<f32> = times.iter().map(|&t| series[sensor][t]).collect();
        let least = if signed { own.iter().copied().fold(0.0, f32::min) } else { 0.0 };
        own.into_iter().map(move |pressure| pressure - least)
    };
    Tactile { samples: times.len(), pressures: sensors.iter().flat_map(own).collect() }
}
