//! Describe a folder of results in two files: `manifest.json`, equal for two runs of the same program, and `run.json`,
//! which tells the runs apart.

use std::path::Path;
use std::time::{Instant, SystemTime};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::error::FileError;
use super::hash::sha256;
use super::provenance::{Provenance, field_of};
use super::whole::{read_text, write_text};

/// The name of the manifest in its folder.
pub(crate) const MANIFEST: &str = "manifest.json";

/// What made the results in a folder, and the hash of each file.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// The experiment, `exp1` or `exp2`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub experiment: Option<String>,
    /// The subcommand of a study: `study` or `bodies`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub study: Option<String>,
    /// Conditions and amounts of an experiment, in words.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub summary: Option<String>,
    /// The headline in a sentence: what came out, and what the paper reports.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub headline: Vec<String>,
    /// Whether it was a small run that only shows the program working.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub quick: Option<bool>,
    /// Master seed.
    pub seed: u64,
    /// The program, its libraries and the machine.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// For each simulation of an experiment, how well its sensors could be mapped.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bodies: Option<Vec<Value>>,
    /// All settings of an experiment; a study has a design among its files.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub settings: Option<Value>,
    /// The files that an experiment read.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inputs: Option<Vec<HashedFile>>,
    /// The files of the folder.
    pub outputs: Vec<HashedFile>,
}

/// A file and its hash.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct HashedFile {
    /// Its path, within the folder of the manifest or as the user gave it.
    pub file: String,
    /// SHA-256 in hexadecimal.
    pub sha256: String,
}

impl HashedFile {
    /// Hashes the file at `path`, which the manifest calls `file`.
    ///
    /// # Errors
    /// If it cannot be read.
    pub fn new(file: &str, path: &Path) -> Result<Self, FileError> {
        Ok(Self { file: file.to_owned(), sha256: sha256(path)? })
    }
}

impl Manifest {
    /// Of a study by this program.
    pub fn of_study(study: &str, seed: u64) -> Self {
        Self { study: Some(study.to_owned()), seed, provenance: Provenance::here(), ..Self::default() }
    }

    /// Whether a folder has a manifest, as finished results do.
    pub fn is_in(folder: &Path) -> bool {
        folder.join(MANIFEST).is_file()
    }

    /// Reads the manifest of a folder.
    ///
    /// # Errors
    /// If there is no manifest, or the file is not one.
    pub fn read(folder: &Path) -> Result<Self, FileError> {
        let path = folder.join(MANIFEST);
        if !path.exists() {
            return Err(FileError::new(&path, "no such file; a run writes its manifest when it is finished"));
        }
        let text = read_text(&path)?;
        serde_json::from_str(&text)
            .map_err(|error| FileError::new(&path, format!("is not a manifest of results: {error}")))
    }

    /// Writes it into a folder.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), FileError> {
        write_json(&folder.join(MANIFEST), self)
    }
}

/// The command by which this process was started; what is no text in it is replaced.
pub(crate) fn arguments() -> Vec<String> {
    std::env::args_os().map(|argument| argument.to_string_lossy().into_owned()).collect()
}

/// How a run went: when, by which command, and with what effort.
#[derive(Debug, Serialize)]
struct Circumstances {
    command: Vec<String>,
    started: String,
    seconds: f64,
    threads: usize,
    peak_memory: Option<String>,
}

/// Writes `run.json` for a run of this process that started at a given time.
///
/// # Errors
/// If it cannot be written.
pub(crate) fn write_circumstances(
    folder: &Path,
    (started, clock): (SystemTime, Instant),
) -> Result<(), FileError> {
    let circumstances = Circumstances {
        command: arguments(),
        started: humantime::format_rfc3339_seconds(started).to_string(),
        seconds: clock.elapsed().as_secs_f64(),
        threads: rayon::current_num_threads(),
        peak_memory: field_of("/proc/self/status", "VmHWM"),
    };
    write_json(&folder.join("run.json"), &circumstances)
}

/// Writes plain data as JSON that is easy to read.
///
/// # Errors
/// If it cannot be written.
pub(crate) fn write_json(path: &Path, value: &impl Serialize) -> Result<(), FileError> {
    let text = serde_json::to_string_pretty(value).expect("plain data can be written as JSON");
    write_text(path, &(text + "\n"))
}
