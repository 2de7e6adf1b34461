//! Keep scenes in a folder of results, so that its page can be made again.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::files::{FileError, read_text};

/// The folder of scenes within that of results.
const FOLDER: &str = "scenes";

/// Name of the file of a scene within a folder of results.
pub(crate) fn name(coordination: f64) -> String {
    format!("{FOLDER}/p-{coordination}.json")
}

/// What the file of a scene holds, which [`super::scene::Scene::data`] gives.
pub(crate) fn text(data: &Value) -> String {
    format!("{data}\n")
}

/// Names of the files of all scenes of a folder of results, p rising.
pub(crate) fn names(folder: &Path) -> Vec<String> {
    let Ok(entries) = fs::read_dir(folder.join(FOLDER)) else { return Vec::new() };
    let coordination = |name: &str| name.strip_prefix("p-")?.strip_suffix(".json")?.parse::<f64>().ok();
    let named = |name: String| Some((coordination(&name)?, name));
    let mut found: Vec<(f64, String)> =
        entries.filter_map(|entry| named(entry.ok()?.file_name().into_string().ok()?)).collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found.into_iter().map(|(_, name)| format!("{FOLDER}/{name}")).collect()
}

/// All scenes of a folder of results, p rising; none if it has none.
///
/// # Errors
/// If a file is malformed.
pub(crate) fn read(folder: &Path) -> Result<Vec<Value>, FileError> {
    let read = |name: String| {
        let path = folder.join(name);
        let wrong =
            |what: String| FileError::new(&path, format!("is not a scene: {what}; run the experiment again"));
        let scene: Value =
            serde_json::from_str(&read_text(&path)?).map_err(|error| wrong(error.to_string()))?;
        if scene["frames"].is_u64() {
            Ok(scene)
        } else {
            Err(wrong("it lacks the number of frames".to_owned()))
        }
    };
    names(folder).into_iter().map(read).collect()
}
