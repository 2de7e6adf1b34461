//! The stages composed: settings → body maps, and body maps → scored samples. The file to read first.

use indicatif::ProgressBar;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::agent::Agent;
use crate::baselines::{Clustering, cluster};
use crate::body_map::{ClassicalScaling, MapError};
use crate::body_maps::BodyMaps;
use crate::distance::{Distances, information_metric};
use crate::evaluate::{Truth, adjusted_rand_index, parts, score};
use crate::quantise::quantise;
use crate::schema::gaussian::MixtureError;
use crate::schema::{Model, Sample, best, infer, one_part};
use crate::sense::{Tactile, sense};
use crate::settings::Settings;
use crate::simulate::simulate;
use crate::simulate::world::Unstable;
use crate::smacof::Improvement;
use crate::streams::stream;

/// What the inference and its evaluation need of one simulation.
#[derive(Debug, Clone)]
pub struct Body {
    /// The true parts and tree, which the inference must not see.
    pub truth: Truth,
    /// The body maps; none where no sensor differs from another, as when nothing ever moves (p = 1).
    pub maps: Option<BodyMaps>,
}

/// What stages 1 to 5 make of one simulation.
#[derive(Debug, Clone)]
pub struct MappedBody {
    /// What the inference needs.
    pub body: Body,
    /// The information metric between all sensors.
    pub distances: Distances,
    /// How well the distances could be mapped.
    pub facts: Facts,
}

/// How well the sensors of a body could be mapped.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Facts {
    /// Sensors that showed one symbol throughout.
    pub constant_sensors: usize,
    /// Eigenvalues of the dimensions of the largest classical map, descending, bits².
    pub eigenvalues: Vec<f64>,
    /// How well that map agrees with the distances; see [`ClassicalScaling::agreement`].
    pub map_agreement: f64,
    /// How far each map is better than the classical one; of classical maps nothing.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub improvements: Vec<Improvement>,
}

/// A draw and its evaluation: a row of an experiment's `samples.csv`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
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
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
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
    Infer(#[from] MixtureError),
}

/// What a body felt in one simulation, and what it is made of.
#[derive(Debug, Clone)]
pub struct FeltBody {
    /// The pressures on its sensors.
    pub tactile: Tactile,
    /// The true parts and tree, which the inference must not see.
    pub truth: Truth,
}

/// Stages 1 and 2. `progress` advances by one for each sample.
///
/// # Errors
/// If the simulation is unstable.
pub fn feel(settings: &Settings, simulation: usize, progress: &ProgressBar) -> Result<FeltBody, StageError> {
    let agent = Agent::new(&settings.agent, &settings.skin);
    let mut rng = stream(settings.experiment.seed, simulation, "motion", 0);
    let trajectory = simulate(&agent, settings, &mut rng, progress)?;
    let tactile = sense(&agent, &trajectory, &settings.sense);
    Ok(FeltBody { tactile, truth: Truth { labels: agent.labels(), tree: agent.tree() } })
}

/// Stages 3 to 5, to maps of each of `dims` dimensions, of which there is at least one.
///
/// # Errors
/// If the distances cannot be scaled.
pub fn map_felt(felt: &FeltBody, settings: &Settings, dims: &[usize]) -> Result<MappedBody, StageError> {
    let symbols = quantise(&felt.tactile, &settings.quantise);
    let distances = information_metric(&symbols);
    let largest = dims.iter().copied().max().expect("there is a dimension to map to");
    let scaling = ClassicalScaling::new(&distances, largest)?;
    let (maps, improvements) = if scaling.positive() == 0 {
        (None, Vec::new())
    } else {
        let (maps, improvements) = BodyMaps::new(&distances, &scaling, settings.map.method, dims)?;
        (Some(maps), improvements)
    };
    let facts = Facts {
        constant_sensors: symbols.constant_sensors().len(),
        map_agreement: scaling.agreement(largest),
        eigenvalues: scaling.eigenvalues,
        improvements,
    };
    Ok(MappedBody { body: Body { truth: felt.truth.clone(), maps }, distances, facts })
}

/// What the inference says of one body map.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Inference {
    /// All draws, evaluated.
    pub records: Vec<Record>,
    /// The draw of highest log posterior.
    pub best: Sample,
}

/// Stages 6 and 7 for one condition. `progress` advances by one for each chain.
///
/// Where there is no body map to draw from, the answer of every chain is one part that has all sensors.
///
/// # Errors
/// If the map spans fewer than `dimension` dimensions.
pub fn infer_and_score(
    body: &Body,
    dimension: usize,
    model: Model,
    settings: &Settings,
    simulation: usize,
    progress: &ProgressBar,
) -> Result<Inference, StageError> {
    let schema = &settings.schema;
    let samples = match &body.maps {
        None => {
            progress.inc(schema.chains as u64);
            one_part(body.truth.labels.len(), schema)
        }
        Some(maps) => {
            let map = maps.in_dims(dimension);
            infer(&map, model, schema, settings.experiment.seed, simulation, progress)?
        }
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
/// Where there is no body map, all sensors are in one cluster.
pub fn cluster_and_score(
    body: &Body,
    dimension: usize,
    settings: &Settings,
    simulation: usize,
) -> Vec<BaselineRecord> {
    let Settings { baselines, experiment, motion, .. } = settings;
    let map = body.maps.as_ref().map(|maps| maps.in_dims(dimension));
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
    conditions.into_par_iter().map(record).collect()
}
