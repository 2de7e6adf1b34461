//! An experiment of the paper → a folder with its samples, figure data, verdicts and manifest.

use std::path::Path;
use std::time::{Duration, Instant, SystemTime};

use clap::ValueEnum;
use indicatif::{ProgressBar, ProgressStyle};
use serde::{Deserialize, Serialize};
use serde_json::json;

use crate::agent::Agent;
use crate::claims::{self, Evidence, Judged, table};
use crate::conditions::{Conditions, baseline_estimates};
use crate::figures::Figures;
use crate::pipeline::{self, BaselineRecord, MappedBody, Record, StageError};
use crate::plot;
use crate::record::{FileError, npy, sha256, tables, write_text};
use crate::report;
use crate::schema::{Model, Sample};
use crate::settings::{Experiment as ExperimentSettings, Settings};
use crate::simulate::{simulate, world};
use crate::streams::stream;

/// An experiment that could not be finished.
#[derive(Debug, thiserror::Error)]
#[error(transparent)]
pub enum ReproduceError {
    /// A file could not be written.
    File(#[from] FileError),
    /// A stage failed.
    Stage(#[from] StageError),
}

/// How an experiment is run.
#[derive(Debug)]
pub struct Run<'a> {
    /// Which one.
    pub experiment: Experiment,
    /// Its settings.
    pub settings: &'a Settings,
    /// The user's settings file, for the manifest.
    pub settings_file: Option<&'a Path>,
    /// Whether it is a small run that shows the parts working.
    pub quick: bool,
    /// The folder that all files go to.
    pub out: &'a Path,
}

/// An experiment of the paper.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Experiment {
    /// Section 5: body schema estimation over the dimensions d of the body map.
    Exp1,
    /// Section 6: body schema estimation over the ratios p of motor coordination.
    Exp2,
}

/// Runs an experiment: all its simulations, conditions and figures. Returns the judged claims.
///
/// # Errors
/// If a stage fails or a file cannot be written.
pub fn reproduce(run: &Run) -> Result<Vec<Judged>, ReproduceError> {
    let (started, clock) = (SystemTime::now(), Instant::now());
    let Run { experiment, settings, out, quick, .. } = *run;
    // What an earlier run found must not stand beside what this one is about to write.
    for name in ["claims.csv", "claims.md", "report.html", "manifest.json"] {
        let path = out.join(name);
        if path.exists() {
            std::fs::remove_file(&path)
                .map_err(|error| FileError::new(&path, format!("cannot be replaced: {error}")))?;
        }
    }
    let folder = out.join("figures");
    let mut figures = Figures::new(&folder)?;
    let mut collected = Collected::default();
    match experiment {
        Experiment::Exp1 => {
            body_and_movement(settings, &mut figures)?;
            for simulation in 1..=settings.experiment.simulations {
                let body = collected.map_body(run, simulation, "")?;
                collected.over_dimensions(run, &body, simulation, &mut figures)?;
            }
        }
        Experiment::Exp2 => {
            let mut settings = settings.clone();
            for &coordination in &run.settings.experiment.coordinations {
                settings.motion.coordination = coordination;
                let run = Run { settings: &settings, ..*run };
                for simulation in 1..=settings.experiment.simulations {
                    let place = format!("p-{coordination}/");
                    let body = collected.map_body(&run, simulation, &place)?;
                    let (d, model) = (settings.experiment.dimension, Model::DpgmmLj);
                    let bar =
                        chains_bar(&settings, 1, &format!("p = {coordination}, simulation {simulation}"));
                    collected.infer(&run, &body, d, model, simulation, &bar)?;
                    bar.finish_and_clear();
                }
            }
        }
    }

    let Collected { records, baselines, bodies, mut outputs, mapping, inferring } = collected;
    tables::write_rows(&out.join("samples.csv"), &records)?;
    outputs.push("samples.csv".to_owned());
    let Settings { experiment: ExperimentSettings { simulations, seed, .. }, .. } = *settings;
    let conditions = Conditions::new(records, simulations, seed);
    let evidence = Evidence { conditions, baselines: baseline_estimates(&baselines) };
    let best = evidence.conditions.best();
    match experiment {
        Experiment::Exp1 => {
            tables::write_rows(&out.join("baselines.csv"), &baselines)?;
            outputs.push("baselines.csv".to_owned());
            figures.baselines(&evidence.baselines)?;
            figures.by_dimension(&evidence.conditions, &best)?;
        }
        Experiment::Exp2 => figures.by_coordination(&evidence.conditions, &best)?,
    }
    let judged = claims::judge(experiment, &evidence);
    tables::write_rows(&out.join("claims.csv"), table::rows(&judged))?;
    table::write_markdown(&out.join("claims.md"), &preamble(run), &judged)?;
    let pictures = plot::draw(&folder)?;
    outputs.extend(figures.names.into_iter().chain(pictures).map(|name| format!("figures/{name}")));
    outputs.extend(["claims.csv", "claims.md"].map(str::to_owned));

    let times = json!({
        "started": humantime::format_rfc3339_seconds(started).to_string(),
        "body_maps_s": mapping.as_secs_f64(),
        "chains_s": inferring.as_secs_f64(),
        "total_s": clock.elapsed().as_secs_f64(),
    });
    let hashes: Result<Vec<_>, FileError> =
        outputs.iter().map(|name| Ok(json!({ "file": name, "sha256": sha256(&out.join(name))? }))).collect();
    let inputs: Result<Vec<_>, FileError> = run
        .settings_file
        .into_iter()
        .map(|path| Ok(json!({ "file": path.display().to_string(), "sha256": sha256(path)? })))
        .collect();
    let (ode_version, ode_configuration) = world::engine();
    let manifest = json!({
        "program": format!("bodyschema {}", env!("CARGO_PKG_VERSION")),
        "revision": env!("BODYSCHEMA_REVISION"),
        "command": std::env::args().collect::<Vec<_>>(),
        "experiment": experiment,
        "summary": preamble(run),
        "headline": judged.iter().filter_map(table::comparison).collect::<Vec<_>>(),
        "quick": quick,
        "seed": settings.experiment.seed,
        "streams": "SHA-256 of (seed, simulation, chain, stage) seeds xoshiro256++",
        "ode": { "version": ode_version, "configuration": ode_configuration },
        "rustc": env!("BODYSCHEMA_RUSTC"),
        "libc": first_line_of(std::process::Command::new("getconf").arg("GNU_LIBC_VERSION")),
        "cpu": field_of("/proc/cpuinfo", "model name"),
        "threads": rayon::current_num_threads(),
        "peak_memory": field_of("/proc/self/status", "VmHWM"),
        "times": times,
        "bodies": bodies,
        "settings": settings,
        "inputs": inputs?,
        "outputs": hashes?,
    });
    let text = serde_json::to_string_pretty(&manifest).expect("a JSON value can be written");
    write_text(&out.join("manifest.json"), &(text + "\n"))?;
    report::write(out)?;
    Ok(judged)
}

