//! Take NumPy arrays as what the library computes with, and give results back as arrays.

use std::fmt::Display;

use bodyschema::stages::body_map::BodyMap;
use bodyschema::stages::distance::{Distances, MAX_SENSORS};
use bodyschema::stages::sense::Tactile;
use bodyschema::stages::tree::Edge;
use numpy::ndarray::{Array2, ArrayView2};
use numpy::{Element, IntoPyArray, PyArray2, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::{PyMemoryError, PyValueError};
use pyo3::prelude::*;
use rayon::prelude::*;

use crate::run::Threads;

/// Sensors that are taken in together: as many float32 as the memory hands over at once.
const TOGETHER: usize = 16;

/// A user's mistake.
pub(crate) fn value_error(error: impl Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// An array of two dimensions that can be read where it is; `None` if it has another type.
fn matrix<'py, T: Element>(array: &Bound<'py, PyAny>) -> PyResult<Option<PyReadonlyArray2<'py, T>>> {
    let Ok(array) = array.cast::<PyArray2<T>>() else { return Ok(None) };
    if !array.is_aligned() {
        return Err(value_error("the array is not aligned in memory; copy it"));
    }
    array.try_readonly().map(Some).map_err(value_error)
}

/// Pressures, T × M float32 or float64 in any order of memory, as one series after the other: each value is read once, where it is.
/// What is beyond float32 becomes infinite, as from a file.
pub(crate) fn touch(threads: &Threads, array: &Bound<'_, PyAny>) -> PyResult<Tactile> {
    if let Some(array) = matrix::<f32>(array)? {
        return series(threads, array.py(), array.as_array(), |value| value);
    }
    if let Some(array) = matrix::<f64>(array)? {
        return series(threads, array.py(), array.as_array(), |value| value as f32);
    }
    Err(value_error("touch must be a float32 or float64 array of two dimensions, a row for each sample"))
}

fn series<T: Copy + Send + Sync>(
    threads: &Threads,
    py: Python<'_>,
    rows: ArrayView2<'_, T>,
    convert: impl Fn(T) -> f32 + Send + Sync,
) -> PyResult<Tactile> {
    let (samples, sensors) = rows.dim();
    check_sensors(samples, sensors)?;
    check_memory::<f32>(samples, sensors)?;
    let pressures = threads.copy(py, || {
        let mut pressures = vec![0.0; samples * sensors];
        pressures.par_chunks_mut(TOGETHER * samples).enumerate().for_each(|(at, group)| {
            let first = TOGETHER * at;
            let own = rows.slice(numpy::ndarray::s![.., first..first + group.len() / samples]);
            if own.strides()[0] == 1 {
                for (series, column) in group.chunks_exact_mut(samples).zip(own.columns()) {
                    series.iter_mut().zip(column).for_each(|(to, value)| *to = convert(*value));
                }
            } else {
                for (t, row) in own.rows().into_iter().enumerate() {
                    for (series, value) in group.chunks_exact_mut(samples).zip(row) {
                        series[t] = convert(*value);
                    }
                }
            }
        });
        pressures
    })?;
    Ok(Tactile { samples, pressures })
}

/// Refuses an empty recording, and one of too many sensors, as one of sensors × times has.
pub(crate) fn check_sensors(samples: usize, sensors: usize) -> PyResult<()> {
    if samples == 0 || sensors == 0 {
        return Err(value_error(format!("touch is empty: its shape is ({samples}, {sensors})")));
    }
    if sensors > MAX_SENSORS {
        return Err(value_error(format!(
            "touch has {samples} rows and {sensors} columns; each row is a sample in time, each column a sensor, and {MAX_SENSORS} \
             sensors are the maximum: is it transposed?"
        )));
    }
    Ok(())
}

/// Refuses what the memory cannot hold: an array may be larger than its memory (`numpy.broadcast_to`).
pub(crate) fn check_memory<T>(rows: usize, columns: usize) -> PyResult<()> {
    let fits =
        rows.checked_mul(columns).is_some_and(|count| Vec::<T>::new().try_reserve_exact(count).is_ok());
    if fits {
        return Ok(());
    }
    Err(PyMemoryError::new_err(format!("an array of shape ({rows}, {columns}) does not fit the memory")))
}

