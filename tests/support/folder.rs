//! The program as a user runs it, in a temporary folder.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;
use tempfile::TempDir;
use walkdir::WalkDir;

use super::said::Said;

pub struct Folder(TempDir);

impl Folder {
    pub fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub fn path(&self) -> &Path {
        self.0.path()
    }

    pub fn at(&self, name: impl AsRef<Path>) -> PathBuf {
        self.path().join(name)
    }

    /// Writes a file, and the folders that it is in.
    pub fn write(&self, name: impl AsRef<Path>, content: impl AsRef<[u8]>) {
        let path = self.at(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, content).unwrap();
    }

    #[track_caller]
    pub fn bytes(&self, name: impl AsRef<Path>) -> Vec<u8> {
        let path = self.at(name);
        fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    }

    #[track_caller]
    pub fn text(&self, name: impl AsRef<Path>) -> String {
        String::from_utf8(self.bytes(name)).unwrap()
    }

    #[track_caller]
    pub fn json(&self, name: impl AsRef<Path>) -> Value {
        serde_json::from_slice(&self.bytes(name)).unwrap()
    }

    /// `bodyschema` with arguments that have no spaces within; others can be added.
    pub fn command(&self, arguments: &str) -> Command {
        // The harness shows it where a test fails.
        println!("bodyschema {arguments}");
        let mut command = Command::new(env!("CARGO_BIN_EXE_bodyschema"));
        command.current_dir(&self.0).args(arguments.split_whitespace());
        command
    }

    pub fn run(&self, arguments: &str) -> Said {
        Said::by(&mut self.command(arguments))
    }

    /// What a run prints that succeeds and has nothing to warn of.
    #[track_caller]
    pub fn succeed(&self, arguments: &str) -> String {
        let said = self.done(arguments);
        assert_eq!(said.err, "", "{arguments}: {}", said.out);
        said.out
    }

    /// A run that succeeds, whatever it warns of.
    #[track_caller]
    pub fn done(&self, arguments: &str) -> Said {
        let said = self.run(arguments);
        assert_eq!(said.status, Some(0), "{arguments}: {said:?}");
        said
    }

    /// An experiment: whether small ones reproduce the paper's claims (status 0) or not (1) does not matter.
    #[track_caller]
    pub fn reproduce(&self, arguments: &str) -> Said {
        let said = self.run(&format!("reproduce {arguments}"));
        assert!(said.status.is_some_and(|status| status <= 1), "{arguments}: {said:?}");
        said
    }

    /// That a run refuses a mistake: status 2 and one line, which contains this.
    #[track_caller]
    pub fn refuse(&self, arguments: &str, expected: &str) {
        self.run(arguments).is_refused(expected);
    }

    /// The rows of a table; see [`rows`].
    pub fn rows(&self, table: impl AsRef<Path>) -> Vec<BTreeMap<String, String>> {
        rows(&self.at(table))
    }

    /// The files of a run, by name; see [`files`].
    pub fn files(&self, run: &str) -> BTreeMap<String, Vec<u8>> {
        files(&self.at(run))
    }

    /// That a run has these files and no others.
    #[track_caller]
    pub fn has_files(&self, run: &str, expected: &BTreeMap<String, Vec<u8>>) {
        let found = self.files(run);
        assert_eq!(found.keys().collect::<Vec<_>>(), expected.keys().collect::<Vec<_>>(), "{run}");
        let other = expected.iter().filter(|(name, bytes)| found[*name] != **bytes).map(|(name, _)| name);
        assert_eq!(other.collect::<Vec<_>>(), [""; 0], "{run}: these differ");
    }
}

/// The rows of a table in CSV, by column.
pub fn rows(table: &Path) -> Vec<BTreeMap<String, String>> {
    csv::Reader::from_path(table).unwrap().deserialize().map(Result::unwrap).collect()
}

/// The files in a folder and their bytes, by name; without those that tell equal runs apart.
pub fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let paths = WalkDir::new(folder).into_iter().map(|entry| entry.unwrap().into_path());
    let named = paths.filter(|path| path.is_file()).map(|path| {
        (path.strip_prefix(folder).unwrap().to_str().unwrap().to_owned(), fs::read(&path).unwrap())
    });
    named
        .filter(|(name, _)| !["run.json", "ro-crate-metadata.json"].iter().any(|own| name.ends_with(own)))
        .collect()
}
