//! Give bytes to a reader as a file, and check its answer: a value, or one line that says what is wrong.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use tempfile::TempDir;

/// The folder of this process; `reproduce/fuzz.sh` removes it.
pub fn folder() -> &'static Path {
    static FOLDER: OnceLock<TempDir> = OnceLock::new();
    FOLDER.get_or_init(|| TempDir::new().expect("a folder for files")).path()
}

/// A file in [`folder`] that holds `bytes`.
pub fn file(name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder().join(name);
    fs::create_dir_all(path.parent().expect("it is in a folder")).expect("folders can be made");
    fs::write(&path, bytes).expect("files can be written");
    path
}

/// What was read, if it was.
///
/// # Panics
/// If the reason why it was not takes more than a line, or a line that nobody reads to its end.
pub fn accepted<T, E: Error>(answer: Result<T, E>) -> Option<T> {
    answer
        .inspect_err(|error| {
            let message = error.to_string();
            assert!(message.lines().count() == 1 && message.chars().count() < 500, "{message:?}");
        })
        .ok()
}
