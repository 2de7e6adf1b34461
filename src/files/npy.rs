//! Read and write matrices as NumPy's `.npy` files: pressures, symbols, distances, body maps, assignments.

use std::fmt::Display;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

use npyz::{DType, Deserialize, NpyFile, Order, TypeChar, TypeRead, WriterBuilder};
use rayon::prelude::*;

use super::error::FileError;
use super::whole::write_whole;
use crate::stages::body_map::BodyMap;
use crate::stages::distance::{Distances, MAX_SENSORS};
use crate::stages::quantise::Symbols;
use crate::stages::schema::Sample;
use crate::stages::sense::Tactile;

/// Writes pressures as float32, T × M. The file is in Fortran order, one sensor's series after another's,
/// which NumPy reads as any other.
pub fn write_tactile(path: &Path, tactile: &Tactile) -> Result<(), FileError> {
    write(path, [tactile.samples, tactile.sensors()], Order::Fortran, tactile.pressures.iter().copied())
}

/// Writes distances as float64, M × M.
pub fn write_distances(path: &Path, distances: &Distances) -> Result<(), FileError> {
    write(path, [distances.sensors; 2], Order::C, distances.values.iter().copied())
}

/// Writes a body map as float64, M × d.
pub fn write_body_map(path: &Path, map: &BodyMap) -> Result<(), FileError> {
    write(path, [map.points(), map.dims], Order::C, map.coordinates.iter().copied())
}

/// Writes the component of each sensor as int32, draws × M.
pub fn write_assignments(path: &Path, draws: &[Sample]) -> Result<(), FileError> {
    let sensors = draws.first().map_or(0, |draw| draw.labels.len());
    let labels = draws.iter().flat_map(|draw| draw.labels.iter().map(|&label| label as i32));
    write(path, [draws.len(), sensors], Order::C, labels)
}

/// Writes a matrix whose values come in the order given.
pub(super) fn write<T: npyz::AutoSerialize>(
    path: &Path,
    shape: [usize; 2],
    order: Order,
    values: impl Iterator<Item = T>,
) -> Result<(), FileError> {
    write_whole(path, |file| {
        let shape = shape.map(|length| length as u64);
        let mut writer =
            npyz::WriteOptions::new().default_dtype().shape(&shape).order(order).writer(file).begin_nd()?;
        writer.extend(values)?;
        writer.finish()
    })
}

/// Reads pressures, T × M, of float32, float64 or any integer type; each must be finite and not negative.
pub fn read_tactile(path: &Path) -> Result<Tactile, FileError> {
    let matrix = Matrix::read(path, Order::Fortran, |value| match value {
        value if !value.is_finite() => Err("a pressure must be a finite number"),
        value if value < 0.0 => {
            Err("a pressure must not be negative (if the file holds symbols, add --symbols)")
        }
        value if value > f64::from(f32::MAX) => Err("a pressure must not exceed the largest float32"),
        value => Ok(value as f32),
    })?;
    check_sensors(path, matrix.columns, matrix.rows)?;
    Ok(Tactile { samples: matrix.rows, pressures: matrix.values })
}

/// Reads pressures as a robot has them, T × M, of any numeric type: of any sign, and NaN where a value is not finite or
/// exceeds the largest float32.
pub fn read_any_tactile(path: &Path) -> Result<Tactile, FileError> {
    let finite = |value: f64| value.abs() <= f64::from(f32::MAX);
    let matrix =
        Matrix::read(path, Order::Fortran, |value| Ok(if finite(value) { value as f32 } else { f32::NAN }))?;
    check_sensors(path, matrix.columns, matrix.rows)?;
    Ok(Tactile { samples: matrix.rows, pressures: matrix.values })
}

/// Refuses a matrix of too many columns, as one of sensors × times has: its distances would not fit the memory.
pub(super) fn check_sensors(path: &Path, columns: usize, rows: impl Display) -> Result<(), FileError> {
    if columns <= MAX_SENSORS {
        return Ok(());
    }
    let message = format!(
        "has {rows} rows and {columns} columns; each row is a sample in time, each column a sensor, and {MAX_SENSORS} sensors are the \
         maximum: is it transposed?"
    );
    Err(FileError::new(path, message))
}

