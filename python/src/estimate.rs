//! Estimate parts and tree of one's own recording, as the command line does.

use std::collections::BTreeMap;
use std::path::PathBuf;

use bodyschema::estimate::{
    Estimate, Repeats, TooFewSensors, estimate as estimate_of, repeats as repeats_of,
};
use bodyschema::files::FrontEnd;
use bodyschema::files::touch::{Column, Decimal, Format, Recorded, Separator, TimeColumn, read_recorded};
use bodyschema::numerics::rng::stream;
use bodyschema::recording::{Cleaning, Recording};
use bodyschema::settings::{Base, Settings};
use bodyschema::stages::joints::{Joints, Pair, joints};
use bodyschema::stages::parameters::Parameters;
use bodyschema::stages::sense::Tactile;
use numpy::{IntoPyArray, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{self, by_rows, by_series, check_sensors, edges, ends, value_error, whole};
use crate::run::{Steps, Threads};

/// A recording, T × M; the time between two samples, s, if the file tells it; and what was guessed of the file.
type Read<'py> = (Bound<'py, PyArray2<f32>>, Option<f64>, Vec<String>);

/// A column of a file.
#[derive(FromPyObject)]
enum Place {
    Number(usize),
    Name(String),
}

impl From<Place> for Column {
    fn from(place: Place) -> Self {
        match place {
            Place::Number(number) => Self { number: Some(number), name: None },
            Place::Name(name) => Self { number: None, name: Some(name) },
        }
    }
}

/// How to read a file.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Reading {
    separator: Option<char>,
    decimal: Option<char>,
    header: Option<bool>,
    /// The column of times, if there is one; `None` to guess.
    time: Option<Vec<Place>>,
    leave_out: Vec<Place>,
    array: Option<String>,
}

impl TryFrom<Reading> for Format {
    type Error = PyErr;

    fn try_from(reading: Reading) -> PyResult<Self> {
        let separator = match reading.separator {
            None => None,
            Some(',') => Some(Separator::Comma),
            Some(';') => Some(Separator::Semicolon),
            Some('\t') => Some(Separator::Tab),
            Some(' ') => Some(Separator::Blank),
            Some(other) => return Err(value_error(format!("separator cannot be {other:?}"))),
        };
        let decimal = match reading.decimal {
            None => None,
            Some('.') => Some(Decimal::Point),
            Some(',') => Some(Decimal::Comma),
            Some(other) => return Err(value_error(format!("decimal cannot be {other:?}"))),
        };
        let time = match reading.time.map(|columns| columns.into_iter().next()) {
            None => TimeColumn::Guess,
            Some(None) => TimeColumn::None,
            Some(Some(column)) => TimeColumn::Is(column.into()),
        };
        Ok(Self {
            separator,
            decimal,
            header: reading.header,
            time,
            leave_out: reading.leave_out.into_iter().map(Column::from).collect(),
            array: reading.array,
            front_end: FrontEnd::Python,
        })
    }
}

/// Reads a recording as `bodyschema estimate` does: float32, NaN where there is no value.
#[pyfunction]
pub(crate) fn read_touch(py: Python<'_>, path: PathBuf, reading: Reading, jobs: usize) -> PyResult<Read<'_>> {
    let (threads, format) = (Threads::start(jobs)?, Format::try_from(reading)?);
    let read = move |_: &Steps| read_recorded(&path, &format);
    let Recorded { tactile, interval, guesses } = threads.run(py, None, read)?.map_err(value_error)?;
    Ok((by_series(py, tactile.samples, tactile.pressures)?, interval, guesses))
}

/// Whether negative values count, if it is said, and whether saturated ones do.
type Said = (Option<bool>, bool);

/// The seed, and the parameters that the user has changed.
type Asked = (u64, BTreeMap<String, f64>);

/// All parameters, of which some were changed.
fn parameters_of(changed: &BTreeMap<String, f64>) -> PyResult<Parameters> {
    let changes = changed.iter().map(|(name, value)| (name.as_str(), *value));
    Parameters::changed(changes).map_err(value_error)
}

/// Cleans a recording as the user says.
fn cleaned(tactile: Tactile, (signed, keep_saturated): Said) -> Recording {
    Recording::cleaned(tactile, Cleaning { keep_saturated, signed })
}

/// `bodyschema estimate`, with so many repeats, and whether also where it does not fit.
#[pyfunction]
#[pyo3(signature = (touch, said, asked, again, jobs, progress))]
pub(crate) fn estimate<'py>(
    py: Python<'py>,
    touch: &Bound<'py, PyAny>,
    said: Said,
    asked: Asked,
    again: (usize, bool),
    jobs: usize,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let ((seed, changed), (repeats, force)) = (asked, again);
    let (threads, parameters) = (Threads::start(jobs)?, parameters_of(&changed)?);
    let tactile = arrays::touch(&threads, touch)?;
    let levels = Settings::load_over(Some(Base::ESTIMATE), None).map_err(value_error)?.quantise;
    let work = move |steps: &Steps| {
        let recording = cleaned(tactile, said);
        let rng = &mut stream(seed, 1, "co-motion", 0);
        let found = estimate_of(&recording, &levels, &parameters, rng, &|| steps.tick())?;
        let shows_tree = force || found.fit.fits();
        let again = (repeats > 0 && shows_tree)
            .then(|| repeats_of(&recording, &found, repeats, &parameters, rng, &|| steps.tick()));
        Ok((recording, found, again))
    };
    let outcome = threads.run(py, progress, work)?;
    let (recording, found, again) = outcome.map_err(|error: TooFewSensors| value_error(error))?;
    let facts = PyDict::new(py);
    became(&facts, &recording)?;
    let Estimate { fit, parts, joints, mapped, distances, doubts } = found;
    facts.set_item("verdict", fit.verdict.to_string())?;
    facts.set_item("fits", fit.fits())?;
    facts.set_item("explained", fit.explained)?;
    facts.set_item("novelty", fit.novelty)?;
    facts.set_item("cause", fit.cause)?;
    facts.set_item("doubts", doubts.iter().map(ToString::to_string).collect::<Vec<String>>())?;
    let (others, left): (Vec<i64>, Vec<f64>) = parts
        .alternatives
        .iter()
        .map(|others| others.first().map_or((-1, f64::NAN), |&(part, residual)| (part as i64, residual)))
        .unzip();
    facts.set_item("parts", whole(parts.labels).into_pyarray(py))?;
    facts.set_item("residuals", parts.residuals.into_pyarray(py))?;
    facts.set_item("next_parts", others.into_pyarray(py))?;
    facts.set_item("next_residuals", left.into_pyarray(py))?;
    joined(&facts, &joints)?;
    if let Some(Repeats { sensors, parts, tree, .. }) = again {
        facts.set_item("repeated", sensors.into_pyarray(py))?;
        facts.set_item("repeated_parts", parts.into_values().collect::<Vec<f64>>().into_pyarray(py))?;
        facts.set_item("repeated_joints", tree.into_pyarray(py))?;
    }
    facts.set_item("mapped", whole(mapped.iter().map(|&at| recording.sensors[at])).into_pyarray(py))?;
    facts.set_item("distances", by_rows(py, distances.sensors, distances.values)?)?;
    Ok(facts)
}

