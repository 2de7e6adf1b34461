//! Run tasks: simulate each movement once, infer from its body maps as often as asked, and do no work twice.
//!
//! Finished work is kept in checkpoints, from which a run that was stopped continues. Experiments and studies run their simulations
//! here.

use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use indicatif::ProgressBar;

use super::artifacts::{ArtifactFiles, Artifacts};
use super::beginning::beginning;
use super::cache::StageCache;
use super::error::ExperimentError;
use super::prefetch::Prefetch;
use super::task::{Keep, Task, TaskProgress};
use crate::files::FileError;
use crate::files::checkpoint::Checkpoints;
use crate::pipeline::{
    BaselineRecord, Condition, Inference, Mapped, MappedBody, Record, StageError, cluster_and_score,
    infer_and_score,
};
use crate::stages::schema::Sample;
use crate::stages::simulate::{Resolution, Trajectory};

/// What a task found.
#[derive(Debug, Clone, Default)]
pub(crate) struct TaskOutput {
    /// All posterior samples, evaluated, by condition.
    pub records: Vec<Record>,
    /// Of each condition the posterior sample of highest log posterior.
    pub best: Vec<Sample>,
    /// All clusterings, evaluated.
    pub baselines: Vec<BaselineRecord>,
    /// The body, where its files are kept.
    pub body: Option<MappedBody>,
    /// What is known of that body.
    pub kept: Option<Artifacts>,
    /// How well the physics step resolved its movement.
    pub resolution: Resolution,
    /// How its movement begins, if the task [is shown](Task::is_shown) and no checkpoint spared its simulation.
    pub beginning: Option<Trajectory>,
}

/// What a task found, or why it failed.
pub(crate) type Outcome = Result<TaskOutput, String>;

/// Runs tasks whose results go to one folder.
pub(crate) struct Batch<'a> {
    /// The folder.
    pub out: &'a Path,
    /// Finished work.
    pub checkpoints: &'a Checkpoints,
    /// A bar as long as [`Batch::length`] says.
    pub bar: &'a ProgressBar,
}

