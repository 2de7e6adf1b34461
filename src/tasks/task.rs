//! Say what is to be inferred from one movement of one body, and which tasks share work.

use std::cell::Cell;
use std::collections::HashMap;
use std::sync::atomic::{AtomicU64, Ordering};

use indicatif::ProgressBar;

use super::cache::Keys;
use crate::pipeline::{Condition, simulate_movement};
use crate::settings::Settings;
use crate::stages::simulate::Trajectory;

/// Steps of the progress bar that a movement counts for.
const MOVEMENT_STEPS: u64 = 100;

/// What is inferred from one movement of one body.
#[derive(Debug, Clone)]
pub(crate) struct Task {
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
pub(crate) enum Keep {
    /// No file: only what is inferred counts.
    Nothing,
    /// The truth and the body maps.
    Maps,
    /// The truth, the body maps and the distances.
    MapsAndDistances,
}

impl Task {
    /// d of its body maps, rising.
    pub(crate) fn dimensions(&self) -> Vec<usize> {
        let inferred = self.conditions.iter().map(|condition| condition.dimension);
        let mut all: Vec<usize> = inferred.chain(self.clustered.iter().copied()).collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// Whether figures and the viewer show how its movement begins: that of the first simulation whose files are results.
    pub(crate) fn is_shown(&self) -> bool {
        self.simulation == 1 && self.keep != Keep::Nothing
    }

    /// Whether another task needs the same movement.
    pub(crate) fn shares_movement(&self, other: &Self) -> bool {
        let key = |task: &Self| Keys::of(&task.settings, task.simulation, &[]).movement;
        key(self) == key(other)
    }

    /// Steps of the progress bar: one for each chain, and some for the movement.
    pub(crate) fn length(&self) -> u64 {
        MOVEMENT_STEPS + (self.conditions.len() * self.settings.schema.chains) as u64
    }

    /// Simulates its movement.
    ///
    /// # Errors
    /// Why that failed.
    pub(crate) fn simulate(&self, progress: &TaskProgress) -> Result<Trajectory, String> {
        let samples = self.settings.physics.samples(self.settings.sense.interval) + 1;
        let seen = Cell::new(0);
        let tick = || {
            let (before, now) = (seen.get(), seen.get() + 1);
            seen.set(now);
            let steps = |seen: usize| MOVEMENT_STEPS * seen as u64 / samples as u64;
            progress.add(steps(now) - steps(before));
        };
        simulate_movement(&self.settings, self.simulation, &tick).map_err(|error| error.to_string())
    }
}

/// Progress of one task, of which some may be done already, or never.
pub(crate) struct TaskProgress<'a> {
    bar: &'a ProgressBar,
    done: AtomicU64,
}

impl<'a> TaskProgress<'a> {
    pub(crate) fn new(bar: &'a ProgressBar) -> Self {
        Self { bar, done: AtomicU64::new(0) }
    }

    pub(crate) fn add(&self, steps: u64) {
        self.done.fetch_add(steps, Ordering::Relaxed);
        self.bar.inc(steps);
    }

    pub(crate) fn complete(&self, task: &Task) {
        self.bar.inc(task.length().saturating_sub(self.done.load(Ordering::Relaxed)));
    }
}

/// Places of the tasks in their list, those together that need the same movement, and of these those after each other that
/// need the same pressures, distances and maps.
pub(crate) fn by_movement(tasks: &[Task]) -> Vec<Vec<usize>> {
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
