//! Gather what a folder has of a body: a simulation, an estimate, or one's own data.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::best_sample;
use super::frames::Frames;
use super::scene::{Parts, Scene, TreeEdge};
use super::sketch::sketch;
use crate::estimate::distances;
use crate::files::moved_body::MovedBody;
use crate::files::tables::{read_cells, read_parts, read_rows};
use crate::files::touch::{Format, read_recorded};
use crate::files::{FileError, npy, read_text};
use crate::settings::Settings;
use crate::stages::body_map::BodyMap;
use crate::stages::rigid_parts::is_signed;
use crate::stages::sense::Tactile;
use crate::stages::usable::usable;

/// Where the files of a scene are.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sources<'a> {
    /// The folder.
    pub folder: &'a Path,
    /// Pressures, if they are not in the folder.
    pub tactile: Option<&'a Path>,
    /// How to read them.
    pub format: &'a Format,
    /// Folder of an estimate, if it is not the folder itself.
    pub estimate: Option<&'a Path>,
}

/// Reads what there is, and says what was guessed of the pressures. Makes a map of three dimensions where there is none.
///
/// # Errors
/// If there are no pressures, or files do not fit each other.
pub(crate) fn read(sources: &Sources, settings: &Settings) -> Result<(Scene, Vec<String>), FileError> {
    let folder = sources.folder;
    let tactile = tactile(sources)?;
    let recorded = read_recorded(&tactile, sources.format)?;
    let touch = recorded.tactile;
    let sensors = touch.sensors();
    let body = MovedBody::is_in(folder).then(|| MovedBody::read(folder)).transpose()?;
    if let Some(body) = &body {
        check(folder, body, &touch)?;
    }
    let interval = interval(folder).or(recorded.interval);
    let labels = folder.join("labels.csv");
    let truth =
        if labels.is_file() { Some(true_parts(&labels, &folder.join("tree.csv"), sensors)?) } else { None };
    let found = sources.estimate.unwrap_or(folder);
    let file = found.join("parts.csv");
    let estimate = if file.is_file() {
        check_estimate(found, sensors)?;
        // A tree beside labels is the true one.
        let trees: &[&str] =
            if found.join("labels.csv").is_file() { &["edges.csv"] } else { &["tree.csv", "edges.csv"] };
        let trees: Vec<PathBuf> = trees.iter().map(|name| found.join(name)).collect();
        Some(parts(&file, &trees, sensors)?)
    } else if best_sample::is_in(found) {
        Some(best_sample::read(found, sensors)?)
    } else if let Some(estimate) = sources.estimate {
        return Err(FileError::new(
            estimate,
            "has no parts.csv; give a folder that `bodyschema estimate` or `infer` wrote",
        ));
    } else {
        None
    };
    let solids = body.as_ref().map_or(0, |body| body.shapes.len());
    let frames = Frames::of(&touch, solids, Frames::every(interval), Frames::ROOM);
    let shown = frames.of_touch(&touch);
    let map = map(&[found, folder], touch, settings)?;
    let scene = Scene {
        name: String::new(),
        frames,
        times: None,
        interval,
        sensors,
        touch: shown,
        body,
        is_still: false,
        surfaces: Vec::new(),
        map,
        truth,
        estimate,
    };
    Ok((scene, recorded.guesses))
}

/// The file of the pressures.
fn tactile(sources: &Sources) -> Result<PathBuf, FileError> {
    let folder = sources.folder;
    if !folder.is_dir() {
        return Err(FileError::new(folder, "no such folder"));
    }
    if let Some(tactile) = sources.tactile {
        return Ok(tactile.to_owned());
    }
    let names = ["tactile.npy", "tactile.csv"].map(|name| folder.join(name));
    names.into_iter().find(|path| path.is_file()).ok_or_else(|| {
        FileError::new(folder, "has no tactile.npy or tactile.csv; give the file of pressures with --tactile")
    })
}

/// Whether a body is that of the pressures.
fn check(folder: &Path, body: &MovedBody, touch: &Tactile) -> Result<(), FileError> {
    let times = body.poses.len() / body.shapes.len();
    if body.sites.len() == touch.sensors() && times == touch.samples + 1 {
        return Ok(());
    }
    let message = format!(
        "is of {} sensors and {} samples, but the pressures are of {} sensors and {} samples",
        body.sites.len(),
        times - 1,
        touch.sensors(),
        touch.samples
    );
    Err(FileError::new(&folder.join("poses.npy"), message))
}