/// What the simulations of an experiment have given so far.
#[derive(Default)]
struct Collected {
    records: Vec<Record>,
    baselines: Vec<BaselineRecord>,
    /// What the manifest says of each body.
    bodies: Vec<serde_json::Value>,
    outputs: Vec<String>,
    mapping: Duration,
    inferring: Duration,
}

impl Collected {
    /// Stages 1 to 5 of one simulation; its files go to the folder `place` of the run.
    fn map_body(&mut self, run: &Run, simulation: usize, place: &str) -> Result<MappedBody, ReproduceError> {
        let Run { settings, out, .. } = *run;
        let begun = Instant::now();
        let p = settings.motion.coordination;
        let bar =
            progress(settings.samples() as u64 + 1, format!("p = {p}, simulation {simulation}: body map"));
        let body = pipeline::map_body(settings, simulation, &bar)?;
        bar.finish_and_clear();
        self.bodies.push(json!({
            "coordination": p,
            "simulation": simulation,
            "constant_sensors": body.constant_sensors,
            "positive_eigenvalues": body.scaling.positive(),
            "negative_eigenvalue_share": body.scaling.negative_share(),
        }));
        let mut file = |name: &str| {
            self.outputs.push(format!("{place}simulation-{simulation}/{name}"));
            out.join(&self.outputs[self.outputs.len() - 1])
        };
        // For each p of experiment 2, distances would come to a quarter of a gigabyte; its body maps hold all
        // that the inference sees.
        if run.experiment == Experiment::Exp1 {
            npy::write_distances(&file("distance.npy"), &body.distances)?;
        }
        tables::write_truth(&file("labels.csv"), &file("tree.csv"), &body.truth)?;
        if body.scaling.positive() > 0 {
            let coordinates = body.scaling.coordinates(run.largest_dimension()).map_err(StageError::from)?;
            npy::write_body_map(&file("body-map.npy"), &coordinates)?;
        }
        self.mapping += begun.elapsed();
        Ok(body)
    }

    /// Stages 6 and 7 of one condition. Returns the draw of highest log posterior.
    fn infer(
        &mut self,
        run: &Run,
        body: &MappedBody,
        dimension: usize,
        model: Model,
        simulation: usize,
        bar: &ProgressBar,
    ) -> Result<Sample, ReproduceError> {
        let begun = Instant::now();
        let inference = pipeline::infer_and_score(body, dimension, model, run.settings, simulation, bar)?;
        self.records.extend(inference.records);
        self.inferring += begun.elapsed();
        Ok(inference.best)
    }

