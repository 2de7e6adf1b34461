//! Judge a finished experiment again, from its samples: without a new run, by the claims and accepted ranges of this program.

use std::path::Path;

use super::experiment::{judge_all, write_curves};
use super::interpretation::other_than;
use crate::analysis::claims::headline;
use crate::analysis::conditions::Conditions;
use crate::analysis::measure::Evidence;
use crate::analysis::published::Experiment;
use crate::files::manifest::Manifest;
use crate::files::provenance::Provenance;
use crate::files::result_folder::ResultFolder;
use crate::files::{FileError, tables};
use crate::report::claims_table::{illustrated, rows};
use crate::report::figures::Figures;
use crate::report::headline::{Headline, claims_page};
use crate::report::plot::Picture;
use crate::settings::Settings;
use crate::tasks::error::ExperimentError;

/// Writes claims.csv, claims.md and the tables and pictures of the figures again, and the manifest with their hashes. Returns the
/// pictures; `None` where the folder does not have the samples.
///
/// # Errors
/// If a file of the experiment is missing or malformed, or one cannot be written.
pub(crate) fn rejudge(path: &Path) -> Result<Option<Vec<Picture>>, ExperimentError> {
    let samples = path.join("samples.csv");
    if !samples.is_file() {
        return Ok(None);
    }
    let manifest = Manifest::read(path)?;
    let wrong = |what: &str| FileError::new(&path.join("manifest.json"), what.to_owned());
    let experiment = match manifest.experiment.as_deref() {
        Some("exp1") => Experiment::Exp1,
        Some("exp2") => Experiment::Exp2,
        _ => return Err(wrong("names no experiment").into()),
    };
    let settings = manifest.settings.clone().ok_or_else(|| wrong("has no settings"))?;
    let settings: Settings = serde_json::from_value(settings).map_err(|error| wrong(&error.to_string()))?;

    let baselines = path.join("baselines.csv");
    let baselines = if baselines.is_file() { tables::read_rows(&baselines)? } else { Vec::new() };
    let (mut judged, evidence) = judge_all(experiment, &settings, tables::read_rows(&samples)?, &baselines);
    let other = path.join("other-reading.csv");
    if other.is_file() {
        let conditions = Conditions::new(
            tables::read_rows(&other)?,
            settings.experiment.simulations,
            settings.experiment.seed,
        );
        let reading = other_than(settings.schema.sampler);
        judged.insert(1, headline(experiment, &Evidence { conditions, baselines: Vec::new(), reading }));
    }
    let rows = if manifest.quick == Some(true) { illustrated(rows(&judged)) } else { rows(&judged) };

    let here = Provenance::here().revision;
    let again = format!(" Judged again by revision {here}.");
    let mut preamble = manifest.summary.clone().unwrap_or_default();
    if manifest.provenance.revision != here && !preamble.ends_with(&again) {
        preamble += &again;
    }
    let mut folder = ResultFolder::new(path);
    folder.remember(manifest.outputs.iter().map(|output| output.file.clone()));
    let pictures = write_curves(experiment, &evidence, Figures::new(&mut folder)?)?;
    folder.write_rows("claims.csv", &rows)?;
    folder.write_text("claims.md", &claims_page(&preamble, &rows))?;
    let headline = Headline::of(&rows).map(|headline| headline.sentence).into_iter().collect();
    folder.write_manifest(Manifest { summary: Some(preamble), headline, ..manifest })?;
    Ok(Some(pictures))
}