/// Time between two samples as joint-angles.csv has it, s.
fn interval(folder: &Path) -> Option<f64> {
    let cells = read_cells(&folder.join("joint-angles.csv")).ok()?;
    let time = |row: usize| cells.get(row)?.first()?.parse::<f64>().ok();
    Some(time(2)? - time(1)?).filter(|interval| *interval > 0.0 && interval.is_finite())
}

/// A row of tree.csv or edges.csv, whose columns differ by the method.
#[derive(Deserialize)]
struct EdgeRow {
    #[serde(alias = "part")]
    child: usize,
    #[serde(alias = "other")]
    parent: usize,
    #[serde(alias = "probability", alias = "confidence")]
    support: Option<f64>,
    in_tree: Option<bool>,
}

/// A row of names.csv.
#[derive(Deserialize)]
struct NameRow {
    part: usize,
    name: String,
}

/// True parts, their names if they have any, and the tree. A tree with the support of its edges is an estimated one, and left out.
fn true_parts(labels: &Path, tree: &Path, sensors: usize) -> Result<Parts, FileError> {
    let mut truth = parts(labels, &[tree.to_owned()], sensors)?;
    truth.tree.retain(|edge| edge.support.is_none());
    let names = labels.with_file_name("names.csv");
    if names.is_file() {
        let mut rows: Vec<NameRow> = read_rows(&names)?;
        rows.sort_by_key(|row| row.part);
        if let Some(at) = (0..rows.len()).find(|at| rows[*at].part != *at) {
            return Err(FileError::new(
                &names,
                format!("names part {} where part {at} is expected", rows[at].part),
            ));
        }
        truth.names = rows.into_iter().map(|row| row.name).collect();
    }
    Ok(truth)
}

/// What `estimate` says of its input.
#[derive(Deserialize)]
struct Summary {
    sensors: usize,
}

/// Whether an estimate is of so many sensors, where it says of how many.
fn check_estimate(folder: &Path, sensors: usize) -> Result<(), FileError> {
    let path = folder.join("summary.json");
    if !path.is_file() {
        return Ok(());
    }
    let summary: Summary = serde_json::from_str(&read_text(&path)?).map_err(|error| {
        FileError::new(&path, format!("is not what `bodyschema estimate` writes: {error}"))
    })?;
    if summary.sensors == sensors {
        return Ok(());
    }
    let message = format!("is of {} sensors, but the pressures are of {sensors}", summary.sensors);
    Err(FileError::new(&path, message))
}

/// Parts and the first tree that exists; no tree is no error.
fn parts(file: &Path, trees: &[PathBuf], sensors: usize) -> Result<Parts, FileError> {
    let of = read_parts(file, sensors)?;
    let Some(path) = trees.iter().find(|path| path.is_file()) else {
        return Ok(Parts { of, tree: Vec::new(), names: Vec::new() });
    };
    let rows: Vec<EdgeRow> = read_rows(path)?;
    let known = |part: usize| of.contains(&Some(part));
    let mut tree = Vec::new();
    for EdgeRow { child, parent, support, .. } in rows.into_iter().filter(|row| row.in_tree != Some(false)) {
        if let Some(part) = [child, parent].into_iter().find(|part| !known(*part)) {
            return Err(FileError::new(path, format!("part {part} has no sensor in {}", file.display())));
        }
        tree.push(TreeEdge { child, parent, support });
    }
    Ok(Parts { of, tree, names: Vec::new() })
}

/// The map of the first folder that has one, and else a sketch; `None` where pressures give none.
fn map(folders: &[&Path], touch: Tactile, settings: &Settings) -> Result<Option<BodyMap>, FileError> {
    let sensors = touch.sensors();
    if let Some(path) = folders.iter().map(|folder| folder.join("body-map.npy")).find(|path| path.is_file()) {
        let map = npy::read_body_map(&path)?;
        if map.points() != sensors {
            let message = format!("has {} points, but there are {sensors} sensors", map.points());
            return Err(FileError::new(&path, message));
        }
        return Ok(Some(map));
    }
    let used = usable(touch);
    if used.sensors.is_empty() {
        return Ok(None);
    }
    let (mapped, distances) = distances(&used.tactile, is_signed(&used.tactile), &settings.quantise);
    let mapped: Vec<usize> = mapped.into_iter().map(|at| used.sensors[at]).collect();
    Ok(sketch(&distances, settings.map.of, &mapped, sensors))
}
