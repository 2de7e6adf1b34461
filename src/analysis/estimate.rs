//! Estimate the parts and the tree of any body from touch alone: the stages for one's own robot, composed.

use rand::Rng;
use thiserror::Error;

use super::posterior::Posterior;
use crate::numerics::partition::sizes;
use crate::stages::body_map::{BodyMap, ClassicalScaling, MapError};
use crate::stages::co_motion::{CoMotion, co_motion, is_signed, rigid_parts};
use crate::stages::distance::information_metric;
use crate::stages::quantise::{Quantise, quantise};
use crate::stages::schema::{InferenceError, Model, Schema, infer};
use crate::stages::sense::Tactile;

/// Dimensions of the body map, if the distances span as many. More do not help, and fewer join parts.
const DIMENSIONS: usize = 14;

/// What was found.
#[derive(Debug)]
pub struct Estimate {
    /// The part of each sensor, 0, 1, …
    pub labels: Vec<usize>,
    /// The share of draws in which the sensor is with its part, before parts were mended.
    pub certainty: Vec<f64>,
    /// Sensors whose part was mended.
    pub mended: usize,
    /// The tree over the parts.
    pub tree: CoMotion,
    /// The body map.
    pub map: BodyMap,
    /// What the draws say.
    pub posterior: Posterior,
}

/// Why nothing was found.
#[derive(Debug, Error)]
pub enum EstimateError {
    /// The sensors feel the same.
    #[error("{0}")]
    Map(#[from] MapError),
    /// The draws failed.
    #[error("{0}")]
    Inference(#[from] InferenceError),
}

/// Estimates the parts and the tree.
///
/// In: M × T pressures of sensors that all change. Calls `tick` once for each chain.
///
/// # Errors
/// If the sensors cannot be mapped, or no draw can be made.
pub fn estimate(
    tactile: &Tactile,
    levels: &Quantise,
    schema: &Schema,
    seed: u64,
    rng: &mut impl Rng,
    tick: &(dyn Fn() + Sync),
) -> Result<Estimate, EstimateError> {
    let symbols =
        if is_signed(tactile) { quantise(&from_zero(tactile), levels) } else { quantise(tactile, levels) };
    let distances = information_metric(&symbols);
    let scaling = ClassicalScaling::new(&distances, DIMENSIONS)?;
    let map = scaling.coordinates(scaling.positive().clamp(1, DIMENSIONS))?;
    let draws = infer(&map, Model::DpgmmLj, schema, seed, 1, tick)?;
    let posterior = Posterior::of(&map, Model::DpgmmLj, &draws, schema, seed, 1)?;
    let labels = rigid_parts(tactile, &posterior.consensus.labels);
    let found = co_motion(tactile, &labels, None, rng);
    Ok(Estimate {
        mended: mended(&posterior.consensus.labels, &labels),
        certainty: posterior.consensus.certainty.clone(),
        tree: found,
        labels,
        map,
        posterior,
    })
}

/// Pressures that are not negative, in the same order: each sensor's minus its smallest negative one.
fn from_zero(tactile: &Tactile) -> Tactile {
    let mut pressures = tactile.pressures.clone();
    for series in pressures.chunks_exact_mut(tactile.samples) {
        let smallest = series.iter().copied().fold(0.0, f32::min);
        series.iter_mut().for_each(|pressure| *pressure -= smallest);
    }
    Tactile { samples: tactile.samples, pressures }
}

/// Sensors that are not with most of those of their part before.
fn mended(before: &[usize], after: &[usize]) -> usize {
    let both: Vec<(usize, usize)> = before.iter().copied().zip(after.iter().copied()).collect();
    let together = sizes(&both);
    let most = |label: usize| {
        together
            .iter()
            .filter(|((own, _), _)| *own == label)
            .max_by_key(|(_, count)| **count)
            .map(|(pair, _)| pair.1)
    };
    both.iter().filter(|(own, now)| most(*own) != Some(*now)).count()
}