/// `bodyschema tree`: labels of −1 are of no part.
#[pyfunction]
#[pyo3(signature = (touch, labels, rank, said, seed, jobs))]
pub(crate) fn tree<'py>(
    py: Python<'py>,
    touch: &Bound<'py, PyAny>,
    labels: Vec<i64>,
    rank: Option<usize>,
    said: Said,
    seed: u64,
    jobs: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let threads = Threads::start(jobs)?;
    let tactile = arrays::touch(&threads, touch)?;
    if labels.len() != tactile.sensors() {
        return Err(value_error(format!(
            "parts has {} entries, but touch has {} sensors",
            labels.len(),
            tactile.sensors()
        )));
    }
    if rank.is_some_and(|rank| !(1..=6).contains(&rank)) {
        return Err(value_error("rank must be 1 to 6"));
    }
    let known: Vec<Option<usize>> = labels.into_iter().map(|label| usize::try_from(label).ok()).collect();
    let work = move |_: &Steps| {
        let recording = cleaned(tactile, said);
        let own = recording.of_sensors(&known);
        let feels = own.iter().any(Option::is_some);
        let rng = &mut stream(seed, 1, "co-motion", 0);
        (
            feels.then(|| {
                joints(&recording.tactile, recording.signed, &own, rank, &Parameters::default(), rng)
            }),
            recording,
        )
    };
    let (found, recording) = threads.run(py, None, work)?;
    let found = found.ok_or_else(|| value_error("no sensor that has a part feels anything"))?;
    let facts = PyDict::new(py);
    became(&facts, &recording)?;
    joined(&facts, &found)?;
    Ok(facts)
}

/// What became of sensors and samples.
fn became(facts: &Bound<'_, PyDict>, recording: &Recording) -> PyResult<()> {
    let py = facts.py();
    check_sensors(recording.tactile.samples, recording.all_sensors())?;
    facts.set_item("sensors", whole(recording.sensors.iter().copied()).into_pyarray(py))?;
    facts.set_item("samples", whole(recording.samples.iter().copied()).into_pyarray(py))?;
    let dropped: Vec<(usize, String)> =
        recording.dropped.iter().map(|(sensor, fault)| (*sensor, fault.to_string())).collect();
    facts.set_item("dropped", dropped)?;
    facts.set_item("lost_samples", recording.lost_samples)?;
    facts.set_item("missing", recording.missing.values)?;
    facts.set_item("infinite", recording.missing.infinite)?;
    facts.set_item("saturated", recording.missing.saturated)?;
    facts.set_item("noisy", recording.noisy)?;
    facts.set_item("signed", recording.signed)
}

/// How parts are joined.
fn joined(facts: &Bound<'_, PyDict>, joints: &Joints) -> PyResult<()> {
    let py = facts.py();
    let support: Vec<f64> = joints.tree.iter().map(|edge| joints.support(edge)).collect();
    facts.set_item("labels", whole(joints.ranks.keys().copied()).into_pyarray(py))?;
    facts.set_item("ranks", whole(joints.ranks.values().copied()).into_pyarray(py))?;
    facts.set_item("tree", edges(py, joints.tree.iter().map(ends))?)?;
    facts.set_item("support", support.into_pyarray(py))?;
    let numbers = |number: fn(&Pair) -> f64| -> Vec<f64> { joints.pairs.iter().map(number).collect() };
    facts.set_item("pairs", edges(py, joints.pairs.iter().map(|pair| (pair.part, pair.other)))?)?;
    facts.set_item("pair_correlation", numbers(|pair| pair.correlation).into_pyarray(py))?;
    facts.set_item("pair_information", numbers(|pair| pair.information).into_pyarray(py))?;
    facts.set_item("pair_support", numbers(|pair| pair.support).into_pyarray(py))
}
