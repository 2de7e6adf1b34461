//! Write results into a folder, and remember what was written for its manifest and its crate.

use std::path::{Path, PathBuf};
use std::time::SystemTime;

use serde::Serialize;

use super::error::FileError;
use super::manifest::{HashedFile, Manifest};
use super::ro_crate;
use super::tables::write_rows;
use super::whole::{remove_if_there, write_text};

/// A folder of results that remembers the names of its files, in the order in which they were written.
#[derive(Debug)]
pub(crate) struct ResultFolder {
    path: PathBuf,
    names: Vec<String>,
    begun: SystemTime,
}

impl ResultFolder {
    /// A folder to write to. It is made when the work begins: its crate states that time.
    pub(crate) fn new(path: &Path) -> Self {
        Self { path: path.to_owned(), names: Vec::new(), begun: SystemTime::now() }
    }

    /// Where it is.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Writes a table; `name` is its path within the folder.
    ///
    /// # Errors
    /// If it cannot be written.
    pub(crate) fn write_rows<T: Serialize>(
        &mut self,
        name: &str,
        rows: impl IntoIterator<Item = T>,
    ) -> Result<(), FileError> {
        write_rows(&self.path.join(name), rows)?;
        self.remember_one(name);
        Ok(())
    }

    /// Writes a text; `name` is its path within the folder.
    ///
    /// # Errors
    /// If it cannot be written.
    pub(crate) fn write_text(&mut self, name: &str, text: &str) -> Result<(), FileError> {
        write_text(&self.path.join(name), text)?;
        self.remember_one(name);
        Ok(())
    }

    /// A file that is written again is the same file.
    fn remember_one(&mut self, name: &str) {
        if self.names.iter().all(|known| known != name) {
            self.names.push(name.to_owned());
        }
    }

    /// Remembers files that are there already.
    pub(crate) fn remember(&mut self, names: impl IntoIterator<Item = String>) {
        names.into_iter().for_each(|name| self.remember_one(&name));
    }

    /// Removes files that an earlier run left, so that they do not stand beside those of this one.
    ///
    /// # Errors
    /// If one is there and cannot be removed.
    pub(crate) fn remove(&self, names: impl IntoIterator<Item = String>) -> Result<(), FileError> {
        for path in names.into_iter().map(|name| self.path.join(name)) {
            remove_if_there(&path)
                .map_err(|error| FileError::new(&path, format!("cannot be replaced: {error}")))?;
        }
        Ok(())
    }

    /// Writes the manifest, with the hashes of all files that were written or remembered, and the crate, with the same.
    /// Returns the manifest with the hashes.
    ///
    /// # Errors
    /// If a file cannot be read, or one of the two not written.
    pub(crate) fn write_manifest(&self, manifest: Manifest) -> Result<Manifest, FileError> {
        let hash = |name: &String| HashedFile::new(name, &self.path.join(name));
        let outputs = self.names.iter().map(hash).collect::<Result<_, _>>()?;
        let manifest = Manifest { outputs, ..manifest };
        manifest.write(&self.path)?;
        ro_crate::write(&self.path, &manifest, self.begun)?;
        Ok(manifest)
    }
}
