//! Write files that appear whole or not at all, and read text.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

use super::error::FileError;

/// Whether both paths lead to one file that is there.
pub(crate) fn is_same_file(one: &Path, other: &Path) -> bool {
    matches!((one.canonicalize(), other.canonicalize()), (Ok(one), Ok(other)) if one == other)
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
    let mut write = Some(write);
    write_aside(path, &mut |file| write.take().map_or(Ok(()), |write| write(file)))
}

/// [`write_whole`], compiled once for all that it is called with.
fn write_aside(
    path: &Path,
    write: &mut dyn FnMut(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), FileError> {
    // A link keeps pointing where it does; a device or pipe is not replaced.
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    if target.exists() && !target.is_file() {
        return Err(FileError::new(path, "cannot be written: it is not a regular file; choose another name"));
    }
    let aside = target.with_added_extension("bodyschema.partial");
    let mut attempt = || -> io::Result<()> {
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

/// Makes a folder if it does not exist, and checks that it can be written to, before any work is done for it.
///
/// # Errors
/// If it cannot be made or written to.
pub fn prepare_folder(path: &Path) -> Result<(), FileError> {
    const PROBE: &str = ".bodyschema.probe";
    fs::create_dir_all(path)
        // Others may be looking, too.
        .and_then(|()| File::create(path.join(own(PROBE))))
        .and_then(|_| fs::read_dir(path))
        .and_then(|mut entries| {
            entries.try_for_each(|entry| {
                let entry = entry?;
                // Runs that were killed may have left theirs.
                let is_probe = entry.file_name().to_string_lossy().starts_with(PROBE);
                if is_probe { remove_if_there(&entry.path()) } else { Ok(()) }
            })
        })
        .map_err(|error| FileError::new(path, format!("cannot be written to: {error}")))
}

/// Removes a file that may not be there, or that others may remove, too.
pub(crate) fn remove_if_there(path: &Path) -> io::Result<()> {
    fs::remove_file(path).or_else(|error| match error.kind() {
        io::ErrorKind::NotFound => Ok(()),
        _ => Err(error),
    })
}

/// Writes a text that several processes may write at once, all of them the same.
///
/// # Errors
/// As for [`write_whole`].
pub(crate) fn write_same_text(path: &Path, text: &str) -> Result<(), FileError> {
    let aside = path.with_added_extension(own("new"));
    write_text(&aside, text)?;
    fs::rename(&aside, path).map_err(|error| FileError::new(path, format!("cannot be written: {error}")))
}

const PARTIAL: &str = "partial";

/// An extension that no other process has, on this machine or another one.
fn own(what: &str) -> String {
    let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_nanos());
    format!("{what}-{}-{now:x}.{PARTIAL}", std::process::id())
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
/// If it cannot be read, or is not UTF-8 text.
pub fn read_text(path: &Path) -> Result<String, FileError> {
    fs::read_to_string(path).map_err(|error| FileError::new(path, format!("cannot be read: {error}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_that_is_prepared_has_no_probe_in_it() {
        let folder = tempfile::tempdir().unwrap();
        let left = folder.path().join(".bodyschema.probe-1-2.partial");
        for file in [&left, &folder.path().join("result.csv")] {
            fs::write(file, "").unwrap();
        }
        prepare_folder(folder.path()).unwrap();
        let names = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name());
        assert_eq!(names.collect::<Vec<_>>(), ["result.csv"]);
        assert!(prepare_folder(&folder.path().join("result.csv")).is_err());
    }
}
