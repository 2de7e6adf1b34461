//! Describe a folder of results as a Process Run Crate, the field's format for "this program made these files": what its
//! manifest says, and when and by which command.
//!
//! RO-Crate 1.1 (<https://w3id.org/ro/crate/1.1>) with the profile Process Run Crate 0.5
//! (<https://w3id.org/ro/wfrun/process/0.5>). Who ran the program and under which licence the results are only that person
//! can say; the crate says so in their places.

use std::path::Path;
use std::time::SystemTime;

use serde::Deserialize;
use serde_json::{Value, json};

use super::error::FileError;
use super::manifest::{HashedFile, MANIFEST, Manifest, arguments, write_json};
use super::provenance::Provenance;
use super::whole::read_text;

/// The name of the crate's description in its folder.
pub(crate) const RO_CRATE: &str = "ro-crate-metadata.json";

/// Files of a folder that say what was to be done; all others are what came of it.
const TASKS: [&str; 2] = ["settings.toml", "design.toml"];

const SPECIFICATION: &str = "https://w3id.org/ro/crate/1.1";
const PROFILE: &str = "https://w3id.org/ro/wfrun/process/0.5";
const ODE: &str = "https://www.ode.org";

/// Describes a folder whose manifest is written, of a process that began at a given time and ends now.
///
/// # Errors
/// If it cannot be written.
pub(crate) fn write(folder: &Path, manifest: &Manifest, begun: SystemTime) -> Result<(), FileError> {
    write_json(&folder.join(RO_CRATE), &described(manifest, begun, SystemTime::now()))
}

fn described(manifest: &Manifest, begun: SystemTime, ended: SystemTime) -> Value {
    let what = match (&manifest.experiment, &manifest.study) {
        (Some(experiment), _) => format!("experiment {experiment}"),
        (None, study) => format!("study {}", study.as_deref().unwrap_or_default()),
    };
    let Provenance { program, revision, ode, .. } = &manifest.provenance;
    let (name, version) = program.split_once(' ').unwrap_or((program, ""));
    let (tasks, results): (Vec<_>, Vec<_>) =
        manifest.outputs.iter().partition(|output| TASKS.contains(&output.file.as_str()));
    let ids = |files: &[&HashedFile]| files.iter().map(|file| id(&file.file)).collect::<Vec<_>>();
    let objects = [&ids(&tasks)[..], &[id("#seed")]].concat();
    let parts = [&ids(&tasks)[..], &ids(&results), &[id(MANIFEST)]].concat();
    let summary = manifest.summary.as_deref().unwrap_or("Tables, figures and a report.");
    let mut graph = vec![
        json!({
            "@id": RO_CRATE,
            "@type": "CreativeWork",
            "conformsTo": id(SPECIFICATION),
            "about": id("./"),
        }),
        json!({
            "@id": "./",
            "@type": "Dataset",
            "conformsTo": id(PROFILE),
            "name": format!("Results of {what} by {program}"),
            "description": format!(
                "{summary} {MANIFEST} names libraries, machine and settings. The times are those of the last process: an \
                 interrupted run continues from checkpoints of earlier processes."
            ),
            "datePublished": time(ended),
            "license": id("#licence"),
            "hasPart": parts,
            "mentions": id("#run"),
        }),
        json!({
            "@id": PROFILE,
            "@type": "CreativeWork",
            "name": "Process Run Crate",
            "version": "0.5",
        }),
        json!({
            "@id": "#run",
            "@type": "CreateAction",
            "name": format!("Run of {what}"),
            "description": arguments().join(" "),
            "startTime": time(begun),
            "endTime": time(ended),
            "actionStatus": "http://schema.org/CompletedActionStatus",
            "agent": id("#agent"),
            "instrument": id("#program"),
            "object": objects,
            "result": ids(&results),
        }),
        json!({
            "@id": "#program",
            "@type": "SoftwareApplication",
            "name": name,
            "softwareVersion": format!("{version} (revision {revision})"),
            "softwareRequirements": id(ODE),
        }),
        json!({
            "@id": ODE,
            "@type": "SoftwareApplication",
            "name": "Open Dynamics Engine",
            "softwareVersion": ode.version,
            "url": ODE,
        }),
        json!({
            "@id": "#agent",
            "@type": "Person",
            "name": "Whoever ran the program (not named)",
        }),
        json!({
            "@id": "#licence",
            "@type": "CreativeWork",
            "name": "No licence is stated",
            "description": "Whoever publishes the results chooses one. The program is MIT OR Apache-2.0.",
        }),
        json!({
            "@id": "#seed",
            "@type": "PropertyValue",
            "name": "master seed",
            "value": manifest.seed,
        }),
        json!({
            "@id": MANIFEST,
            "@type": "File",
            "name": MANIFEST,
            "encodingFormat": format_of(MANIFEST),
        }),
    ];
    graph.extend(manifest.outputs.iter().map(|HashedFile { file, sha256 }| {
        json!({
            "@id": file,
            "@type": "File",
            "name": file,
            "encodingFormat": format_of(file),
            "sha256": sha256,
        })
    }));
    json!({
        // The context of RO-Crate 1.1 is older than the term.
        "@context": [format!("{SPECIFICATION}/context"), { "sha256": "http://schema.org/sha256" }],
        "@graph": graph,
    })
}

fn id(of: &str) -> Value {
    json!({ "@id": of })
}

/// A time in UTC. The profile's check knows offsets, but no `Z`.
fn time(time: SystemTime) -> String {
    humantime::format_rfc3339_seconds(time).to_string().replace('Z', "+00:00")
}

/// The media type of a file that we write.
fn format_of(file: &str) -> &'static str {
    match Path::new(file).extension().and_then(|extension| extension.to_str()) {
        Some("csv") => "text/csv",
        Some("html") => "text/html",
        Some("json") => "application/json",
        Some("md") => "text/markdown",
        Some("svg") => "image/svg+xml",
        Some("toml") => "application/toml",
        // NumPy's format has no registered name.
        _ => "application/octet-stream",
    }
}

/// What we read of a crate, which its user may have completed.
#[derive(Deserialize)]
struct Crate {
    #[serde(rename = "@graph")]
    graph: Vec<Entity>,
}

#[derive(Deserialize)]
struct Entity {
    #[serde(rename = "@id")]
    id: String,
    sha256: Option<String>,
}

/// The files of a folder with the hashes that its crate states; `None` if it has no crate.
///
/// # Errors
/// If the crate cannot be read as one.
pub(crate) fn stated(folder: &Path) -> Result<Option<Vec<HashedFile>>, FileError> {
    let path = folder.join(RO_CRATE);
    if !path.exists() {
        return Ok(None);
    }
    let Crate { graph } = serde_json::from_str(&read_text(&path)?)
        .map_err(|error| FileError::new(&path, format!("is not a crate of results: {error}")))?;
    let hashed = |Entity { id, sha256 }| Some(HashedFile { file: id, sha256: sha256? });
    Ok(Some(graph.into_iter().filter_map(hashed).collect()))
}
