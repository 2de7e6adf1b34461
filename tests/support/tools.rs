//! Tools that a machine may lack: what needs one is left out with a message, but never under CI.

use std::env;
use std::io::{self, ErrorKind, Write};
use std::path::Path;
use std::process::Command;

use super::said::Said;

/// Says why a check is left out.
///
/// # Panics
/// If the environment variable `CI` is set: `.ci/run` installs all tools.
pub fn skipped(why: &str) {
    assert!(env::var_os("CI").is_none(), "under CI nothing is skipped: {why}");
    // Not by eprintln, which the test harness would keep to itself.
    io::stderr()
        .write_all(format!("skipped: {why} (.ci/run installs what tests need)\n").as_bytes())
        .unwrap();
}

/// A script for Python 3.11, which brought tomllib; none, with a message, without it.
pub fn python(script: &Path) -> Option<Command> {
    let modern = Command::new("python3").args(["-c", "import tomllib"]).output();
    if !modern.is_ok_and(|output| output.status.success()) {
        skipped("there is no Python 3.11");
        return None;
    }
    let mut command = Command::new("python3");
    command.arg(script);
    Some(command)
}

/// What a command does; none, with a message, where its program is missing.
pub fn run(command: &mut Command) -> Option<Said> {
    match command.output() {
        Err(error) if error.kind() == ErrorKind::NotFound => {
            skipped(&format!("{} is missing", command.get_program().display()));
            None
        }
        output => Some(Said::from(output.unwrap_or_else(|error| panic!("{command:?}: {error}")))),
    }
}
