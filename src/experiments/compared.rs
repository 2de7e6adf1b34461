//! Name a claim that configurations are compared by.

use serde::Deserialize;

use crate::analysis::published::{Claim, Experiment, Measure};

/// A claim that configurations are compared by.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Compared {
    /// Its short name.
    pub id: String,
    /// The experiment that it is judged by.
    pub experiment: Experiment,
    /// What stands above its column, in two lines at most.
    pub label: String,
}

impl Compared {
    /// The claim.
    pub fn find<'a>(&self, claims: &'a [Claim]) -> Option<&'a Claim> {
        let same = |claim: &&Claim| claim.id == self.id && claim.experiments.contains(&self.experiment);
        claims.iter().find(same).filter(|claim| claim.accept.is_some() && is_of_draws(&claim.measure))
    }

    /// Whether every one names a claim with a range.
    ///
    /// # Errors
    /// Which one does not.
    pub fn check(all: &[Self], claims: &[Claim]) -> Result<(), String> {
        let Some(unknown) = all.iter().find(|compared| compared.find(claims).is_none()) else {
            return Ok(());
        };
        let (id, experiment) = (&unknown.id, unknown.experiment.name());
        let rule = "is not a claim of that experiment with an accepted range for values of its samples";
        Err(format!("names `{id}` of {experiment}, which {rule}; see reproduce/published.toml"))
    }
}

/// Whether it is a value of draws alone, and no test of them.
fn is_of_draws(measure: &Measure) -> bool {
    !matches!(
        measure,
        Measure::BaselineShare { .. }
            | Measure::BaselineLoss { .. }
            | Measure::TreeDependence {}
            | Measure::Nothing { .. }
    )
}
