//! Try candidates in rounds, each of which keeps the best and tries them harder, and write what came out.

use std::path::Path;

use serde::Serialize;

use super::super::configurations::run;
use super::super::design::flat;
use super::super::error::ExperimentError;
use super::design::{Continuation, Design};
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
    resolved: bool,
    anchor_separation: f64,
    turn: f64,
    /// Terms of the score that are satisfied.
    satisfied: usize,
    terms: usize,
    /// Parts that failed.
    failures: usize,
    /// The first failure's reason.
    failure: String,
    /// Names of the claims that hold.
    hold: String,
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

/// Candidates of each round whose claims are in credits.csv, the best ones.
const CREDITED: usize = 100;

/// Runs a search, or its rounds from that on which `from` says, and writes into `out`: scores.csv, credits.csv, search.md,
/// design.toml, best.toml and, after every round but the last, next.toml.
///
/// # Errors
/// If a candidate's settings cannot be used, or a file cannot be written.
pub fn search(
    design: &Design,
    text: &str,
    from: Option<Continuation>,
    out: &Path,
) -> Result<String, ExperimentError> {
    let mut folder = ResultFolder::new(out);
    let first = from.as_ref().map_or(0, |from| from.round - 1);
    let mut candidates = from.map_or_else(|| design.all_candidates(), |from| from.start);
    if candidates.is_empty() {
        let message = "it has no candidates; add [draws] or a [[start]]";
        return Err(ExperimentError::design("the design of the search", message));
    }
    // Before hours are spent on those that come first.
    design.check(&candidates)?;
    let (mut scores, mut credits, mut rounds) = (Vec::new(), Vec::new(), Vec::new());
    for (at, round) in design.round.iter().enumerate().skip(first) {
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
        // Movements that the step resolves come first. Stable: of equal scores the earlier candidate stays prefetch.
        tried.sort_by(|a, b| b.is_resolved().cmp(&a.is_resolved()).then(b.score.total_cmp(&a.score)));
        for (rank, tried) in tried.iter().enumerate() {
            scores.push(tried.score_row(at + 1, rank + 1));
            if rank < CREDITED {
                credits.extend(design.credit_rows(at + 1, tried));
            }
        }
        candidates = tried.iter().map(|tried| tried.candidate.clone()).collect();
        if let Some(next) = design.round.get(at + 1) {
            let start = candidates.iter().take(next.candidates).cloned().collect();
            let next =
                toml::to_string(&Continuation { round: at + 2, start }).expect("tables can be written");
            folder.write_text("next.toml", &format!("# Candidates of the next round.\n{next}"))?;
        }
        rounds.push((at, tried));
        // After each round, so that a search that is stopped has shown something.
        folder.write_rows("scores.csv", &scores)?;
        folder.write_rows("credits.csv", &credits)?;
    }
    let page = design.page(&rounds);
    folder.write_text("search.md", &page)?;
    folder.remove(["best.toml".to_owned()])?;
    let best = &rounds.last().expect("there is a round").1[0];
    // What the step does not resolve cannot win.
    if best.is_resolved() {
        let overlay = toml::to_string(&best.candidate.settings).expect("a table can be written");
        folder.write_text("best.toml", &format!("# Candidate {}.\n{overlay}", best.candidate.name))?;
    }
    folder.write_text("design.toml", text)?;
    folder.write_manifest(Manifest::of_study("search", design.seed))?;
    Ok(page)
}

impl Tried {
    /// Names of the claims that hold.
    fn holding(&self) -> impl Iterator<Item = &str> {
        let hold = self.terms.iter().filter(|(judged, _)| judged.verdict == Verdict::Reproduced);
        hold.map(|(judged, _)| judged.claim.id.as_str())
    }

    fn score_row(&self, round: usize, rank: usize) -> ScoreRow {
        ScoreRow {
            round,
            rank,
            candidate: self.candidate.name.clone(),
            score: self.score,
            satisfied: self.holding().count(),
            terms: self.terms.len(),
            failures: self.failures.len(),
            failure: self.failures.first().map_or(String::new(), |failure| failure.reason.clone()),
            resolved: self.is_resolved(),
            anchor_separation: self.resolution.anchor_separation,
            turn: self.resolution.turn,
            hold: self.holding().collect::<Vec<_>>().join(" "),
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
