//! Verify results: compare a folder with the hashes in its manifest, or with another folder.
//!
//! On one class of CPU the same settings and seed give the same bytes. On another, last digits may differ. The
//! movement is chaotic, so it then becomes another movement, and all that follows from it changes. From the same body map,
//! a single chain may end elsewhere, but the rates over many chains stay within their standard errors.

use std::collections::BTreeMap;
use std::fmt::{self, Display};
use std::fs;
use std::path::{Component, Path};

use serde::Deserialize;
use serde_json::Value;

use super::error::FileError;
use super::hash::sha256;
use super::manifest::{HashedFile, Manifest};
use super::ro_crate::{self, RO_CRATE};
use super::{npy, tables};

/// Numbers agree if they differ by no more than this share of the larger one, or of 1.
pub const TOLERANCE: f64 = 1e-6;

/// Rates over posterior samples agree if they differ by no more than this many standard errors.
pub const STANDARD_ERRORS: f64 = 4.0;

/// What was found of one file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// The file, within its folder.
    pub file: String,
    /// What was found.
    pub outcome: Outcome,
}

/// How a file compares with what it should be.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Outcome {
    /// The same bytes.
    Same,
    /// All numbers within [`TOLERANCE`], all else the same.
    Close(String),
    /// Other posterior samples, whose rates are within [`STANDARD_ERRORS`].
    SameRates(String),
    /// Different; says where.
    Differs(String),
    /// The file does not exist.
    Missing,
}

impl Outcome {
    /// Whether the file is as it should be.
    pub fn agrees(&self) -> bool {
        matches!(self, Self::Same | Self::Close(_) | Self::SameRates(_))
    }
}

impl Display for Finding {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (word, detail) = match &self.outcome {
            Outcome::Same => ("same", ""),
            Outcome::Close(detail) => ("within tolerance", detail.as_str()),
            Outcome::SameRates(detail) => ("same rates", detail.as_str()),
            Outcome::Differs(detail) => ("differs", detail.as_str()),
            Outcome::Missing => ("missing", ""),
        };
        // It may quote cells, which may have lines.
        let colon = if detail.is_empty() { "" } else { ": " };
        write!(formatter, "{word:<16}  {}{colon}{}", self.file, detail.replace(['\n', '\r'], " "))
    }
}

/// Compares each file of finished results with the hash that their manifest states, and the hashes of their crate with
/// those of the manifest.
///
/// # Errors
/// If there is no manifest, or a file cannot be read.
pub fn against_manifest(folder: &Path) -> Result<Vec<Finding>, FileError> {
    let outputs = Manifest::read(folder)?.outputs;
    let of_crate = ro_crate::stated(folder)?.map(|stated| {
        let outcome = disagreement(&stated, &outputs).map_or(Outcome::Same, Outcome::Differs);
        Finding { file: RO_CRATE.to_owned(), outcome }
    });
    let of_files = outputs
        .into_iter()
        .map(|HashedFile { file, sha256: stated }| {
            let inside = Path::new(&file).components().all(|part| matches!(part, Component::Normal(_)));
            if !inside {
                let message = format!("lists {file:?}, which is not a file within its folder");
                return Err(FileError::new(&folder.join("manifest.json"), message));
            }
            let path = folder.join(&file);
            let outcome = if !path.is_file() {
                Outcome::Missing
            } else if sha256(&path)? == stated {
                Outcome::Same
            } else {
                Outcome::Differs("its SHA-256 is not the one that the manifest states".to_owned())
            };
            Ok(Finding { file, outcome })
        })
        .collect::<Result<Vec<_>, _>>()?;
    Ok(of_files.into_iter().chain(of_crate).collect())
}

/// The first file on which a crate and a manifest part ways, in words.
fn disagreement(of_crate: &[HashedFile], of_manifest: &[HashedFile]) -> Option<String> {
    let among = |file: &HashedFile, others: &[HashedFile]| {
        others.iter().find(|other| other.file == file.file).map(|other| other.sha256 == file.sha256)
    };
    let of_manifest_alone = of_manifest.iter().find(|file| among(file, of_crate).is_none());
    let of_both = of_crate.iter().find_map(|file| match among(file, of_manifest) {
        None => Some(format!("states a SHA-256 of {}, which manifest.json does not list", file.file)),
        Some(false) => Some(format!("states another SHA-256 of {} than manifest.json", file.file)),
        Some(true) => None,
    });
    of_both.or_else(|| {
        of_manifest_alone.map(|file| format!("states no SHA-256 of {}, which manifest.json lists", file.file))
    })
}

