//! Read and write matrices as NumPy's `.npy` files: pressures, symbols, distances, body maps, assignments.

use std::fmt::Display;
use std::fs::File;
use std::io;
use std::path::Path;

use npyz::{Order, WriterBuilder};

use super::array::{Array, Matrix};
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

/// Writes the component of each sensor as int32, posterior samples × M.
pub fn write_assignments(path: &Path, samples: &[Sample]) -> Result<(), FileError> {
    let sensors = samples.first().map_or(0, |sample| sample.labels.len());
    let labels = samples.iter().flat_map(|sample| sample.labels.iter().map(|&label| label as i32));
    write(path, [samples.len(), sensors], Order::C, labels)
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

/// Reads pressures, T × M, of any numeric type; each must be finite and not negative.
pub fn read_tactile(path: &Path) -> Result<Tactile, FileError> {
    let matrix = read_matrix(path, Order::Fortran, |value| match value {
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
    let matrix = read_matrix(path, Order::Fortran, |value| {
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
    let matrix = read_matrix(path, Order::C, |value| match value {
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
    let matrix = read_matrix(path, Order::C, |value| {
        if value.is_finite() { Ok(value) } else { Err("a coordinate must be a finite number") }
    })?;
    Ok(BodyMap { dims: matrix.columns, coordinates: matrix.values })
}

/// Reads the component of each sensor: how many posterior samples, how many sensors, and their components, sample after sample.
pub fn read_assignments(path: &Path) -> Result<(usize, usize, Vec<usize>), FileError> {
    let whole = |value: f64| value >= 0.0 && value <= f64::from(i32::MAX) && value.fract() == 0.0;
    let matrix = read_matrix(path, Order::C, |value| {
        if whole(value) {
            Ok(value as usize)
        } else {
            Err("a component must be a whole number of at least 0")
        }
    })?;
    Ok((matrix.rows, matrix.columns, matrix.values))
}

/// Reads a matrix of any numeric type into the order `wanted`, each value checked by `convert`.
pub(super) fn read_matrix<T: Copy + Default + Send + Sync>(
    path: &Path,
    wanted: Order,
    convert: impl Fn(f64) -> Result<T, &'static str> + Sync,
) -> Result<Matrix<T>, FileError> {
    let broken = |error: io::Error| match error.kind() {
        io::ErrorKind::NotFound => FileError::new(path, "no such file"),
        _ => FileError::new(path, format!("cannot be read as a .npy file: {error}")),
    };
    let file = File::open(path).map_err(broken)?;
    let bytes = file.metadata().map_err(broken)?.len();
    Array::open(path, Box::new(file), bytes)?.read(wanted, convert)
}

#[cfg(test)]
mod tests;
