//! Run tasks: simulate each movement once, infer from its body maps as often as asked, and do no work twice.
//!
//! Finished work is kept in checkpoints, from which a run that was stopped goes on. Experiments, the search and the
//! study all run their simulations here.

use std::cell::Cell;
use std::collections::HashMap;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

use indicatif::ProgressBar;

use super::body_files::{BodyFiles, Kept};
use super::error::ExperimentError;
use super::shared::{Keys, Shared};
use crate::files::FileError;
use crate::files::checkpoint::Checkpoints;
use crate::pipeline::{
    BaselineRecord, Body, Condition, Inference, MappedBody, Record, StageError, cluster_and_score,
    infer_and_score,
};
use crate::settings::Settings;
use crate::stages::schema::Draw;
use crate::stages::simulate::Resolution;

/// Steps of the progress bar that a movement counts for.
const MOVEMENT_STEPS: u64 = 100;

/// What is inferred from one movement of one body.
#[derive(Debug, Clone)]
pub struct Task {
    /// Its name among the checkpoints; tasks of one name are the same.
    pub name: String,
    /// All settings, with p of this movement.
    pub settings: Settings,
    /// Number of the simulation, from 1.
    pub simulation: usize,
    /// What is inferred, each at d of a body map.
    pub conditions: Vec<Condition>,
    /// d of the body maps that are also clustered.
    pub clustered: Vec<usize>,
    /// Which files of the body are kept in the folder of its name.
    pub keep: Keep,
}

/// Which files of a body are results.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Keep {
    /// No file: only what is inferred counts.
    Nothing,
    /// The truth and the body maps.
    Maps,
    /// The truth, the body maps and the distances.
    MapsAndDistances,
}

/// What a task found.
#[derive(Debug, Clone, Default)]
pub struct Found {
    /// All draws, evaluated, by condition.
    pub records: Vec<Record>,
    /// Of each condition the draw of highest log posterior.
    pub best: Vec<Draw>,
    /// All clusterings, evaluated.
    pub baselines: Vec<BaselineRecord>,
    /// The body, where its files are kept.
    pub body: Option<Body>,
    /// What is known of that body.
    pub kept: Option<Kept>,
    /// How well the physics step resolved its movement.
    pub resolution: Resolution,
}

/// What a task found, or why it failed.
pub type Outcome = Result<Found, String>;

/// Runs tasks whose results go to one folder.
pub struct Batch<'a> {
    /// The folder.
    pub out: &'a Path,
    /// Finished work.
    pub checkpoints: &'a Checkpoints,
    /// A bar as long as [`Batch::length`] says.
    pub bar: &'a ProgressBar,
}

/// Why a task stops: it fails, which is an outcome, or a file cannot be written, which ends the run.
enum Stop {
    Failed(String),
    File(FileError),
}

impl From<FileError> for Stop {
    fn from(error: FileError) -> Self {
        Self::File(error)
    }
}

impl From<StageError> for Stop {
    fn from(error: StageError) -> Self {
        Self::Failed(error.to_string())
    }
}

