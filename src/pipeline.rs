//! Compose the stages: from settings to body maps, and from body maps to evaluated posterior samples. Read this file first.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::numerics::partition::adjusted_rand_index;
use crate::numerics::rng::{Stream, stream};
use crate::settings::Settings;
use crate::stages::agent::Agent;
use crate::stages::baselines::{ClusteringMethod, cluster};
use crate::stages::body_map::{BodyMaps, ClassicalScaling, Improvement, MapError, scaled};
use crate::stages::distance::{Distances, information_metric};
use crate::stages::evaluate::{parts, score};
use crate::stages::quantise::{Quantise, quantise};
use crate::stages::schema::{InferenceError, Model, Sample, best, infer, one_part};
use crate::stages::sense::{Tactile, sense};
use crate::stages::simulate::{Resolution, Trajectory, Unstable, simulate};
use crate::stages::tree::Truth;

/// What the inference and its evaluation need of one simulation.
#[derive(Debug, Clone)]
pub struct MappedBody {
    /// The true parts and tree, which the inference must not see.
    pub truth: Truth,
    /// The body maps; `None` where no sensor differs from another, as when nothing ever moves (p = 1).
    pub maps: Option<BodyMaps>,
    /// How well the physics step resolved its movement.
    pub resolution: Resolution,
}

/// What stages 1 to 5 make of one simulation.
#[derive(Debug, Clone)]
pub struct Mapped {
    /// What the inference needs.
    pub body: MappedBody,
    /// The information metric between all sensors.
    pub distances: Distances,
    /// How well the distances could be mapped.
    pub facts: MapQuality,
}

/// How well the sensors of a simulated body could be mapped.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MapQuality {
    /// Sensors that showed one symbol throughout.
    pub constant_sensors: usize,
    /// How well the physics step resolved the movement.
    pub resolution: Resolution,
    /// Eigenvalues of the dimensions of the largest classical map, descending, bits².
    pub eigenvalues: Vec<f64>,
    /// How well that map agrees with the distances; see [`ClassicalScaling::agreement`].
    pub map_agreement: f64,
    /// How far each map is better than the classical one; empty for classical maps.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub improvements: Vec<Improvement>,
}

/// A condition of the inference: the mixture, the p of the movement, and the d of the body map.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Condition {
    /// The mixture.
    pub model: Model,
    /// p, 0 to 1: the probability that a joint is locked for an epoch (section 5.1).
    pub coordination: f64,
    /// d: the number of dimensions of the body map.
    pub dimension: usize,
}

/// A posterior sample and its evaluation: a row of an experiment's `samples.csv`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Simulation, from 1.
    pub simulation: usize,
    /// p of its movement, 0 to 1.
    pub coordination: f64,
    /// d: the number of dimensions of the body map.
    pub dimension: usize,
    /// The mixture.
    pub model: Model,
    /// The chain, from 0.
    pub chain: usize,
    /// Number of the sweep after which the state was kept, from 1.
    pub sweep: usize,
    /// Number of estimated parts.
    pub parts: usize,
    /// log p(x, z); `None` where there is no body map.
    pub log_posterior: Option<f64>,
    /// Adjusted Rand index.
    pub ari: f64,
    /// Whether the tree counts for the success rate.
    pub eligible: bool,
    /// Whether the tree is right.
    pub tree_correct: bool,
}

impl Record {
    /// The condition that this sample is of.
    pub fn condition(&self) -> Condition {
        Condition { model: self.model, coordination: self.coordination, dimension: self.dimension }
    }
}

/// A clustering by a method that is given the number of clusters, and its evaluation: a row of `baselines.csv`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct BaselineRecord {
    /// Simulation, from 1.
    pub simulation: usize,
    /// p of its movement, 0 to 1.
    pub coordination: f64,
    /// d: the number of dimensions of the body map.
    pub dimension: usize,
    /// The clustering.
    pub method: ClusteringMethod,
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
    Infer(#[from] InferenceError),
}

/// What a body sensed in one simulation, and its truth.
#[derive(Debug, Clone)]
pub struct Sensed {
    /// The pressures on its sensors.
    pub tactile: Tactile,
    /// How well the physics step resolved the movement.
    pub resolution: Resolution,
    /// The true parts and tree, which the inference must not see.
    pub truth: Truth,
}

/// Stages 1 and 2: moves the body and computes the pressures on its sensors. Calls `tick` once for each sample.
///
/// # Errors
/// If the simulation is unstable.
pub fn simulate_and_sense(
    settings: &Settings,
    simulation: usize,
    tick: &dyn Fn(),
) -> Result<Sensed, StageError> {
    Ok(sense_movement(&simulate_movement(settings, simulation, tick)?, settings))
}

/// Stage 1: moves the body, whose sensors do not matter. Calls `tick` once for each sample.
///
/// # Errors
/// If the simulation is unstable.
pub fn simulate_movement(
    settings: &Settings,
    simulation: usize,
    tick: &dyn Fn(),
) -> Result<Trajectory, StageError> {
    let Settings { agent, skin, motion, physics, sense, experiment, .. } = settings;
    let mut rng = stream(experiment.seed, simulation, "motion", 0);
    Ok(simulate(&Agent::new(agent, skin), motion, physics, sense.interval, &mut rng, tick)?)
}

