//! The stages composed: settings → body maps, and body maps → scored samples. The file to read first.

use indicatif::ProgressBar;

use crate::agent::Agent;
use crate::body_map::{ClassicalScaling, MapError};
use crate::distance::{Distances, information_metric};
use crate::evaluate::{Truth, parts, score};
use crate::quantise::quantise;
use crate::schema::gaussian::PriorError;
use crate::schema::{Model, infer};
use crate::sense::sense;
use crate::settings::Settings;
use crate::simulate::simulate;
use crate::simulate::world::Unstable;
use crate::streams::stream;

/// All that one simulation gives to the inference, and the truth that it must not see.
#[derive(Debug, Clone)]
pub struct MappedBody {
    /// The true parts and tree.
    pub truth: Truth,
    /// The information metric between all sensors.
    pub distances: Distances,
    /// The body maps of all dimensions.
    pub scaling: ClassicalScaling,
    /// Sensors that showed one symbol throughout.
    pub constant_sensors: usize,
}

/// A draw and its evaluation: a row of an experiment's `samples.csv`.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Record {
    /// Simulation, from 1.
    pub simulation: usize,
    /// d of the body map.
    pub dimension: usize,
    /// The mixture.
    pub model: Model,
    /// The chain, from 0.
    pub chain: usize,
    /// The sweep after which it was drawn, from 1.
    pub sweep: usize,
    /// Number of estimated parts.
    pub parts: usize,
    /// log p(x, z).
    pub log_posterior: f64,
    /// Adjusted Rand index.
    pub ari: f64,
    /// Whether the tree counts.
    pub eligible: bool,
    /// Whether the tree is right.
    pub tree_correct: bool,
}

/// A stage that failed.
#[derive(Debug, thiserror::Error)]
#[error(transparent)]
pub enum StageError {
    /// Stage 1.
    Simulate(#[from] Unstable),
    /// Stage 5.
    Map(#[from] MapError),
    /// Stage 6.
    Infer(#[from] PriorError),
}

/// Stages 1 to 5. `progress` advances by one for each sample.
///
/// # Errors
/// If the simulation is unstable or the distances cannot be scaled.
pub fn map_body(
    settings: &Settings,
    simulation: usize,
    progress: &ProgressBar,
) -> Result<MappedBody, StageError> {
    let agent = Agent::new(&settings.agent, &settings.skin);
    let mut rng = stream(settings.experiment.seed, simulation, "motion", 0);
    let trajectory = simulate(&agent, settings, &mut rng, progress)?;
    let tactile = sense(&agent, &trajectory, &settings.sense);
    let symbols = quantise(&tactile, &settings.quantise);
    drop(tactile);
    let distances = information_metric(&symbols);
    Ok(MappedBody {
        truth: Truth { labels: agent.labels(), tree: agent.tree() },
        scaling: ClassicalScaling::new(&distances)?,
        distances,
        constant_sensors: symbols.constant_sensors().len(),
    })
}

/// Stages 6 and 7 for one condition. `progress` advances by one for each chain.
///
/// # Errors
/// If the distances span fewer than `dimension` dimensions.
pub fn infer_and_score(
    body: &MappedBody,
    dimension: usize,
    model: Model,
    settings: &Settings,
    simulation: usize,
    progress: &ProgressBar,
) -> Result<Vec<Record>, StageError> {
    let map = body.scaling.coordinates(dimension)?;
    let samples = infer(&map, model, &settings.schema, settings.experiment.seed, simulation, progress)?;
    let record = |sample| {
        let score = score(sample, &body.truth, settings.evaluate.eligible_ari);
        Record {
            simulation,
            dimension,
            model,
            chain: sample.chain,
            sweep: sample.sweep,
            parts: parts(&sample.labels),
            log_posterior: sample.log_posterior,
            ari: score.ari,
            eligible: score.eligible,
            tree_correct: score.tree_correct,
        }
    };
    Ok(samples.iter().map(record).collect())
}
