//! Simulate a body that moves at random or as it was recorded, and what its sensors feel; and make a body of a description.

use std::path::{Path, PathBuf};

use bodyschema::files::body::{BodyFile, NamedBody, read_body};
use bodyschema::files::import::{Imported, Options, import_into};
use bodyschema::files::{FileError, FrontEnd};
use bodyschema::movement::{Played, Playing, move_as_recorded};
use bodyschema::numerics::rng::stream;
use bodyschema::settings::Settings;
use bodyschema::stages::agent::{Agent, Site};
use bodyschema::stages::sense::{Tactile, sense};
use bodyschema::stages::simulate::{Unstable, simulate as move_body};
use bodyschema::stages::tree::Truth;
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{by_rows, by_series, edges, value_error, whole};
use crate::run::{Steps, Threads};

/// The bodies that come with the package.
pub(crate) const BODIES: [(&str, &str); 15] = [
    ("arm", include_str!("../../bodies/arm.toml")),
    ("chain-10", include_str!("../../bodies/chain-10.toml")),
    ("chain-3", include_str!("../../bodies/chain-3.toml")),
    ("chain-6", include_str!("../../bodies/chain-6.toml")),
    ("fork", include_str!("../../bodies/fork.toml")),
    ("hand", include_str!("../../bodies/hand.toml")),
    ("human", include_str!("../../bodies/human.toml")),
    ("ladder", include_str!("../../bodies/ladder.toml")),
    ("paper", include_str!("../../bodies/paper.toml")),
    ("quadruped", include_str!("../../bodies/quadruped.toml")),
    ("snake", include_str!("../../bodies/snake.toml")),
    ("spider", include_str!("../../bodies/spider.toml")),
    ("star", include_str!("../../bodies/star.toml")),
    ("tee", include_str!("../../bodies/tee.toml")),
    ("y", include_str!("../../bodies/y.toml")),
];

/// A body by its name or file.
fn body(name: &str) -> PyResult<NamedBody> {
    match BODIES.iter().find(|(own, _)| *own == name) {
        Some((_, text)) => toml::from_str::<BodyFile>(text).map_err(value_error)?.body().map_err(value_error),
        None => read_body(Path::new(name)).map_err(value_error),
    }
}

/// `bodyschema simulate`; `changes` are settings in TOML.
#[pyfunction]
#[pyo3(signature = (name, changes, seed, jobs, progress))]
pub(crate) fn simulate<'py>(
    py: Python<'py>,
    name: Option<&str>,
    changes: &str,
    seed: u64,
    jobs: usize,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let settings = Settings::paper().with(changes, "settings").map_err(value_error)?;
    let body = name.map(body).transpose()?;
    let names = body.as_ref().map(NamedBody::rigid_names);
    let agent = body.map_or_else(|| Agent::new(&settings.agent, &settings.skin), |body| body.agent);
    settings.check_times(agent.sites.len()).map_err(value_error)?;
    let (truth, interval, sites) = (agent.truth(), settings.sense.interval, agent.sites.clone());
    let work = move |steps: &Steps| {
        let mut rng = stream(seed, 1, "motion", 0);
        let Settings { motion, physics, sense: settings, .. } = &settings;
        let tick = || steps.tick();
        let trajectory = move_body(&agent, motion, physics, interval, &mut rng, &tick)?;
        Ok((sense(&agent, &trajectory, settings), trajectory.resolution))
    };
    let outcome = Threads::start(jobs)?.run(py, progress, work)?;
    let (tactile, resolution) = outcome.map_err(|error: Unstable| value_error(error))?;
    let facts = moved(py, tactile, truth, names, interval)?;
    sites_of(&facts, &sites)?;
    facts.set_item("resolved", resolution.is_resolved())?;
    facts.set_item("resolution", resolution.in_words("this movement"))?;
    Ok(facts)
}

