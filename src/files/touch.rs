//! Read pressures as people have them: a table, an array of NumPy, or an archive of arrays; from a file, a pipe or standard input.

mod arrays;
mod cell;
mod columns;
mod dialect;
mod format;
mod recorded;
mod source;
mod table;
mod unicode;

use std::io::Read;
use std::path::Path;

use self::dialect::Dialect;
pub use self::format::{Column, Decimal, Format, Separator, TimeColumn};
pub use self::recorded::Recorded;
use self::source::{HEAD, Kind, Source};
use super::error::FileError;
use crate::stages::sense::Tactile;

/// Reads pressures, T × M, as [`read_recorded`] does without being told anything. A column of times is left out.
///
/// # Errors
/// As [`read_recorded`].
pub fn read_touch(path: &Path) -> Result<Tactile, FileError> {
    Ok(read_recorded(path, &Format::default())?.tactile)
}

/// Reads pressures, T × M, of any sign: a table in text, a `.npy` file, or an array of an `.npz` archive, which their first bytes
/// tell. The path `-` is standard input.
///
/// A first row of a table that is not all numbers has names. An empty cell, and what programs write for none, is NaN. A column of
/// times or row numbers is no sensor.
///
/// # Errors
/// If the file cannot be read, or a cell is no number. The message says which, and what helps.
pub fn read_recorded(path: &Path, format: &Format) -> Result<Recorded, FileError> {
    let source = Source::open(path)?;
    if let Some(array) = format.array.as_ref().filter(|_| source.kind() != Kind::Npz) {
        let array = format.front_end.choice("array", [array, &format!("{array:?}")]);
        let message = format!("is no .npz archive, so that {array} means nothing");
        return Err(FileError::new(&source.name, message));
    }
    let name = source.name.clone();
    let recorded = match source.kind() {
        Kind::Npy => arrays::read_npy(&source.bytes()?, format),
        Kind::Npz => arrays::read_npz(&source.bytes()?, format),
        Kind::Text => read_text(source, format),
    }?;
    if recorded.tactile.pressures.is_empty() {
        let message =
            format!("has no column of a sensor; if its columns are no times, say {}", format.no_time());
        return Err(FileError::new(&name, message));
    }
    Ok(recorded)
}

fn read_text(source: Source, format: &Format) -> Result<Recorded, FileError> {
    let (name, first) = (source.name.clone(), source.head().to_vec());
    let broken = |error: std::io::Error| FileError::new(&name, format!("cannot be read: {error}"));
    let mut text = unicode::text(&first, source.reader()).map_err(broken)?;
    let mut head = Vec::new();
    text.by_ref().take(HEAD as u64).read_to_end(&mut head).map_err(broken)?;
    let dialect = Dialect::of(&head, format);
    table::read(&name, head.as_slice().chain(text), dialect, format)
}

#[cfg(test)]
mod tests;