/// Compares every table and matrix of `reference` with that of `folder`, and the settings if both have a
/// manifest. Pictures and reports are made from tables, and not compared.
///
/// # Errors
/// If a folder has no table or matrix, or a file cannot be read as what its name says.
pub fn against_reference(folder: &Path, reference: &Path) -> Result<Vec<Finding>, FileError> {
    let mut findings = Vec::new();
    if Manifest::is_in(folder) && Manifest::is_in(reference) {
        let read = |folder| -> Result<[Value; 3], FileError> {
            let Manifest { experiment, seed, settings, .. } = Manifest::read(folder)?;
            Ok([experiment.into(), seed.into(), settings.into()])
        };
        let mut different = Vec::new();
        let names = ["experiment", "seed", "settings"];
        for (name, (own, other)) in names.into_iter().zip(read(folder)?.iter().zip(&read(reference)?)) {
            differences(name, own, other, &mut different);
        }
        let outcome = match &different[..] {
            [] => Outcome::Same,
            _ => Outcome::Differs(different.join("; ")),
        };
        findings.push(Finding { file: "settings and seed".to_owned(), outcome });
    }
    let mut files = Vec::new();
    list(reference, "", &mut files)?;
    if files.is_empty() {
        return Err(FileError::new(reference, "has no .csv or .npy file to compare with"));
    }
    for file in files {
        let (path, other) = (folder.join(&file), reference.join(&file));
        let outcome = if !path.is_file() {
            Outcome::Missing
        } else if sha256(&path)? == sha256(&other)? {
            Outcome::Same
        } else if file.ends_with(".npy") {
            matrices(&path, &other)?
        } else {
            tables(&path, &other)?
        };
        findings.push(Finding { file, outcome });
    }
    Ok(findings)
}

/// All tables and matrices below a folder, in the order of their names.
fn list(folder: &Path, within: &str, files: &mut Vec<String>) -> Result<(), FileError> {
    let unreadable = |error: std::io::Error| FileError::new(folder, format!("cannot be read: {error}"));
    let mut entries =
        fs::read_dir(folder).map_err(unreadable)?.collect::<Result<Vec<_>, _>>().map_err(unreadable)?;
    entries.sort_by_key(fs::DirEntry::file_name);
    for entry in entries {
        let name = format!("{within}{}", entry.file_name().to_string_lossy());
        let kind = entry.file_type().map_err(unreadable)?;
        if kind.is_dir() {
            list(&entry.path(), &format!("{name}/"), files)?;
        } else if kind.is_file() && (name.ends_with(".csv") || name.ends_with(".npy")) {
            files.push(name);
        }
    }
    Ok(())
}

/// Names the values that two trees of settings do not share.
fn differences(name: &str, own: &Value, other: &Value, different: &mut Vec<String>) {
    match (own, other) {
        (Value::Object(own), Value::Object(other)) => {
            let keys = own.keys().chain(other.keys().filter(|key| !own.contains_key(*key)));
            for key in keys {
                let value =
                    |object: &serde_json::Map<String, Value>| object.get(key).cloned().unwrap_or_default();
                differences(&format!("{name}.{key}"), &value(own), &value(other), different);
            }
        }
        _ if own != other => different.push(format!("{name} is {own}, reference {other}")),
        _ => {}
    }
}

fn agree(own: f64, other: f64) -> bool {
    (own - other).abs() <= TOLERANCE * own.abs().max(other.abs()).max(1.0)
}

fn matrices(path: &Path, reference: &Path) -> Result<Outcome, FileError> {
    let (own, other) = (npy::read_body_map(path)?, npy::read_body_map(reference)?);
    if (own.points(), own.dims) != (other.points(), other.dims) {
        let (rows, columns) = (other.points(), other.dims);
        let shape = format!("{} x {}, reference {rows} x {columns}", own.points(), own.dims);
        return Ok(Outcome::Differs(shape));
    }
    let pairs = || own.coordinates.iter().zip(&other.coordinates);
    let gap = |(own, other): (&f64, &f64)| (own - other).abs();
    let (at, largest) =
        pairs().map(gap).enumerate().fold((0, 0.0), |kept, next| if next.1 > kept.1 { next } else { kept });
    let detail = format!(
        "largest difference {largest:.1e}, in row {}, column {}: {}, reference {}",
        at / own.dims,
        at % own.dims,
        own.coordinates[at],
        other.coordinates[at]
    );
    let close = pairs().all(|(own, other)| agree(*own, *other));
    Ok(if close { Outcome::Close(detail) } else { Outcome::Differs(detail) })
}