/// Stages 1 to 5 of a task, with what an earlier one made of the same settings.
type ComputeMaps<'a> = &'a mut dyn FnMut() -> Result<Mapped, String>;

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
    pub(crate) fn length(tasks: &[Task]) -> u64 {
        tasks.iter().map(Task::length).sum()
    }

    /// Runs one task after the other, each on all threads, up to the first with files that fails; the outcome of one
    /// without files may be a failure.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub(crate) fn run_in_order(&self, tasks: &[Task]) -> Result<Vec<Outcome>, ExperimentError> {
        let progress: Vec<_> = tasks.iter().map(|_| TaskProgress::new(self.bar)).collect();
        std::thread::scope(|scope| {
            let mut all = Vec::with_capacity(tasks.len());
            let mut shared = StageCache::default();
            let mut prefetch = Prefetch::new(scope, tasks, &progress);
            for (at, (task, progress)) in tasks.iter().zip(&progress).enumerate() {
                self.bar.set_message(task.name.clone());
                // A failure is not kept among the checkpoints: what failed may succeed on a machine or with a library
                // that differs.
                let mut begun = None;
                let mut simulate = || {
                    let movement = prefetch.movement(at)?;
                    begun = task.is_shown().then(|| beginning(&movement, &task.settings));
                    Ok(movement)
                };
                let mut map =
                    || shared.map(&task.settings, task.simulation, &task.dimensions(), &mut simulate);
                let outcome = match self.run_task(task, &mut map, progress) {
                    Ok(found) => Ok(TaskOutput { beginning: begun, ..found }),
                    Err(Stop::Failed(reason)) if task.keep == Keep::Nothing => Err(reason),
                    Err(Stop::Failed(reason)) => return Err(ExperimentError::Stage(reason)),
                    Err(Stop::File(error)) => return Err(error.into()),
                };
                progress.complete(task);
                if !tasks.get(at + 1).is_some_and(|next| next.shares_movement(task)) {
                    shared = StageCache::default();
                }
                all.push(outcome);
            }
            Ok(all)
        })
    }

    /// Runs as many groups of tasks at once as there are threads, the tasks of a group after each other: those that share a movement.
    /// Each group takes as much memory as the pressures of one simulation, 0.5 GB at full size. When a group is finished, its
    /// place and its outcomes are handed to `keep`.
    ///
    /// # Errors
    /// If a file cannot be written, or `keep` fails.
    pub(crate) fn run_groups(
        &self,
        groups: &[Vec<Task>],
        keep: &(dyn Fn(usize, Vec<Outcome>) -> Result<(), FileError> + Sync),
    ) -> Result<(), FileError> {
        let trouble: Mutex<Option<FileError>> = Mutex::new(None);
        let next = AtomicUsize::new(0);
        let work = || {
            loop {
                let at = next.fetch_add(1, Ordering::Relaxed);
                let Some(group) = groups.get(at) else { return };
                let mut shared = StageCache::default();
                let outcomes: Result<Vec<Outcome>, FileError> =
                    group.iter().map(|task| self.finish(task, &mut shared)).collect();
                if let Err(error) = outcomes.and_then(|outcomes| keep(at, outcomes)) {
                    next.store(groups.len(), Ordering::Relaxed);
                    trouble.lock().expect("no worker panics").get_or_insert(error);
                    return;
                }
            }
        };
        // Not by the pool's threads: one that waits for its own work would begin another movement meanwhile, and
        // with it take as much memory again.
        std::thread::scope(|scope| {
            (0..rayon::current_num_threads()).for_each(|_| drop(scope.spawn(work)));
        });
        trouble.into_inner().expect("no worker panics").map_or(Ok(()), Err)
    }

    /// Does what is left of a task, and keeps a failure, so that it is not tried again.
    fn finish(&self, task: &Task, shared: &mut StageCache) -> Result<Outcome, FileError> {
        let progress = TaskProgress::new(self.bar);
        let mut map =
            || shared.map(&task.settings, task.simulation, &task.dimensions(), || task.simulate(&progress));
        let failed = format!("{}/failed", task.name);
        let outcome = match self.checkpoints.recall(&failed) {
            Some(reason) => Err(reason),
            None => match self.run_task(task, &mut map, &progress) {
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

    fn run_task(&self, task: &Task, map: ComputeMaps, progress: &TaskProgress) -> Result<TaskOutput, Stop> {
        let mut found = TaskOutput::default();
        let mut body = None;
        if task.keep != Keep::Nothing {
            let files = ArtifactFiles { out: self.out, checkpoints: self.checkpoints, name: &task.name };
            let (mapped, kept) = match files.recall(&task.settings) {
                Some(recalled) => recalled,
                None => {
                    let mapped = map().map_err(Stop::Failed)?;
                    files.write(mapped, task.keep == Keep::MapsAndDistances)?
                }
            };
            (body, found.kept) = (Some(mapped), Some(kept));
        }
        for &condition in &task.conditions {
            let inference = self.infer(task, condition, &mut body, map, progress)?;
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
        body: &mut Option<MappedBody>,
        map: ComputeMaps,
        progress: &TaskProgress,
    ) -> Result<Inference, Stop> {
        let name = format!("{}/{}-{}", task.name, condition.model.name(), condition.dimension);
        if let Some(finished) = self.checkpoints.recall(&name) {
            progress.add(task.settings.schema.chains as u64);
            return Ok(finished);
        }
        let body = match body {
            Some(body) => body,
            none => none.insert(map().map_err(Stop::Failed)?.body),
        };
        let tick = || progress.add(1);
        let found = infer_and_score(body, condition, &task.settings, task.simulation, &tick)?;
        self.checkpoints.keep(&name, &found)?;
        Ok(found)
    }

    /// The clusterings on one body map.
    fn cluster(&self, task: &Task, body: &MappedBody, dimension: usize) -> Result<Vec<BaselineRecord>, Stop> {
        let name = format!("{}/baselines-{dimension}", task.name);
        if let Some(finished) = self.checkpoints.recall(&name) {
            return Ok(finished);
        }
        let found = cluster_and_score(body, dimension, &task.settings, task.simulation);
        self.checkpoints.keep(&name, &found)?;
        Ok(found)
    }
}
