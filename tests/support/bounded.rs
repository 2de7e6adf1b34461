//! Run every stage on settings whose sizes are cut to what a test can afford.
#![allow(unreachable_pub, reason = "a test and a fuzz target compile it for themselves")]

use bodyschema::pipeline::{
    Condition, StageError, cluster_and_score, infer_and_score, map_sensed, simulate_and_sense,
};
use bodyschema::settings::Settings;
use bodyschema::stages::schema::Model;

/// Most physics steps of a run.
const STEPS: usize = 400;

/// Cuts down sizes and times and nothing else: what the physics engine and the mixture compute with stays.
pub fn bounded(settings: &Settings) -> Settings {
    let mut settings = settings.clone();
    let steps = settings.physics.steps_per_sample(settings.sense.interval).min(STEPS / 2);
    let samples = settings.physics.samples(settings.sense.interval).min(STEPS / steps);
    settings.sense.interval = steps as f64 * settings.physics.step;
    settings.physics.duration = samples as f64 * settings.sense.interval;
    settings.motion.epoch = settings.motion.epoch.min(STEPS / 8);

    let skin = &mut settings.skin;
    (skin.around, skin.along, skin.caps) = (skin.around.min(4), skin.along.min(3), skin.caps.min(4));
    let schema = &mut settings.schema;
    (schema.chains, schema.sweeps, schema.burn_in) = (schema.chains.min(2), schema.sweeps.min(3), 0);
    let map = &mut settings.map;
    (map.starts, map.steps) = (map.starts.min(2), map.steps.min(20));
    let baselines = &mut settings.baselines;
    baselines.restarts = baselines.restarts.min(2);
    baselines.clusters.retain(|clusters| *clusters <= 5);
    if baselines.clusters.is_empty() {
        baselines.clusters.push(5);
    }
    let experiment = &mut settings.experiment;
    experiment.dimensions = vec![experiment.dimensions[0].min(4)];
    experiment.dimension = experiment.dimension.min(4);
    experiment.simulations = 1;
    settings
}

/// Simulates, maps, infers by both mixtures, and clusters, and checks what comes out of it.
///
/// # Errors
/// If a stage fails.
pub fn run_every_stage(settings: &Settings) -> Result<(), StageError> {
    let dimension = settings.experiment.dimensions[0];
    let felt = simulate_and_sense(settings, 1, &|| ())?;
    let mapped = map_sensed(&felt, settings, 1, &[dimension])?;
    assert!(mapped.distances.values.iter().all(|distance| (0.0..=16.0).contains(distance)));
    for model in Model::ALL {
        let condition = Condition { model, coordination: settings.motion.coordination, dimension };
        let found = infer_and_score(&mapped.body, condition, settings, 1, &|| ())?;
        assert!(found.records.len() >= settings.schema.chains);
        for record in found.records {
            assert!((-1.0..=1.0 + 1e-9).contains(&record.ari), "{record:?}");
            assert!(record.log_posterior.is_none_or(f64::is_finite), "{record:?}");
        }
    }
    for record in cluster_and_score(&mapped.body, dimension, settings, 1) {
        assert!((-1.0..=1.0 + 1e-9).contains(&record.ari), "{record:?}");
    }
    Ok(())
}
