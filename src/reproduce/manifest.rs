//! A finished experiment → manifest.json, which two runs of the same program share, and run.json, which tells
//! them apart.

use std::time::{Instant, SystemTime};

use serde_json::{Value, json};

use super::{Run, preamble};
use crate::claims::{Judged, table};
use crate::record::provenance::{field_of, hashes, provenance, write_json};
use crate::record::{FileError, sha256};

/// Writes what the results depend on, and the hash of each file.
///
/// # Errors
/// If a file cannot be read, or the manifest not written.
pub fn write(run: &Run, judged: &[Judged], bodies: &[Value], outputs: &[String]) -> Result<(), FileError> {
    let Run { experiment, settings, settings_file, quick, out } = *run;
    let inputs: Result<Vec<_>, FileError> = settings_file
        .into_iter()
        .map(|path| Ok(json!({ "file": path.display().to_string(), "sha256": sha256(path)? })))
        .collect();
    let mut manifest = json!({
        "experiment": experiment,
        "summary": preamble(run),
        "headline": judged.iter().filter_map(table::comparison).collect::<Vec<_>>(),
        "quick": quick,
        "seed": settings.experiment.seed,
    });
    let fields = manifest.as_object_mut().expect("it is written as an object");
    fields.extend(provenance());
    fields.insert("bodies".to_owned(), bodies.into());
    fields.insert("settings".to_owned(), serde_json::to_value(settings).expect("settings are plain data"));
    fields.insert("inputs".to_owned(), inputs?.into());
    fields.insert("outputs".to_owned(), hashes(out, outputs.iter().map(String::as_str))?.into());
    write_json(&out.join("manifest.json"), &manifest)
}

/// Writes when, how and with what effort the run was made.
///
/// # Errors
/// If it cannot be written.
pub fn write_circumstances(run: &Run, (started, clock): (SystemTime, Instant)) -> Result<(), FileError> {
    let circumstances = json!({
        "command": std::env::args().collect::<Vec<_>>(),
        "started": humantime::format_rfc3339_seconds(started).to_string(),
        "seconds": clock.elapsed().as_secs_f64(),
        "threads": rayon::current_num_threads(),
        "peak_memory": field_of("/proc/self/status", "VmHWM"),
    });
    write_json(&run.out.join("run.json"), &circumstances)
}
