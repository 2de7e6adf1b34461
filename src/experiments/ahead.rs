//! Simulate the next movement, by a thread of its own, while the others work on the last.

use std::thread::{Scope, ScopedJoinHandle};

use super::task::{Task, TaskProgress};
use crate::stages::simulate::Trajectory;

/// The movements of a list of tasks, of which the next is simulated while the last is inferred from. Two trajectories are in
/// memory at a time.
pub struct Ahead<'scope, 'env> {
    pub scope: &'scope Scope<'scope, 'env>,
    pub tasks: &'env [Task],
    pub progress: &'env [TaskProgress<'env>],
    /// The task whose movement is simulated, and the thread that does so.
    pub next: Option<(usize, ScopedJoinHandle<'scope, Result<Trajectory, String>>)>,
}

impl Ahead<'_, '_> {
    /// The movement of the task at this place of the list. That of the first one after it that needs another is begun, in
    /// the hope that no checkpoint has what is to be inferred from it.
    pub fn movement(&mut self, at: usize) -> Result<Trajectory, String> {
        let (tasks, progress) = (self.tasks, self.progress);
        let movement = match self.next.take() {
            Some((next, thread)) if self.tasks[next].shares_movement(&self.tasks[at]) => {
                thread.join().expect("no simulation panics")
            }
            _ => tasks[at].simulate(&progress[at]),
        };
        let next = (at + 1..tasks.len()).find(|&next| !tasks[next].shares_movement(&tasks[at]));
        if let Some(next) = next.filter(|_| rayon::current_num_threads() > 1) {
            let thread = self.scope.spawn(move || tasks[next].simulate(&progress[next]));
            self.next = Some((next, thread));
        }
        movement
    }
}
