//! Name what results depend on besides settings and seed: the program, its libraries and the machine.

use std::process::Command;

use serde::{Deserialize, Serialize};

use crate::stages::simulate::engine;

/// The program, the physics engine, the compiler, the C library and the processor.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Provenance {
    /// Name and version.
    pub program: String,
    /// Git revision of its source.
    pub revision: String,
    /// How streams of random numbers derive from the master seed.
    pub streams: String,
    /// Open Dynamics Engine.
    pub ode: Engine,
    /// Version of the compiler.
    pub rustc: String,
    /// Version of the C library.
    pub libc: Option<String>,
    /// Model of the processor.
    pub cpu: Option<String>,
}

/// The physics engine.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Engine {
    /// Its version, as built against.
    pub version: String,
    /// Its configuration, as linked.
    pub configuration: String,
}

impl Provenance {
    /// Of this program on this machine.
    pub fn here() -> Self {
        let (version, configuration) = engine();
        Self {
            program: format!("bodyschema {}", env!("CARGO_PKG_VERSION")),
            revision: env!("BODYSCHEMA_REVISION").to_owned(),
            streams: "SHA-256 of (seed, simulation, chain, stage) seeds xoshiro256++".to_owned(),
            ode: Engine { version: version.to_owned(), configuration },
            rustc: env!("BODYSCHEMA_RUSTC").to_owned(),
            libc: first_line_of(Command::new("getconf").arg("GNU_LIBC_VERSION")),
            cpu: field_of("/proc/cpuinfo", "model name"),
        }
    }
}

/// The value of the first `name : value` line of a file of the proc file system.
pub(crate) fn field_of(path: &str, name: &str) -> Option<String> {
    let text = std::fs::read_to_string(path).ok()?;
    let (_, value) = text.lines().find(|line| line.starts_with(name))?.split_once(':')?;
    Some(value.trim().to_owned())
}

fn first_line_of(command: &mut Command) -> Option<String> {
    let output = command.output().ok()?;
    String::from_utf8(output.stdout).ok()?.lines().next().map(str::to_owned)
}
