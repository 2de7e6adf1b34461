//! Read and write tables as CSV: labels, trees, joint angles, posterior samples.

use std::path::Path;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::error::FileError;
use super::whole::write_whole;
use crate::numerics::partition::is_tree;
use crate::stages::agent::Joint;
use crate::stages::evaluate::{Score, parts};
use crate::stages::schema::Keep;
use crate::stages::schema::Sample;
use crate::stages::simulate::Trajectory;
use crate::stages::tree::Truth;

/// Writes rows with a header made of their fields' names; a `None` is an empty cell. A row may contain another by
/// `#[serde(flatten)]`, which the csv crate alone does not write.
///
/// # Errors
/// If the file cannot be written.
///
/// # Panics
/// If a row is no struct of plain values.
pub fn write_rows<T: Serialize>(path: &Path, rows: impl IntoIterator<Item = T>) -> Result<(), FileError> {
    write_rows_of(path, &[], rows)
}

/// As [`write_rows`], for a table that may have no row: its header is `columns`, the names of the fields.
///
/// # Errors
/// If the file cannot be written.
///
/// # Panics
/// If a row is no struct of plain values with these names.
pub fn write_rows_of<T: Serialize>(
    path: &Path,
    columns: &[&str],
    rows: impl IntoIterator<Item = T>,
) -> Result<(), FileError> {
    let value = |row: T| serde_json::to_value(row).expect("a row is plain values");
    write_values(path, columns, &mut rows.into_iter().map(value))
}

/// [`write_rows_of`], compiled once for all kinds of rows.
fn write_values(
    path: &Path,
    columns: &[&str],
    rows: &mut dyn Iterator<Item = Value>,
) -> Result<(), FileError> {
    write_whole(path, |file| {
        let mut writer = csv::Writer::from_writer(file);
        if !columns.is_empty() {
            writer.write_record(columns)?;
        }
        for (at, row) in rows.enumerate() {
            let Value::Object(row) = row else { panic!("a row is a struct") };
            if columns.is_empty() && at == 0 {
                writer.write_record(row.keys())?;
            }
            assert!(columns.is_empty() || row.keys().eq(columns), "a row has the columns of its header");
            writer.write_record(row.values().map(cell))?;
        }
        writer.flush()
    })
}

fn cell(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        plain => plain.to_string(),
    }
}

#[derive(Serialize, Deserialize)]
struct LabelRow {
    sensor: usize,
    part: usize,
}

#[derive(Serialize, Deserialize)]
struct TreeRow {
    child: usize,
    parent: usize,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    place: Option<usize>,
}

/// Writes the truth as a table `sensor,part` and a table `child,parent`; a third column, `place`, follows where several parts turn
/// about one place: joints with the same number are at the same place.
pub fn write_truth(labels: &Path, tree: &Path, truth: &Truth) -> Result<(), FileError> {
    write_rows(labels, truth.labels.iter().enumerate().map(|(sensor, &part)| LabelRow { sensor, part }))?;
    let shares = truth.shares_places();
    let row = |(&(child, parent), &place): (&(usize, usize), &usize)| TreeRow {
        child,
        parent,
        place: shares.then_some(place),
    };
    write_rows(tree, truth.tree.iter().zip(&truth.places).map(row))
}

/// Reads the truth: a part for each of `sensors` sensors, and a tree over all the parts, as [`write_truth`] writes them.
pub fn read_truth(labels: &Path, tree: &Path, sensors: usize) -> Result<Truth, FileError> {
    let part_of = read_parts(labels, sensors)?;
    if let Some(sensor) = part_of.iter().position(Option::is_none) {
        return Err(FileError::new(
            labels,
            format!("sensor {sensor} of {sensors} has no part; give each sensor one row"),
        ));
    }
    let rows: Vec<TreeRow> = read_rows(tree)?;
    let edges = rows.iter().map(|row| (row.child, row.parent)).collect();
    let mut truth = Truth::new(part_of.into_iter().flatten().collect(), edges);
    if let Some(places) = rows.iter().map(|row| row.place).collect() {
        truth.places = places;
    } else if let Some(line) =
        rows.iter().position(|row| row.place.is_none()).filter(|_| rows.iter().any(|row| row.place.is_some()))
    {
        return Err(FileError::new(
            tree,
            format!("line {}: the joint has no place; give each one, or none", line + 2),
        ));
    }
    check_tree(&truth).map_err(|message| FileError::new(tree, message))?;
    Ok(truth)
}

/// Reads the part of each of `sensors` sensors; `None` for one that has no row. Other columns may follow.
pub fn read_parts(path: &Path, sensors: usize) -> Result<Vec<Option<usize>>, FileError> {
    let mut part_of = vec![None; sensors];
    for LabelRow { sensor, part } in read_rows(path)? {
        let message = match part_of.get_mut(sensor) {
            Some(slot @ None) => {
                *slot = Some(part);
                continue;
            }
            Some(Some(_)) => format!("sensor {sensor} has two parts; give each sensor one row"),
            None => format!("there is no sensor {sensor}: the data have sensors 0 to {}", sensors - 1),
        };
        return Err(FileError::new(path, message));
    }
    Ok(part_of)
}

/// Whether the edges connect all parts without a cycle: one fewer than parts, none between parts connected before.
fn check_tree(truth: &Truth) -> Result<(), String> {
    let mut parts = truth.labels.clone();
    parts.sort_unstable();
    parts.dedup();
    let unknown =
        truth.tree.iter().flat_map(|&(a, b)| [a, b]).find(|part| parts.binary_search(part).is_err());
    if let Some(part) = unknown {
        return Err(format!("part {part} has no sensor in the labels"));
    }
    if !is_tree(&truth.tree) || truth.tree.len() + 1 != parts.len() {
        return Err(format!(
            "{} edges do not make a tree over {} parts: give one edge fewer than parts, without a cycle",
            truth.tree.len(),
            parts.len()
        ));
    }
    Ok(())
}

