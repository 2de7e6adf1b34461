//! Run independent chains on a body map and keep their posterior samples (section 3).

use rayon::prelude::*;

use super::error::{InferenceError, MAX_LABELS, matrices_fit};
use super::gibbs::{Chain, start_labels};
use super::prior::prior;
use super::sample::Sample;
use super::settings::{Keep, Model, Sampler, Schema};
use super::split_merge::{Neighbours, SplitMerge, Target, TreePosterior, tree_given};
use crate::numerics::interrupt;
use crate::numerics::rng::{Stream, stream};
use crate::stages::body_map::BodyMap;
use crate::stages::mixture::{NormalInverseWishart, Points};

/// Runs `settings.chains` independent chains on a body map (M × d) and returns the posterior samples that are kept, ordered
/// by chain and sweep.
///
/// Chain c of a map in d dimensions has the stream (seed, simulation, "model d", c). Calls `tick` once for each finished
/// chain.
///
/// # Errors
/// [`InferenceError`] if the map spans fewer than d dimensions or too large a range, a matrix is numerically singular, or the samples
/// would not fit the memory.
pub fn infer(
    map: &BodyMap,
    model: Model,
    settings: &Schema,
    seed: u64,
    simulation: usize,
    tick: &(dyn Fn() + Sync),
) -> Result<Vec<Sample>, InferenceError> {
    check_size(map, settings)?;
    let points = Points::new(map);
    let prior = prior(&points, settings)?;
    let stage = format!("{} {}", model.name(), map.dims);
    let target = (settings.sampler == Sampler::SplitMerge).then(|| target(&points, &prior, settings, model));
    let chains: Result<Vec<Vec<Sample>>, InferenceError> = (0..settings.chains)
        .into_par_iter()
        .map(|chain| {
            let mut rng = stream(seed, simulation, &stage, chain);
            let settings = &Schema { start: settings.start.of_chain(chain), ..settings.clone() };
            let samples = if let Some(target) = &target {
                let labels = start_labels(&points, settings, &mut rng);
                let state = SplitMerge::start(target, &labels, &mut rng)?;
                run_chain(chain, state, settings, &mut rng)?
            } else {
                let state = Chain::start(&points, &prior, settings, model, &mut rng)?;
                run_chain(chain, state, settings, &mut rng)?
            };
            tick();
            Ok(samples)
        })
        .collect();
    Ok(chains?.into_iter().flatten().collect())
}

/// What all chains of the split–merge sampler share.
fn target<'a>(
    points: &'a Points,
    prior: &'a NormalInverseWishart,
    settings: &Schema,
    model: Model,
) -> Target<'a> {
    let concentration = settings.concentration;
    Target { points, prior, concentration, model, neighbours: Neighbours::of(points) }
}

/// The posterior of the tree over the parts of a partition of a body map's sensors, labels 0 to K − 1, each of which occurs, with the
/// prior that the settings ask for. Its stream is (seed, simulation, "tree d", 0).
///
/// # Errors
/// As for [`infer`].
///
/// # Panics
/// If a label does not occur.
pub fn tree_over(
    map: &BodyMap,
    labels: &[usize],
    settings: &Schema,
    seed: u64,
    simulation: usize,
) -> Result<TreePosterior, InferenceError> {
    check_size(map, settings)?;
    let points = Points::new(map);
    let prior = prior(&points, settings)?;
    let mut rng = stream(seed, simulation, &format!("tree {}", map.dims), 0);
    Ok(tree_given(&target(&points, &prior, settings, Model::DpgmmLj), labels, &mut rng)?)
}

/// The state of a chain, by either sampler.
trait State {
    /// Updates every variable once.
    fn sweep(&mut self, rng: &mut Stream) -> Result<(), InferenceError>;

    /// The state after a sweep, as a posterior sample of a chain.
    fn sample(&self, chain: usize, sweep: usize, rng: &mut Stream) -> Result<Sample, InferenceError>;
}

impl State for Chain<'_> {
    fn sweep(&mut self, rng: &mut Stream) -> Result<(), InferenceError> {
        Chain::sweep(self, rng)
    }

    fn sample(&self, chain: usize, sweep: usize, _: &mut Stream) -> Result<Sample, InferenceError> {
        Ok(Sample {
            chain,
            sweep,
            labels: self.labels.clone(),
            tree: self.edges(),
            joints: self.joints(),
            log_posterior: Some(self.log_posterior()?),
        })
    }
}

impl State for SplitMerge<'_> {
    fn sweep(&mut self, rng: &mut Stream) -> Result<(), InferenceError> {
        Ok(SplitMerge::sweep(self, rng)?)
    }

    fn sample(&self, chain: usize, sweep: usize, rng: &mut Stream) -> Result<Sample, InferenceError> {
        Ok(Sample {
            chain,
            sweep,
            labels: self.labels.clone(),
            tree: self.edges(rng)?,
            joints: Vec::new(),
            log_posterior: Some(self.log_posterior()),
        })
    }
}

/// Refuses a map or settings that would take too much memory, before anything of that size is made.
fn check_size(map: &BodyMap, settings: &Schema) -> Result<(), InferenceError> {
    let (components, dims, samples, count) =
        (settings.components, map.dims, settings.posterior_samples(), map.points());
    // n points span n − 1 dimensions.
    if count <= dims {
        return Err(InferenceError::Flat { points: count, dims });
    }
    if !matrices_fit(components, dims) {
        return Err(InferenceError::TooManyNumbers { components, dims });
    }
    if samples.saturating_mul(count) > MAX_LABELS {
        return Err(InferenceError::TooManyLabels { samples, points: count });
    }
    Ok(())
}

/// Runs all sweeps of one chain, and returns the posterior samples that are kept.
fn run_chain(
    chain: usize,
    mut state: impl State,
    settings: &Schema,
    rng: &mut Stream,
) -> Result<Vec<Sample>, InferenceError> {
    let mut samples = Vec::new();
    for sweep in 1..=settings.sweeps {
        interrupt::check();
        state.sweep(rng)?;
        let keep = match settings.keep {
            Keep::Last => sweep == settings.sweeps,
            Keep::All => sweep > settings.burn_in,
        };
        if keep {
            samples.push(state.sample(chain, sweep, rng)?);
        }
    }
    Ok(samples)
}
