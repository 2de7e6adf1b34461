//! Cluster a body map: by the DPGMM-LJ and the DPGMM, or by the methods that the paper compares them with.

use bodyschema::numerics::rng::stream;
use bodyschema::settings::{Base, Settings};
use bodyschema::stages::baselines::{self, ClusteringMethod};
use bodyschema::stages::schema::{self, InferenceError, Model, Sampler};
use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{self, by_rows, edges, ends, value_error, whole};
use crate::run::{Steps, Threads};

/// Stage 6, `bodyschema infer`: posterior samples of parts and tree; `changes` are settings in TOML.
#[pyfunction]
#[pyo3(signature = (points, latent_joints, changes, seed, jobs, progress))]
pub(crate) fn infer<'py>(
    py: Python<'py>,
    points: &Bound<'py, PyAny>,
    latent_joints: bool,
    changes: &str,
    seed: u64,
    jobs: usize,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let map = arrays::points(points)?;
    let (count, dims) = (map.points(), map.dims);
    let mut settings = Settings::paper().with(changes, "settings").map_err(value_error)?;
    if settings.schema.sampler == Sampler::SplitMerge {
        let base = Settings::load_over(Some(Base::SPLIT_MERGE), None).map_err(value_error)?;
        settings = base.with(changes, "settings").map_err(value_error)?;
    }
    let model = if latent_joints { Model::DpgmmLj } else { Model::Dpgmm };
    let schema = settings.schema;
    let work = move |steps: &Steps| schema::infer(&map, model, &schema, seed, 1, &|| steps.tick());
    let outcome = Threads::start(jobs)?.run(py, progress, work)?;
    let samples = outcome.map_err(|error: InferenceError| value_error(error))?;
    let facts = PyDict::new(py);
    let labels = samples.iter().flat_map(|sample| sample.labels.iter().map(|&label| label as i32));
    facts.set_item("labels", by_rows(py, count, labels.collect())?)?;
    facts.set_item("chain", whole(samples.iter().map(|sample| sample.chain)).into_pyarray(py))?;
    facts.set_item("sweep", whole(samples.iter().map(|sample| sample.sweep)).into_pyarray(py))?;
    let posterior = samples.iter().map(|sample| sample.log_posterior.unwrap_or(f64::NAN));
    facts.set_item("log_posterior", posterior.collect::<Vec<f64>>().into_pyarray(py))?;
    let trees = samples.iter().map(|sample| edges(py, sample.tree.iter().map(ends)));
    facts.set_item("trees", trees.collect::<PyResult<Vec<_>>>()?)?;
    let joints = samples.iter().map(|sample| by_rows(py, dims, sample.joints.concat()));
    facts.set_item("joints", joints.collect::<PyResult<Vec<_>>>()?)?;
    let best: *const _ = schema::best(&samples);
    facts.set_item("best", samples.iter().position(|sample| std::ptr::eq(sample, best)))?;
    Ok(facts)
}

/// Ward's method, k-means or a Gaussian mixture: the cluster of each of n points.
#[pyfunction]
pub(crate) fn cluster<'py>(
    py: Python<'py>,
    points: &Bound<'py, PyAny>,
    method: &str,
    clusters: usize,
    restarts: usize,
    seed: u64,
    jobs: usize,
) -> PyResult<Bound<'py, PyArray1<i64>>> {
    let map = arrays::points(points)?;
    let known = ClusteringMethod::ALL.into_iter().find(|known| known.name() == method);
    let method =
        known.ok_or_else(|| value_error(format!("`{method}` is no method: ward, k-means or gmm")))?;
    if !(1..=map.points()).contains(&clusters) {
        return Err(value_error(format!("{clusters} clusters were asked for, of {} points", map.points())));
    }
    let work = move |_: &Steps| {
        let mut rng = stream(seed, 1, &format!("{} {clusters} {}", method.name(), map.dims), 0);
        baselines::cluster(method, &map, clusters, restarts, &mut rng)
    };
    Ok(whole(Threads::start(jobs)?.run(py, None, work)?).into_pyarray(py))
}
