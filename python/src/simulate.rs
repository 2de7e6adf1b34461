//! Simulate a body that moves at random, and what its sensors feel: stages 1 and 2.

use std::path::Path;

use bodyschema::files::body::{BodyFile, NamedBody, read_body};
use bodyschema::numerics::rng::stream;
use bodyschema::settings::Settings;
use bodyschema::stages::agent::Agent;
use bodyschema::stages::sense::sense;
use bodyschema::stages::simulate::{Unstable, simulate as move_body};
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{by_series, edges, value_error, whole};
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
    let (truth, interval) = (agent.truth(), settings.sense.interval);
    let work = move |steps: &Steps| {
        let mut rng = stream(seed, 1, "motion", 0);
        let Settings { motion, physics, sense: settings, .. } = &settings;
        let tick = || steps.tick();
        let trajectory = move_body(&agent, motion, physics, interval, &mut rng, &tick)?;
        Ok((sense(&agent, &trajectory, settings), trajectory.resolution))
    };
    let outcome = Threads::start(jobs)?.run(py, progress, work)?;
    let (tactile, resolution) = outcome.map_err(|error: Unstable| value_error(error))?;
    let facts = PyDict::new(py);
    facts.set_item("touch", by_series(py, tactile.samples, tactile.pressures)?)?;
    facts.set_item("labels", whole(truth.labels).into_pyarray(py))?;
    facts.set_item("tree", edges(py, truth.tree)?)?;
    facts.set_item("names", names)?;
    facts.set_item("interval", interval)?;
    facts.set_item("resolved", resolution.is_resolved())?;
    facts.set_item("resolution", resolution.in_words("this movement"))?;
    Ok(facts)
}
