//! A search design → the configuration that satisfies most of the paper's claims, and which claims conflict.
//!
//! Candidates are named starting points and random draws from a space of options (Bergstra & Bengio, "Random
//! search for hyper-parameter optimization", 2012). They are tried in rounds, of which each keeps the best and
//! tries them harder (successive halving: Jamieson & Talwalkar, 2016). The score was written down, in
//! `reproduce/search.toml`, before the first run.

use std::fmt::Write as _;
use std::path::Path;

use rand::RngExt;
use serde::{Deserialize, Serialize};
use toml::{Table, Value};

use super::{Outcome, StudyError, run, write_manifest};
use crate::claims::{self, Claim, Evidence, Judged, Verdict, table};
use crate::record::{tables, write_text};
use crate::reproduce::Experiment;
use crate::schema::Model;
use crate::settings::{Settings, SettingsError};
use crate::streams::stream;

/// `reproduce/search.toml`, the design of the search that the default comes from.
pub const DESIGN: &str = include_str!("../../reproduce/search.toml");

/// What is searched, how, and by which score.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Design {
    /// Master seed of every candidate and of the draws of candidates: a calibration seed.
    pub seed: u64,
    /// Number of candidates drawn at random.
    candidates: usize,
    /// The terms of the score.
    score: Vec<Term>,
    /// Rounds, in their order.
    round: Vec<Round>,
    /// Named candidates.
    start: Vec<Start>,
    /// What is drawn at random: one option of each.
    factor: Vec<Factor>,
}

