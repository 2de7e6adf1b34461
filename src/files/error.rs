//! Say in one line which file cannot be read or written, and why.

use std::path::{Path, PathBuf};

/// A file that cannot be read or written as what it should be.
#[derive(Debug, thiserror::Error)]
#[error("{}: {message}", path.display())]
pub struct FileError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong with it and what to do.
    pub message: String,
}

impl FileError {
    /// Says `message` of the file at `path`, on one line.
    pub fn new(path: &Path, message: impl ToString) -> Self {
        Self { path: path.to_owned(), message: one_line(&message.to_string()) }
    }
}

/// A message on one line that a person reads to its end: it may quote what a file holds.
pub fn one_line(message: &str) -> String {
    const MAX_CHARACTERS: usize = 300;
    let line = message.split_whitespace().collect::<Vec<_>>().join(" ");
    // A terminal would obey them.
    let line = line.replace(char::is_control, "\u{fffd}");
    match line.char_indices().nth(MAX_CHARACTERS) {
        Some((end, _)) => format!("{} …", &line[..end]),
        None => line,
    }
}
