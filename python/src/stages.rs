//! Run single stages of the paper: symbols, distances and body maps; and compare an estimate with the truth.

use bodyschema::pipeline::map_stream;
use bodyschema::settings::Settings;
use bodyschema::stages::body_map::{BodyMaps, ClassicalScaling, MapError, scaled};
use bodyschema::stages::distance::{Distances, information_metric as metric_of};
use bodyschema::stages::evaluate;
use bodyschema::stages::quantise::{Symbols, quantise as symbols_of};
use bodyschema::stages::tree::{Edge, Truth};
use numpy::{PyArray2, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::arrays::{self, by_rows, by_series, check_memory, check_sensors, value_error};
use crate::run::{Steps, Threads};

/// Stage 3; `changes` are settings in TOML.
#[pyfunction]
pub(crate) fn quantise<'py>(
    py: Python<'py>,
    touch: &Bound<'py, PyAny>,
    changes: &str,
    jobs: usize,
) -> PyResult<Bound<'py, PyArray2<u8>>> {
    let levels = Settings::paper().with(changes, "settings").map_err(value_error)?.quantise;
    let threads = Threads::start(jobs)?;
    let tactile = arrays::felt(&threads, touch)?;
    let symbols = threads.run(py, None, move |_| symbols_of(&tactile, &levels))?;
    by_series(py, symbols.samples, symbols.values)
}

/// Stage 4: symbols T × M to distances M × M.
#[pyfunction]
pub(crate) fn information_metric<'py>(
    py: Python<'py>,
    symbols: &Bound<'py, PyArray2<u8>>,
    jobs: usize,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    if !symbols.is_aligned() {
        return Err(value_error("the array is not aligned in memory; copy it"));
    }
    let threads = Threads::start(jobs)?;
    let array = symbols.try_readonly().map_err(value_error)?;
    let (samples, sensors) = array.as_array().dim();
    check_sensors(samples, sensors)?;
    check_memory::<u8>(samples, sensors)?;
    let rows = array.as_array();
    let values: Vec<u8> = threads.copy(py, || rows.t().iter().copied().collect())?;
    // Two at least: a single symbol is one that never changes.
    let levels = 2.max(1 + values.iter().copied().max().map_or(0, usize::from));
    let work = move |_: &Steps| metric_of(&Symbols { samples, levels, values });
    let Distances { sensors, values } = threads.run(py, None, work)?;
    by_rows(py, sensors, values)
}

/// Stage 5: distances M × M to a body map M × d; `changes` are settings in TOML.
#[pyfunction]
pub(crate) fn body_map<'py>(
    py: Python<'py>,
    distances: &Bound<'py, PyAny>,
    dims: usize,
    changes: &str,
    seed: u64,
    jobs: usize,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let settings = Settings::paper().with(changes, "settings").map_err(value_error)?.map;
    let distances = arrays::distances(distances)?;
    if dims == 0 {
        return Err(value_error("a body map needs at least one dimension"));
    }
    let work = move |_: &Steps| {
        let distances = scaled(&distances, settings.of);
        let scaling = ClassicalScaling::new(&distances, dims)?;
        let random = |d: usize, start: usize| map_stream(seed, 1, d, start);
        Ok(BodyMaps::new(&distances, &scaling, &settings, &[dims], &random)?.0.in_dims(dims))
    };
    let map = Threads::start(jobs)?.run(py, None, work)?.map_err(|error: MapError| value_error(error))?;
    by_rows(py, map.dims, map.coordinates)
}

/// Stage 7: (adjusted Rand index, whether the tree counts, whether it is right).
#[pyfunction]
pub(crate) fn score(
    labels: Vec<usize>,
    tree: Vec<(usize, usize)>,
    true_labels: Vec<usize>,
    true_tree: Vec<(usize, usize)>,
    eligible_ari: f64,
) -> PyResult<(f64, bool, bool)> {
    if labels.len() != true_labels.len() || labels.is_empty() {
        return Err(value_error(format!(
            "labels has {} entries and true_labels {}; both need one for each sensor",
            labels.len(),
            true_labels.len()
        )));
    }
    let tree: Vec<Edge> = tree.into_iter().map(|(child, parent)| Edge { child, parent }).collect();
    let score = evaluate::score(&labels, &tree, &Truth::new(true_labels, true_tree), eligible_ari);
    Ok((score.ari, score.eligible, score.tree_correct))
}
