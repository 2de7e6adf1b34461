//! Read pressures from an array of NumPy, or from an archive of them.

use std::io::Read;
use std::path::Path;

use npyz::Order;
use zip::ZipArchive;

use super::columns::Columns;
use super::format::{Format, TimeColumn};
use super::recorded::{Recorded, without};
use super::source::{Bytes, ReadSeek};
use crate::files::array::Array;
use crate::files::error::FileError;
use crate::files::npy::check_sensors;
use crate::stages::clock::may_rise;
use crate::stages::sense::Tactile;
use crate::stages::usable::only;

/// Values that tell whether a column may rise.
const FIRST: usize = 64;
/// From this size on, float32 has no room for steps of a clock.
const LARGE: f32 = (1 << 20) as f32;

/// Reads a `.npy` file.
pub(super) fn read_npy(bytes: &Bytes, format: &Format) -> Result<Recorded, FileError> {
    read(bytes.name(), format, &mut |take| {
        let (reader, length) = bytes.open()?;
        take(Array::open(bytes.name(), reader, length)?)
    })
}

/// Reads an array of an `.npz` archive.
pub(super) fn read_npz(bytes: &Bytes, format: &Format) -> Result<Recorded, FileError> {
    let entry = entry(bytes, format)?;
    read(bytes.name(), format, &mut |take| {
        let mut archive = archive(bytes)?;
        let (reader, length) = open(bytes.name(), &mut archive, &entry)?;
        take(Array::open(bytes.name(), reader, length)?)
    })
}

/// What is done with an opened array.
type Take<'a> = &'a mut dyn FnMut(Array<'_>) -> Result<(), FileError>;

/// Reads the array that `open` hands over each time that it is called.
fn read(
    file: &Path,
    format: &Format,
    open: &mut dyn FnMut(Take<'_>) -> Result<(), FileError>,
) -> Result<Recorded, FileError> {
    let (mut matrix, mut is_single) = (None, false);
    open(&mut |array| {
        check_sensors(file, array.columns, array.rows)?;
        is_single = array.is_single();
        matrix = Some(array.read(Order::Fortran, |value| Ok(value as f32))?);
        Ok(())
    })?;
    let matrix = matrix.expect("it was read");
    let (count, samples) = (matrix.columns, matrix.rows);
    let tactile = Tactile { samples, pressures: matrix.values };
    let columns = Columns::new(file, count, Vec::new(), format)?;
    let series: Vec<&[f32]> = tactile.series().collect();
    let candidates: Vec<usize> = match format.time {
        TimeColumn::Guess => (0..count).filter(|at| is_candidate(series[*at], is_single)).collect(),
        _ => columns.times.clone(),
    };
    let mut values: Vec<Vec<f64>> = Vec::new();
    if is_single {
        values
            .extend(candidates.iter().map(|at| series[*at].iter().map(|value| f64::from(*value)).collect()));
    } else if !candidates.is_empty() {
        open(&mut |array| {
            values = array.read_columns(&candidates)?;
            Ok(())
        })?;
    }
    let candidates: Vec<(usize, Vec<f64>)> = candidates.into_iter().zip(values).collect();
    let found = columns.found(&candidates, is_single, format);
    let kept = without(count, &found.left_out);
    Ok(Recorded { tactile: only(tactile, &kept), interval: found.interval, guesses: found.guesses })
}

/// Whether a column may hold times: it rises, or it is too large for float32 to tell.
fn is_candidate(series: &[f32], is_single: bool) -> bool {
    let first: Vec<f64> = series.iter().take(FIRST).map(|value| f64::from(*value)).collect();
    may_rise(&first) || !is_single && series[0].abs() >= LARGE
}

type Archive<'a> = ZipArchive<Box<dyn ReadSeek + 'a>>;

fn archive(bytes: &Bytes) -> Result<Archive<'_>, FileError> {
    let (reader, _) = bytes.open()?;
    ZipArchive::new(reader)
        .map_err(|error| FileError::new(bytes.name(), format!("cannot be read as an .npz archive: {error}")))
}

/// The name of the entry that holds the array: the one that the user names, or the only one.
fn entry(bytes: &Bytes, format: &Format) -> Result<String, FileError> {
    let archive = archive(bytes)?;
    let array = |name: &str| name.strip_suffix(".npy").map(str::to_owned);
    let arrays: Vec<String> = archive.file_names().filter_map(|name| array(&name.ok()?)).collect();
    let (listed, asked) = (arrays.join(", "), format.front_end.name("array"));
    let message = match (&format.array, &arrays[..]) {
        (Some(wanted), _) if arrays.contains(wanted) => return Ok(format!("{wanted}.npy")),
        (None, [only]) => return Ok(format!("{only}.npy")),
        (_, []) => "holds no array of NumPy".to_owned(),
        (Some(wanted), _) => format!("has no array `{wanted}`; {asked} takes one of: {listed}"),
        (None, _) => format!("holds {} arrays; say which with {asked}, one of: {listed}", arrays.len()),
    };
    Err(FileError::new(bytes.name(), message))
}

/// Opens an entry, and says how many bytes it has.
fn open<'a>(
    name: &Path,
    archive: &'a mut Archive<'_>,
    entry: &str,
) -> Result<(Box<dyn Read + Send + 'a>, u64), FileError> {
    /// Most bytes that one compressed byte can give.
    const MOST: u64 = 1032;
    /// What may come on top of that.
    const MORE: u64 = 1 << 16;
    let wrong = |error: String| FileError::new(name, format!("array {entry} cannot be read: {error}"));
    let found = archive.by_name(entry).map_err(|error| wrong(error.to_string()))?;
    let (length, packed) = (found.size(), found.compressed_size());
    if length > packed.saturating_mul(MOST).saturating_add(MORE) {
        return Err(wrong(format!("{packed} bytes cannot hold the {length} that it states")));
    }
    Ok((Box::new(found), length))
}
