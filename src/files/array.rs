//! Read a matrix of any numeric type from the bytes of a `.npy` file, wherever they come from.

mod decode;
mod header;

use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

use npyz::{DType, NpyFile, Order};
use rayon::prelude::*;

use self::decode::Decode;
use super::error::FileError;

/// A matrix as it was read.
pub(super) struct Matrix<T> {
    pub(super) rows: usize,
    pub(super) columns: usize,
    pub(super) values: Vec<T>,
}

/// A matrix whose header was read, and whose values follow.
pub(super) struct Array<'a> {
    /// The file, as messages name it.
    name: &'a Path,
    npy: NpyFile<BufReader<Box<dyn Read + Send + 'a>>>,
    decode: Decode,
    pub(super) rows: usize,
    pub(super) columns: usize,
}

/// How values lie in a file, and how they are wanted.
#[derive(Clone, Copy)]
struct Layout {
    /// Values of a line of the file.
    line: usize,
    /// Whether lines of the other direction are wanted.
    transposed: bool,
}

impl<'a> Array<'a> {
    /// Reads the header of a `.npy` file of so many bytes. The matrix is not empty, and its values are as many bytes as there are at
    /// least: this is known before anything is allocated, since a header can state any size.
    pub(super) fn open(
        name: &'a Path,
        reader: Box<dyn Read + Send + 'a>,
        bytes: u64,
    ) -> Result<Self, FileError> {
        let broken = |error: io::Error| {
            FileError::new(name, format!("cannot be read as a .npy file: {}", explained(&error)))
        };
        let mut reader = BufReader::with_capacity(1 << 20, reader);
        header::check(reader.fill_buf().map_err(broken)?).map_err(|message| FileError::new(name, message))?;
        let npy = NpyFile::new(reader).map_err(broken)?;
        let decode = Decode::of(&npy.dtype()).ok_or_else(|| wrong_type(name, &npy.dtype()))?;
        let &[rows, columns] = npy.shape() else {
            let message = format!(
                "must have two dimensions, but its shape is {:?}; save x.reshape(len(x), -1)",
                npy.shape()
            );
            return Err(FileError::new(name, message));
        };
        if rows == 0 || columns == 0 {
            return Err(FileError::new(name, format!("is empty: its shape is {rows} x {columns}")));
        }
        let size = rows.checked_mul(columns).and_then(|count| count.checked_mul(decode.width as u64));
        if size.is_none_or(|size| size > bytes) {
            let message = format!(
                "is truncated: its header states {rows} x {columns} values, but the file has only {bytes} bytes"
            );
            return Err(FileError::new(name, message));
        }
        Ok(Self { name, npy, decode, rows: rows as usize, columns: columns as usize })
    }

    /// Reads the values into the order `wanted`, each checked by `convert`.
    pub(super) fn read<T: Copy + Default + Send + Sync>(
        self,
        wanted: Order,
        convert: impl Fn(f64) -> Result<T, &'static str> + Sync,
    ) -> Result<Matrix<T>, FileError> {
        let Self { name, npy, decode, rows, columns } = self;
        let order = npy.order();
        let checked = |at: usize, value: f64| {
            convert(value).map_err(|message| {
                let (row, column) = match order {
                    Order::C => (at / columns, at % columns),
                    Order::Fortran => (at % rows, at / rows),
                };
                FileError::new(name, format!("row {row}, column {column}: {value}; {message}"))
            })
        };
        let transposed = (order == Order::C) != (wanted == Order::C);
        // Lines of the file: rows in C order, columns in Fortran order.
        let line = if order == Order::C { columns } else { rows };
        let layout = Layout { line, transposed };
        let values = collect(npy.into_inner(), &decode, name, rows * columns, layout, checked)?;
        Ok(Matrix { rows, columns, values })
    }

    /// Whether float32 has room for all digits of a value.
    pub(super) fn is_single(&self) -> bool {
        self.decode.is_single
    }

    /// Reads only these columns, with all their digits.
    pub(super) fn read_columns(self, which: &[usize]) -> Result<Vec<Vec<f64>>, FileError> {
        let Self { name, npy, decode, rows, columns } = self;
        let is_by_row = npy.order() == Order::C;
        let (lines, line) = if is_by_row { (rows, columns) } else { (columns, rows) };
        let mut file = npy.into_inner();
        let mut bytes = vec![0; line * decode.width];
        let mut found: Vec<Vec<f64>> = vec![Vec::new(); which.len()];
        for at in 0..lines {
            file.read_exact(&mut bytes).map_err(|error| damaged(name, &error))?;
            for (column, values) in which.iter().zip(&mut found) {
                let own = match is_by_row {
                    true => &bytes[column * decode.width..(column + 1) * decode.width],
                    false if at == *column => &bytes[..],
                    false => continue,
                };
                (decode.add)(own, values).map_err(|error| damaged(name, &error))?;
            }
        }
        Ok(found)
    }
}

/// The reader's words, where they are not plain.
fn explained(error: &io::Error) -> String {
    match error.to_string() {
        text if text.contains("magic not found") => {
            format!("{text}; a table of numbers must have another name than .npy")
        }
        text => text,
    }
}

fn damaged(name: &Path, error: &io::Error) -> FileError {
    FileError::new(name, format!("is truncated or damaged: {error}"))
}

fn wrong_type(name: &Path, dtype: &DType) -> FileError {
    let message = format!(
        "must hold numbers or bool, but its dtype is {}; save x.astype(numpy.float32)",
        dtype.descr()
    );
    FileError::new(name, message)
}

/// Reads all values in the wanted order. A large file takes the memory of its values once: bytes are read a few lines at a time,
/// which all threads decode and put in place.
fn collect<T: Copy + Default + Send + Sync>(
    mut file: impl Read,
    Decode { width, add, .. }: &Decode,
    name: &Path,
    length: usize,
    Layout { line, transposed }: Layout,
    convert: impl Fn(usize, f64) -> Result<T, FileError> + Sync,
) -> Result<Vec<T>, FileError> {
    /// Values that are read at a time, about: few enough to stay near the processor.
    const VALUES: usize = 1 << 17;
    /// Fewest lines that are read at a time where they are to be columns: enough to fill what the memory hands over at once.
    const LINES: usize = 64;
    /// Values that a thread decodes at a time.
    const SHARE: usize = 1 << 13;
    let damaged = |error: io::Error| damaged(name, &error);
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
    let mut bytes = Vec::new();
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
