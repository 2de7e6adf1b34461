//! The stages composed: settings → body maps, and body maps → scored samples. The file to read first.

use indicatif::ProgressBar;
use rayon::prelude::*;

use crate::agent::Agent;
use crate::baselines::{Clustering, cluster};
use crate::body_map::{ClassicalScaling, MapError};
use crate::distance::{Distances, information_metric};
use crate::evaluate::{Truth, adjusted_rand_index, parts, score};
use crate::quantise::quantise;
use crate::schema::gaussian::PriorError;
use crate::schema::{Model, Sample, best, infer, one_part};
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
    /// p of its movement.
    pub coordination: f64,
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
    /// log p(x, z); none where there is no body map.
    pub log_posterior: Option<f64>,
    /// Adjusted Rand index.
    pub ari: f64,
    /// Whether the tree counts.
    pub eligible: bool,
    /// Whether the tree is right.
    pub tree_correct: bool,
}

/// A clustering that was told the number of clusters, and its evaluation: a row of `baselines.csv`.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct BaselineRecord {
    /// Simulation, from 1.
    pub simulation: usize,
    /// p of its movement.
    pub coordination: f64,
    /// d of the body map.
    pub dimension: usize,
    /// The clustering.
    pub method: Clustering,
    /// K, the number of clusters.
    pub clusters: usize,
    /// Adjusted Rand index.
    pub ari: f64,
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

/// What the inference says of one body map.
#[derive(Debug, Clone)]
pub struct Inference {
    /// All draws, evaluated.
    pub records: Vec<Record>,
    /// The draw of highest log posterior.
    pub best: Sample,
}

/// Stages 6 and 7 for one condition. `progress` advances by one for each chain.
///
/// Where no sensor differs from another, as when nothing ever moves (p = 1), there is no body map to draw
/// from. The answer of every chain is then one part that has all sensors.
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
) -> Result<Inference, StageError> {
    let schema = &settings.schema;
    let samples = if body.scaling.positive() == 0 {
        progress.inc(schema.chains as u64);
        one_part(body.distances.sensors, schema)
    } else {
        let map = body.scaling.coordinates(dimension)?;
        infer(&map, model, schema, settings.experiment.seed, simulation, progress)?
    };
    let record = |sample: &Sample| {
        let score = score(sample, &body.truth, settings.evaluate.eligible_ari);
        Record {
            simulation,
            coordination: settings.motion.coordination,
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
    Ok(Inference { records: samples.iter().map(record).collect(), best: best(&samples).clone() })
}

/// Ward's method, k-means and GMM with each number of clusters on one body map (figure 8a).
///
/// Where no sensor differs from another, all of them are in one cluster.
///
/// # Errors
/// If the distances span fewer than `dimension` dimensions.
pub fn cluster_and_score(
    body: &MappedBody,
    dimension: usize,
    settings: &Settings,
    simulation: usize,
) -> Result<Vec<BaselineRecord>, StageError> {
    let Settings { baselines, experiment, motion, .. } = settings;
    let map = match body.scaling.positive() {
        0 => None,
        _ => Some(body.scaling.coordinates(dimension)?),
    };
    let conditions: Vec<(Clustering, usize)> = Clustering::ALL
        .into_iter()
        .flat_map(|method| baselines.clusters.iter().map(move |&k| (method, k)))
        .collect();
    let record = |(method, clusters): (Clustering, usize)| {
        let labels = match &map {
            None => vec![0; body.truth.labels.len()],
            Some(map) => {
                let stage = format!("{} {clusters} {dimension}", method.name());
                let mut rng = stream(experiment.seed, simulation, &stage, 0);
                cluster(method, map, clusters, baselines.restarts, &mut rng)
            }
        };
        let ari = adjusted_rand_index(&labels, &body.truth.labels);
        BaselineRecord { simulation, coordination: motion.coordination, dimension, method, clusters, ari }
    };
    Ok(conditions.into_par_iter().map(record).collect())
}