/// Reads symbols, T × M, of any type with whole values from 0 to 255.
pub fn read_symbols(path: &Path) -> Result<Symbols, FileError> {
    let matrix = Matrix::read(path, Order::Fortran, |value| {
        let symbol = value as u8;
        if f64::from(symbol) == value {
            Ok(symbol)
        } else {
            Err("a symbol must be a whole number from 0 to 255")
        }
    })?;
    check_sensors(path, matrix.columns, matrix.rows)?;
    // Two at least: a single symbol is one that never changes.
    let levels = 2.max(1 + matrix.values.iter().copied().max().map_or(0, usize::from));
    Ok(Symbols { samples: matrix.rows, levels, values: matrix.values })
}

/// Reads distances, M × M: finite, not negative, symmetric, with a zero diagonal.
pub fn read_distances(path: &Path) -> Result<Distances, FileError> {
    let matrix = Matrix::read(path, Order::C, |value| match value {
        value if !value.is_finite() => Err("a distance must be a finite number"),
        value if value < 0.0 => Err("a distance must not be negative"),
        value => Ok(value),
    })?;
    let sensors = matrix.rows;
    if matrix.columns != sensors {
        let message = format!(
            "distances must be a square matrix, but the shape is {sensors} x {}; give the output of `bodyschema distance`",
            matrix.columns
        );
        return Err(FileError::new(path, message));
    }
    let distances = Distances { sensors, values: matrix.values };
    for i in 0..sensors {
        if distances.get(i, i) != 0.0 {
            let message = format!("row {i}, column {i}: {}; the diagonal must be 0", distances.get(i, i));
            return Err(FileError::new(path, message));
        }
        for j in 0..i {
            let (lower, upper) = (distances.get(i, j), distances.get(j, i));
            if (lower - upper).abs() > 1e-9 * (lower + upper) {
                let message = format!(
                    "row {i}, column {j}: {lower}, but row {j}, column {i}: {upper}; distances must be symmetric"
                );
                return Err(FileError::new(path, message));
            }
        }
    }
    Ok(distances)
}

/// Reads a body map, M × d; all coordinates must be finite.
pub fn read_body_map(path: &Path) -> Result<BodyMap, FileError> {
    let matrix = Matrix::read(path, Order::C, |value| {
        if value.is_finite() { Ok(value) } else { Err("a coordinate must be a finite number") }
    })?;
    Ok(BodyMap { dims: matrix.columns, coordinates: matrix.values })
}

/// Reads the component of each sensor: how many draws, how many sensors, and their components, draw after draw.
pub fn read_assignments(path: &Path) -> Result<(usize, usize, Vec<usize>), FileError> {
    let whole = |value: f64| value >= 0.0 && value <= f64::from(i32::MAX) && value.fract() == 0.0;
    let matrix = Matrix::read(path, Order::C, |value| {
        if whole(value) {
            Ok(value as usize)
        } else {
            Err("a component must be a whole number of at least 0")
        }
    })?;
    Ok((matrix.rows, matrix.columns, matrix.values))
}

/// A matrix as it was read.
pub(super) struct Matrix<T> {
    pub(super) rows: usize,
    pub(super) columns: usize,
    pub(super) values: Vec<T>,
}

impl<T: Copy + Default + Send + Sync> Matrix<T> {
    /// Reads a matrix of float32, float64 or any integer type into the order `wanted`, each value checked by `convert`.
    pub(super) fn read(
        path: &Path,
        wanted: Order,
        convert: impl Fn(f64) -> Result<T, &'static str> + Sync,
    ) -> Result<Self, FileError> {
        let (npy, bytes) = open(path)?;
        let (rows, columns) = shape(path, &npy, bytes)?;
        let order = npy.order();
        let checked = |at: usize, value: f64| {
            convert(value).map_err(|message| {
                let (row, column) = match order {
                    Order::C => (at / columns, at % columns),
                    Order::Fortran => (at % rows, at / rows),
                };
                FileError::new(path, format!("row {row}, column {column}: {value}; {message}"))
            })
        };
        let decode = decoder(path, &npy)?;
        let transposed = (order == Order::C) != (wanted == Order::C);
        // Lines of the file: rows in C order, columns in Fortran order.
        let line = if order == Order::C { columns } else { rows };
        let values = collect(npy, decode, path, Layout { line, transposed }, checked)?;
        Ok(Self { rows, columns, values })
    }
}

/// How values lie in a file, and how they are wanted.
#[derive(Clone, Copy)]
struct Layout {
    /// Values of a line of the file.
    line: usize,
    /// Whether lines of the other direction are wanted.
    transposed: bool,
}

/// A `.npy` file whose header was read.
type Npy = NpyFile<BufReader<File>>;

