//! Matrices as NumPy's `.npy` files: tactile pressures, symbols, distances, body maps, assignments.

use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::path::Path;

use npyz::{DType, Deserialize, NpyFile, Order, TypeChar, WriterBuilder};

use super::{FileError, write_whole};
use crate::body_map::BodyMap;
use crate::distance::{Distances, MOST_SENSORS};
use crate::quantise::Symbols;
use crate::schema::Sample;
use crate::sense::Tactile;

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

/// Writes the component of each sensor as int32, samples × M.
pub fn write_assignments(path: &Path, samples: &[Sample]) -> Result<(), FileError> {
    let sensors = samples.first().map_or(0, |sample| sample.labels.len());
    let labels = samples.iter().flat_map(|sample| sample.labels.iter().map(|&label| label as i32));
    write(path, [samples.len(), sensors], Order::C, labels)
}

fn write<T: npyz::AutoSerialize>(
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
        value if value < 0.0 => Err("a pressure must not be negative (if these are symbols, say --symbols)"),
        value if value > f64::from(f32::MAX) => Err("a pressure must be in the range of float32"),
        value => Ok(value as f32),
    })?;
    check_sensors(path, &matrix)?;
    Ok(Tactile { samples: matrix.rows, pressures: matrix.values })
}

/// A matrix by sensors and times, in place of times and sensors, asks for distances beyond any memory.
fn check_sensors<T>(path: &Path, matrix: &Matrix<T>) -> Result<(), FileError> {
    if matrix.columns <= MOST_SENSORS {
        return Ok(());
    }
    let message = format!(
        "has {} rows and {} columns; a row is a time and a column a sensor, of which there may be {MOST_SENSORS}: \
         is it transposed?",
        matrix.rows, matrix.columns
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
    check_sensors(path, &matrix)?;
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
        let message = format!("distances must be a square matrix, but it is {sensors} x {}", matrix.columns);
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

struct Matrix<T> {
    rows: usize,
    columns: usize,
    values: Vec<T>,
}

impl<T: Copy> Matrix<T> {
    /// Reads a matrix of float32, float64 or any integer type into the order that is asked for, each value checked by `convert`.
    fn read(
        path: &Path,
        wanted: Order,
        convert: impl Fn(f64) -> Result<T, &'static str>,
    ) -> Result<Self, FileError> {
        let broken = |error: io::Error| match error.kind() {
            io::ErrorKind::NotFound => FileError::new(path, "no such file"),
            _ => FileError::new(path, format!("cannot be read as a .npy file: {error}")),
        };
        let file = File::open(path).map_err(broken)?;
        let bytes = file.metadata().map_err(broken)?.len();
        let mut reader = BufReader::with_capacity(1 << 20, file);
        check_header(reader.fill_buf().map_err(broken)?).map_err(|message| FileError::new(path, message))?;
        let npy = NpyFile::new(reader).map_err(broken)?;

        let &[rows, columns] = npy.shape() else {
            let message = format!("must have two dimensions, but its shape is {:?}", npy.shape());
            return Err(FileError::new(path, message));
        };
        if rows == 0 || columns == 0 {
            return Err(FileError::new(path, format!("is empty: its shape is {rows} x {columns}")));
        }
        let dtype = npy.dtype();
        let unusable = || {
            FileError::new(
                path,
                format!("must hold float32, float64 or integers, but its dtype is {}", dtype.descr()),
            )
        };
        let DType::Plain(kind) = &dtype else { return Err(unusable()) };
        let width = kind.num_bytes().ok_or_else(unusable)? as u64;
        // Before anything is allocated: a header can promise any size.
        if rows.checked_mul(columns).and_then(|n| n.checked_mul(width)).is_none_or(|size| size > bytes) {
            let message = format!(
                "is truncated: its header promises {rows} x {columns} values, the file has {bytes} bytes"
            );
            return Err(FileError::new(path, message));
        }
        let (rows, columns, order) = (rows as usize, columns as usize, npy.order());
        let place = |at: usize| match order {
            Order::C => (at / columns, at % columns),
            Order::Fortran => (at % rows, at / rows),
        };
        let checked = |at: usize, value: f64| {
            convert(value).map_err(|message| {
                let (row, column) = place(at);
                FileError::new(path, format!("row {row}, column {column}: {value}; {message}"))
            })
        };
        let values = match (kind.type_char(), width) {
            (TypeChar::Float, 4) => collect(npy, path, |at, x: f32| checked(at, x.into())),
            (TypeChar::Float, 8) => collect(npy, path, |at, x: f64| checked(at, x)),
            (TypeChar::Int, 1) => collect(npy, path, |at, x: i8| checked(at, x.into())),
            (TypeChar::Int, 2) => collect(npy, path, |at, x: i16| checked(at, x.into())),
            (TypeChar::Int, 4) => collect(npy, path, |at, x: i32| checked(at, x.into())),
            (TypeChar::Int, 8) => collect(npy, path, |at, x: i64| checked(at, x as f64)),
            (TypeChar::Uint, 1) => collect(npy, path, |at, x: u8| checked(at, x.into())),
            (TypeChar::Uint, 2) => collect(npy, path, |at, x: u16| checked(at, x.into())),
            (TypeChar::Uint, 4) => collect(npy, path, |at, x: u32| checked(at, x.into())),
            (TypeChar::Uint, 8) => collect(npy, path, |at, x: u64| checked(at, x as f64)),
            _ => Err(unusable()),
        }?;
        let values = match (order, wanted) {
            (Order::C, Order::Fortran) => transpose(&values, rows, columns),
            (Order::Fortran, Order::C) => transpose(&values, columns, rows),
            _ => values,
        };
        Ok(Self { rows, columns, values })
    }
}

/// Whether the header is one that NumPy would write, given the start of a file.
///
/// `npyz` reads any Python literal: it takes twice as long for each further list in a list, and multiplies the
/// lengths of any shape. NumPy's own header of a matrix has about a hundred characters, two pairs of brackets, and the
/// digits of two lengths and of a type.
fn check_header(start: &[u8]) -> Result<(), &'static str> {
    const LONGEST: usize = 10_000;
    const MOST_BRACKETS: usize = 6;
    const MOST_DIGITS: usize = 18;
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
    if length > LONGEST {
        return Err("has a header of more than 10000 characters, as NumPy never writes");
    }
    let text = &text[..length.min(text.len())];
    let brackets = text.iter().filter(|character| b"([{".contains(character)).count();
    let digits = text.iter().filter(|character| character.is_ascii_digit()).count();
    let hexadecimal = text.windows(2).any(|pair| pair.eq_ignore_ascii_case(b"0x"));
    if brackets > MOST_BRACKETS || digits > MOST_DIGITS || hexadecimal {
        return Err("has a header that is not that of a matrix: too many brackets or digits");
    }
    Ok(())
}

fn collect<S: Deserialize, T>(
    npy: NpyFile<BufReader<File>>,
    path: &Path,
    convert: impl Fn(usize, S) -> Result<T, FileError>,
) -> Result<Vec<T>, FileError> {
    let length = npy.len() as usize;
    let values = npy.data::<S>().map_err(|error| FileError::new(path, error))?;
    let mut converted = Vec::with_capacity(length);
    for (at, value) in values.enumerate() {
        let value =
            value.map_err(|error| FileError::new(path, format!("is truncated or damaged: {error}")))?;
        converted.push(convert(at, value)?);
    }
    Ok(converted)
}

/// From `rows` rows of `columns` values to `columns` rows of `rows`, in squares that fit the cache.
fn transpose<T: Copy>(values: &[T], rows: usize, columns: usize) -> Vec<T> {
    const SIDE: usize = 32;
    let mut transposed = vec![values[0]; values.len()];
    for top in (0..rows).step_by(SIDE) {
        for left in (0..columns).step_by(SIDE) {
            for row in top..(top + SIDE).min(rows) {
                for column in left..(left + SIDE).min(columns) {
                    transposed[column * rows + row] = values[row * columns + column];
                }
            }
        }
    }
    transposed
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder() -> tempfile::TempDir {
        tempfile::tempdir().unwrap()
    }

    #[test]
    fn what_was_written_is_read_in_either_order() {
        let folder = folder();
        let (samples, sensors) = (70, 45);
        let tactile =
            Tactile { samples, pressures: (0..samples * sensors).map(|at| at as f32 * 0.25).collect() };
        let fortran = folder.path().join("fortran.npy");
        write_tactile(&fortran, &tactile).unwrap();
        assert_eq!(read_tactile(&fortran).unwrap(), tactile);

        let by_time = transpose(&tactile.pressures, sensors, samples);
        let c = folder.path().join("c.npy");
        write(&c, [samples, sensors], Order::C, by_time.iter().map(|&x| f64::from(x))).unwrap();
        assert_eq!(read_tactile(&c).unwrap(), tactile);
    }

    #[test]
    fn symbols_of_any_type_are_read() {
        let folder = folder();
        let path = folder.path().join("symbols.npy");
        let expected = Symbols { samples: 2, levels: 6, values: vec![0, 1, 5, 0, 2, 2] };
        macro_rules! check {
            ($($kind:ty),*) => {$({
                let values = [0, 5, 2, 1, 0, 2].map(|value: u8| value as $kind);
                write(&path, [2, 3], Order::C, values.into_iter()).unwrap();
                assert_eq!(read_symbols(&path).unwrap(), expected);
            })*};
        }
        check!(i8, i16, i32, i64, u8, u16, u32, u64, f32, f64);
        write(&path, [1, 1], Order::C, [-1_i8].into_iter()).unwrap();
        assert!(read_symbols(&path).is_err());
    }

    #[test]
    fn mistakes_are_named_with_their_place() {
        let folder = folder();
        let path = folder.path().join("bad.npy");
        let says = |message: String, expected: &str| {
            assert!(
                message.contains(expected) && message.contains("bad.npy"),
                "{message:?} lacks {expected:?}"
            );
        };
        says(read_tactile(&path).unwrap_err().to_string(), "no such file");

        write(&path, [2, 2], Order::C, [0.0, 1.0, f64::NAN, 2.0].into_iter()).unwrap();
        says(
            read_tactile(&path).unwrap_err().to_string(),
            "row 1, column 0: NaN; a pressure must be a finite",
        );
        says(read_body_map(&path).unwrap_err().to_string(), "row 1, column 0: NaN; a coordinate");
        says(read_symbols(&path).unwrap_err().to_string(), "whole number from 0 to 255");

        write(&path, [2, 2], Order::C, [0.0, 1.0, -1.0, 2.0].into_iter()).unwrap();
        says(
            read_tactile(&path).unwrap_err().to_string(),
            "row 1, column 0: -1; a pressure must not be negative",
        );
        write(&path, [2, 2], Order::C, [0.0, 1.0, 3.0, 0.0].into_iter()).unwrap();
        says(read_distances(&path).unwrap_err().to_string(), "must be symmetric");
        write(&path, [2, 2], Order::C, [0.5, 1.0, 1.0, 0.0].into_iter()).unwrap();
        says(read_distances(&path).unwrap_err().to_string(), "the diagonal must be 0");
        write(&path, [1, 2], Order::C, [0.5, 1.0].into_iter()).unwrap();
        says(read_distances(&path).unwrap_err().to_string(), "square matrix, but it is 1 x 2");
        write(&path, [0, 2], Order::C, std::iter::empty::<f64>()).unwrap();
        says(read_body_map(&path).unwrap_err().to_string(), "is empty");

        write(&path, [100, 100], Order::C, (0..10_000).map(f64::from)).unwrap();
        let whole = std::fs::read(&path).unwrap();
        std::fs::write(&path, &whole[..whole.len() / 2]).unwrap();
        says(read_body_map(&path).unwrap_err().to_string(), "is truncated");
        std::fs::write(&path, &whole[..whole.len() - 3]).unwrap();
        says(read_body_map(&path).unwrap_err().to_string(), "is truncated");
        std::fs::write(&path, "sensor,part\n0,1\n").unwrap();
        says(read_body_map(&path).unwrap_err().to_string(), "cannot be read as a .npy file");
    }

    /// A file as NumPy writes it, of a header of our own and some bytes.
    fn raw(version: u8, header: &str, data: &[u8]) -> Vec<u8> {
        let length = header.len() as u32;
        let prefix = match version {
            1 => (length as u16).to_le_bytes().to_vec(),
            _ => length.to_le_bytes().to_vec(),
        };
        [&b"\x93NUMPY"[..], &[version, 0], prefix.as_slice(), header.as_bytes(), data].concat()
    }

    fn header(dtype: &str, shape: &str) -> String {
        format!("{{'descr': '{dtype}', 'fortran_order': False, 'shape': {shape}, }}\n")
    }

    #[test]
    fn bytes_in_any_order_and_any_version_of_the_header_are_read() {
        let folder = folder();
        let path = folder.path().join("map.npy");
        let expected = BodyMap { dims: 2, coordinates: vec![0.0, 258.0, -2.0, 3.0, 5.0, -300.0] };
        for version in 1..=3 {
            let big: Vec<u8> = expected.coordinates.iter().flat_map(|x| x.to_be_bytes()).collect();
            std::fs::write(&path, raw(version, &header(">f8", "(3, 2)"), &big)).unwrap();
            assert_eq!(read_body_map(&path).unwrap(), expected);
            let whole: Vec<u8> =
                expected.coordinates.iter().flat_map(|x| (*x as i16).to_be_bytes()).collect();
            std::fs::write(&path, raw(version, &header(">i2", "(3, 2)"), &whole)).unwrap();
            assert_eq!(read_body_map(&path).unwrap(), expected);
        }
        // Keys in another order, and no space.
        let text = "{'shape':(1,2),'descr':'<f4','fortran_order':True}";
        std::fs::write(&path, raw(1, text, &[0; 8])).unwrap();
        assert_eq!(read_body_map(&path).unwrap(), BodyMap { dims: 2, coordinates: vec![0.0; 2] });
    }

    #[test]
    fn one_sensor_and_one_sample_are_data() {
        let folder = folder();
        let path = folder.path().join("one.npy");
        write(&path, [3, 1], Order::C, [0.0, 2.0, 1.0].into_iter()).unwrap();
        assert_eq!(read_tactile(&path).unwrap(), Tactile { samples: 3, pressures: vec![0.0, 2.0, 1.0] });
        write(&path, [1, 3], Order::C, [0.0, 2.0, 1.0].into_iter()).unwrap();
        assert_eq!(read_tactile(&path).unwrap(), Tactile { samples: 1, pressures: vec![0.0, 2.0, 1.0] });
        write(&path, [1, 1], Order::C, [0.0].into_iter()).unwrap();
        assert_eq!(read_distances(&path).unwrap(), Distances { sensors: 1, values: vec![0.0] });
    }

    #[test]
    fn no_header_takes_long_or_much_memory_to_refuse() {
        let folder = folder();
        let path = folder.path().join("bad.npy");
        let largest = "18446744073709551615";
        let nested = format!("{}{}", "[".repeat(60), "]".repeat(60));
        for (bytes, expected) in [
            (
                raw(1, &header("<f8", &format!("({largest}, {largest})")), &[0; 64]),
                "too many brackets or digits",
            ),
            (
                raw(1, &header("<f8", "(0xffffffffffffffff, 0xffffffffffffffff)"), &[0; 64]),
                "too many brackets or",
            ),
            (raw(1, &header("<f8", &nested), &[0; 64]), "too many brackets"),
            (raw(2, &header("<f8", &"(".repeat(40)), &[0; 64]), "too many brackets"),
            (raw(1, &header("<f8", "(999999999, 9999999)"), &[0; 64]), "is truncated: its header promises"),
            (
                raw(1, &header("<f8", &format!("(1, 1{})", " ".repeat(20_000))), &[0; 8]),
                "more than 10000 characters",
            ),
            (b"\x93NUMPY\x02\x00\xff\xff\xff\xff{".to_vec(), "more than 10000 characters"),
            (b"\x93NUMPY\x01\x00\x80\x00{".to_vec(), "cannot be read as a .npy file"),
            (b"\x93NUMPY\x09\x00\x01\x00\x00\x00{".to_vec(), "cannot be read as a .npy file"),
            (b"\x93NUMPY\x01".to_vec(), "cannot be read as a .npy file"),
            (Vec::new(), "cannot be read as a .npy file"),
            (raw(1, &header("<f8", "(-1, 2)"), &[0; 64]), "dimension cannot be negative"),
            (raw(1, &header("<f8", "(4,)"), &[0; 64]), "must have two dimensions"),
            (raw(1, &header("<f8", "()"), &[0; 64]), "must have two dimensions"),
            (
                raw(1, &header("<f2", "(2, 2)"), &[0; 8]),
                "float32, float64 or integers, but its dtype is '<f2'",
            ),
            (raw(1, &header("|b1", "(2, 2)"), &[0; 8]), "but its dtype is '|b1'"),
            (raw(1, &header("<c8", "(2, 2)"), &[0; 64]), "but its dtype is '<c8'"),
            (raw(1, &header("<U3", "(2, 2)"), &[0; 64]), "but its dtype is '<U3'"),
            (raw(1, &header("|O", "(2, 2)"), &[0; 64]), "but its dtype is '|O"),
            (raw(1, &header("<f7", "(2, 2)"), &[0; 64]), "cannot be read as a .npy file"),
        ] {
            std::fs::write(&path, bytes).unwrap();
            let begun = std::time::Instant::now();
            let message = read_tactile(&path).unwrap_err().to_string();
            assert!(message.contains(expected) && !message.contains('\n'), "{message:?} lacks {expected:?}");
            assert!(begun.elapsed().as_secs() < 5, "{expected} took {:?}", begun.elapsed());
        }
    }
}
