//! Keep the result of one specification in a folder of its own, which is there whole or not at all.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use toml::{Table, Value};

use super::super::compared::Compared;
use super::super::configurations::Outcome;
use super::super::error::ExperimentError;
use super::design::{Design, Factor};
use super::draw::Drawn;
use crate::analysis::cells::EstimateCells;
use crate::analysis::claims::{Verdict, judge_claim};
use crate::analysis::published::{Claim, Experiment};
use crate::files::tables::{read_rows, write_rows};
use crate::files::{FileError, read_text, write_folder, write_text};
use crate::pipeline::Condition;
use crate::settings::Settings;
use crate::stages::schema::{Keep, Model};

/// What a specification gave beside its claims: `specification.toml`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Summary {
    /// Its number, from 1.
    pub number: usize,
    /// The movement that it shares with others, from 1.
    pub movement: usize,
    /// The matrix of distances that it shares with others, from 1.
    pub distances: usize,
    /// The body maps that it shares with others, from 1.
    pub maps: usize,
    /// Revision of the program that ran it.
    pub revision: String,
    /// Right trees and eligible draws of each body at the condition of the headline; empty where a chain keeps all its
    /// draws, which are not independent.
    pub headline: Vec<[usize; 2]>,
    /// Whether the physics step resolves all its movements.
    pub resolved: bool,
    /// Largest distance between two ends of a joint, m.
    pub anchor_separation: f64,
    /// Largest turn of a part in a step.
    pub turn: f64,
    /// Movements that failed.
    pub failed: usize,
    /// The first failure's reason.
    pub failure: String,
    /// The label of each factor's option, by its name.
    pub choices: Table,
}

/// A claim as a specification has it: a row of `claims.csv`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Short name of the claim.
    pub claim: String,
    /// The experiment that it is judged by.
    pub experiment: Experiment,
    /// The value; of several, that which lies farthest towards the outside of the accepted range.
    pub value: Option<f64>,
    /// What it is over, and its interval.
    #[serde(flatten)]
    pub cells: EstimateCells,
    /// Where it was found.
    pub found: String,
    /// Whether it is in the accepted range.
    pub verdict: Verdict,
}

/// A finished specification.
#[derive(Debug, Clone, PartialEq)]
pub struct Specification {
    /// What it gave beside its claims.
    pub summary: Summary,
    /// Its claims, in the order of the design.
    pub rows: Vec<Row>,
}

impl Specification {
    /// The label of its option of a factor.
    pub fn label(&self, factor: &str) -> &str {
        self.summary.choices.get(factor).and_then(Value::as_str).unwrap_or_default()
    }
}

const SUMMARY: &str = "specification.toml";
const SETTINGS: &str = "settings.toml";
const CLAIMS: &str = "claims.csv";

/// The folder of a specification.
pub fn folder(out: &Path, number: usize) -> PathBuf {
    out.join("specifications").join(format!("{number:06}"))
}

/// Writes what became of a specification.
///
/// # Errors
/// If a file cannot be written.
pub fn write(
    out: &Path,
    design: &Design,
    claims: &[Claim],
    drawn: &Drawn,
    settings: &Settings,
    outcome: &Outcome,
) -> Result<(), ExperimentError> {
    let [of_first, of_second] =
        [Experiment::Exp1, Experiment::Exp2].map(|experiment| outcome.evidence(experiment, settings));
    let row = |compared: &Compared| {
        let evidence = match compared.experiment {
            Experiment::Exp1 => &of_first,
            Experiment::Exp2 => &of_second,
        };
        let claim = compared.find(claims).expect("the design was checked");
        let (found, place, verdict) = judge_claim(claim, evidence);
        Row {
            claim: compared.id.clone(),
            experiment: compared.experiment,
            value: found.value,
            cells: (&found).into(),
            found: outcome.failures.first().map_or(place, |failure| failure.reason.clone()),
            verdict,
        }
    };
    let rows: Vec<Row> = design.claims.iter().map(row).collect();
    let label = |(factor, option): (&Factor, &usize)| {
        (factor.name.clone(), Value::String(factor.options[*option].label.clone()))
    };
    let failures = &outcome.failures;
    let summary = Summary {
        number: drawn.number,
        movement: drawn.movement,
        distances: drawn.distances,
        maps: drawn.maps,
        revision: env!("BODYSCHEMA_REVISION").to_owned(),
        headline: headline(settings, outcome),
        resolved: failures.is_empty() && outcome.resolution.is_resolved(),
        anchor_separation: outcome.resolution.anchor_separation,
        turn: outcome.resolution.turn,
        failed: failures.len(),
        failure: failures.first().map_or(String::new(), |failure| failure.reason.clone()),
        choices: design.factors.iter().zip(&drawn.options).map(label).collect(),
    };
    let settings = toml::to_string(settings).expect("settings are tables");
    let use_it =
        "# Use: bodyschema reproduce exp1 --settings settings.toml --out DIR; and the same with exp2.\n";
    let summary = toml::to_string(&summary).expect("a summary is a table");
    write_folder(&folder(out, drawn.number), |folder| {
        write_text(&folder.join(SETTINGS), &format!("{use_it}{settings}"))?;
        write_text(&folder.join(SUMMARY), &summary)?;
        write_rows(&folder.join(CLAIMS), &rows)
    })?;
    Ok(())
}

/// Reads what became of a specification; `None` if it is not finished.
///
/// # Errors
/// If a file is not what [`write`] wrote.
pub fn read(out: &Path, design: &Design, number: usize) -> Result<Option<Specification>, ExperimentError> {
    let folder = folder(out, number);
    if !folder.exists() {
        return Ok(None);
    }
    let path = folder.join(SUMMARY);
    let summary = toml::from_str(&read_text(&path)?).map_err(|error| FileError::new(&path, error))?;
    let found = Specification { summary, rows: read_rows(&folder.join(CLAIMS))? };
    let claims = found.rows.iter().map(|row| row.claim.as_str());
    if found.summary.number != number || !claims.eq(design.claims.iter().map(|claim| claim.id.as_str())) {
        let message = format!("was changed after it was written; run it again with --only {number}");
        return Err(FileError::new(&folder, message).into());
    }
    Ok(Some(found))
}

/// Right trees and eligible draws of each body at the condition of the headline.
fn headline(settings: &Settings, outcome: &Outcome) -> Vec<[usize; 2]> {
    if settings.schema.keep == Keep::All || !outcome.failures.is_empty() {
        return Vec::new();
    }
    let conditions = outcome.conditions(settings, |_| true);
    let (coordination, dimension) = (settings.motion.coordination, settings.experiment.dimension);
    let trees = conditions.trees(Condition { model: Model::DpgmmLj, coordination, dimension });
    trees.iter().map(|trees| [trees.iter().filter(|right| **right == 1.0).count(), trees.len()]).collect()
}
