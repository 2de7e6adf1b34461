//! Run several configurations on several simulations, and gather what each of them gave.

use std::path::Path;

use indicatif::ProgressBar;

use super::batch::{Batch, Found};
use super::progress::progress;
use super::task::{Keep, Task};
use crate::analysis::conditions::Conditions;
use crate::analysis::measure::Evidence;
use crate::analysis::published::Experiment;
use crate::files::checkpoint::Checkpoints;
use crate::files::{FileError, sha256_of_text};
use crate::pipeline::{Condition, Record};
use crate::settings::Settings;
use crate::stages::schema::Model;
use crate::stages::simulate::Resolution;

/// What a configuration gave in its `experiment.simulations` simulations.
#[derive(Debug, Clone, Default)]
pub struct Outcome {
    /// All draws, evaluated, of the tasks that did not fail.
    pub records: Vec<Record>,
    /// Tasks that failed: unstable movement, or distances without a map of the dimensions.
    pub failures: Vec<Failure>,
    /// How well the physics step resolved the movements of the others: the worst of them in each respect.
    pub resolution: Resolution,
}

/// A task that failed.
#[derive(Debug, Clone, PartialEq)]
pub struct Failure {
    /// p.
    pub coordination: f64,
    /// Why.
    pub reason: String,
}

impl Outcome {
    /// The draws that `counts` keeps, by condition, with intervals over simulations.
    pub fn conditions(&self, settings: &Settings, counts: impl Fn(&Record) -> bool) -> Conditions {
        let records = self.records.iter().copied().filter(counts).collect();
        Conditions::new(records, settings.experiment.simulations, settings.experiment.seed)
    }

    /// The draws that belong to an experiment; none if a task failed, for what some simulations gave says nothing of a
    /// configuration in which others failed.
    pub fn evidence(&self, experiment: Experiment, settings: &Settings) -> Evidence {
        let belongs = |record: &Record| match experiment {
            Experiment::Exp1 => {
                record.coordination == settings.motion.coordination
                    && settings.experiment.dimensions.contains(&record.dimension)
            }
            Experiment::Exp2 => {
                record.dimension == settings.experiment.dimension && record.model == Model::DpgmmLj
            }
        };
        let conditions = self.conditions(settings, |record| self.failures.is_empty() && belongs(record));
        Evidence { conditions, baselines: Vec::new(), reading: settings.schema.sampler }
    }
}

/// Configurations that are run together: each at its own p with both mixtures at each of `experiment.dimensions`, and at
/// the other `experiment.coordinations` with the DPGMM-LJ at `experiment.dimension`.
pub struct Configurations<'a> {
    out: &'a Path,
    checkpoints: Checkpoints,
    tasks: Vec<Task>,
    /// The configuration that each task is of, and its p.
    of: Vec<(usize, f64)>,
    count: usize,
}

impl<'a> Configurations<'a> {
    /// Those with these settings. Checkpoints are in `out`/checkpoints, for a condition is the same in every round of a
    /// search, and in every study of the same program.
    pub fn new(all: &[Settings], out: &'a Path) -> Self {
        let (mut tasks, mut of) = (Vec::new(), Vec::new());
        for (at, settings) in all.iter().enumerate() {
            for coordination in coordinations(settings) {
                for simulation in 1..=settings.experiment.simulations {
                    tasks.push(task(settings, coordination, simulation));
                    of.push((at, coordination));
                }
            }
        }
        Self { out, checkpoints: checkpoints(out), tasks, of, count: all.len() }
    }

    /// Length of the progress bar for them.
    pub fn length(&self) -> u64 {
        Batch::length(&self.tasks)
    }

    /// Runs them all.
    ///
    /// # Errors
    /// If a checkpoint cannot be written. A configuration that fails is an outcome.
    pub fn run(&self, bar: &ProgressBar) -> Result<Vec<Outcome>, FileError> {
        let found = Batch { out: self.out, checkpoints: &self.checkpoints, bar }.side_by_side(&self.tasks)?;
        let mut outcomes = vec![Outcome::default(); self.count];
        for (&(at, coordination), outcome) in self.of.iter().zip(found) {
            match outcome {
                Ok(Found { records, resolution, .. }) => {
                    outcomes[at].records.extend(records);
                    outcomes[at].resolution = outcomes[at].resolution.worse(resolution);
                }
                Err(reason) => outcomes[at].failures.push(Failure { coordination, reason }),
            }
        }
        Ok(outcomes)
    }

    /// Removes their checkpoints, once what they gave is kept elsewhere.
    ///
    /// # Errors
    /// If one cannot be removed.
    pub fn forget(&self) -> Result<(), FileError> {
        self.tasks.iter().try_for_each(|task| self.checkpoints.forget(&task.name))
    }
}

/// Those of all configurations that were run in a folder.
fn checkpoints(out: &Path) -> Checkpoints {
    Checkpoints::new(out, &"study")
}

/// Removes the checkpoints of all configurations in a folder.
///
/// # Errors
/// If they cannot be removed.
pub fn clear_checkpoints(out: &Path) -> Result<(), FileError> {
    checkpoints(out).clear()
}

/// Runs all configurations, with a progress bar of this name, and keeps their checkpoints.
///
/// # Errors
/// As [`Configurations::run`].
pub fn run(all: &[Settings], out: &Path, name: &str) -> Result<Vec<Outcome>, FileError> {
    let configurations = Configurations::new(all, out);
    let bar = progress(configurations.length(), name.to_owned());
    let outcomes = configurations.run(&bar)?;
    bar.finish_and_clear();
    Ok(outcomes)
}

/// Its own p and those of experiment 2, rising.
fn coordinations(settings: &Settings) -> Vec<f64> {
    let mut all = settings.experiment.coordinations.clone();
    all.push(settings.motion.coordination);
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}

/// One simulation of a configuration at one p, with a name that says all that its results depend on.
fn task(settings: &Settings, coordination: f64, simulation: usize) -> Task {
    let experiment = &settings.experiment;
    let at = |model, dimension| Condition { model, coordination, dimension };
    let last = at(Model::DpgmmLj, experiment.dimension);
    let mut conditions = Vec::new();
    if settings.motion.coordination == coordination {
        conditions.extend(experiment.dimensions.iter().flat_map(|&d| Model::ALL.map(|model| at(model, d))));
    }
    if !conditions.contains(&last) {
        conditions.push(last);
    }
    let mut settings = settings.clone();
    settings.motion.coordination = coordination;
    // What else is run does not change the results.
    settings.experiment.simulations = 1;
    settings.experiment.dimensions = vec![last.dimension];
    settings.experiment.coordinations = vec![coordination];
    // All conditions are part of it: with other dimensions, the same maps may differ in their last digits.
    let key = serde_json::to_string(&(&settings, &conditions, simulation)).expect("settings are plain data");
    let name = sha256_of_text(&key);
    Task { name, settings, simulation, conditions, clustered: Vec::new(), keep: Keep::Nothing }
}