impl Batch<'_> {
    /// Length of the progress bar for some tasks.
    pub fn length(tasks: &[Task]) -> u64 {
        tasks.iter().map(Task::length).sum()
    }

    /// Runs one task after the other, each on all threads, up to the first with files that fails; the outcome of one
    /// without files may be a failure. Of all but the first, only the files of the body are kept.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn one_by_one(&self, tasks: &[Task]) -> Result<Vec<Outcome>, ExperimentError> {
        let mut all = Vec::with_capacity(tasks.len());
        let mut shared = Shared::default();
        for (at, task) in tasks.iter().enumerate() {
            self.bar.set_message(task.name.clone());
            let progress = TaskProgress { bar: self.bar, done: AtomicU64::new(0) };
            // A failure is not kept among the checkpoints: what failed may succeed on a machine or with a library that
            // differs.
            let mut outcome = match self.try_to_finish(task, &mut shared, &progress) {
                Ok(found) => Ok(found),
                Err(Stop::Failed(reason)) if task.keep == Keep::Nothing => Err(reason),
                Err(Stop::Failed(reason)) => return Err(ExperimentError::Stage(reason)),
                Err(Stop::File(error)) => return Err(error.into()),
            };
            progress.complete(task);
            if !tasks.get(at + 1).is_some_and(|next| next.shares_movement(task)) {
                shared = Shared::default();
            }
            if at > 0
                && let Ok(found) = &mut outcome
            {
                (found.best, found.body) = (Vec::new(), None);
            }
            all.push(outcome);
        }
        Ok(all)
    }

    /// Runs as many tasks at once as there are threads, those that share a movement after each other. Each takes as much
    /// memory as the pressures of one simulation, 0.5 GB at full size.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn side_by_side(&self, tasks: &[Task]) -> Result<Vec<Outcome>, FileError> {
        let movements = by_movement(tasks);
        let outcomes: Vec<Mutex<Option<Outcome>>> = tasks.iter().map(|_| Mutex::new(None)).collect();
        let trouble: Mutex<Option<FileError>> = Mutex::new(None);
        let next = AtomicUsize::new(0);
        let work = || {
            while let Some(movement) = movements.get(next.fetch_add(1, Ordering::Relaxed)) {
                let mut shared = Shared::default();
                for &at in movement {
                    match self.finish(&tasks[at], &mut shared) {
                        Ok(outcome) => *outcomes[at].lock().expect("no worker panics") = Some(outcome),
                        Err(error) => {
                            next.store(movements.len(), Ordering::Relaxed);
                            trouble.lock().expect("no worker panics").get_or_insert(error);
                            return;
                        }
                    }
                }
            }
        };
        // Not by the pool's threads: one that waits for its own work would begin another movement meanwhile, and
        // with it take as much memory again.
        std::thread::scope(|scope| {
            (0..rayon::current_num_threads()).for_each(|_| drop(scope.spawn(work)));
        });
        if let Some(error) = trouble.into_inner().expect("no worker panics") {
            return Err(error);
        }
        let outcome = |slot: Mutex<Option<Outcome>>| slot.into_inner().expect("no worker panics");
        Ok(outcomes.into_iter().map(|slot| outcome(slot).expect("every task was done")).collect())
    }

    /// Does what is left of a task, and keeps a failure, so that it is not tried again.
    fn finish(&self, task: &Task, shared: &mut Shared) -> Result<Outcome, FileError> {
        let progress = TaskProgress { bar: self.bar, done: AtomicU64::new(0) };
        let failed = format!("{}/failed", task.name);
        let outcome = match self.checkpoints.recall(&failed) {
            Some(reason) => Err(reason),
            None => match self.try_to_finish(task, shared, &progress) {
                Ok(found) => Ok(found),
                Err(Stop::File(error)) => return Err(error),
                Err(Stop::Failed(reason)) => {
                    self.checkpoints.keep(&failed, &reason)?;
                    Err(reason)
                }
            },
        };
        progress.complete(task);
        Ok(outcome)
    }

    fn try_to_finish(
        &self,
        task: &Task,
        shared: &mut Shared,
        progress: &TaskProgress,
    ) -> Result<Found, Stop> {
        let mut found = Found::default();
        let mut body = None;
        if task.keep != Keep::Nothing {
            let files = BodyFiles { out: self.out, checkpoints: self.checkpoints, name: &task.name };
            let (mapped, kept) = match files.recall(&task.settings) {
                Some(recalled) => recalled,
                None => {
                    let mapped = map(task, shared, progress)?;
                    files.write(mapped, task.keep == Keep::MapsAndDistances)?
                }
            };
            (body, found.kept) = (Some(mapped), Some(kept));
        }
        for &condition in &task.conditions {
            let inference = self.infer(task, condition, &mut body, shared, progress)?;
            found.resolution = found.resolution.worse(inference.resolution);
            found.records.extend(inference.records);
            found.best.push(inference.best);
        }
        for &dimension in &task.clustered {
            let body = body.as_ref().expect("a body that is clustered is kept");
            found.baselines.extend(self.cluster(task, body, dimension)?);
        }
        found.body = body.filter(|_| found.kept.is_some());
        Ok(found)
    }

    /// What is inferred in one condition; its body is mapped if that was not done before.
    fn infer(
        &self,
        task: &Task,
        condition: Condition,
        body: &mut Option<Body>,
        shared: &mut Shared,
        progress: &TaskProgress,
    ) -> Result<Inference, Stop> {
        let name = format!("{}/{}-{}", task.name, condition.model.name(), condition.dimension);
        if let Some(finished) = self.checkpoints.recall(&name) {
            progress.add(task.settings.schema.chains as u64);
            return Ok(finished);
        }
        let body = match body {
            Some(body) => body,
            none => none.insert(map(task, shared, progress)?.body),
        };
        let tick = || progress.add(1);
        let found = infer_and_score(body, condition, &task.settings, task.simulation, &tick)?;
        self.checkpoints.keep(&name, &found)?;
        Ok(found)
    }

    /// The clusterings on one body map.
    fn cluster(&self, task: &Task, body: &Body, dimension: usize) -> Result<Vec<BaselineRecord>, Stop> {
        let name = format!("{}/baselines-{dimension}", task.name);
        if let Some(finished) = self.checkpoints.recall(&name) {
            return Ok(finished);
        }
        let found = cluster_and_score(body, dimension, &task.settings, task.simulation);
        self.checkpoints.keep(&name, &found)?;
        Ok(found)
    }
}