/// How a recorded movement is played.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Recording {
    movement: PathBuf,
    scale: Option<f64>,
    keep_jumps: bool,
    /// At most, s; otherwise that of the settings.
    duration: Option<f64>,
    /// Whether samples are as far apart as the settings say, and not at the frames.
    has_interval: bool,
}

/// `bodyschema simulate --movement`; `changes` are settings in TOML.
#[pyfunction]
#[pyo3(signature = (name, changes, recording, jobs))]
pub(crate) fn play<'py>(
    py: Python<'py>,
    name: Option<&str>,
    changes: &str,
    recording: Recording,
    jobs: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let Recording { movement, scale, keep_jumps, duration, has_interval } = recording;
    let mut settings = Settings::paper().with(changes, "settings").map_err(value_error)?;
    let body = name.map(|name| body(name).map(|body| (PathBuf::from(name), body))).transpose()?;
    let work = move |_: &Steps| {
        let playing = Playing {
            scale,
            keep_jumps,
            interval: has_interval.then_some(settings.sense.interval),
            duration: duration.unwrap_or(settings.physics.duration),
            front_end: FrontEnd::Python,
        };
        let body = body.as_ref().map(|(path, body)| (path.as_path(), body.clone()));
        let played = move_as_recorded(&movement, body, &playing)?;
        settings.sense.interval = played.interval;
        Ok((sense(&played.body.agent, &played.trajectory, &settings.sense), played))
    };
    let outcome = Threads::start(jobs)?.run(py, None, work)?;
    let (tactile, played) = outcome.map_err(|error: FileError| value_error(error))?;
    let Played { body, interval, notes, cut, .. } = played;
    let facts = moved(py, tactile, body.agent.truth(), Some(body.rigid_names()), interval)?;
    sites_of(&facts, &body.agent.sites)?;
    facts.set_item("notes", notes)?;
    facts.set_item("cut", cut)?;
    Ok(facts)
}

/// Where the sensors are, in the frames of their solids.
fn sites_of(facts: &Bound<'_, PyDict>, sites: &[Site]) -> PyResult<()> {
    let py = facts.py();
    facts.set_item("positions", by_rows(py, 3, sites.iter().flat_map(|site| site.position).collect())?)?;
    facts.set_item("normals", by_rows(py, 3, sites.iter().flat_map(|site| site.normal).collect())?)?;
    facts.set_item("solids", whole(sites.iter().map(|site| site.part)).into_pyarray(py))
}

/// What a body felt, and the truth.
fn moved(
    py: Python<'_>,
    tactile: Tactile,
    truth: Truth,
    names: Option<Vec<String>>,
    interval: f64,
) -> PyResult<Bound<'_, PyDict>> {
    let facts = PyDict::new(py);
    facts.set_item("touch", by_series(py, tactile.samples, tactile.pressures)?)?;
    facts.set_item("labels", whole(truth.labels).into_pyarray(py))?;
    facts.set_item("tree", edges(py, truth.tree)?)?;
    facts.set_item("names", names)?;
    facts.set_item("interval", interval)?;
    Ok(facts)
}

/// How a description becomes a body.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Import {
    sensors_per_part: Option<usize>,
    per_area: Option<f64>,
    scale: Option<f64>,
    min_length: Option<f64>,
    root: Option<String>,
    strict: bool,
}

/// `bodyschema body import`; gives its notes.
#[pyfunction]
#[pyo3(signature = (source, out, options))]
pub(crate) fn import_body(
    py: Python<'_>,
    source: PathBuf,
    out: PathBuf,
    options: Import,
) -> PyResult<Vec<String>> {
    let Import { sensors_per_part, per_area, scale, min_length, root, strict } = options;
    let front_end = FrontEnd::Python;
    let options = Options { strict, root, scale, min_length, front_end, ..Options::default() }
        .with_skin(sensors_per_part, per_area);
    let work = move |_: &Steps| import_into(&source, &out, &options);
    let Imported { notes, .. } = Threads::start(1)?.run(py, None, work)?.map_err(value_error)?;
    Ok(notes)
}
