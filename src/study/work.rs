//! Run the work of a study, or of one shard of it.
//!
//! The unit of work is a movement: one simulation at one p, with all that any configuration infers from it. Configurations that
//! have a movement, distances or maps in common share them. What a movement gave is kept in one file, whole or absent, so
//! that shards on different machines can work on one folder, and a run that was stopped continues.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};
use toml::Table;

use super::outcome::{Failure, Outcome};
use super::plan::Configuration;
use crate::files::checkpoint::Checkpoints;
use crate::files::manifest::Manifest;
use crate::files::{FileError, read_text, sha256_of_text, write_same_text};
use crate::pipeline::{Condition, Record};
use crate::settings::Settings;
use crate::stages::evaluate::is_eligible;
use crate::stages::schema::Model;
use crate::stages::simulate::Resolution;
use crate::tasks::batch::{Batch, Outcome as TaskOutcome, TaskOutput};
use crate::tasks::cache::Keys;
use crate::tasks::error::ExperimentError;
use crate::tasks::progress::progress;
use crate::tasks::shard::Shard;
use crate::tasks::task::{Keep, Task, by_movement};

/// Key of the checkpoints. The names of tasks already hash the settings that their results depend on.
pub(super) const KEY: &str = "study";

/// Where the design is kept beside the results.
pub(super) const DESIGN: &str = "design.toml";

/// Runs what is left of the configurations, or of one shard of them. What each movement gave goes to `out`/checkpoints. A
/// configuration that fails is a result.
///
/// # Errors
/// If `out` holds results of another design, or a file cannot be written.
pub(crate) fn run(
    text: &str,
    plan: &[Configuration],
    shard: Shard,
    out: &Path,
) -> Result<(), ExperimentError> {
    keep_design(text, out)?;
    let work = StudyWork::new(plan, Checkpoints::new(out, &KEY));
    // Of a movement, what other configurations inferred from it before is there.
    let unfinished =
        |movement| Some((movement, work.unfinished(movement))).filter(|(_, tasks)| !tasks.is_empty());
    let (left, groups): (Vec<&Movement>, Vec<Vec<Task>>) =
        work.of_shard(shard).into_iter().filter_map(unfinished).unzip();
    let bar =
        progress(groups.iter().map(|tasks| Batch::length(tasks)).sum(), format!("{} movements", left.len()));
    let (begun, finished) = (Instant::now(), AtomicUsize::new(0));
    let keep = |at: usize, outcomes: Vec<TaskOutcome>| -> Result<(), FileError> {
        work.keep(left[at], &groups[at], outcomes)?;
        if bar.is_hidden() {
            tell(1 + finished.fetch_add(1, Ordering::Relaxed), left.len(), begun.elapsed());
        }
        Ok(())
    };
    Batch { out, checkpoints: &work.checkpoints, bar: &bar }.run_groups(&groups, &keep)?;
    bar.finish_and_clear();
    Ok(())
}

/// Says in a log how far the work is.
fn tell(finished: usize, all: usize, spent: Duration) {
    let left = spent.mul_f64((all - finished) as f64 / finished as f64);
    let left = humantime::format_duration(Duration::from_secs(left.as_secs()));
    eprintln!("bodyschema: {finished} of {all} movements are finished; about {left} left");
}

/// Keeps the design beside the results, if it is not there.
fn keep_design(text: &str, out: &Path) -> Result<(), ExperimentError> {
    let path = out.join(DESIGN);
    if !path.exists() {
        if Manifest::is_in(out) || out.join("checkpoints").exists() {
            let message = "holds results of another command; choose another folder";
            return Err(FileError::new(out, message).into());
        }
        // Other shards may do so at the same time.
        write_same_text(&path, text)?;
    }
    check_design(text, out)
}

/// Whether the results in a folder are of this design.
///
/// # Errors
/// If they are not.
pub(super) fn check_design(text: &str, out: &Path) -> Result<(), ExperimentError> {
    let path = out.join(DESIGN);
    // Comments may change. What is no TOML is no design, and equal to none.
    let table = |text: &str| text.parse::<Table>().ok();
    if table(&read_text(&path)?).is_some_and(|known| table(text) == Some(known)) {
        return Ok(());
    }
    let message = "is another design, whose results are in this folder; choose another folder or that design";
    Err(FileError::new(&path, message).into())
}