/// The same pressures as the stages of the paper take them: finite, and not negative.
pub(crate) fn felt(threads: &Threads, array: &Bound<'_, PyAny>) -> PyResult<Tactile> {
    let tactile = touch(threads, array)?;
    match tactile.pressures.iter().position(|pressure| !pressure.is_finite() || *pressure < 0.0) {
        None => Ok(tactile),
        Some(at) => Err(value_error(format!(
            "touch[{}, {}] is {}, but a pressure must be a finite number and not negative",
            at % tactile.samples,
            at / tactile.samples,
            tactile.pressures[at]
        ))),
    }
}

/// Rows of a float64 array of n × d, all of them finite.
fn rows(array: &Bound<'_, PyAny>, name: &str) -> PyResult<(usize, usize, Vec<f64>)> {
    let Some(array) = matrix::<f64>(array)? else {
        return Err(value_error(format!("{name} must be a float64 array of two dimensions")));
    };
    let (count, width) = array.as_array().dim();
    if count == 0 || width == 0 {
        return Err(value_error(format!("{name} is empty: its shape is ({count}, {width})")));
    }
    check_memory::<f64>(count, width)?;
    let values: Vec<f64> = array.as_array().iter().copied().collect();
    match values.iter().position(|value| !value.is_finite()) {
        None => Ok((count, width, values)),
        Some(at) => Err(value_error(format!(
            "{name}[{}, {}] is {}, but must be a finite number",
            at / width,
            at % width,
            values[at]
        ))),
    }
}

/// A body map, n × d.
pub(crate) fn points(array: &Bound<'_, PyAny>) -> PyResult<BodyMap> {
    let (_, dims, coordinates) = rows(array, "X")?;
    Ok(BodyMap { dims, coordinates })
}

/// Distances, M × M: symmetric, not negative, 0 on the diagonal.
pub(crate) fn distances(array: &Bound<'_, PyAny>) -> PyResult<Distances> {
    let (sensors, width, values) = rows(array, "distances")?;
    if sensors != width || sensors > MAX_SENSORS {
        return Err(value_error(format!(
            "distances must be a square matrix of at most {MAX_SENSORS} sensors, but the shape is ({sensors}, {width})"
        )));
    }
    let distances = Distances { sensors, values };
    for (i, j) in (0..sensors).flat_map(|i| (0..=i).map(move |j| (i, j))) {
        let (lower, upper) = (distances.get(i, j), distances.get(j, i));
        if lower < 0.0 || upper < 0.0 {
            return Err(value_error(format!("distances[{i}, {j}] is negative")));
        }
        if (i == j && lower != 0.0) || (lower - upper).abs() > 1e-9 * (lower + upper) {
            return Err(value_error(format!(
                "distances[{i}, {j}] is {lower} and distances[{j}, {i}] is {upper}; distances must be symmetric, with 0 on the \
                 diagonal"
            )));
        }
    }
    Ok(distances)
}

/// Values by rows as an array, which takes them over.
pub(crate) fn by_rows<T: Element>(
    py: Python<'_>,
    width: usize,
    values: Vec<T>,
) -> PyResult<Bound<'_, PyArray2<T>>> {
    let count = values.len().checked_div(width).unwrap_or(0);
    Ok(Array2::from_shape_vec((count, width), values).map_err(value_error)?.into_pyarray(py))
}

/// One series after the other as an array T × M in Fortran order, which takes them over.
pub(crate) fn by_series<T: Element>(
    py: Python<'_>,
    samples: usize,
    values: Vec<T>,
) -> PyResult<Bound<'_, PyArray2<T>>> {
    let sensors = values.len().checked_div(samples).unwrap_or(0);
    let series = Array2::from_shape_vec((sensors, samples), values).map_err(value_error)?;
    Ok(series.reversed_axes().into_pyarray(py))
}

/// Edges as an array of (child, parent).
pub(crate) fn edges<'py>(
    py: Python<'py>,
    edges: impl IntoIterator<Item = (usize, usize)>,
) -> PyResult<Bound<'py, PyArray2<i64>>> {
    by_rows(py, 2, edges.into_iter().flat_map(|(child, parent)| [child as i64, parent as i64]).collect())
}

/// The ends of an edge.
pub(crate) fn ends(edge: &Edge) -> (usize, usize) {
    (edge.child, edge.parent)
}

/// Whole numbers as NumPy has them.
pub(crate) fn whole(numbers: impl IntoIterator<Item = usize>) -> Vec<i64> {
    numbers.into_iter().map(|number| number as i64).collect()
}