/// A claim that counts.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct Term {
    claim: String,
    experiment: Experiment,
    /// Its share of the score, before division by the sum of all.
    weight: f64,
    /// How far outside of the accepted range nothing is left of the credit, which falls linearly.
    slack: f64,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct Round {
    /// Candidates that it tries: the best of the round before.
    candidates: usize,
    /// What it lays over `reproduce/paper.toml`, below the candidate's own settings.
    settings: Table,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct Start {
    name: String,
    settings: Table,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct Factor {
    #[expect(dead_code, reason = "for the reader of the design")]
    name: String,
    options: Vec<Table>,
}

/// A candidate's fate in one round: a row of `scores.csv`.
#[derive(Debug, Clone, Serialize)]
struct ScoreRow {
    round: usize,
    rank: usize,
    candidate: String,
    score: f64,
    /// Terms of the score that are satisfied.
    satisfied: usize,
    terms: usize,
    /// Parts that failed.
    failures: usize,
    /// The first failure's reason.
    failure: String,
    settings: String,
}

/// A term of a candidate's score in one round: a row of `credits.csv`.
#[derive(Debug, Clone, Serialize)]
struct CreditRow {
    round: usize,
    candidate: String,
    claim: String,
    experiment: Experiment,
    weight: f64,
    accepted: String,
    value: Option<f64>,
    n: usize,
    low: Option<f64>,
    high: Option<f64>,
    simulations: usize,
    found: String,
    verdict: &'static str,
    credit: f64,
}

/// A candidate that has been tried.
struct Tried {
    start: Start,
    score: f64,
    failures: Vec<super::Failure>,
    terms: Vec<(Judged, f64)>,
}

impl Design {
    /// Reads a design; `origin` says where it is from.
    ///
    /// # Errors
    /// If it is no design, or names what is not there.
    pub fn parse(text: &str, origin: &str) -> Result<Self, StudyError> {
        let wrong = |message: String| StudyError::design(origin, &message);
        let design: Self = toml::from_str(text).map_err(|error| wrong(error.to_string()))?;
        if design.round.is_empty() || design.score.is_empty() {
            return Err(wrong("needs a [[round]] and a [[score]] at least".to_owned()));
        }
        if design.candidates > 0 && design.factor.iter().any(|factor| factor.options.is_empty()) {
            return Err(wrong("has a factor without options".to_owned()));
        }
        let claims = claims::published();
        for term in &design.score {
            let known = |claim: &Claim| {
                claim.id == term.claim
                    && claim.experiments.contains(&term.experiment)
                    && claim.accept.is_some()
            };
            if !claims.iter().any(known) {
                return Err(wrong(format!("no claim `{}` of this experiment has a range", term.claim)));
            }
            if !(term.weight > 0.0 && term.slack > 0.0) {
                return Err(wrong(format!("weight and slack of `{}` must be positive", term.claim)));
            }
        }
        Ok(design)
    }

    /// All candidates: those with a name, then those drawn at random, none twice.
    fn all_candidates(&self) -> Vec<Start> {
        let mut all = self.start.clone();
        for number in 1..=self.candidates {
            let mut rng = stream(self.seed, 0, "candidate", number);
            let mut settings = Table::new();
            for factor in &self.factor {
                merge(&mut settings, &factor.options[rng.random_range(0..factor.options.len())]);
            }
            if all.iter().all(|other| other.settings != settings) {
                all.push(Start { name: format!("R{number:02}"), settings });
            }
        }
        all
    }

    fn settings(&self, round: &Round, candidate: &Start) -> Result<Settings, SettingsError> {
        let origin = format!("the search's candidate {}", candidate.name);
        let mut settings = Settings::overlaid([&round.settings, &candidate.settings], &origin)?;
        settings.experiment.seed = self.seed;
        Ok(settings)
    }

    /// Whether every candidate can be tried in every round.
    ///
    /// # Errors
    /// If the settings of one cannot be used.
    pub fn check(&self) -> Result<(), StudyError> {
        let candidates = self.all_candidates();
        let mut pairs = self.round.iter().flat_map(|round| candidates.iter().map(move |one| (round, one)));
        pairs.try_for_each(|(round, candidate)| Ok(self.settings(round, candidate).map(drop)?))
    }

    /// A candidate's score: weighted credit of all terms; 0 if anything of it failed.
    fn judge(&self, start: Start, settings: &Settings, outcome: &Outcome) -> Tried {
        let of = |experiment| {
            let conditions = outcome.conditions(settings, |record| match experiment {
                Experiment::Exp1 => {
                    record.coordination == settings.motion.coordination
                        && settings.experiment.dimensions.contains(&record.dimension)
                }
                Experiment::Exp2 => {
                    record.dimension == settings.experiment.dimension && record.model == Model::DpgmmLj
                }
            });
            claims::judge(experiment, &Evidence { conditions, baselines: Vec::new() })
        };
        let [first, second] = [Experiment::Exp1, Experiment::Exp2].map(of);
        let terms: Vec<(Judged, f64)> = self
            .score
            .iter()
            .map(|term| {
                let mut judged = match term.experiment {
                    Experiment::Exp1 => first.iter(),
                    Experiment::Exp2 => second.iter(),
                };
                let judged = judged.find(|judged| judged.claim.id == term.claim).expect("checked");
                (judged.clone(), term.credit(judged))
            })
            .collect();
        let total: f64 = self.score.iter().map(|term| term.weight).sum();
        let score =
            terms.iter().zip(&self.score).map(|((_, credit), term)| credit * term.weight).sum::<f64>()
                / total;
        let score = if outcome.failures.is_empty() { score } else { 0.0 };
        Tried { start, score, failures: outcome.failures.clone(), terms }
    }
}

impl Term {
    /// 1 within the accepted range, less outside, 0 where there is nothing to judge.
    fn credit(&self, judged: &Judged) -> f64 {
        let (Some(value), Some((low, high))) = (judged.reproduced.value, judged.claim.accept) else {
            return 0.0;
        };
        let outside = (low - value).max(value - high).max(0.0);
        (1.0 - outside / self.slack).max(0.0)
    }
}

/// Runs a search, and writes into `out`: scores.csv, credits.csv, search.md and best.toml.
///
/// # Errors
/// If a candidate's settings cannot be used, or a file cannot be written.
pub fn search(design: &Design, out: &Path) -> Result<String, StudyError> {
    // Before hours are spent on those that come first.
    design.check()?;
    let mut field = design.all_candidates();
    let (mut scores, mut credits, mut rounds) = (Vec::new(), Vec::new(), Vec::new());
    for (at, round) in design.round.iter().enumerate() {
        field.truncate(round.candidates);
        let configurations: Vec<Settings> = field
            .iter()
            .map(|candidate| design.settings(round, candidate))
            .collect::<Result<_, SettingsError>>()?;
        let outcomes = run(&configurations, out, &format!("round {} of {}", at + 1, design.round.len()))?;
        let mut tried: Vec<Tried> = field
            .into_iter()
            .zip(configurations.iter().zip(&outcomes))
            .map(|(start, (settings, outcome))| design.judge(start, settings, outcome))
            .collect();
        // Stable: of equal scores the earlier candidate stays ahead.
        tried.sort_by(|a, b| b.score.total_cmp(&a.score));
        for (rank, tried) in tried.iter().enumerate() {
            scores.push(tried.score_row(at + 1, rank + 1));
            credits.extend(design.credit_rows(at + 1, tried));
        }
        field = tried.iter().map(|tried| tried.start.clone()).collect();
        rounds.push(tried);
        // After each round, so that a search that is stopped has shown something.
        tables::write_rows(&out.join("scores.csv"), &scores)?;
        tables::write_rows(&out.join("credits.csv"), &credits)?;
    }
    let text = design.describe(&rounds);
    write_text(&out.join("search.md"), &text)?;
    let best = &rounds.last().expect("there is a round")[0].start;
    let overlay = toml::to_string(&best.settings).expect("a table can be written");
    write_text(&out.join("best.toml"), &format!("# Candidate {}.\n{overlay}", best.name))?;
    write_manifest(out, "search", design.seed, &["scores.csv", "credits.csv", "search.md", "best.toml"])?;
    Ok(text)
}

impl Tried {
    fn satisfied(&self) -> usize {
        self.terms.iter().filter(|(judged, _)| judged.verdict == Verdict::Reproduced).count()
    }

    fn score_row(&self, round: usize, rank: usize) -> ScoreRow {
        ScoreRow {
            round,
            rank,
            candidate: self.start.name.clone(),
            score: self.score,
            satisfied: self.satisfied(),
            terms: self.terms.len(),
            failures: self.failures.len(),
            failure: self.failures.first().map_or(String::new(), |failure| failure.reason.clone()),
            settings: flat(&self.start.settings).join(", "),
        }
    }
}

impl Design {
    fn credit_rows<'a>(&'a self, round: usize, tried: &'a Tried) -> impl Iterator<Item = CreditRow> + 'a {
        tried.terms.iter().zip(&self.score).map(move |((judged, credit), term)| {
            let (low, high) = judged.reproduced.interval.unzip();
            CreditRow {
                round,
                candidate: tried.start.name.clone(),
                claim: term.claim.clone(),
                experiment: term.experiment,
                weight: term.weight,
                accepted: table::accepted(&judged.claim),
                value: judged.reproduced.value,
                n: judged.reproduced.n,
                low,
                high,
                simulations: judged.reproduced.simulations,
                found: judged.place.clone(),
                verdict: judged.verdict.name(),
                credit: *credit,
            }
        })
    }

    /// The search for people: the last round, and which claims were ever satisfied together.
    fn describe(&self, rounds: &[Vec<Tried>]) -> String {
        let mut text = String::new();
        let line = |text: &mut String, line: String| writeln!(text, "{line}").expect("a text takes all");
        let first = &rounds[0];
        line(
            &mut text,
            format!(
                "{} candidates, seed {}, revision {}. Score: weighted share of claims, in part for those nearly satisfied; \
                 the claims and their weights stand in reproduce/search.toml.\n",
                first.len(),
                self.seed,
                env!("BODYSCHEMA_REVISION")
            ),
        );
        for (at, round) in rounds.iter().enumerate() {
            let shown = if at + 1 == rounds.len() { round.len() } else { round.len().min(16) };
            let experiment = &self.round[at].settings;
            line(
                &mut text,
                format!("Round {}: {} candidates, {}\n", at + 1, round.len(), flat(experiment).join(", ")),
            );
            let names: Vec<&str> = self.score.iter().map(|term| term.claim.as_str()).collect();
            line(&mut text, format!("| candidate | score | {} | settings |", names.join(" | ")));
            line(&mut text, format!("|---|---|{}---|", "---|".repeat(names.len())));
            for tried in &round[..shown] {
                let cell = |(judged, _): &(Judged, f64)| {
                    let value = table::number(judged.reproduced.value);
                    if judged.verdict == Verdict::Reproduced { format!("**{value}**") } else { value }
                };
                let cells: Vec<String> = tried.terms.iter().map(cell).collect();
                let failed = match tried.failures.len() {
                    0 => String::new(),
                    failures => format!("; {failures} parts failed: {}", tried.failures[0].reason),
                };
                line(
                    &mut text,
                    format!(
                        "| {} | {:.3} | {} | {}{failed} |",
                        tried.start.name,
                        tried.score,
                        cells.join(" | "),
                        flat(&tried.start.settings).join(", ")
                    ),
                );
            }
            line(&mut text, String::new());
        }
        line(&mut text, "Bold: within the accepted range.\n".to_owned());
        self.conflicts(&mut text, first);
        text
    }

    /// Of the first round, which tries all candidates alike: how often each claim holds, alone and with each other.
    fn conflicts(&self, text: &mut String, tried: &[Tried]) {
        let stable: Vec<&Tried> = tried.iter().filter(|tried| tried.failures.is_empty()).collect();
        let holds = |tried: &Tried, term: usize| tried.terms[term].0.verdict == Verdict::Reproduced;
        let count = |terms: &[usize]| {
            stable.iter().filter(|tried| terms.iter().all(|&term| holds(tried, term))).count()
        };
        let mut line = |line: String| writeln!(text, "{line}").expect("a text takes all");
        line(format!(
            "How often two claims hold together, of {} candidates without a failure in round 1 (the diagonal: alone)\n",
            stable.len()
        ));
        let names: Vec<&str> = self.score.iter().map(|term| term.claim.as_str()).collect();
        line(format!("| | {} |", names.join(" | ")));
        line(format!("|---|{}", "---|".repeat(names.len())));
        for (row, name) in names.iter().enumerate() {
            let cells: Vec<String> =
                (0..names.len()).map(|column| count(&[row, column]).to_string()).collect();
            line(format!("| {name} | {} |", cells.join(" | ")));
        }
        let never: Vec<&str> =
            (0..names.len()).filter(|&term| count(&[term]) == 0).map(|term| names[term]).collect();
        let all: Vec<usize> = (0..names.len()).collect();
        line(format!("\nAll claims together hold for {} of them.", count(&all)));
        if !never.is_empty() {
            line(format!("Never satisfied: {}.", never.join(", ")));
        }
        for a in 0..names.len() {
            for b in a + 1..names.len() {
                let (one, other) = (count(&[a]), count(&[b]));
                if one > 0 && other > 0 && count(&[a, b]) == 0 {
                    line(format!(
                        "Never together: {} (alone {one}) and {} (alone {other}).",
                        names[a], names[b]
                    ));
                }
            }
        }
    }
}

/// Lays `over` on `base`, section by section.
fn merge(base: &mut Table, over: &Table) {
    for (name, value) in over {
        match (base.get_mut(name), value) {
            (Some(Value::Table(base)), Value::Table(over)) => merge(base, over),
            _ => {
                base.insert(name.clone(), value.clone());
            }
        }
    }
}

/// `section.key = value` for every setting of a table.
pub fn flat(table: &Table) -> Vec<String> {
    let mut all = Vec::new();
    for (name, value) in table {
        match value {
            Value::Table(inner) => all.extend(flat(inner).into_iter().map(|line| format!("{name}.{line}"))),
            value => all.push(format!("{name} = {}", value.to_string().replace('"', ""))),
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Estimate;

    #[test]
    fn credit_is_full_within_the_range_and_falls_to_nothing_outside() {
        let claim = claims::published().into_iter().find(|claim| claim.id == "tree-accuracy").unwrap();
        let (low, high) = claim.accept.unwrap();
        let term = Term { claim: claim.id.clone(), experiment: Experiment::Exp1, weight: 3.0, slack: 0.2 };
        let credit = |value: Option<f64>| {
            let reproduced = Estimate::bare(value, 10);
            let verdict = Verdict::NotTestable;
            let judged =
                Judged { claim: claim.clone(), reproduced, place: String::new(), verdict, best: None };
            term.credit(&judged)
        };
        assert_eq!([low, 0.5 * (low + high), high].map(|value| credit(Some(value))), [1.0; 3]);
        assert!(
            (credit(Some(low - 0.05)) - 0.75).abs() < 1e-12
                && (credit(Some(high + 0.05)) - 0.75).abs() < 1e-12
        );
        assert_eq!([credit(Some(low - 0.3)), credit(None)], [0.0; 2]);
    }
}