    /// Experiment 1 of one body: every d, by both mixtures and by the clusterings; and figure 6.
    fn over_dimensions(
        &mut self,
        run: &Run,
        body: &MappedBody,
        simulation: usize,
        figures: &mut Figures,
    ) -> Result<(), ReproduceError> {
        let settings = run.settings;
        let dimensions = &settings.experiment.dimensions;
        let bar =
            chains_bar(settings, dimensions.len() * Model::ALL.len(), &format!("simulation {simulation}"));
        for &d in dimensions {
            self.baselines.extend(pipeline::cluster_and_score(body, d, settings, simulation)?);
            for model in Model::ALL {
                let best = self.infer(run, body, d, model, simulation, &bar)?;
                if simulation == 1
                    && model == Model::DpgmmLj
                    && (2..=3).contains(&d)
                    && best.log_posterior.is_some()
                {
                    let map = body.scaling.coordinates(d).map_err(StageError::from)?;
                    figures.map(&map, &body.truth.labels, &best)?;
                }
            }
        }
        bar.finish_and_clear();
        Ok(())
    }
}

/// Figures 4 and 5: the agent, and how it moves at first for each p of experiment 2.
fn body_and_movement(settings: &Settings, figures: &mut Figures) -> Result<(), ReproduceError> {
    // Some twenty epochs, s, and a sample every so often, s.
    const SHOWN: f64 = 100.0;
    const EVERY: f64 = 0.2;
    let agent = Agent::new(&settings.agent, &settings.skin);
    let mut settings = settings.clone();
    settings.physics.duration = settings.physics.duration.min(SHOWN.max(settings.sense.interval));
    let mut trajectories = Vec::new();
    for coordination in settings.experiment.coordinations.clone() {
        settings.motion.coordination = coordination;
        let mut rng = stream(settings.experiment.seed, 1, "motion", 0);
        let trajectory =
            simulate(&agent, &settings, &mut rng, &ProgressBar::hidden()).map_err(StageError::from)?;
        trajectories.push((coordination, trajectory));
    }
    let rest = &trajectories[0].1.poses[..agent.parts.len()];
    figures.agent(&agent, rest, settings.agent.part_length)?;
    let every = (EVERY / settings.sense.interval).round().max(1.0) as usize;
    figures.angles(&trajectories, settings.sense.interval, every)?;
    Ok(())
}

fn chains_bar(settings: &Settings, conditions: usize, what: &str) -> ProgressBar {
    progress((conditions * settings.schema.chains) as u64, format!("{what}: chains of the body schema"))
}

impl Run<'_> {
    /// The largest d of its body maps.
    pub fn largest_dimension(&self) -> usize {
        let settings = &self.settings.experiment;
        match self.experiment {
            Experiment::Exp1 => *settings.dimensions.last().expect("validated as not empty"),
            Experiment::Exp2 => settings.dimension,
        }
    }
}

/// What stands above the table of claims.
pub fn preamble(run: &Run) -> String {
    let Settings { motion, schema, experiment, .. } = run.settings;
    let what = match run.experiment {
        Experiment::Exp1 => {
            format!("Experiment 1: p = {}, d = {}", motion.coordination, list(&experiment.dimensions))
        }
        Experiment::Exp2 => {
            format!("Experiment 2: p = {}, d = {}", list(&experiment.coordinations), experiment.dimension)
        }
    };
    let caution = if run.quick { " Quick run: its numbers are no replication." } else { "" };
    let scope = match experiment.simulations {
        1 => "Intervals are over the chains of this one simulation; another can differ by more.",
        _ => "Intervals are over simulations (bootstrap).",
    };
    format!(
        "{what}; {} simulation(s), {} chains of {} sweeps for each condition, seed {}, revision {}.{caution} {scope} \
         Rows marked extension count, of each simulation, only the draw of highest log posterior, which the paper does \
         not.",
        experiment.simulations,
        schema.chains,
        schema.sweeps,
        experiment.seed,
        env!("BODYSCHEMA_REVISION"),
    )
}

fn list<T: ToString>(values: &[T]) -> String {
    values.iter().map(T::to_string).collect::<Vec<_>>().join(", ")
}

/// A progress bar on standard error, which shows only on a terminal.
pub fn progress(length: u64, what: String) -> ProgressBar {
    let style = ProgressStyle::with_template("{msg} {wide_bar} {percent} %, {eta} left")
        .expect("the template is valid");
    let bar = ProgressBar::new(length).with_style(style).with_message(what);
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

/// The value of the first `name : value` line of a file of the proc file system.
fn field_of(path: &str, name: &str) -> Option<String> {
    let text = std::fs::read_to_string(path).ok()?;
    let (_, value) = text.lines().find(|line| line.starts_with(name))?.split_once(':')?;
    Some(value.trim().to_owned())
}

fn first_line_of(command: &mut std::process::Command) -> Option<String> {
    let output = command.output().ok()?;
    String::from_utf8(output.stdout).ok()?.lines().next().map(str::to_owned)
}
