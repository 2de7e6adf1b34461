//! Configurations → what each gives in several simulations: every movement is simulated once, every part done once.
//!
//! A [`sensitivity`] study varies one open setting at a time around the default; a [`search`] looks for a default.

mod deviations;
pub mod search;
pub mod sensitivity;

use std::collections::HashMap;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use indicatif::ProgressBar;

use crate::conditions::Conditions;
use crate::pipeline::{FeltBody, Record, feel, infer_and_score, map_felt};
use crate::progress::progress;
use crate::record::checkpoint::{Checkpoints, hash};
use crate::record::provenance::{hashes, provenance, write_json};
use crate::record::{FileError, one_line};
use crate::schema::Model;
use crate::settings::{Settings, SettingsError};

/// A design that cannot be used, or a study that could not be finished.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// The design does not say what it must.
    #[error("{origin}: {message}")]
    Design {
        /// The file.
        origin: String,
        /// What is wrong, on one line.
        message: String,
    },
    /// Settings that the design names.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// A file could not be read or written.
    #[error(transparent)]
    File(#[from] FileError),
}

impl StudyError {
    fn design(origin: &str, message: &str) -> Self {
        Self::Design { origin: origin.to_owned(), message: one_line(message) }
    }
}

/// Whether neither the search for the default nor the study of its settings has used a master seed.
pub fn is_held_out(seed: u64) -> bool {
    let search = search::Design::parse(search::DESIGN, "reproduce/search.toml").map(|design| design.seed);
    let study = sensitivity::Design::parse(sensitivity::DESIGN, "reproduce/sensitivity.toml");
    let used = [search, study.map(|design| design.seed)];
    used.into_iter().all(|used| used.expect("the repository's designs can be read; a test checks it") != seed)
}

/// Writes manifest.json of a study: what made its tables, and their hashes.
fn write_manifest(out: &Path, study: &str, seed: u64, tables: &[&str]) -> Result<(), FileError> {
    let mut manifest = serde_json::json!({ "study": study, "seed": seed });
    let fields = manifest.as_object_mut().expect("it is written as an object");
    fields.extend(provenance());
    fields.insert("outputs".to_owned(), hashes(out, tables.iter().copied())?.into());
    write_json(&out.join("manifest.json"), &manifest)
}

/// What a configuration gave in its `experiment.simulations` simulations.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// All draws, evaluated, but those of parts that failed.
    pub records: Vec<Record>,
    /// Parts that failed: unstable movement, or distances without a map of the dimensions.
    pub failures: Vec<Failure>,
}

/// A part that could not be done.
#[derive(Debug, Clone, PartialEq)]
pub struct Failure {
    /// p.
    pub coordination: f64,
    /// Why.
    pub reason: String,
}

impl Outcome {
    /// The draws that `counts` keeps, by condition, with intervals over simulations.
    pub fn conditions(&self, settings: &Settings, counts: impl Fn(&Record) -> bool) -> Conditions {
        let records = self.records.iter().copied().filter(counts).collect();
        Conditions::new(records, settings.experiment.simulations, settings.experiment.seed)
    }
}

/// One movement of one body, as one configuration sees it.
struct Part<'a> {
    /// The configuration's place in the list.
    configuration: usize,
    settings: &'a Settings,
    coordination: f64,
    simulation: usize,
}

/// A part's draws, or why there are none.
type Draws = Result<Vec<Record>, String>;

/// Runs all configurations: each at its own p with both mixtures at each of `experiment.dimensions`, and at the other
/// `experiment.coordinations` with the DPGMM-LJ at `experiment.dimension`. Parts that an earlier run finished are taken from `out`/checkpoints, where they
/// stay: a part is the same in every round of a search, and in every study of the same program.
///
/// Works on as many parts at once as there are threads; each takes as much memory as the pressures of one
/// simulation, 0.5 GB.
///
/// # Errors
/// If a checkpoint cannot be written. A configuration that fails is an outcome.
pub fn run(configurations: &[Settings], out: &Path, name: &str) -> Result<Vec<Outcome>, FileError> {
    let checkpoints = Checkpoints::new(out, &"study");
    let movements = by_movement(configurations);
    let parts = movements.iter().map(Vec::len).sum::<usize>();
    let bar = progress(parts as u64, name.to_owned());
    let found: Mutex<Vec<(&Part, Draws)>> = Mutex::new(Vec::with_capacity(parts));
    let trouble: Mutex<Option<FileError>> = Mutex::new(None);
    let next = AtomicUsize::new(0);
    // Not by the pool's threads: one that waits for its own work would begin another movement meanwhile, and
    // with it take as much memory again.
    std::thread::scope(|scope| {
        for _ in 0..rayon::current_num_threads() {
            scope.spawn(|| {
                while let Some(movement) = movements.get(next.fetch_add(1, Ordering::Relaxed)) {
                    match follow(movement, &checkpoints, &bar) {
                        Ok(draws) => found.lock().expect("no worker panics").extend(draws),
                        Err(error) => {
                            next.store(movements.len(), Ordering::Relaxed);
                            trouble.lock().expect("no worker panics").get_or_insert(error);
                        }
                    }
                }
            });
        }
    });
    bar.finish_and_clear();
    if let Some(error) = trouble.into_inner().expect("no worker panics") {
        return Err(error);
    }
    let mut found = found.into_inner().expect("no worker panics");
    // Workers finish in any order.
    found.sort_by(|(a, _), (b, _)| {
        (a.configuration.cmp(&b.configuration))
            .then(a.coordination.total_cmp(&b.coordination))
            .then(a.simulation.cmp(&b.simulation))
    });
    let mut outcomes = vec![Outcome { records: Vec::new(), failures: Vec::new() }; configurations.len()];
    for (&Part { configuration, coordination, .. }, draws) in found {
        match draws {
            Ok(draws) => outcomes[configuration].records.extend(draws),
            Err(reason) => outcomes[configuration].failures.push(Failure { coordination, reason }),
        }
    }
    Ok(outcomes)
}

