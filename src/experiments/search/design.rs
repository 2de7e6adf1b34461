//! Read the design of a search: its score, its rounds, and the candidates that it tries.

use rand::RngExt;
use serde::Deserialize;
use toml::Table;

use super::super::design::merge;
use super::super::error::ExperimentError;
use crate::analysis::published::{Claim, Experiment, claims};
use crate::numerics::rng::stream;
use crate::settings::{Settings, SettingsError};

/// What is searched, how, and by which score.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Design {
    /// Master seed of every candidate and of the draws of candidates: a calibration seed.
    pub seed: u64,
    /// Number of candidates drawn at random.
    pub candidates: usize,
    /// The terms of the score.
    pub score: Vec<Term>,
    /// Rounds, in their order.
    pub round: Vec<Round>,
    /// Named candidates.
    pub start: Vec<Candidate>,
    /// What is drawn at random: one option of each.
    pub factor: Vec<Factor>,
}

/// A claim that counts.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Term {
    /// Short name of the claim.
    pub claim: String,
    /// The experiment that it is judged by.
    pub experiment: Experiment,
    /// Its share of the score, before division by the sum of all.
    pub weight: f64,
    /// Distance from the accepted range at which no credit is left; credit falls linearly up to there.
    pub slack: f64,
}

/// A round of the search.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Round {
    /// Candidates that it tries: the best of the round before.
    pub candidates: usize,
    /// What it lays over `reproduce/paper.toml`, below the candidate's own settings.
    pub settings: Table,
}

/// A candidate for the default settings.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Candidate {
    /// Its name.
    pub name: String,
    /// Its settings that differ from `reproduce/paper.toml`.
    pub settings: Table,
}

/// An open setting and the values that are tried.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Factor {
    #[expect(dead_code, reason = "for the reader of the design")]
    name: String,
    options: Vec<Table>,
}

impl Design {
    /// Reads a design; `origin` says where it is from.
    ///
    /// # Errors
    /// If it is no design, or names what is not there.
    pub fn parse(text: &str, origin: &str) -> Result<Self, ExperimentError> {
        let wrong = |message: String| ExperimentError::design(origin, message);
        let design: Self = toml::from_str(text).map_err(|error| wrong(error.to_string()))?;
        if design.round.is_empty() || design.score.is_empty() {
            return Err(wrong("needs a [[round]] and a [[score]] at least".to_owned()));
        }
        if design.candidates > 0 && design.factor.iter().any(|factor| factor.options.is_empty()) {
            return Err(wrong("has a factor without options".to_owned()));
        }
        let claims = claims();
        design.score.iter().try_for_each(|term| term.check(&claims)).map_err(wrong)?;
        Ok(design)
    }

    /// All candidates: those with a name, then those drawn at random, each once.
    pub fn all_candidates(&self) -> Vec<Candidate> {
        let mut all = self.start.clone();
        for number in 1..=self.candidates {
            let mut rng = stream(self.seed, 0, "candidate", number);
            let mut settings = Table::new();
            for factor in &self.factor {
                merge(&mut settings, &factor.options[rng.random_range(0..factor.options.len())]);
            }
            if all.iter().all(|other| other.settings != settings) {
                all.push(Candidate { name: format!("R{number:02}"), settings });
            }
        }
        all
    }

    /// The settings of a candidate in a round.
    ///
    /// # Errors
    /// If they cannot be used.
    pub fn settings(&self, round: &Round, candidate: &Candidate) -> Result<Settings, SettingsError> {
        let origin = format!("the search's candidate {}", candidate.name);
        let mut settings = Settings::overlaid([&round.settings, &candidate.settings], &origin)?;
        settings.experiment.seed = self.seed;
        Ok(settings)
    }

    /// Whether every candidate can be tried in every round.
    ///
    /// # Errors
    /// If the settings of one cannot be used.
    pub fn check(&self) -> Result<(), ExperimentError> {
        let candidates = self.all_candidates();
        let mut pairs = self.round.iter().flat_map(|round| candidates.iter().map(move |one| (round, one)));
        pairs.try_for_each(|(round, candidate)| Ok(self.settings(round, candidate).map(drop)?))
    }
}

impl Term {
    /// Whether it names a claim that the experiment judges by a range.
    fn check(&self, claims: &[Claim]) -> Result<(), String> {
        let known = |claim: &Claim| {
            claim.id == self.claim && claim.experiments.contains(&self.experiment) && claim.accept.is_some()
        };
        if !claims.iter().any(known) {
            return Err(format!("no claim `{}` of this experiment has a range", self.claim));
        }
        if !(self.weight > 0.0 && self.slack > 0.0) {
            return Err(format!("weight and slack of `{}` must be positive", self.claim));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::design::SEARCH;
    use super::*;

    #[test]
    fn the_design_of_the_repository_can_be_run() {
        Design::parse(SEARCH, "search.toml").unwrap().check().unwrap();
    }
}
