//! Run independent chains on a body map and keep their draws (section 3).

use rayon::prelude::*;

use super::draw::Draw;
use super::error::{InferenceError, MAX_LABELS, matrices_fit};
use super::gibbs::Chain;
use super::prior::prior;
use super::settings::{Keep, Model, Schema};
use crate::numerics::rng::{Stream, stream};
use crate::stages::body_map::BodyMap;
use crate::stages::mixture::Points;

/// Runs `settings.chains` independent chains on a body map (M × d) and returns the draws that are kept, ordered by chain
/// and sweep.
///
/// Chain c of a map in d dimensions has the stream (seed, simulation, "model d", c). Calls `tick` once for each finished
/// chain.
///
/// # Errors
/// [`InferenceError`] if the map spans fewer than d dimensions, or is too large for the memory.
pub fn infer(
    map: &BodyMap,
    model: Model,
    settings: &Schema,
    seed: u64,
    simulation: usize,
    tick: &(dyn Fn() + Sync),
) -> Result<Vec<Draw>, InferenceError> {
    check_size(map, settings)?;
    let points = Points::new(map);
    let prior = prior(&points, settings)?;
    let stage = format!("{} {}", model.name(), map.dims);
    let chains: Result<Vec<Vec<Draw>>, InferenceError> = (0..settings.chains)
        .into_par_iter()
        .map(|chain| {
            let mut rng = stream(seed, simulation, &stage, chain);
            let state = Chain::start(&points, &prior, settings, model, &mut rng)?;
            let draws = run_chain(chain, state, &points, settings, &mut rng)?;
            tick();
            Ok(draws)
        })
        .collect();
    Ok(chains?.into_iter().flatten().collect())
}

/// Refuses a map or settings that would take too much memory, before anything of that size is made.
fn check_size(map: &BodyMap, settings: &Schema) -> Result<(), InferenceError> {
    let (components, dims, draws, count) = (settings.components, map.dims, settings.draws(), map.points());
    // n points span n − 1 dimensions.
    if count <= dims {
        return Err(InferenceError::Flat { points: count, dims });
    }
    if !matrices_fit(components, dims) {
        return Err(InferenceError::TooManyNumbers { components, dims });
    }
    if draws.saturating_mul(count) > MAX_LABELS {
        return Err(InferenceError::TooManyLabels { draws, points: count });
    }
    Ok(())
}

/// Runs all sweeps of one chain, and returns the draws that are kept.
fn run_chain(
    chain: usize,
    mut state: Chain,
    points: &Points,
    settings: &Schema,
    rng: &mut Stream,
) -> Result<Vec<Draw>, InferenceError> {
    let mut draws = Vec::new();
    for sweep in 1..=settings.sweeps {
        state.sweep(rng)?;
        let keep = match settings.keep {
            Keep::Last => sweep == settings.sweeps,
            Keep::All => sweep > settings.burn_in,
        };
        if keep {
            draws.push(Draw {
                chain,
                sweep,
                labels: state.labels.clone(),
                tree: state.edges(),
                joints: state.tree.joints.iter().map(|joint| points.uncentred(&joint.position)).collect(),
                log_posterior: Some(state.log_posterior()?),
            });
        }
    }
    Ok(draws)
}
