//! The rows of a comparison's table: a claim as one configuration has it, and how far that is from the first one.

use serde::{Deserialize, Serialize};

use super::super::compared::Compared;
use super::super::configurations::Outcome;
use crate::analysis::cells::{EstimateCells, number_or_empty};
use crate::analysis::claims::{Verdict, judge_claim};
use crate::analysis::paired::change;
use crate::analysis::published::{Claim, Experiment};
use crate::settings::Settings;

/// A claim as one configuration has it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Name of the configuration.
    pub configuration: String,
    /// Short name of the claim.
    pub claim: String,
    /// The experiment that it is judged by.
    pub experiment: Experiment,
    /// Lower end of the range that counts as reproduced.
    pub accepted_low: f64,
    /// Upper end of that range.
    pub accepted_high: f64,
    /// The value; of several, that which lies farthest towards the outside of the range.
    pub value: Option<f64>,
    /// What it is over, and its interval.
    #[serde(flatten)]
    pub cells: EstimateCells,
    /// Where it was found.
    pub found: String,
    /// Whether it is in the range.
    pub verdict: Verdict,
    /// The value minus that of the first configuration.
    #[serde(deserialize_with = "number_or_empty")]
    pub change: Option<f64>,
    /// Lower end of the change's 95 % interval.
    #[serde(deserialize_with = "number_or_empty")]
    pub change_low: Option<f64>,
    /// Upper end of the change's 95 % interval.
    #[serde(deserialize_with = "number_or_empty")]
    pub change_high: Option<f64>,
    /// Whether the physics step resolves all movements.
    pub resolved: bool,
    /// Movements that failed.
    pub failed: usize,
    /// The first failure's reason.
    pub failure: String,
}

/// What one configuration gave.
pub struct Tried<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its settings.
    pub settings: &'a Settings,
    /// What became of its simulations.
    pub outcome: &'a Outcome,
}

impl Tried<'_> {
    /// The row of a claim.
    pub fn row(&self, claim: &Claim, compared: &Compared, first: &Self) -> Row {
        let experiment = compared.experiment;
        let evidence = |tried: &Self| tried.outcome.evidence(experiment, tried.settings);
        let own = evidence(self);
        let (found, place, verdict) = judge_claim(claim, &own);
        let change = if self.name == first.name {
            None
        } else {
            change(claim, &evidence(first), &own, self.settings.experiment.seed)
        };
        let (change, ends) = change.unzip();
        let (change_low, change_high) = ends.flatten().unzip();
        let (accepted_low, accepted_high) = claim.accept.expect("the design was checked");
        let failures = &self.outcome.failures;
        Row {
            configuration: self.name.to_owned(),
            claim: claim.id.clone(),
            experiment,
            accepted_low,
            accepted_high,
            value: found.value,
            cells: (&found).into(),
            found: place,
            verdict,
            change,
            change_low,
            change_high,
            resolved: failures.is_empty() && self.outcome.resolution.is_resolved(),
            failed: failures.len(),
            failure: failures.first().map_or(String::new(), |failure| failure.reason.clone()),
        }
    }
}
