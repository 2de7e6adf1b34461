//! An experiment of the paper → a folder with its samples, figure data, verdicts and manifest.

use std::path::Path;
use std::time::{Duration, Instant, SystemTime};

use indicatif::{ProgressBar, ProgressStyle};
use serde_json::json;

use crate::claims::{self, Judged};
use crate::figures::{Conditions, write_figures};
use crate::pipeline::{self, Record, StageError};
use crate::record::{FileError, npy, sha256, tables, write_text};
use crate::schema::Model;
use crate::settings::Settings;
use crate::simulate::world;

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
    /// Its settings.
    pub settings: &'a Settings,
    /// The user's settings file, for the manifest.
    pub settings_file: Option<&'a Path>,
    /// Whether it is a small run that shows the parts working.
    pub quick: bool,
    /// The folder that all files go to.
    pub out: &'a Path,
}

/// Experiment 1 (section 5): all simulations, dimensions and both mixtures. Returns the judged claims.
///
/// # Errors
/// If a stage fails or a file cannot be written.
pub fn experiment_1(run: &Run) -> Result<Vec<Judged>, ReproduceError> {
    let (started, clock) = (SystemTime::now(), Instant::now());
    let Run { settings, out, quick, .. } = *run;
    let mut outputs = Vec::new();
    let mut records: Vec<Record> = Vec::new();
    // What an earlier run found must not stand beside what this one is about to write.
    for name in ["claims.csv", "claims.md", "manifest.json"] {
        let path = out.join(name);
        if path.exists() {
            std::fs::remove_file(&path)
                .map_err(|error| FileError::new(&path, format!("cannot be replaced: {error}")))?;
        }
    }
    let (mut mapping, mut inferring) = (Duration::ZERO, Duration::ZERO);
    let mut bodies = Vec::new();

    for simulation in 1..=settings.experiment.simulations {
        let begun = Instant::now();
        let bar = progress(settings.samples() as u64 + 1, format!("simulation {simulation}: body map"));
        let body = pipeline::map_body(settings, simulation, &bar)?;
        bar.finish_and_clear();
        mapping += begun.elapsed();
        bodies.push(json!({
            "simulation": simulation,
            "constant_sensors": body.constant_sensors,
            "positive_eigenvalues": body.scaling.positive(),
            "negative_eigenvalue_share": body.scaling.negative_share(),
        }));
        let largest = *settings.experiment.dimensions.last().expect("validated as not empty");
        let file = |name: &str| format!("simulation-{simulation}/{name}");
        let [distance, map, labels, tree] =
            ["distance.npy", "body-map.npy", "labels.csv", "tree.csv"].map(file);
        npy::write_distances(&out.join(&distance), &body.distances)?;
        let coordinates = body.scaling.coordinates(largest).map_err(StageError::from)?;
        npy::write_body_map(&out.join(&map), &coordinates)?;
        tables::write_truth(&out.join(&labels), &out.join(&tree), &body.truth)?;
        outputs.extend([distance, map, labels, tree]);

        let begun = Instant::now();
        let conditions = settings.experiment.dimensions.len() * Model::ALL.len();
        let bar = progress(
            (conditions * settings.schema.chains) as u64,
            format!("simulation {simulation}: chains of the body schema"),
        );
        for &dimension in &settings.experiment.dimensions {
            for model in Model::ALL {
                records
                    .extend(pipeline::infer_and_score(&body, dimension, model, settings, simulation, &bar)?);
            }
        }
        bar.finish_and_clear();
        inferring += begun.elapsed();
    }

    tables::write_rows(&out.join("samples.csv"), &records)?;
    let conditions = Conditions::new(&records);
    let figures = write_figures(&out.join("figures"), &conditions)?;
    let judged: Vec<Judged> =
        claims::published().into_iter().map(|claim| claims::judge(claim, &conditions)).collect();
    claims::write_csv(&out.join("claims.csv"), &judged)?;
    claims::write_markdown(&out.join("claims.md"), &preamble(run), &judged)?;
    outputs.extend(figures.into_iter().map(|name| format!("figures/{name}")));
    outputs.extend(["samples.csv", "claims.csv", "claims.md"].map(str::to_owned));

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
        "experiment": "exp1",
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
    Ok(judged)
}

/// What stands above the table of claims.
pub fn preamble(run: &Run) -> String {
    let Settings { motion, schema, experiment, .. } = run.settings;
    let caution = if run.quick { " Quick run: its numbers are no replication." } else { "" };
    let scope = match experiment.simulations {
        1 => "Intervals are over the chains of this one simulation; another can differ by more.",
        _ => {
            "Intervals pool the chains of all simulations, which differ more than chains do: they are too narrow."
        }
    };
    format!(
        "Experiment 1: p = {}, {} simulation(s), {} chains of {} sweeps for each dimension and model, seed {}, \
         revision {}.{caution} {scope}",
        motion.coordination,
        experiment.simulations,
        schema.chains,
        schema.sweeps,
        experiment.seed,
        env!("BODYSCHEMA_REVISION"),
    )
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
