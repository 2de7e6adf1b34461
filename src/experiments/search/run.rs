//! Try candidates in rounds, each of which keeps the best and tries them harder, and write what came out.

use std::path::Path;

use serde::Serialize;

use super::super::configurations::run;
use super::super::design::flat;
use super::super::error::ExperimentError;
use super::design::Design;
use super::score::Tried;
use crate::analysis::claims::Verdict;
use crate::analysis::published::Experiment;
use crate::files::manifest::Manifest;
use crate::files::result_folder::ResultFolder;
use crate::settings::{Settings, SettingsError};

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

/// Runs a search, and writes into `out`: scores.csv, credits.csv, search.md and best.toml.
///
/// # Errors
/// If a candidate's settings cannot be used, or a file cannot be written.
pub fn search(design: &Design, out: &Path) -> Result<String, ExperimentError> {
    // Before hours are spent on those that come first.
    design.check()?;
    let mut candidates = design.all_candidates();
    let mut folder = ResultFolder::new(out);
    let (mut scores, mut credits, mut rounds) = (Vec::new(), Vec::new(), Vec::new());
    for (at, round) in design.round.iter().enumerate() {
        candidates.truncate(round.candidates);
        let configurations: Vec<Settings> = candidates
            .iter()
            .map(|candidate| design.settings(round, candidate))
            .collect::<Result<_, SettingsError>>()?;
        let outcomes = run(&configurations, out, &format!("round {} of {}", at + 1, design.round.len()))?;
        let mut tried: Vec<Tried> = candidates
            .into_iter()
            .zip(configurations.iter().zip(&outcomes))
            .map(|(candidate, (settings, outcome))| design.judge(candidate, settings, outcome))
            .collect();
        // Stable: of equal scores the earlier candidate stays ahead.
        tried.sort_by(|a, b| b.score.total_cmp(&a.score));
        for (rank, tried) in tried.iter().enumerate() {
            scores.push(tried.score_row(at + 1, rank + 1));
            credits.extend(design.credit_rows(at + 1, tried));
        }
        candidates = tried.iter().map(|tried| tried.candidate.clone()).collect();
        rounds.push(tried);
        // After each round, so that a search that is stopped has shown something.
        folder.write_rows("scores.csv", &scores)?;
        folder.write_rows("credits.csv", &credits)?;
    }
    let page = design.page(&rounds);
    folder.write_text("search.md", &page)?;
    let best = &rounds.last().expect("there is a round")[0].candidate;
    let overlay = toml::to_string(&best.settings).expect("a table can be written");
    folder.write_text("best.toml", &format!("# Candidate {}.\n{overlay}", best.name))?;
    folder.write_manifest(Manifest::of_study("search", design.seed))?;
    Ok(page)
}

impl Tried {
    fn score_row(&self, round: usize, rank: usize) -> ScoreRow {
        ScoreRow {
            round,
            rank,
            candidate: self.candidate.name.clone(),
            score: self.score,
            satisfied: self.terms.iter().filter(|(judged, _)| judged.verdict == Verdict::Reproduced).count(),
            terms: self.terms.len(),
            failures: self.failures.len(),
            failure: self.failures.first().map_or(String::new(), |failure| failure.reason.clone()),
            settings: flat(&self.candidate.settings).join(", "),
        }
    }
}

impl Design {
    fn credit_rows<'a>(&'a self, round: usize, tried: &'a Tried) -> impl Iterator<Item = CreditRow> + 'a {
        tried.terms.iter().zip(&self.score).map(move |((judged, credit), term)| {
            let (low, high) = judged.reproduced.interval.unzip();
            CreditRow {
                round,
                candidate: tried.candidate.name.clone(),
                claim: term.claim.clone(),
                experiment: term.experiment,
                weight: term.weight,
                accepted: judged.claim.accepted(),
                value: judged.reproduced.value,
                n: judged.reproduced.n,
                low,
                high,
                simulations: judged.reproduced.simulations,
                // The words of earlier tables, which `verify --against` compares.
                found: judged.place.replace("no value:", "no sample:"),
                verdict: judged.verdict.name(),
                credit: *credit,
            }
        })
    }
}
