//! A finished experiment → manifest.json, which two runs of the same program share, and run.json, which tells
//! them apart.

use std::time::{Instant, SystemTime};

use serde_json::{Value, json};

use super::{Run, preamble};
use crate::claims::{Judged, table};
use crate::record::{FileError, sha256, write_text};
use crate::simulate::world;

/// Writes what the results depend on, and the hash of each file.
///
/// # Errors
/// If a file cannot be read, or the manifest not written.
pub fn write(run: &Run, judged: &[Judged], bodies: &[Value], outputs: &[String]) -> Result<(), FileError> {
    let Run { experiment, settings, settings_file, quick, out } = *run;
    let hashes: Result<Vec<_>, FileError> =
        outputs.iter().map(|name| Ok(json!({ "file": name, "sha256": sha256(&out.join(name))? }))).collect();
    let inputs: Result<Vec<_>, FileError> = settings_file
        .into_iter()
        .map(|path| Ok(json!({ "file": path.display().to_string(), "sha256": sha256(path)? })))
        .collect();
    let (ode_version, ode_configuration) = world::engine();
    let manifest = json!({
        "program": format!("bodyschema {}", env!("CARGO_PKG_VERSION")),
        "revision": env!("BODYSCHEMA_REVISION"),
        "experiment": experiment,
        "summary": preamble(run),
        "headline": judged.iter().filter_map(table::comparison).collect::<Vec<_>>(),
        "quick": quick,
        "seed": settings.experiment.seed,
        "streams": "SHA-256 of (seed, simulation, chain, stage) seeds xoshiro256++",
        "ode": { "version": ode_version, "configuration": ode_configuration },
        "rustc": env!("BODYSCHEMA_RUSTC"),
        "libc": first_line_of(std::process::Command::new("getconf").arg("GNU_LIBC_VERSION")),
        "cpu": field_of("/proc/cpuinfo", "model name"),
        "bodies": bodies,
        "settings": settings,
        "inputs": inputs?,
        "outputs": hashes?,
    });
    write_json(run, "manifest.json", &manifest)
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
    write_json(run, "run.json", &circumstances)
}

fn write_json(run: &Run, name: &str, value: &Value) -> Result<(), FileError> {
    let text = serde_json::to_string_pretty(value).expect("a JSON value can be written");
    write_text(&run.out.join(name), &(text + "\n"))
}

/// The value of the first `name : value` line of a file of the proc file system.
fn field_of(path: &str, name: &str) -> Option<String> {
    let text = std::fs::read_to_string(path).ok()?;
    let (_, value) = text.lines().find(|line| line.starts_with(name))?.split_once(':')?;
    Some(value.trim().to_owned())
}

fn first_line_of(command: &mut std::process::Command) -> Option<String> {
    let output = command.output().ok()?;
    String::from_utf8(output.stdout).ok()?.lines().next().map(str::to_owned)
}