fn tables(path: &Path, reference: &Path) -> Result<Outcome, FileError> {
    let (own, other) = (tables::read_cells(path)?, tables::read_cells(reference)?);
    if own[0] != other[0] {
        return Ok(Outcome::Differs(format!(
            "columns {}, reference {}",
            own[0].join(","),
            other[0].join(",")
        )));
    }
    let Some(detail) = first_difference(&own, &other) else {
        return Ok(Outcome::Close("all numbers are".to_owned()));
    };
    // Other samples of the same posterior may still have the same rates.
    match (rates(path), rates(reference)) {
        (Some(own), Some(other)) => Ok(compare_rates(&own, &other, &detail)),
        _ => Ok(Outcome::Differs(detail)),
    }
}

/// The first place where two tables of the same columns are not the same within tolerance.
fn first_difference(own: &[Vec<String>], other: &[Vec<String>]) -> Option<String> {
    let same = |a: &String, b: &String| {
        a == b || matches!((a.parse::<f64>(), b.parse::<f64>()), (Ok(a), Ok(b)) if agree(a, b))
    };
    if own.len() != other.len() {
        return Some(format!("{} rows, reference {}", own.len() - 1, other.len() - 1));
    }
    own.iter().zip(other).enumerate().find_map(|(line, (cells, others))| {
        let (column, (cell, reference)) =
            cells.iter().zip(others).enumerate().find(|(_, (cell, reference))| !same(cell, reference))?;
        Some(format!("line {}, {}: {cell:?}, reference {reference:?}", line + 1, own[0][column]))
    })
}

/// A row of any table of posterior samples.
#[derive(Deserialize)]
struct SampleRow {
    simulation: Option<usize>,
    coordination: Option<f64>,
    dimension: Option<usize>,
    model: Option<String>,
    eligible: bool,
    tree_correct: bool,
}

/// Posterior samples of one condition: all, the eligible ones, and those of them with the right tree.
#[derive(Default)]
struct Counts {
    samples: usize,
    eligible: usize,
    correct: usize,
}

/// Counts for each condition, if the table is one of posterior samples that were evaluated.
fn rates(path: &Path) -> Option<BTreeMap<String, Counts>> {
    let mut conditions = BTreeMap::<String, Counts>::new();
    for sample in tables::read_rows::<SampleRow>(path).ok()? {
        let named = [
            sample.simulation.map(|simulation| format!("simulation {simulation}")),
            sample.coordination.map(|p| format!("p = {p}")),
            sample.dimension.map(|d| format!("d = {d}")),
            sample.model,
        ];
        let condition = named.into_iter().flatten().collect::<Vec<_>>().join(", ");
        let counts = conditions.entry(condition).or_default();
        counts.samples += 1;
        counts.eligible += usize::from(sample.eligible);
        counts.correct += usize::from(sample.eligible && sample.tree_correct);
    }
    Some(conditions)
}

fn compare_rates(
    own: &BTreeMap<String, Counts>,
    other: &BTreeMap<String, Counts>,
    difference: &str,
) -> Outcome {
    if !own.keys().eq(other.keys()) {
        return Outcome::Differs(format!("{difference}; and their conditions differ"));
    }
    let mut largest: f64 = 0.0;
    for ((condition, own), other) in own.iter().zip(other.values()) {
        let pairs = [
            ("eligible", (own.eligible, own.samples), (other.eligible, other.samples)),
            ("correct trees", (own.correct, own.eligible), (other.correct, other.eligible)),
        ];
        for (name, own, other) in pairs {
            let errors = standard_errors(own, other);
            largest = largest.max(errors);
            if errors > STANDARD_ERRORS {
                let place = if condition.is_empty() { String::new() } else { format!("{condition}: ") };
                return Outcome::Differs(format!(
                    "{place}{name} {} of {}, reference {} of {}: {errors:.1} standard errors apart",
                    own.0, own.1, other.0, other.1
                ));
            }
        }
    }
    Outcome::SameRates(format!("{difference}; rates at most {largest:.1} standard errors apart"))
}

/// How many standard errors of their pooled rate two rates are apart; 0 where one has no trial.
fn standard_errors((k, n): (usize, usize), (other_k, other_n): (usize, usize)) -> f64 {
    if n == 0 || other_n == 0 {
        return 0.0;
    }
    let rate = |k: usize, n: usize| k as f64 / n as f64;
    let pooled = rate(k + other_k, n + other_n);
    let variance = pooled * (1.0 - pooled) * (1.0 / n as f64 + 1.0 / other_n as f64);
    if variance > 0.0 { (rate(k, n) - rate(other_k, other_n)).abs() / variance.sqrt() } else { 0.0 }
}