/// Stages 1 to 5 of a task; what an earlier task made of the same settings is not made again.
fn map(task: &Task, shared: &mut Shared, progress: &TaskProgress) -> Result<MappedBody, Stop> {
    let samples = task.settings.physics.samples(task.settings.sense.interval) + 1;
    let seen = Cell::new(0);
    let tick = || {
        let (before, now) = (seen.get(), seen.get() + 1);
        seen.set(now);
        let steps = |seen: usize| MOVEMENT_STEPS * seen as u64 / samples as u64;
        progress.add(steps(now) - steps(before));
    };
    shared.map(&task.settings, task.simulation, &task.dimensions(), &tick).map_err(Stop::Failed)
}

impl Task {
    /// d of its body maps, rising.
    fn dimensions(&self) -> Vec<usize> {
        let inferred = self.conditions.iter().map(|condition| condition.dimension);
        let mut all: Vec<usize> = inferred.chain(self.clustered.iter().copied()).collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// Whether another task needs the same movement.
    fn shares_movement(&self, other: &Self) -> bool {
        let key = |task: &Self| Keys::of(&task.settings, task.simulation, &[]).movement;
        key(self) == key(other)
    }

    /// Steps of the progress bar: one for each chain, and some for the movement.
    fn length(&self) -> u64 {
        MOVEMENT_STEPS + (self.conditions.len() * self.settings.schema.chains) as u64
    }
}

/// Progress of one task, of which some may be done already, or never.
struct TaskProgress<'a> {
    bar: &'a ProgressBar,
    done: AtomicU64,
}

impl TaskProgress<'_> {
    fn add(&self, steps: u64) {
        self.done.fetch_add(steps, Ordering::Relaxed);
        self.bar.inc(steps);
    }

    fn complete(&self, task: &Task) {
        self.bar.inc(task.length().saturating_sub(self.done.load(Ordering::Relaxed)));
    }
}

/// Places of the tasks in their list, those together that need the same movement, and of these those after each other that
/// need the same pressures, distances and maps.
fn by_movement(tasks: &[Task]) -> Vec<Vec<usize>> {
    let mut movements: Vec<Vec<usize>> = Vec::new();
    let mut places: HashMap<String, usize> = HashMap::new();
    for (at, Task { settings, simulation, .. }) in tasks.iter().enumerate() {
        let place = *places.entry(Keys::of(settings, *simulation, &[]).movement).or_insert_with(|| {
            movements.push(Vec::new());
            movements.len() - 1
        });
        movements[place].push(at);
    }
    for movement in &mut movements {
        // Stable: where nothing is shared, the order of the list stays.
        let mut order: HashMap<String, usize> = HashMap::new();
        let mut first = |key: String| {
            let next = order.len();
            *order.entry(key).or_insert(next)
        };
        movement.sort_by_cached_key(|&at| {
            let keys = Keys::of(&tasks[at].settings, tasks[at].simulation, &tasks[at].dimensions());
            [keys.pressures, keys.distances, keys.maps].map(&mut first)
        });
    }
    movements
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tasks_that_share_a_movement_are_together_and_no_others() {
        let task = |change: &dyn Fn(&mut Settings), simulation| {
            let mut settings = Settings::paper();
            change(&mut settings);
            let (conditions, clustered) = (Vec::new(), Vec::new());
            Task { name: String::new(), settings, simulation, conditions, clustered, keep: Keep::Nothing }
        };
        let tasks = [
            task(&|_| (), 1),
            task(&|settings| settings.agent.gap = 0.01, 1),
            task(&|settings| settings.quantise.levels = 7, 1),
            task(&|_| (), 2),
            task(&|settings| settings.motion.coordination = 0.5, 1),
            task(&|settings| settings.experiment.seed += 1, 1),
            task(&|settings| settings.schema.chains = 3, 2),
        ];
        assert_eq!(by_movement(&tasks), [vec![0, 2], vec![1], vec![3, 6], vec![4], vec![5]]);
    }
}
