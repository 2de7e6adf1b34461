//! Keep finished work of an experiment or a study in files, from which an interrupted run continues.
//!
//! A checkpoint is used only if its file is whole (by its hash) and of the same program, settings and seed, so that
//! nothing stale or half-written gets into a result.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use super::error::FileError;
use super::hash::{sha256, sha256_of_text};
use super::whole::write_text;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;

/// The checkpoints of one run.
#[derive(Debug)]
pub(crate) struct Checkpoints {
    folder: PathBuf,
    /// What the results depend on.
    key: String,
    /// Whether the user was told that checkpoints are used, and that some are of another run.
    told: [AtomicBool; 2],
}

#[derive(Serialize, Deserialize)]
struct File {
    key: String,
    sha256: String,
    content: Box<RawValue>,
}

impl Checkpoints {
    /// The checkpoints in the folder `out`, of a run whose results depend on `inputs` alone.
    pub(crate) fn new(out: &Path, inputs: &impl Serialize) -> Self {
        let inputs = serde_json::to_string(inputs).expect("inputs are plain data");
        let key = sha256_of_text(&format!("{}{inputs}", program()));
        Self { folder: out.join("checkpoints"), key, told: Default::default() }
    }

    /// The same, without a word of them: what is recalled is of this run.
    pub(crate) fn silent(out: &Path, inputs: &impl Serialize) -> Self {
        Self { told: [true, false].map(AtomicBool::new), ..Self::new(out, inputs) }
    }

    /// What an earlier run kept under a name; `None` if it kept nothing that can be used.
    pub(crate) fn recall<T: DeserializeOwned>(&self, name: &str) -> Option<T> {
        let path = self.path(name);
        let text = match fs::read_to_string(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == ErrorKind::NotFound => return None,
            Err(error) => return self.damaged(&path, &error.to_string()),
        };
        let file: File = match serde_json::from_str(&text) {
            Ok(file) => file,
            Err(_) => return self.damaged(&path, "is not a checkpoint"),
        };
        if file.sha256 != sha256_of_text(file.content.get()) {
            return self.damaged(&path, "its content does not match its hash");
        }
        if file.key != self.key {
            if !self.told[1].swap(true, Ordering::Relaxed) {
                eprintln!(
                    "bodyschema: {}: checkpoints of other settings or of another version of the program are ignored",
                    self.folder.display()
                );
            }
            return None;
        }
        let Ok(content) = serde_json::from_str(file.content.get()) else {
            return self.damaged(&path, "holds results of another kind");
        };
        if !self.told[0].swap(true, Ordering::Relaxed) {
            eprintln!("bodyschema: {}: continuing from what an earlier run finished", self.folder.display());
        }
        Some(content)
    }

    fn damaged<T>(&self, path: &Path, what: &str) -> Option<T> {
        eprintln!("bodyschema: {}: {what}; this part is run again", path.display());
        None
    }

    /// Keeps a result under a name.
    ///
    /// # Errors
    /// If it cannot be written.
    pub(crate) fn keep<T: Serialize>(&self, name: &str, content: &T) -> Result<(), FileError> {
        let content = serde_json::value::to_raw_value(content).expect("results are plain data");
        let file = File { key: self.key.clone(), sha256: sha256_of_text(content.get()), content };
        let text = serde_json::to_string(&file).expect("a checkpoint is plain data");
        write_text(&self.path(name), &text)
    }

    /// Removes all of them, when the run is finished.
    ///
    /// # Errors
    /// If they cannot be removed.
    pub(crate) fn clear(&self) -> Result<(), FileError> {
        remove(&self.folder)
    }

    /// Removes those whose names begin with `name` and a slash.
    ///
    /// # Errors
    /// If they cannot be removed.
    pub(crate) fn forget(&self, name: &str) -> Result<(), FileError> {
        remove(&self.folder.join(name))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.join(format!("{name}.json"))
    }
}

fn remove(folder: &Path) -> Result<(), FileError> {
    match fs::remove_dir_all(folder) {
        Err(error) if error.kind() != ErrorKind::NotFound => {
            Err(FileError::new(folder, format!("cannot be removed: {error}")))
        }
        _ => Ok(()),
    }
}

/// What tells this program from any other: the hash of its own file, since two builds of one revision may
/// differ.
fn program() -> String {
    let own = std::env::current_exe().ok().and_then(|path| sha256(&path).ok());
    own.unwrap_or_else(|| env!("BODYSCHEMA_REVISION").to_owned())
}

#[cfg(test)]
mod tests;
