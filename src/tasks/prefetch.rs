//! Simulate the next movements, by threads of their own, while others work on the last.

use std::collections::VecDeque;
use std::thread::{Scope, ScopedJoinHandle};

use super::task::{Task, TaskProgress};
use crate::stages::simulate::Trajectory;

/// Movements that are simulated or wait at a time, at most: each takes some 50 MB.
const MOST_PREFETCHED: usize = 8;

/// The movements of a list of tasks, of which the next ones, as many as there are threads, are simulated while the last is
/// inferred from. A simulation has one thread, so that one at a time would leave the others idle.
pub(super) struct Prefetch<'scope, 'env> {
    scope: &'scope Scope<'scope, 'env>,
    tasks: &'env [Task],
    progress: &'env [TaskProgress<'env>],
    /// The tasks whose movements are simulated, and the threads that do so, in order.
    begun: VecDeque<(usize, ScopedJoinHandle<'scope, Result<Trajectory, String>>)>,
}

impl<'scope, 'env> Prefetch<'scope, 'env> {
    /// Of some tasks, those with the same movement side by side.
    pub(super) fn new(
        scope: &'scope Scope<'scope, 'env>,
        tasks: &'env [Task],
        progress: &'env [TaskProgress<'env>],
    ) -> Self {
        Self { scope, tasks, progress, begun: VecDeque::new() }
    }

    /// The movement of the task at this place of the list. Those that the tasks after it need are begun, in the hope that no
    /// checkpoint has what is to be inferred from them.
    pub(super) fn movement(&mut self, at: usize) -> Result<Trajectory, String> {
        let (tasks, progress) = (self.tasks, self.progress);
        // Those that were begun for tasks that a checkpoint had.
        while self
            .begun
            .front()
            .is_some_and(|(next, _)| *next < at && !tasks[*next].shares_movement(&tasks[at]))
        {
            self.begun.pop_front();
        }
        let movement = match self.begun.pop_front() {
            Some((next, thread)) if tasks[next].shares_movement(&tasks[at]) => {
                thread.join().expect("no simulation panics")
            }
            other => {
                other.into_iter().for_each(|begun| self.begun.push_front(begun));
                tasks[at].simulate(&progress[at])
            }
        };
        self.begin_after(at);
        movement
    }

    fn begin_after(&mut self, at: usize) {
        let threads = rayon::current_num_threads();
        let (tasks, progress) = (self.tasks, self.progress);
        let most = if threads > 1 { threads.min(MOST_PREFETCHED) } else { 0 };
        while self.begun.len() < most {
            let last = self.begun.back().map_or(at, |(last, _)| *last);
            let Some(next) = (last + 1..tasks.len()).find(|&next| !tasks[next].shares_movement(&tasks[last]))
            else {
                break;
            };
            self.begun.push_back((next, self.scope.spawn(move || tasks[next].simulate(&progress[next]))));
        }
    }
}
