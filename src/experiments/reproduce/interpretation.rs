//! Infer the headline by the other interpretation of the paper as well, on the same simulations.

use super::run::Run;
use crate::analysis::claims::{Judged, headline};
use crate::analysis::conditions::Conditions;
use crate::analysis::measure::Evidence;
use crate::analysis::published::{HEADLINE, Measure, claims};
use crate::pipeline::{Condition, Record};
use crate::settings::{Settings, SettingsError};
use crate::stages::schema::{Model, Sampler};
use crate::tasks::batch::Outcome;
use crate::tasks::task::{Keep, Task};

/// `reproduce/authors.toml`.
const AUTHORS: &str = include_str!("../../../reproduce/authors.toml");

/// `reproduce/equations.toml`.
const EQUATIONS: &str = include_str!("../../../reproduce/equations.toml");

/// The headline by the other interpretation of the paper. It does not count: where it fails, its claim says why, and the run goes
/// on.
pub(super) struct OtherInterpretation {
    /// The interpretation.
    sampler: Sampler,
    /// One task for each simulation.
    tasks: Vec<Task>,
    /// Why there is none.
    problem: Option<String>,
}

impl OtherInterpretation {
    /// The headline's condition by the interpretation that the run does not follow; `None` if the run has not this condition.
    pub(super) fn of(run: &Run, tasks: &[Task]) -> Option<Self> {
        let condition = condition();
        let same: Vec<&Task> = tasks.iter().filter(|task| task.conditions.contains(&condition)).collect();
        let sampler = other_than(run.settings.schema.sampler);
        let task = |task: &&Task| -> Result<Task, SettingsError> {
            Ok(Task {
                name: format!("other-reading/simulation-{}", task.simulation),
                settings: by(sampler, &task.settings)?,
                conditions: vec![condition],
                clustered: Vec::new(),
                keep: Keep::Nothing,
                ..(**task).clone()
            })
        };
        let (tasks, problem) = match same.iter().map(task).collect() {
            Ok(tasks) => (tasks, None),
            Err(error) => (Vec::new(), Some(error.to_string())),
        };
        (!same.is_empty()).then_some(Self { sampler, tasks, problem })
    }

    /// The tasks of the run, each followed by that of this interpretation which shares its movement.
    pub(super) fn behind(&self, tasks: &[Task]) -> Vec<Task> {
        let shares = |task: &Task, other: &Task| {
            let p = |task: &Task| task.settings.motion.coordination;
            other.simulation == task.simulation && p(other) == p(task)
        };
        let own = |task: &Task| self.tasks.iter().find(|other| shares(task, other)).cloned();
        tasks.iter().flat_map(|task| std::iter::once(task.clone()).chain(own(task))).collect()
    }

    /// By how many chains the headline is inferred, in words.
    pub(super) fn in_words(&self) -> String {
        let Some(Task { settings, .. }) = self.tasks.first() else { return String::new() };
        let (chains, sweeps) = (settings.schema.chains, settings.schema.sweeps);
        format!(" For the headline, the {} uses {chains} chains of {sweeps} sweeps.", self.sampler.in_words())
    }

    /// All its posterior samples, and the headline by them.
    pub(super) fn judge(&self, run: &Run, outcomes: Vec<Outcome>) -> (Vec<Record>, Judged) {
        let mut problem = self.problem.clone();
        let mut records = Vec::new();
        for outcome in outcomes {
            match outcome {
                Ok(found) => records.extend(found.records),
                Err(reason) => problem = Some(reason),
            }
        }
        if problem.is_some() {
            records.clear();
        }
        let experiment = &run.settings.experiment;
        let conditions = Conditions::new(records.clone(), experiment.simulations, experiment.seed);
        let evidence = Evidence { conditions, baselines: Vec::new(), reading: self.sampler };
        let mut judged = headline(run.experiment, &evidence);
        if let Some(reason) = problem {
            judged.place = reason;
        }
        (records, judged)
    }
}

/// The interpretation that stands beside that of a run.
pub(super) fn other_than(sampler: Sampler) -> Sampler {
    match sampler {
        Sampler::Equations | Sampler::SplitMerge => Sampler::AuthorsCode,
        Sampler::AuthorsCode => Sampler::Equations,
    }
}

/// The condition that the headline is about.
fn condition() -> Condition {
    let claim = claims().into_iter().find(|claim| claim.id == HEADLINE).expect("it is published");
    let Measure::TreeRate { at } = claim.measure else { unreachable!("the headline is a rate of trees") };
    Condition { model: Model::DpgmmLj, coordination: at.coordinations[0], dimension: at.dimensions[0] }
}

/// The same simulation, mapped and inferred from by another interpretation, with as many posterior samples.
fn by(sampler: Sampler, settings: &Settings) -> Result<Settings, SettingsError> {
    let mut other = match sampler {
        Sampler::AuthorsCode => settings.with(AUTHORS, "reproduce/authors.toml"),
        Sampler::Equations | Sampler::SplitMerge => settings.with(EQUATIONS, "reproduce/equations.toml"),
    }?;
    other.schema.chains = settings.schema.posterior_samples();
    other.validate()?;
    Ok(other)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_interpretation_has_the_other() {
        let mut equations = Settings::paper().with(EQUATIONS, "equations").unwrap();
        // Beyond what a number in a settings file can be.
        equations.experiment.seed = u64::MAX;
        let authors = by(Sampler::AuthorsCode, &equations).unwrap();
        assert_eq!(authors.schema.sampler, Sampler::AuthorsCode);
        assert_eq!(by(Sampler::Equations, &authors).unwrap(), equations);
        assert_eq!((&authors.agent, &authors.motion), (&equations.agent, &equations.motion));
    }

    #[test]
    fn the_headline_is_at_the_published_condition() {
        let Condition { coordination, dimension, .. } = condition();
        assert_eq!((coordination, dimension), (0.9, 14));
    }
}