/// Reads rows by their header.
///
/// # Errors
/// If the file cannot be read, or a line is not such a row.
pub fn read_rows<T: DeserializeOwned>(path: &Path) -> Result<Vec<T>, FileError> {
    let mut reader = csv::Reader::from_path(path)
        .map_err(|error| FileError::new(path, format!("cannot be read: {}", plain(&error))))?;
    let rows: Result<Vec<T>, _> = reader.deserialize().collect();
    rows.map_err(|error| {
        let line = error.position().map_or(String::new(), |position| format!("line {}: ", position.line()));
        FileError::new(path, format!("{line}{}", plain(&error)))
    })
}

/// Reads all cells of a table, its header first.
///
/// # Errors
/// If the file cannot be read, is empty, or has rows of different lengths.
pub fn read_cells(path: &Path) -> Result<Vec<Vec<String>>, FileError> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .from_path(path)
        .map_err(|error| FileError::new(path, format!("cannot be read: {}", plain(&error))))?;
    let cells = |record: csv::StringRecord| record.iter().map(str::to_owned).collect();
    let rows: Result<Vec<Vec<String>>, _> = reader.records().map(|record| record.map(cells)).collect();
    let rows = rows.map_err(|error| FileError::new(path, plain(&error)))?;
    if rows.is_empty() { Err(FileError::new(path, "is empty")) } else { Ok(rows) }
}

/// The csv crate's message without the parts that repeat the place.
fn plain(error: &csv::Error) -> String {
    match error.kind() {
        csv::ErrorKind::Io(error) => error.to_string(),
        csv::ErrorKind::Deserialize { err, .. } => err.kind().to_string(),
        _ => error.to_string(),
    }
}

/// Writes a row for each of the T + 1 samples: `time_s`, then the angles of each joint in rad.
pub fn write_joint_angles(
    path: &Path,
    joints: &[Joint],
    trajectory: &Trajectory,
    interval: f64,
) -> Result<(), FileError> {
    write_whole(path, |file| {
        let mut writer = csv::Writer::from_writer(file);
        let name = |joint: usize, axis: usize| format!("joint{}_angle{}_rad", joint + 1, axis + 1);
        let freedom = |joint: usize| joints[joint].freedom.angles();
        let names =
            (0..joints.len()).flat_map(|joint| (0..freedom(joint)).map(move |axis| name(joint, axis)));
        writer.write_record(std::iter::once("time_s".to_owned()).chain(names))?;
        for sample in 0..=trajectory.samples() {
            writer.write_field(format!("{:.6}", sample as f64 * interval))?;
            let angles = &trajectory.angles[sample * joints.len()..][..joints.len()];
            for (joint, angles) in angles.iter().enumerate() {
                for angle in &angles[..freedom(joint)] {
                    writer.write_field(format!("{angle:.6}"))?;
                }
            }
            writer.write_record(None::<&[u8]>)?;
        }
        writer.flush()
    })
}

#[derive(Serialize)]
struct SampleRow {
    chain: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    sweep: Option<usize>,
    parts: usize,
    log_posterior: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    ari: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    eligible: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    tree_correct: Option<bool>,
}

/// Writes `samples.csv`, a row for each posterior sample: `chain`, `sweep` where a chain has several, `parts`,
/// `log_posterior`, and `ari`, `eligible` and `tree_correct` if there are scores.
pub fn write_samples(
    path: &Path,
    samples: &[Sample],
    keep: Keep,
    scores: Option<&[Score]>,
) -> Result<(), FileError> {
    let rows = samples.iter().enumerate().map(|(at, sample)| {
        let score = scores.map(|scores| &scores[at]);
        SampleRow {
            chain: sample.chain,
            sweep: (keep == Keep::All).then_some(sample.sweep),
            parts: parts(&sample.labels),
            log_posterior: sample.log_posterior,
            ari: score.map(|score| score.ari),
            eligible: score.map(|score| score.eligible),
            tree_correct: score.map(|score| score.tree_correct),
        }
    });
    write_rows(path, rows)
}

/// Writes `trees.csv`, a row an edge: `chain`, `sweep` where a chain has several samples, `child` and `parent`,
/// labels as in the assignments, and, where the mixture has joints, `x1` … `xd`: the joint on the body map.
pub fn write_trees(path: &Path, samples: &[Sample], keep: Keep) -> Result<(), FileError> {
    let dims = samples.iter().flat_map(|sample| &sample.joints).next().map_or(0, Vec::len);
    let sweep = keep == Keep::All;
    write_whole(path, |file| {
        let mut writer = csv::Writer::from_writer(file);
        let names =
            ["chain", "sweep", "child", "parent"].into_iter().filter(|name| *name != "sweep" || sweep);
        writer.write_record(names.map(str::to_owned).chain((1..=dims).map(|k| format!("x{k}"))))?;
        for sample in samples {
            for (at, edge) in sample.tree.iter().enumerate() {
                let numbers =
                    [Some(sample.chain), sweep.then_some(sample.sweep), Some(edge.child), Some(edge.parent)];
                let joint = sample.joints.get(at).into_iter().flatten();
                let numbers = numbers.into_iter().flatten().map(|number| number.to_string());
                writer.write_record(numbers.chain(joint.map(f64::to_string)))?;
            }
        }
        writer.flush()
    })
}

#[cfg(test)]
mod tests;