/// Opens a `.npy` file and reads its header; also returns the length of the file in bytes.
fn open(path: &Path) -> Result<(Npy, u64), FileError> {
    let broken = |error: io::Error| match error.kind() {
        io::ErrorKind::NotFound => FileError::new(path, "no such file"),
        _ => FileError::new(path, format!("cannot be read as a .npy file: {error}")),
    };
    let file = File::open(path).map_err(broken)?;
    let bytes = file.metadata().map_err(broken)?.len();
    let mut reader = BufReader::with_capacity(1 << 20, file);
    check_header(reader.fill_buf().map_err(broken)?).map_err(|message| FileError::new(path, message))?;
    Ok((NpyFile::new(reader).map_err(broken)?, bytes))
}

/// Rows and columns of a matrix that is not empty and for whose values a file of `bytes` bytes is long enough.
///
/// This is checked before anything is allocated, since a header can state any size.
fn shape(path: &Path, npy: &Npy, bytes: u64) -> Result<(usize, usize), FileError> {
    let &[rows, columns] = npy.shape() else {
        let message = format!("must have two dimensions, but its shape is {:?}", npy.shape());
        return Err(FileError::new(path, message));
    };
    if rows == 0 || columns == 0 {
        return Err(FileError::new(path, format!("is empty: its shape is {rows} x {columns}")));
    }
    let (_, width) = plain_type(path, npy)?;
    if rows.checked_mul(columns).and_then(|n| n.checked_mul(width)).is_none_or(|size| size > bytes) {
        let message = format!(
            "is truncated: its header states {rows} x {columns} values, but the file has only {bytes} bytes"
        );
        return Err(FileError::new(path, message));
    }
    Ok((rows as usize, columns as usize))
}

/// Kind and width in bytes of the values.
fn plain_type(path: &Path, npy: &Npy) -> Result<(TypeChar, u64), FileError> {
    match npy.dtype() {
        DType::Plain(kind) => {
            let width = kind.num_bytes().ok_or_else(|| wrong_type(path, npy))?;
            Ok((kind.type_char(), width as u64))
        }
        _ => Err(wrong_type(path, npy)),
    }
}

fn wrong_type(path: &Path, npy: &Npy) -> FileError {
    let dtype = npy.dtype().descr();
    FileError::new(path, format!("must hold float32, float64 or integers, but its dtype is {dtype}"))
}

/// Whether the header is one that NumPy would write, given the start of a file.
///
/// `npyz` reads any Python literal: it takes twice as long for each further list in a list, and multiplies the
/// lengths of any shape. NumPy's own header of a matrix has about a hundred characters, two pairs of brackets, and the
/// digits of two lengths and of a type.
fn check_header(start: &[u8]) -> Result<(), &'static str> {
    const MAX_CHARACTERS: usize = 10_000;
    const MAX_BRACKETS: usize = 6;
    const MAX_DIGITS: usize = 18;
    let (length, text) = match *start {
        [b'\x93', b'N', b'U', b'M', b'P', b'Y', 1, _, a, b, ref text @ ..] => {
            (usize::from(u16::from_le_bytes([a, b])), text)
        }
        [b'\x93', b'N', b'U', b'M', b'P', b'Y', _, _, a, b, c, d, ref text @ ..] => {
            (u32::from_le_bytes([a, b, c, d]) as usize, text)
        }
        // The reader says what is wrong.
        _ => return Ok(()),
    };
    if length > MAX_CHARACTERS {
        return Err("has a header of more than 10000 characters; save the matrix again with numpy.save");
    }
    let text = &text[..length.min(text.len())];
    let brackets = text.iter().filter(|character| b"([{".contains(character)).count();
    let digits = text.iter().filter(|character| character.is_ascii_digit()).count();
    let hexadecimal = text.windows(2).any(|pair| pair.eq_ignore_ascii_case(b"0x"));
    if brackets > MAX_BRACKETS || digits > MAX_DIGITS || hexadecimal {
        return Err("has a header that is not of a plain matrix; save the matrix again with numpy.save");
    }
    Ok(())
}

/// Adds the values that bytes hold.
type AddValues = dyn Fn(&[u8], &mut Vec<f64>) -> io::Result<()> + Send + Sync;

/// Decodes values of one type, and how many bytes each has.
struct Decode {
    width: usize,
    add: Box<AddValues>,
}

