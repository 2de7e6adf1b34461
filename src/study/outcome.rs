//! What the simulations of one configuration gave.

use crate::analysis::conditions::Conditions;
use crate::analysis::measure::Evidence;
use crate::analysis::published::Experiment;
use crate::pipeline::Record;
use crate::settings::Settings;
use crate::stages::schema::Model;
use crate::stages::simulate::Resolution;

/// What a configuration gave in its `experiment.simulations` simulations.
#[derive(Debug, Clone, Default)]
pub(super) struct Outcome {
    /// All evaluated samples of the tasks that did not fail.
    pub records: Vec<Record>,
    /// Tasks that failed: unstable movement, or distances without a map of the dimensions.
    pub failures: Vec<Failure>,
    /// How well the physics step resolved the movements of the others: the worst of them in each respect.
    pub resolution: Resolution,
}

/// A task that failed.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Failure {
    /// p.
    pub coordination: f64,
    /// Why.
    pub reason: String,
}

impl Outcome {
    /// Whether nothing failed and the physics step resolves all movements.
    pub(super) fn is_resolved(&self) -> bool {
        self.failures.is_empty() && self.resolution.is_resolved()
    }

    /// Why the first failure failed; empty without one.
    pub(super) fn first_reason(&self) -> String {
        self.failures.first().map_or(String::new(), |failure| failure.reason.clone())
    }

    /// The samples that `counts` keeps, by condition, with intervals over simulations.
    pub(super) fn conditions(&self, settings: &Settings, counts: impl Fn(&Record) -> bool) -> Conditions {
        let records = self.records.iter().copied().filter(counts).collect();
        Conditions::new(records, settings.experiment.simulations, settings.experiment.seed)
    }

    /// The samples that belong to an experiment; none if a task failed, for what some simulations gave says nothing of a
    /// configuration in which others failed.
    pub(super) fn evidence(&self, experiment: Experiment, settings: &Settings) -> Evidence {
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
