//! What results depend on besides settings and seed: the program, its libraries and the machine.

use std::path::Path;
use std::process::Command;

use serde_json::{Map, Value, json};

use super::{FileError, read_text, sha256, write_text};
use crate::simulate::world;

/// The program, the physics engine, the compiler, the C library and the processor.
pub fn provenance() -> Map<String, Value> {
    let (ode_version, ode_configuration) = world::engine();
    let facts = json!({
        "program": format!("bodyschema {}", env!("CARGO_PKG_VERSION")),
        "revision": env!("BODYSCHEMA_REVISION"),
        "streams": "SHA-256 of (seed, simulation, chain, stage) seeds xoshiro256++",
        "ode": { "version": ode_version, "configuration": ode_configuration },
        "rustc": env!("BODYSCHEMA_RUSTC"),
        "libc": first_line_of(Command::new("getconf").arg("GNU_LIBC_VERSION")),
        "cpu": field_of("/proc/cpuinfo", "model name"),
    });
    match facts {
        Value::Object(facts) => facts,
        _ => unreachable!("it is written as an object"),
    }
}

/// Reads a manifest.
///
/// # Errors
/// If it cannot be read, or is no JSON.
pub fn read_manifest(path: &Path) -> Result<Value, FileError> {
    serde_json::from_str(&read_text(path)?)
        .map_err(|error| FileError::new(path, format!("is no manifest: {error}")))
}

/// Name and SHA-256 of files of a folder.
///
/// # Errors
/// If one cannot be read.
pub fn hashes<'a>(folder: &Path, names: impl IntoIterator<Item = &'a str>) -> Result<Vec<Value>, FileError> {
    names.into_iter().map(|name| Ok(json!({ "file": name, "sha256": sha256(&folder.join(name))? }))).collect()
}

/// Writes a JSON value for people to read, too.
///
/// # Errors
/// If it cannot be written.
pub fn write_json(path: &Path, value: &Value) -> Result<(), FileError> {
    let text = serde_json::to_string_pretty(value).expect("a JSON value can be written");
    write_text(path, &(text + "\n"))
}

/// The value of the first `name : value` line of a file of the proc file system.
pub fn field_of(path: &str, name: &str) -> Option<String> {
    let text = std::fs::read_to_string(path).ok()?;
    let (_, value) = text.lines().find(|line| line.starts_with(name))?.split_once(':')?;
    Some(value.trim().to_owned())
}

fn first_line_of(command: &mut Command) -> Option<String> {
    let output = command.output().ok()?;
    String::from_utf8(output.stdout).ok()?.lines().next().map(str::to_owned)
}
