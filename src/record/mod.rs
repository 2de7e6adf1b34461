//! Files that NumPy and a spreadsheet open: every stage's input and output.

pub mod checkpoint;
pub mod npy;
pub mod provenance;
pub mod tables;

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

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
    const LONGEST: usize = 300;
    let line = message.split_whitespace().collect::<Vec<_>>().join(" ");
    match line.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{} …", &line[..end]),
        None => line,
    }
}

/// Writes a file that appears whole or not at all: `write` fills a file beside it, which is synced and
/// then takes its name. Folders on the way are made.
///
/// # Errors
/// If any of that fails; what was there before is then untouched.
pub fn write_whole(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), FileError> {
    // A link keeps pointing where it does; a device or pipe is not replaced.
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    if target.exists() && !target.is_file() {
        return Err(FileError::new(path, "cannot be written: it exists and is no regular file"));
    }
    let aside = target.with_added_extension("partial");
    let attempt = || -> io::Result<()> {
        if let Some(folder) = target.parent() {
            fs::create_dir_all(folder)?;
        }
        let mut writer = BufWriter::with_capacity(1 << 20, File::create(&aside)?);
        write(&mut writer)?;
        writer.into_inner().map_err(io::IntoInnerError::into_error)?.sync_all()?;
        fs::rename(&aside, &target)
    };
    attempt().map_err(|error| {
        // Nothing is lost if it cannot be removed; the error that counts is the first.
        let _ = fs::remove_file(&aside);
        FileError::new(path, format!("cannot be written: {error}"))
    })
}

/// Makes sure, before any work is done for it, that a folder is there and can be written to.
///
/// # Errors
/// If it cannot.
pub fn prepare_folder(path: &Path) -> Result<(), FileError> {
    let probe = path.join(".bodyschema.partial");
    fs::create_dir_all(path)
        .and_then(|()| File::create(&probe))
        .and_then(|_| fs::remove_file(&probe))
        .map_err(|error| FileError::new(path, format!("cannot be written to: {error}")))
}

/// [`write_whole`] for text.
///
/// # Errors
/// As for [`write_whole`].
pub fn write_text(path: &Path, text: &str) -> Result<(), FileError> {
    write_whole(path, |file| file.write_all(text.as_bytes()))
}

/// The text of a file.
///
/// # Errors
/// If it cannot be read, or is no text.
pub fn read_text(path: &Path) -> Result<String, FileError> {
    fs::read_to_string(path).map_err(|error| FileError::new(path, format!("cannot be read: {error}")))
}

/// SHA-256 of a file, in hexadecimal.
///
/// # Errors
/// If the file cannot be read.
pub fn sha256(path: &Path) -> Result<String, FileError> {
    let bytes = fs::read(path).map_err(|error| FileError::new(path, format!("cannot be read: {error}")))?;
    Ok(hexadecimal(&Sha256::digest(bytes)))
}

/// Bytes in hexadecimal.
pub fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