/// All work of some configurations, by movement.
pub(super) struct StudyWork {
    checkpoints: Checkpoints,
    movements: Vec<Movement>,
    /// Of each configuration: its tasks, with the movement that each belongs to and its p.
    tasks_of: Vec<Vec<(usize, String, f64)>>,
    /// Of each configuration the least ARI of an eligible sample.
    eligible: Vec<f64>,
}

/// A movement and what is inferred from it.
struct Movement {
    /// Name of its file.
    name: String,
    /// What is inferred, those that share more after each other, no two alike.
    tasks: Vec<Task>,
}

/// The stored results of a movement: of each task, by its name; a failure has a reason.
type MovementResults = BTreeMap<String, Result<TaskResult, String>>;

/// The results of one task, as a checkpoint stores them.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct TaskResult {
    resolution: Resolution,
    samples: Vec<StoredSamples>,
}

/// The samples of a condition, without what all have in common.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct StoredSamples {
    simulation: usize,
    condition: Condition,
    samples: Vec<StoredSample>,
}

/// Chain, sweep, parts, log posterior, ARI, whether the number of parts is right, and whether the tree is.
type StoredSample = (usize, usize, usize, Option<f64>, f64, bool, bool);

impl StudyWork {
    /// The work of some configurations, and what was finished of it.
    pub(super) fn new(plan: &[Configuration], checkpoints: Checkpoints) -> Self {
        let (mut tasks, mut of) = (Vec::new(), Vec::new());
        for Configuration { settings, .. } in plan {
            let first = tasks.len();
            for coordination in coordinations(settings) {
                let simulations = 1..=settings.experiment.simulations;
                tasks.extend(simulations.map(|simulation| task(settings, coordination, simulation)));
            }
            of.push(first..tasks.len());
        }
        let groups = by_movement(&tasks);
        let mut movement_of = vec![0; tasks.len()];
        for (movement, group) in groups.iter().enumerate() {
            group.iter().for_each(|&task| movement_of[task] = movement);
        }
        let movement = |group: &Vec<usize>| {
            let mut known = HashSet::new();
            let own = group.iter().map(|&task| &tasks[task]);
            let key = Keys::of(&tasks[group[0]].settings, tasks[group[0]].simulation, &[]).movement;
            Movement {
                name: format!("movements/{}", sha256_of_text(&key)),
                tasks: own.filter(|task| known.insert(task.name.clone())).cloned().collect(),
            }
        };
        let place = |task: usize| {
            let Task { name, settings, .. } = &tasks[task];
            (movement_of[task], name.clone(), settings.motion.coordination)
        };
        Self {
            checkpoints,
            movements: groups.iter().map(movement).collect(),
            tasks_of: of.into_iter().map(|range| range.map(place).collect()).collect(),
            eligible: plan.iter().map(|one| one.settings.evaluate.eligible_ari).collect(),
        }
    }

    /// The movements of a shard. Those from which more is inferred are dealt out first, so that shards have about as much to do.
    fn of_shard(&self, shard: Shard) -> Vec<&Movement> {
        let mut all: Vec<&Movement> = self.movements.iter().collect();
        all.sort_by_key(|movement| std::cmp::Reverse(Batch::length(&movement.tasks)));
        all.into_iter()
            .enumerate()
            .filter(|(place, _)| shard.has(*place))
            .map(|(_, movement)| movement)
            .collect()
    }

    fn recall(&self, movement: &Movement) -> MovementResults {
        self.checkpoints.recall(&movement.name).unwrap_or_default()
    }

    fn unfinished(&self, movement: &Movement) -> Vec<Task> {
        let kept = self.recall(movement);
        movement.tasks.iter().filter(|task| !kept.contains_key(&task.name)).cloned().collect()
    }

    /// Keeps what a movement gave, beside what other configurations inferred from it before.
    fn keep(&self, movement: &Movement, tasks: &[Task], outcomes: Vec<TaskOutcome>) -> Result<(), FileError> {
        let mut kept = self.recall(movement);
        for (task, outcome) in tasks.iter().zip(outcomes) {
            kept.insert(task.name.clone(), outcome.map(TaskResult::of));
        }
        self.checkpoints.keep(&movement.name, &kept)?;
        tasks.iter().try_for_each(|task| self.checkpoints.forget(&task.name))
    }

