//! Run a comparison, and write its table, its page and its pictures.

use std::path::Path;

use super::super::configurations::run;
use super::super::error::ExperimentError;
use super::design::Design;
use super::page::Page;
use super::table::{Row, Tried};
use crate::analysis::published::claims;
use crate::files::manifest::Manifest;
use crate::files::result_folder::ResultFolder;
use crate::files::{FileError, one_line, read_text, tables, write_text};
use crate::report::plot;

/// Where the design is kept beside its results, and where its table is.
const COPY: &str = "design.toml";
const TABLE: &str = "comparison.csv";

/// Runs a comparison, and writes into `out`: comparison.csv, design.toml, and what [`redraw`] makes of them.
///
/// # Errors
/// If a configuration's settings cannot be used, or a file cannot be written.
pub fn compare(design: &Design, text: &str, out: &Path) -> Result<(), ExperimentError> {
    let mut folder = ResultFolder::new(out);
    let all = design.all_settings()?;
    let outcomes = run(&all, out, "comparison")?;
    let tried: Vec<Tried> = (design.configurations.iter().zip(&all).zip(&outcomes))
        .map(|((configuration, settings), outcome)| Tried { name: &configuration.name, settings, outcome })
        .collect();
    let claims = claims();
    let mut rows: Vec<Row> = Vec::new();
    for one in &tried {
        for compared in &design.claims {
            let claim = compared.find(&claims).expect("the design was checked");
            rows.push(one.row(claim, compared, &tried[0]));
        }
    }
    folder.write_rows(TABLE, &rows)?;
    folder.write_text(COPY, text)?;
    folder.write_manifest(Manifest::of_study("comparison", design.seed))?;
    redraw(out)?;
    Ok(())
}

/// Whether a folder holds a finished comparison.
pub fn is_comparison(folder: &Path) -> bool {
    folder.join(TABLE).exists()
}

/// Makes comparison.md and the pictures of a comparison again, from its table and design alone.
///
/// # Errors
/// If they are not what a comparison wrote, or a file cannot be written.
pub fn redraw(folder: &Path) -> Result<Vec<String>, ExperimentError> {
    let path = folder.join(COPY);
    let design = Design::parse(&read_text(&path)?, &path.display().to_string())?;
    let rows: Vec<Row> = tables::read_rows(&folder.join(TABLE))?;
    let revision = one_line(&Manifest::read(folder)?.provenance.revision);
    let page = Page { design: &design, claims: &claims(), rows: &rows };
    write_text(&folder.join("comparison.md"), &page.text(&revision))?;
    let mut written = Vec::new();
    for (name, claims) in page.pictures() {
        let (columns, lines) = page.picture(claims);
        let picture = plot::effects::render(&columns, &lines, true);
        let picture = picture.map_err(|error| FileError::new(&folder.join(TABLE), error.0))?;
        write_text(&folder.join(&name), &picture)?;
        written.push(name);
    }
    Ok(written)
}
