//! Gather what all movements of a study gave into tables, pictures and a page.

use std::fs;
use std::path::{Path, PathBuf};

use super::design::{Design, Section};
use super::evaluation::Evaluation;
use super::extends::DesignText;
use super::page;
use super::plan::{Configuration, plan};
use super::ranking::Ranking;
use super::results::{Gathering, Results};
use super::work::{DESIGN, KEY, StudyWork, check_design};
use crate::files::checkpoint::Checkpoints;
use crate::files::manifest::Manifest;
use crate::files::result_folder::ResultFolder;
use crate::files::{FileError, one_line, read_text, write_same_text};
use crate::settings::Settings;
use crate::tasks::error::ExperimentError;

/// What the manifest of a study calls it.
const STUDY: &str = "study";

/// The page of a study.
const PAGE: &str = "study.md";

/// Gathers what all movements of these configurations gave, and writes the tables, the pictures and the page into `out`. Of
/// `all` configurations of the design, the checkpoints are removed then; of some of them they stay.
///
/// # Errors
/// If `out` holds another design or lacks a movement, or a file cannot be written.
pub(crate) fn gather(
    design: Design,
    text: &str,
    plan: &[Configuration],
    all: bool,
    out: &Path,
) -> Result<(), ExperimentError> {
    let mut folder = ResultFolder::new(out);
    check_design(text, out)?;
    let work = StudyWork::new(plan, Checkpoints::silent(out, &KEY));
    let seed = design.seed;
    let mut gathering = Gathering::new(design);
    work.outcomes(out, |at, outcome| gathering.add(&plan[at], &outcome))?;
    let results = gathering.finish();
    // What an earlier run of fewer configurations of the design has written.
    if let Ok(earlier) = Manifest::read(out)
        && earlier.study.as_deref() == Some(STUDY)
    {
        folder.remove(earlier.outputs.into_iter().map(|output| output.file).filter(|file| file != DESIGN))?;
    }
    folder.remember([DESIGN.to_owned()]);
    results.write(&mut folder)?;
    write_rest(&results, &mut folder)?;
    if let [only] =
        plan.iter().filter(|one| all || one.number != 1 || plan.len() == 1).collect::<Vec<_>>()[..]
    {
        folder.write_text("settings.toml", &settings_file(&only.settings))?;
    }
    folder.write_manifest(Manifest::of_study(STUDY, seed))?;
    if all {
        work.clear()?;
    }
    Ok(())
}

/// All settings of one configuration, with which anyone can run the experiments.
fn settings_file(settings: &Settings) -> String {
    let settings = toml::to_string(settings).expect("settings are tables");
    format!(
        "# Use: bodyschema reproduce exp1 --settings settings.toml --out DIR; and the same with exp2.\n{settings}"
    )
}

/// Whether the tables of these configurations are in a folder, and nothing is left to do.
///
/// # Errors
/// If tables of further configurations are there, which would be lost.
pub(crate) fn is_finished(text: &str, plan: &[Configuration], out: &Path) -> Result<bool, ExperimentError> {
    if !is_study(out) {
        return Ok(false);
    }
    check_design(text, out)?;
    let there = Results::numbers_in(out)?;
    let wanted: Vec<usize> = plan.iter().map(|one| one.number).collect();
    if let Some(other) = there.iter().find(|number| !wanted.contains(number)) {
        let message = format!(
            "holds the tables of {} configurations, {other} among them, which this command leaves out; choose another --out",
            there.len()
        );
        return Err(FileError::new(out, message).into());
    }
    Ok(there == wanted && !out.join("checkpoints").exists())
}

/// Whether a folder holds a finished study.
pub(crate) fn is_study(folder: &Path) -> bool {
    folder.join(DESIGN).is_file() && Results::are_in(folder)
}

/// Writes the tables, the pictures and the page of all configurations whose tables are in the folders of `parts`, in the order of
/// their numbers: what is finished of a study that was run by ranges of them.
///
/// # Errors
/// If there is none, one is of another design, two have the same configuration, or a file cannot be written.
pub(crate) fn join(design: Design, text: &str, parts: &Path, out: &Path) -> Result<(), ExperimentError> {
    let listed = fs::read_dir(parts).map_err(|error| FileError::new(parts, error.to_string()))?;
    let mut folders: Vec<PathBuf> =
        listed.flatten().map(|entry| entry.path()).filter(|at| is_study(at)).collect();
    folders.sort();
    let (mut all, mut revisions) = (Vec::new(), Vec::new());
    for folder in &folders {
        check_design(text, folder)?;
        let revision = one_line(&Manifest::read(folder)?.provenance.revision);
        all.push(Results::read(folder, design.clone(), revision.clone())?);
        revisions.extend(Some(revision).filter(|one| !revisions.contains(one)));
    }
    let seed = design.seed;
    let results = Results::joined(design, all, revisions.join(", "))
        .ok_or_else(|| FileError::new(parts, "has no tables of this design, or two of one configuration"))?;
    write_same_text(&out.join(DESIGN), text)?;
    let mut folder = ResultFolder::new(out);
    folder.remember([DESIGN.to_owned()]);
    results.write(&mut folder)?;
    write_rest(&results, &mut folder)?;
    folder.write_manifest(Manifest::of_study(STUDY, seed))?;
    Ok(())
}

/// Makes the page, the pictures and the derived tables again, from the tables and the design in a folder.
///
/// # Errors
/// If they are not what a study wrote, or a file cannot be written.
pub(crate) fn redraw(folder: &Path) -> Result<(), ExperimentError> {
    let path = folder.join(DESIGN);
    let source = DesignText { text: read_text(&path)?, origin: path.display().to_string() };
    let design = Design::parse(&source)?;
    plan(&design)?;
    // The revision of the program that ran the study, which may not be this one.
    let manifest = Manifest::read(folder)?;
    let results = Results::read(folder, design, one_line(&manifest.provenance.revision))?;
    let mut written = ResultFolder::new(folder);
    written.remember(manifest.outputs.iter().map(|output| output.file.clone()));
    write_rest(&results, &mut written)?;
    written.write_manifest(manifest)?;
    Ok(())
}

/// Writes the page, the pictures and what the tables give.
fn write_rest(results: &Results, folder: &mut ResultFolder) -> Result<(), ExperimentError> {
    let evaluation = Evaluation::is_asked_for(&results.design).then(|| Evaluation::new(results));
    if let Some(evaluation) = &evaluation {
        if results.design.has(Section::Shares) {
            folder.write_rows("shares.csv", &evaluation.shares)?;
        }
        if let Some(joint) = evaluation.joint {
            folder.write_rows("joint.csv", [joint])?;
        }
        if results.design.has(Section::Variance) {
            folder.write_rows("variance.csv", &evaluation.variance)?;
        }
    }
    let ranking = results.design.has(Section::Ranking).then(|| Ranking::of(results));
    if let Some(ranking) = &ranking {
        folder.write_rows("ranking.csv", &ranking.rows)?;
        if let Some(text) = ranking.best(results) {
            folder.write_text("best.toml", &text)?;
        }
    }
    for (name, picture) in page::pictures(results, evaluation.as_ref())? {
        folder.write_text(&name, &picture)?;
    }
    let text = page::text(results, evaluation.as_ref(), ranking.as_ref());
    folder.write_text(PAGE, &text)?;
    Ok(())
}
