//! Keep scenes in a folder of results, so that its page can be made again.

use std::fs;
use std::path::Path;

use serde_json::Value;

use super::scene::Scene;
use crate::files::{FileError, read_text};

/// The folder of scenes within that of results.
const FOLDER: &str = "scenes";

/// Name of the file of a scene within a folder of results.
pub fn name(coordination: f64) -> String {
    format!("{FOLDER}/p-{coordination}.json")
}

/// What the file of a scene holds.
pub fn text(scene: &Scene) -> String {
    format!("{}\n", scene.data())
}

/// Names of all scenes of a folder of results, as [`name`] gives them, p rising.
pub fn names(folder: &Path) -> Vec<String> {
    let Ok(entries) = fs::read_dir(folder.join(FOLDER)) else { return Vec::new() };
    let coordination = |name: &str| name.strip_prefix("p-")?.strip_suffix(".json")?.parse::<f64>().ok();
    let mut found: Vec<f64> =
        entries.filter_map(|entry| coordination(entry.ok()?.file_name().to_str()?)).collect();
    found.sort_by(f64::total_cmp);
    found.into_iter().map(name).collect()
}

/// All scenes of a folder of results, p rising; none if it has none.
///
/// # Errors
/// If a file is malformed.
pub fn read(folder: &Path) -> Result<Vec<Value>, FileError> {
    let read = |name: String| {
        let path = folder.join(name);
        serde_json::from_str(&read_text(&path)?)
            .map_err(|error| FileError::new(&path, format!("is no scene: {error}; run the experiment again")))
    };
    names(folder).into_iter().map(read).collect()
}