/// Stage 2: computes the pressures on the sensors of a body that moved.
pub fn sense_movement(trajectory: &Trajectory, settings: &Settings) -> Sensed {
    let agent = Agent::new(&settings.agent, &settings.skin);
    let tactile = sense(&agent, trajectory, &settings.sense);
    Sensed { tactile, resolution: trajectory.resolution, truth: agent.truth() }
}

/// Stages 3 to 5: maps the sensors in each number of dimensions in `dims`.
///
/// # Errors
/// If the distances span fewer dimensions than the largest of `dims`.
///
/// # Panics
/// If `dims` is empty.
pub fn map_sensed(
    sensed: &Sensed,
    settings: &Settings,
    simulation: usize,
    dims: &[usize],
) -> Result<Mapped, StageError> {
    let quantised = measure_distances(sensed, &settings.quantise);
    map_distances(sensed, &quantised, settings, simulation, dims)
}

/// The information metric between all sensors of a body, and how many of them showed one symbol throughout.
#[derive(Debug, Clone)]
pub struct Metric {
    /// The distances.
    pub distances: Distances,
    /// Sensors that showed one symbol throughout.
    pub constant_sensors: usize,
}

/// Stages 3 and 4: quantises the pressures, and computes the distances between all sensors.
pub fn measure_distances(sensed: &Sensed, settings: &Quantise) -> Metric {
    let symbols = quantise(&sensed.tactile, settings);
    Metric { distances: information_metric(&symbols), constant_sensors: symbols.constant_sensors().len() }
}

/// Stage 5: maps the sensors in each number of dimensions in `dims`.
///
/// # Errors
/// As [`map_sensed`].
///
/// # Panics
/// If `dims` is empty.
pub fn map_distances(
    sensed: &Sensed,
    metric: &Metric,
    settings: &Settings,
    simulation: usize,
    dims: &[usize],
) -> Result<Mapped, StageError> {
    let Metric { distances, constant_sensors } = metric.clone();
    let largest = dims.iter().copied().max().expect("dims must not be empty");
    let scaled = scaled(&distances, settings.map.of);
    let scaling = ClassicalScaling::new(&scaled, largest)?;
    let (maps, improvements) = if scaling.positive() == 0 {
        (None, Vec::new())
    } else {
        let random = |d: usize, start: usize| map_stream(settings.experiment.seed, simulation, d, start);
        let (maps, improvements) = BodyMaps::new(&scaled, &scaling, &settings.map, dims, &random)?;
        (Some(maps), improvements)
    };
    let facts = MapQuality {
        constant_sensors,
        resolution: sensed.resolution,
        map_agreement: scaling.agreement(largest),
        eigenvalues: scaling.eigenvalues,
        improvements,
    };
    drop(scaled);
    let body = MappedBody { truth: sensed.truth.clone(), maps, resolution: sensed.resolution };
    Ok(Mapped { body, distances, facts })
}

/// The stream of a random start of a body map of d dimensions.
pub fn map_stream(seed: u64, simulation: usize, dims: usize, start: usize) -> Stream {
    stream(seed, simulation, &format!("map {dims}"), start)
}

/// The result of the inference on one body map.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Inference {
    /// All posterior samples, evaluated.
    pub records: Vec<Record>,
    /// The posterior sample of highest log p(x, z).
    pub best: Sample,
    /// How well the physics step resolved the movement of the body.
    pub resolution: Resolution,
}

/// Stages 6 and 7 for one condition. Calls `tick` once for each chain.
///
/// Where there is no body map to infer from, every chain answers that all sensors are on one part.
///
/// # Errors
/// If the map spans fewer than `dimension` dimensions.
pub fn infer_and_score(
    body: &MappedBody,
    condition: Condition,
    settings: &Settings,
    simulation: usize,
    tick: &(dyn Fn() + Sync),
) -> Result<Inference, StageError> {
    let (schema, Condition { model, coordination, dimension }) = (&settings.schema, condition);
    let samples = match &body.maps {
        None => {
            (0..schema.chains).for_each(|_| tick());
            one_part(body.truth.labels.len(), schema)
        }
        Some(maps) => {
            let map = maps.in_dims(dimension);
            infer(&map, model, schema, settings.experiment.seed, simulation, tick)?
        }
    };
    let record = |sample: &Sample| {
        let score = score(&sample.labels, &sample.tree, &body.truth, settings.evaluate.eligible_ari);
        Record {
            simulation,
            coordination,
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
    let records = samples.iter().map(record).collect();
    Ok(Inference { records, best: best(&samples).clone(), resolution: body.resolution })
}

/// Ward's method, k-means and GMM with each number of clusters on one body map (figure 8a).
///
/// Where there is no body map, all sensors are in one cluster.
pub fn cluster_and_score(
    body: &MappedBody,
    dimension: usize,
    settings: &Settings,
    simulation: usize,
) -> Vec<BaselineRecord> {
    let Settings { baselines, experiment, motion, .. } = settings;
    let map = body.maps.as_ref().map(|maps| maps.in_dims(dimension));
    let conditions: Vec<(ClusteringMethod, usize)> = ClusteringMethod::ALL
        .into_iter()
        .flat_map(|method| baselines.clusters.iter().map(move |&k| (method, k)))
        .collect();
    let record = |(method, clusters): (ClusteringMethod, usize)| {
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
