//! Gather the specifications of a multiverse into tables, pictures and a page.

use std::path::Path;

use serde::Serialize;
use serde_json::{Map, Value};

use super::super::configurations::clear_checkpoints;
use super::super::error::ExperimentError;
use super::design::{COLUMNS, Design};
use super::draw::specifications;
use super::evaluation::Evaluation;
use super::page::page;
use super::specification::{self, Row, Specification};
use super::work::{COPY, check_design};
use crate::files::manifest::Manifest;
use crate::files::result_folder::ResultFolder;
use crate::files::{FileError, read_text, remove_partial};
use crate::report::plot::specifications as curve;

/// A row of multiverse.csv.
#[derive(Serialize)]
struct NumberedRow<'a> {
    specification: usize,
    movement: usize,
    resolved: bool,
    #[serde(flatten)]
    row: &'a Row,
}

/// Gathers all specifications in `out`, and writes: specifications.csv, multiverse.csv, shares.csv, variance.csv, joint.csv, figures/
/// and multiverse.md.
///
/// # Errors
/// If `out` holds another design or lacks a specification, or a file cannot be written.
pub fn gather(design: &Design, text: &str, out: &Path) -> Result<(), ExperimentError> {
    let mut folder = ResultFolder::new(out);
    check_design(text, out)?;
    let all = read_all(design, out)?;
    // What shards that were killed left: nobody is at work any more.
    remove_partial(&out.join("specifications"))?;
    clear_checkpoints(out)?;
    folder.remember([COPY.to_owned()]);
    folder.write_rows("specifications.csv", all.iter().map(|one| row_of(design, one)))?;
    let rows = all.iter().flat_map(|one| {
        let Specification { summary, rows } = one;
        rows.iter().map(move |row| NumberedRow {
            specification: summary.number,
            movement: summary.movement,
            resolved: summary.resolved,
            row,
        })
    });
    folder.write_rows("multiverse.csv", rows)?;
    let evaluation = Evaluation::new(design, &all);
    folder.write_rows("shares.csv", &evaluation.shares)?;
    folder.write_rows("variance.csv", &evaluation.variance)?;
    folder.write_rows("joint.csv", evaluation.joint)?;
    for at in 0..design.claims.len() {
        let picture = curve::render(&evaluation.curve(at));
        let picture = picture.map_err(|error| FileError::new(out, error.0))?;
        folder.write_text(&format!("figures/{}.svg", design.claims[at].id), &picture)?;
    }
    folder.write_text("multiverse.md", &page(&evaluation))?;
    folder.write_manifest(Manifest::of_study("multiverse", design.seed))?;
    Ok(())
}

/// Whether a folder holds a multiverse.
pub fn is_multiverse(folder: &Path) -> bool {
    folder.join(COPY).is_file() && folder.join("specifications").is_dir()
}

/// Gathers the specifications of a multiverse again, by the design in its folder.
///
/// # Errors
/// As [`gather`].
pub fn redraw(folder: &Path) -> Result<(), ExperimentError> {
    let path = folder.join(COPY);
    let text = read_text(&path)?;
    let design = Design::parse(&text, &path.display().to_string())?;
    gather(&design, &text, folder)
}

fn read_all(design: &Design, out: &Path) -> Result<Vec<Specification>, ExperimentError> {
    let (mut all, mut missing) = (Vec::new(), Vec::new());
    for drawn in specifications(design) {
        match specification::read(out, design, drawn.number)? {
            Some(found) => all.push(found),
            None => missing.push(drawn.number),
        }
    }
    match missing.first() {
        None => one_program(all, out),
        Some(first) => {
            let message = format!(
                "lacks {} of {} specifications (the first is {first}); run their shards before --gather",
                missing.len(),
                missing.len() + all.len()
            );
            Err(FileError::new(&out.join("specifications"), message).into())
        }
    }
}

/// All specifications, if one program ran them.
fn one_program(all: Vec<Specification>, out: &Path) -> Result<Vec<Specification>, ExperimentError> {
    let Some(other) = all.iter().find(|one| one.summary.revision != all[0].summary.revision) else {
        return Ok(all);
    };
    let message = format!(
        "specifications 1 and {} were run by two revisions of this program; run all of them by one, in a new folder",
        other.summary.number
    );
    Err(FileError::new(&out.join("specifications"), message).into())
}

/// What a specification is, and whether the step resolved it: a row of specifications.csv, with a column for each factor.
fn row_of(design: &Design, one: &Specification) -> Map<String, Value> {
    let summary = &one.summary;
    let fixed: [Value; COLUMNS.len()] = [
        summary.number.into(),
        summary.movement.into(),
        summary.distances.into(),
        summary.maps.into(),
        summary.resolved.into(),
        summary.anchor_separation.into(),
        summary.turn.into(),
        summary.failed.into(),
        summary.failure.as_str().into(),
    ];
    let factors = design.factors.iter().map(|factor| (factor.name.as_str(), one.label(&factor.name).into()));
    COLUMNS.into_iter().zip(fixed).chain(factors).map(|(name, value)| (name.to_owned(), value)).collect()
}
