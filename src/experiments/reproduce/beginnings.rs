//! Gather how the first simulation begins at each p that figures 4 and 5 and the viewer show.

use super::run::Run;
use crate::analysis::published::Experiment;
use crate::stages::simulate::Trajectory;
use crate::tasks::batch::TaskOutput;
use crate::tasks::beginning::simulate_beginning;
use crate::tasks::error::ExperimentError;
use crate::tasks::task::Task;

/// The first seconds of the first simulation, at one p after the other.
#[derive(Debug, Default)]
pub(super) struct Beginnings(Vec<(f64, Trajectory)>);

impl Beginnings {
    /// Those that no task of the run simulates: figure 5 is of experiment 1, which has one p, and shows those of
    /// experiment 2. At the others, nothing but the beginning is simulated.
    ///
    /// # Errors
    /// If a simulation is unstable.
    pub(super) fn of_other_coordinations(run: &Run) -> Result<Self, ExperimentError> {
        if run.experiment == Experiment::Exp2 {
            return Ok(Self::default());
        }
        let mut settings = run.settings.clone();
        let own = settings.motion.coordination;
        let others = run.settings.experiment.coordinations.iter().copied().filter(|p| *p != own);
        let simulate = |p: f64| {
            settings.motion.coordination = p;
            Ok((p, simulate_beginning(&settings, 1)?))
        };
        Ok(Self(others.map(simulate).collect::<Result<_, ExperimentError>>()?))
    }

    /// Adds those of the run's own tasks. Where a checkpoint spared a task its simulation, the beginning is simulated again.
    ///
    /// # Errors
    /// If a simulation is unstable.
    pub(super) fn add(&mut self, tasks: &[Task], found: &mut [TaskOutput]) -> Result<(), ExperimentError> {
        for (task, found) in tasks.iter().zip(found).filter(|(task, _)| task.is_shown()) {
            let trajectory = match found.beginning.take() {
                Some(kept) => kept,
                None => simulate_beginning(&task.settings, task.simulation)?,
            };
            self.0.push((task.settings.motion.coordination, trajectory));
        }
        Ok(())
    }

    /// The one at p.
    ///
    /// # Panics
    /// If there is none.
    pub(super) fn at(&self, coordination: f64) -> &Trajectory {
        let found = self.0.iter().find(|(p, _)| *p == coordination);
        &found.expect("every p that is shown was simulated").1
    }
}