    /// Hands each configuration's outcome to `take`, in their order, and holds no more in memory than what later ones need.
    ///
    /// # Errors
    /// If a movement is not finished.
    pub(super) fn outcomes(
        &self,
        out: &Path,
        mut take: impl FnMut(usize, Outcome),
    ) -> Result<(), ExperimentError> {
        let mut last_user = HashMap::new();
        for (at, tasks) in self.tasks_of.iter().enumerate() {
            last_user.extend(tasks.iter().map(|(movement, ..)| (*movement, at)));
        }
        let mut held: HashMap<usize, MovementResults> = HashMap::new();
        let mut missing = HashSet::new();
        for (at, tasks) in self.tasks_of.iter().enumerate() {
            let mut outcome = Outcome::default();
            for (movement, name, coordination) in tasks {
                let kept = held.entry(*movement).or_insert_with(|| self.recall(&self.movements[*movement]));
                match kept.get(name) {
                    None => drop(missing.insert(*movement)),
                    Some(Ok(gave)) => {
                        outcome.records.extend(gave.records(self.eligible[at]));
                        outcome.resolution = outcome.resolution.worse(gave.resolution);
                    }
                    Some(Err(reason)) => {
                        outcome
                            .failures
                            .push(Failure { coordination: *coordination, reason: reason.clone() });
                    }
                }
            }
            held.retain(|movement, _| last_user[movement] > at);
            if missing.is_empty() {
                take(at, outcome);
            }
        }
        if missing.is_empty() {
            return Ok(());
        }
        let message = format!(
            "lacks {} of {} movements of this design by this program; run all shards before --gather",
            missing.len(),
            self.movements.len()
        );
        Err(FileError::new(&out.join("checkpoints"), message).into())
    }

    /// Removes all that was kept, once the tables are written.
    ///
    /// # Errors
    /// If it cannot be removed.
    pub(super) fn clear(&self) -> Result<(), FileError> {
        self.checkpoints.clear()
    }
}

impl TaskResult {
    fn of(found: TaskOutput) -> Self {
        let mut samples: Vec<StoredSamples> = Vec::new();
        for record in found.records {
            let Record {
                simulation, chain, sweep, parts, log_posterior, ari, eligible, tree_correct, ..
            } = record;
            let condition = record.condition();
            if samples.last().is_none_or(|last| (last.simulation, last.condition) != (simulation, condition))
            {
                samples.push(StoredSamples { simulation, condition, samples: Vec::new() });
            }
            let last = samples.last_mut().expect("it was added");
            last.samples.push((chain, sweep, parts, log_posterior, ari, eligible, tree_correct));
        }
        Self { resolution: found.resolution, samples }
    }

    /// The samples, of which those count that have the right number of parts and at least this ARI.
    fn records(&self, eligible_ari: f64) -> impl Iterator<Item = Record> + '_ {
        self.samples.iter().flat_map(move |StoredSamples { simulation, condition, samples }| {
            let Condition { model, coordination, dimension } = *condition;
            samples.iter().map(
                move |&(chain, sweep, parts, log_posterior, ari, right_parts, tree_correct)| Record {
                    simulation: *simulation,
                    coordination,
                    dimension,
                    model,
                    chain,
                    sweep,
                    parts,
                    log_posterior,
                    ari,
                    eligible: right_parts && is_eligible(ari, eligible_ari),
                    tree_correct,
                },
            )
        })
    }
}

/// Its own p and those of experiment 2, rising.
fn coordinations(settings: &Settings) -> Vec<f64> {
    let mut all = settings.experiment.coordinations.clone();
    all.push(settings.motion.coordination);
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}

/// One simulation of a configuration at one p, with a name that says all that its results depend on: at its own p both mixtures at
/// each of `experiment.dimensions`, and at the other p the DPGMM-LJ at `experiment.dimension`.
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
    // What else is run does not change the results, nor does the ARI from which on a sample counts: here all with the right
    // number of parts count.
    settings.evaluate.eligible_ari = 0.0;
    settings.experiment.simulations = 1;
    settings.experiment.dimensions = vec![last.dimension];
    settings.experiment.coordinations = vec![coordination];
    // All conditions are part of it: with other dimensions, the same maps may differ in their last digits.
    let key = serde_json::to_string(&(&settings, &conditions, simulation)).expect("settings are plain data");
    let name = sha256_of_text(&key);
    Task { name, settings, simulation, conditions, clustered: Vec::new(), keep: Keep::Nothing }
}
