//! Run a study, and write its table, its page and its pictures.

use std::path::Path;

use super::super::configurations::run;
use super::super::error::ExperimentError;
use super::design::Design;
use super::page::{Page, columns};
use super::table::{Counted, Row};
use crate::files::manifest::Manifest;
use crate::files::result_folder::ResultFolder;
use crate::files::{FileError, one_line, read_text, tables, write_text};
use crate::report::plot;

/// Where the study's design is kept beside its results, and where its table is.
const COPY: &str = "design.toml";
const TABLE: &str = "sensitivity.csv";

/// Runs a study, and writes into `out`: sensitivity.csv, design.toml, and what [`redraw`] makes of them.
///
/// # Errors
/// If a value's settings cannot be used, or a file cannot be written.
pub fn study(design: &Design, text: &str, out: &Path) -> Result<(), ExperimentError> {
    let mut folder = ResultFolder::new(out);
    let (places, configurations): (Vec<_>, Vec<_>) = design.configurations()?.into_iter().unzip();
    let outcomes = run(&configurations, out, "sensitivity")?;
    let mut of_default = None;
    let mut rows = Vec::new();
    for ((place, settings), outcome) in places.iter().zip(&configurations).zip(&outcomes) {
        let counted = Counted::new(settings, outcome);
        let default = of_default.get_or_insert_with(|| counted.clone());
        rows.extend(counted.rows(place, outcome, default));
    }
    folder.write_rows(TABLE, &rows)?;
    folder.write_text(COPY, text)?;
    folder.write_manifest(Manifest::of_study("sensitivity", design.seed))?;
    redraw(out)?;
    Ok(())
}

/// Whether a folder holds a finished study.
pub fn is_study(folder: &Path) -> bool {
    folder.join(TABLE).exists()
}

/// Makes sensitivity.md and the pictures of a study again, from its table and design alone.
///
/// # Errors
/// If they are not what a study wrote, or a file cannot be written.
pub fn redraw(folder: &Path) -> Result<Vec<String>, ExperimentError> {
    let path = folder.join(COPY);
    let text = read_text(&path)?;
    let mut design = Design::parse(&text, &path.display().to_string())?;
    let rows: Vec<Row> = tables::read_rows(&folder.join(TABLE))?;
    // A study of some factors alone.
    design.factors.retain(|factor| rows.iter().any(|row| row.factor == factor.name));
    // The revision of the program that made the study, which may not be this one.
    let revision = one_line(&Manifest::read(folder)?.provenance.revision);
    let page = Page::new(&design, &rows);
    write_text(&folder.join("sensitivity.md"), &page.text(&revision))?;
    let columns = columns();
    let mut written = Vec::new();
    for factor in &design.factors {
        let name = format!("figures/{}.svg", factor.name);
        let picture = plot::effects::render(&columns, &page.lines(&factor.name), true);
        let picture = picture.map_err(|error| FileError::new(&folder.join(TABLE), error.0))?;
        write_text(&folder.join(&name), &picture)?;
        written.push(name);
    }
    Ok(written)
}