/// How to decode the values of a file. All but integers beyond 2^53 are exact as f64.
fn decoder(path: &Path, npy: &Npy) -> Result<Decode, FileError> {
    fn of<S: Deserialize<TypeReader: Send + Sync + 'static> + 'static>(
        dtype: &DType,
        number: fn(S) -> f64,
    ) -> Option<Decode> {
        let (decoder, width) = (S::reader(dtype).ok()?, size_of::<S>());
        let add = move |bytes: &[u8], values: &mut Vec<f64>| {
            values.reserve(bytes.len() / width);
            bytes.chunks_exact(width).try_for_each(|value| {
                values.push(number(decoder.read_one(value)?));
                Ok(())
            })
        };
        Some(Decode { width, add: Box::new(add) })
    }
    let dtype = npy.dtype();
    match plain_type(path, npy)? {
        (TypeChar::Float, 4) => of(&dtype, <f64 as From<f32>>::from),
        (TypeChar::Float, 8) => of(&dtype, |value: f64| value),
        (TypeChar::Int, 1) => of(&dtype, <f64 as From<i8>>::from),
        (TypeChar::Int, 2) => of(&dtype, <f64 as From<i16>>::from),
        (TypeChar::Int, 4) => of(&dtype, <f64 as From<i32>>::from),
        (TypeChar::Int, 8) => of(&dtype, |value: i64| value as f64),
        (TypeChar::Uint, 1) => of(&dtype, <f64 as From<u8>>::from),
        (TypeChar::Uint, 2) => of(&dtype, <f64 as From<u16>>::from),
        (TypeChar::Uint, 4) => of(&dtype, <f64 as From<u32>>::from),
        (TypeChar::Uint, 8) => of(&dtype, |value: u64| value as f64),
        _ => None,
    }
    .ok_or_else(|| wrong_type(path, npy))
}

/// Reads all values in the wanted order. A large file takes the memory of its values once: bytes are read a few lines at a time,
/// which all threads decode and put in place.
fn collect<T: Copy + Default + Send + Sync>(
    npy: Npy,
    Decode { width, add }: Decode,
    path: &Path,
    Layout { line, transposed }: Layout,
    convert: impl Fn(usize, f64) -> Result<T, FileError> + Sync,
) -> Result<Vec<T>, FileError> {
    /// Values that are read at a time, about: few enough to stay near the processor.
    const VALUES: usize = 1 << 17;
    /// Fewest lines that are read at a time where they are to be columns: enough to fill what the memory hands over at once.
    const LINES: usize = 64;
    /// Values that a thread decodes at a time.
    const SHARE: usize = 1 << 13;
    let length = npy.len() as usize;
    let damaged = |error: io::Error| FileError::new(path, format!("is truncated or damaged: {error}"));
    // The values from the one with this number on. Of several mistakes, the first is named.
    let decode = |number: usize, bytes: &[u8], values: &mut [T]| -> Result<(), FileError> {
        let shares = values.par_chunks_mut(SHARE).zip(bytes.par_chunks(SHARE * width)).enumerate();
        let decoded = shares.map(|(share, (values, bytes))| {
            let mut decoded = Vec::with_capacity(values.len());
            add(bytes, &mut decoded).map_err(damaged)?;
            for (at, (to, value)) in values.iter_mut().zip(decoded).enumerate() {
                *to = convert(number + share * SHARE + at, value)?;
            }
            Ok(())
        });
        decoded.collect::<Vec<_>>().into_iter().collect()
    };
    let (mut file, mut bytes) = (npy.into_inner(), Vec::new());
    let mut read = |number: usize, values: &mut [T]| {
        bytes.resize(values.len() * width, 0);
        file.read_exact(&mut bytes).map_err(damaged)?;
        decode(number, &bytes, values)
    };
    // Zeros that the system has at hand, and writes nowhere before they are needed.
    let mut values = vec![T::default(); length];
    if !transposed {
        for (at, values) in values.chunks_mut(VALUES).enumerate() {
            read(at * VALUES, values)?;
        }
        return Ok(values);
    }
    let (lines, most) = (length / line, (VALUES / line).max(LINES));
    let mut band = vec![T::default(); most.min(lines) * line];
    for first in (0..lines).step_by(most) {
        let band = &mut band[..most.min(lines - first) * line];
        read(first * line, band)?;
        values.par_chunks_exact_mut(lines).enumerate().for_each(|(at, values)| {
            let column = band[at..].iter().step_by(line);
            values[first..].iter_mut().zip(column).for_each(|(to, value)| *to = *value);
        });
    }
    Ok(values)
}

#[cfg(test)]
mod tests;
