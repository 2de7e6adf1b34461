//! Read the design of a search: its score, its rounds, and the candidates that it tries.

use std::collections::HashSet;

use rand::RngExt;
use serde::{Deserialize, Serialize};
use toml::Table;

use super::super::design::{SEARCH, flat, merge};
use super::super::draws::{Draws, Level};
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
    /// How many candidates are drawn at random.
    pub draws: Draws,
    /// The terms of the score; without any, those of `reproduce/search.toml`, so that every part of the search has one score.
    #[serde(default)]
    pub score: Vec<Term>,
    /// Rounds, in their order.
    pub round: Vec<Round>,
    /// Named candidates.
    #[serde(default)]
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
#[derive(Debug, Clone, Serialize, Deserialize)]
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
    decides: Level,
    options: Vec<Table>,
}

/// The candidates that go on to a round, which a search writes for one that continues it elsewhere.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Continuation {
    /// The round that they go on to, from 1.
    pub round: usize,
    /// The candidates, the best first.
    pub start: Vec<Candidate>,
}

impl Continuation {
    /// Reads what a search wrote; `origin` says where it is from.
    ///
    /// # Errors
    /// If it is no such file, or `design` has no such round.
    pub fn parse(text: &str, origin: &str, design: &Design) -> Result<Self, ExperimentError> {
        let continuation: Self =
            toml::from_str(text).map_err(|error| ExperimentError::design(origin, error))?;
        let round = continuation.round;
        if !(1..=design.round.len()).contains(&round) {
            let message = format!("continues with round {round}, which the design lacks");
            return Err(ExperimentError::design(origin, message));
        }
        if continuation.start.is_empty() {
            return Err(ExperimentError::design(origin, "names no candidate ([[start]]) to continue with"));
        }
        Ok(continuation)
    }
}

impl Design {
    /// Reads a design; `origin` says where it is from.
    ///
    /// # Errors
    /// If it is no design, or names what is not there.
    pub fn parse(text: &str, origin: &str) -> Result<Self, ExperimentError> {
        let wrong = |message: String| ExperimentError::design(origin, message);
        let read = |text: &str| toml::from_str::<Self>(text).map_err(|error| wrong(error.to_string()));
        let mut design = read(text)?;
        if design.score.is_empty() {
            design.score = read(SEARCH)?.score;
        }
        if design.round.is_empty() {
            return Err(wrong("needs at least one [[round]]".to_owned()));
        }
        if design.round.iter().any(|round| round.candidates == 0) {
            return Err(wrong("has a [[round]] with candidates = 0; use at least 1".to_owned()));
        }
        if design.draws.movements > 0 && design.factor.iter().any(|factor| factor.options.is_empty()) {
            return Err(wrong("has a factor without options".to_owned()));
        }
        let claims = claims();
        design.score.iter().try_for_each(|term| term.check(&claims)).map_err(wrong)?;
        Ok(design)
    }

    /// All candidates: those with a name, then those drawn at random, each once.
    pub fn all_candidates(&self) -> Vec<Candidate> {
        let mut all = self.start.clone();
        let mut known: HashSet<String> =
            all.iter().map(|candidate| flat(&candidate.settings).join(",")).collect();
        let Draws { movements, distances, maps, inferences } = self.draws;
        for movement in 1..=movements {
            let moved = self.draw(Level::Movement, &Table::new(), [0, movement]);
            for distance in 1..=distances {
                let felt = self.draw(Level::Distances, &moved, [movement, distance]);
                let felt_as = movement * distances + distance;
                for inference in 1..=maps * inferences {
                    let mapped = self.draw(Level::Map, &felt, [felt_as, inference.div_ceil(inferences)]);
                    let settings = self.draw(Level::Inference, &mapped, [felt_as, inference]);
                    if known.insert(flat(&settings).join(",")) {
                        all.push(Candidate { name: format!("{movement}-{distance}-{inference}"), settings });
                    }
                }
            }
        }
        all
    }

    /// Lays an option of each factor of one kind, drawn at random, over `settings`.
    fn draw(&self, decides: Level, settings: &Table, [branch, number]: [usize; 2]) -> Table {
        let mut rng = stream(self.seed, branch, &format!("{decides:?}"), number);
        let mut settings = settings.clone();
        for factor in self.factor.iter().filter(|factor| factor.decides == decides) {
            merge(&mut settings, &factor.options[rng.random_range(0..factor.options.len())]);
        }
        settings
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
    pub fn check(&self, candidates: &[Candidate]) -> Result<(), ExperimentError> {
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
    use super::super::super::design::PARTS_IN_FLUID;
    use super::*;

    #[test]
    fn the_design_of_the_repository_can_be_run() {
        let design = Design::parse(SEARCH, "search.toml").unwrap();
        let candidates = design.all_candidates();
        design.check(&candidates).unwrap();
        assert!(candidates.len() > 2000, "{} candidates", candidates.len());
    }

    #[test]
    fn its_parts_in_a_fluid_have_its_score_and_seeds_of_their_own() {
        let terms = |design: &Design| format!("{:?}", design.score);
        let first = Design::parse(SEARCH, "search.toml").unwrap();
        let mut seeds = HashSet::from([first.seed]);
        for part in PARTS_IN_FLUID {
            let part = Design::parse(part, "a part in a fluid").unwrap();
            part.check(&part.all_candidates()).unwrap();
            assert_eq!(terms(&part), terms(&first));
            assert!(seeds.insert(part.seed), "seed {}", part.seed);
        }
    }
}