/// All parts, those together that need the same pressures.
fn by_movement(configurations: &[Settings]) -> Vec<Vec<Part<'_>>> {
    let mut movements: Vec<Vec<Part>> = Vec::new();
    let mut places: HashMap<String, usize> = HashMap::new();
    for (configuration, settings) in configurations.iter().enumerate() {
        for simulation in 1..=settings.experiment.simulations {
            for coordination in coordinations(settings) {
                let Settings { agent, skin, motion, physics, sense, experiment, .. } = settings;
                let body = (agent, skin, motion, physics, sense);
                let place = (body, coordination, simulation, experiment.seed);
                let place = serde_json::to_string(&place).expect("settings are plain data");
                let place = *places.entry(place).or_insert_with(|| {
                    movements.push(Vec::new());
                    movements.len() - 1
                });
                movements[place].push(Part { configuration, settings, coordination, simulation });
            }
        }
    }
    movements
}

/// Its own p and those of experiment 2, rising.
fn coordinations(settings: &Settings) -> Vec<f64> {
    let mut all = settings.experiment.coordinations.clone();
    all.push(settings.motion.coordination);
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}

/// Parts of one movement, which is simulated if any of them is not finished.
fn follow<'a>(
    parts: &'a [Part],
    checkpoints: &Checkpoints,
    bar: &ProgressBar,
) -> Result<Vec<(&'a Part<'a>, Draws)>, FileError> {
    let mut felt: Option<Result<FeltBody, String>> = None;
    let mut found = Vec::new();
    for part in parts {
        let simulation = part.simulation;
        let (settings, conditions) = part.work();
        let name = serde_json::to_string(&(&settings, &conditions, simulation)).expect("plain data");
        let name = format!("parts/{}", hash(&name));
        let draws: Draws = match checkpoints.recall(&name) {
            Some(draws) => draws,
            None => {
                let felt = felt.get_or_insert_with(|| {
                    feel(&settings, simulation, &ProgressBar::hidden()).map_err(|error| error.to_string())
                });
                let draws = felt
                    .as_ref()
                    .map_err(String::clone)
                    .and_then(|felt| draw(felt, &settings, &conditions, simulation));
                checkpoints.keep(&name, &draws)?;
                draws
            }
        };
        bar.inc(1);
        found.push((part, draws));
    }
    Ok(found)
}

impl Part<'_> {
    /// The settings that its draws depend on, the same wherever they are, and its conditions.
    fn work(&self) -> (Settings, Vec<(usize, Model)>) {
        let mut settings = self.settings.clone();
        let experiment = &mut settings.experiment;
        let last = (experiment.dimension, Model::DpgmmLj);
        let mut conditions = vec![last];
        if settings.motion.coordination == self.coordination {
            let dimensions = experiment.dimensions.iter();
            conditions = dimensions.flat_map(|&d| Model::ALL.map(|model| (d, model))).collect();
            if !conditions.contains(&last) {
                conditions.push(last);
            }
        }
        settings.motion.coordination = self.coordination;
        (experiment.simulations, experiment.dimensions) = (1, vec![last.0]);
        experiment.coordinations = vec![self.coordination];
        (settings, conditions)
    }
}

fn draw(felt: &FeltBody, settings: &Settings, conditions: &[(usize, Model)], simulation: usize) -> Draws {
    let mut dims: Vec<usize> = conditions.iter().map(|(d, _)| *d).collect();
    dims.sort_unstable();
    dims.dedup();
    let body = map_felt(felt, settings, &dims).map_err(|error| error.to_string())?.body;
    let mut records = Vec::new();
    for &(d, model) in conditions {
        let found = infer_and_score(&body, d, model, settings, simulation, &ProgressBar::hidden());
        records.extend(found.map_err(|error| error.to_string())?.records);
    }
    Ok(records)
}

#[cfg(test)]
mod tests;
