//! The subcommand estimate.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, ensure};
use clap::Args;
use serde::Serialize;

use super::estimate_report::Shown;
use super::options::{ParameterOptions, SettingsAndSeed, TruthFiles};
use super::output::say;
use super::placement;
use super::repeats;
use super::touch::TouchFile;
use super::tree::{self, refuse_truth};
use crate::estimate::{self, Repeats, estimate};
use crate::files::tables::{write_rows, write_rows_of};
use crate::files::{prepare_folder, remove_if_there, write_text};
use crate::numerics::rng::stream;
use crate::recording::Recording;
use crate::report::estimated::page;
use crate::settings::Base;
use crate::stages::evaluate::{joints_right, score};
use crate::stages::rigid_parts::MIN_SENSORS;
use crate::stages::tree::Truth;
use crate::stages::usable::Fault;
use crate::tasks::progress::progress;

/// Estimates parts and tree of any body from touch alone, such as your own robot (docs/own-data.md).
#[derive(Args)]
#[command(
    after_help = "Example:\n  bodyschema estimate tactile.npy --out found    then open found/report.html"
)]
pub(super) struct Estimate {
    #[command(flatten)]
    file: TouchFile,
    #[command(flatten)]
    common: SettingsAndSeed,
    #[command(flatten)]
    parameters: ParameterOptions,
    #[command(flatten)]
    truth: TruthFiles,
    /// Position and normal of each sensor: adds body.urdf, parts as boxes (docs/own-data.md)
    #[arg(long, value_name = "FILE")]
    sensors: Option<PathBuf>,
    /// Show tree and report even if rigid parts do not explain the recording
    #[arg(long)]
    force: bool,
    /// Estimate again N times from resampled times, and tell how often sensors, parts and joints are found again
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true, value_parser = clap::value_parser!(u64).range(..=1000))]
    repeats: u64,
    /// Folder to write to
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

#[derive(Serialize)]
struct DroppedRow {
    sensor: usize,
    fault: String,
}

/// The exit status where rigid parts do not explain the recording.
const NO_FIT: u8 = 1;

/// A row of parts.csv.
#[derive(Serialize)]
struct PartRow {
    sensor: usize,
    part: usize,
    residual: f64,
    next_part: Option<usize>,
    next_residual: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    repeated: Option<f64>,
}

/// summary.json.
#[derive(Serialize)]
struct Summary {
    fit: String,
    cause: Option<&'static str>,
    explained: f64,
    novelty: f64,
    samples: usize,
    sensors: usize,
    dropped: usize,
    lost_samples: usize,
    missing: usize,
    infinite: usize,
    saturated: usize,
    noisy: usize,
    signed: bool,
    interval: Option<f64>,
    parts: usize,
    doubts: Vec<String>,
    seed: u64,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    parameters: BTreeMap<String, f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    repeats: Option<usize>,
    revision: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    truth: Option<AgainstTruth>,
}

/// How parts and tree compare with the truth.
#[derive(Serialize)]
struct AgainstTruth {
    parts: usize,
    adjusted_rand_index: f64,
    joints_right: usize,
    tree_right: bool,
}

impl AgainstTruth {
    fn new(found: &estimate::Estimate, truth: &Truth) -> Self {
        let (labels, tree) = (&found.parts.labels, &found.joints.tree);
        let score = score(labels, tree, truth, 1.0);
        Self {
            parts: truth.parts(),
            adjusted_rand_index: score.ari,
            joints_right: joints_right(labels, tree, truth),
            tree_right: score.tree_correct,
        }
    }
}

impl Estimate {
    /// Runs the subcommand.
    pub(super) fn run(self) -> Result<ExitCode> {
        let settings = self.common.load_over(Base::ESTIMATE)?;
        let parameters = self.parameters.all()?;
        let (out, seed) = (&self.out, settings.experiment.seed);
        let all = self.file.read()?;
        let (name, interval, count) = (all.name.clone(), all.interval, all.tactile.sensors());
        let truth = self.truth.read(count)?;
        let sites = self.sensors.as_deref().map(|file| placement::read(file, count)).transpose()?;
        let recording = all.cleaned();
        // Before anything is written.
        ensure!(
            recording.sensors.len() >= MIN_SENSORS,
            "{name}: {} of {count} sensors feel anything usable, but estimating parts needs at least {MIN_SENSORS}; for known parts, use \
             `bodyschema tree`",
            recording.sensors.len()
        );
        refuse_truth(out)?;
        if sites.is_some() {
            placement::refuse_others(out)?;
        }
        prepare_folder(out)?;
        warn_of_dropped(&name, count, &recording.dropped);
        let bar = progress(3 + self.repeats, "estimate".to_owned());
        let mut rng = stream(seed, 1, "co-motion", 0);
        let found = estimate(&recording, &settings.quantise, &parameters, &mut rng, &|| bar.inc(1))?;
        let shows_tree = self.force || found.fit.fits();
        let count = if shows_tree { self.repeats as usize } else { 0 };
        let again = (count > 0)
            .then(|| estimate::repeats(&recording, &found, count, &parameters, &mut rng, &|| bar.inc(1)));
        bar.finish_and_clear();
        let against = truth.as_ref().map(|truth| AgainstTruth::new(&found, &recording.truth(truth)));
        let said = Said { interval, seed, parameters: self.parameters.changed(), truth: against };
        write(out, &found, again.as_ref(), &recording, said, shows_tree)?;
        let sites = sites.filter(|_| shows_tree).map(|sites| recording.of_sensors(&sites));
        let placed = placement::write(out, &recording, &found, sites.as_deref())?;
        say(found.fit.to_string())?;
        if !shows_tree {
            say(format!(
                "no tree is shown; {} has parts.csv and summary.json, and --force writes the rest",
                out.display()
            ))?;
            return Ok(ExitCode::from(NO_FIT));
        }
        let shown = Shown { name, interval, truth: truth.as_ref(), of: settings.map.of, seed };
        write_text(&out.join("report.html"), &page(&shown.estimated(&found, again.as_ref(), &recording)))?;
        say_found(out, &found, again.as_ref(), &recording)?;
        placed.into_iter().try_for_each(say)?;
        if let Some(truth) = truth {
            let score = score(&found.parts.labels, &found.joints.tree, &recording.truth(&truth), 1.0);
            tree::print_score(&score)?;
        }
        Ok(ExitCode::SUCCESS)
    }
}

/// Says how many sensors are left out, if any are.
fn warn_of_dropped(name: &str, count: usize, dropped: &[(usize, Fault)]) {
    if let Some((first, fault)) = dropped.first() {
        eprintln!(
            "bodyschema: {name}: {} of {count} sensors are left out (the first, {first}, is {fault}); see dropped.csv",
            dropped.len()
        );
    }
}

/// Says which parts and tree were found, and how often again.
fn say_found(
    out: &Path,
    found: &estimate::Estimate,
    again: Option<&Repeats>,
    recording: &Recording,
) -> Result<()> {
    let parts = found.joints.ranks.len();
    say(format!(
        "{parts} parts of {} sensors over {} samples, in {}; open report.html there",
        recording.sensors.len(),
        recording.tactile.samples,
        out.display()
    ))?;
    tree::print(&found.joints, &found.parts.labels)?;
    found.doubts.iter().try_for_each(say)?;
    again.map_or(Ok(()), |again| repeats::print(again, &found.joints.tree))
}

/// What summary.json has of what the user said.
struct Said {
    interval: Option<f64>,
    seed: u64,
    parameters: BTreeMap<String, f64>,
    truth: Option<AgainstTruth>,
}

/// Writes all files, or those without the tree; then, a tree and a report of before are removed.
fn write(
    out: &Path,
    found: &estimate::Estimate,
    again: Option<&Repeats>,
    recording: &Recording,
    said: Said,
    shows_tree: bool,
) -> Result<()> {
    let Recording { tactile, sensors, dropped, lost_samples, missing, noisy, signed, .. } = recording;
    let parts = sensors.iter().enumerate().map(|(at, &sensor)| {
        let (next_part, next_residual) = found.parts.alternatives[at].first().copied().unzip();
        let (part, residual) = (found.parts.labels[at], found.parts.residuals[at]);
        let repeated = again.map(|again| again.sensors[at]);
        PartRow { sensor, part, residual, next_part, next_residual, repeated }
    });
    write_rows(&out.join("parts.csv"), parts)?;
    let row = |(sensor, fault): &(usize, Fault)| DroppedRow { sensor: *sensor, fault: fault.to_string() };
    write_rows_of(&out.join("dropped.csv"), &["sensor", "fault"], dropped.iter().map(row))?;
    if shows_tree {
        tree::write(out, &found.joints, &found.parts.labels)?;
    } else {
        for name in tree::FILES.into_iter().chain(["report.html"]) {
            let file = out.join(name);
            remove_if_there(&file).with_context(|| file.display().to_string())?;
        }
    }
    repeats::write(out, again, &found.joints.tree)?;
    let summary = Summary {
        fit: found.fit.verdict.to_string(),
        cause: found.fit.cause,
        explained: found.fit.explained,
        novelty: found.fit.novelty,
        samples: tactile.samples,
        sensors: sensors.len() + dropped.len(),
        dropped: dropped.len(),
        lost_samples: *lost_samples,
        missing: missing.values,
        infinite: missing.infinite,
        saturated: missing.saturated,
        noisy: *noisy,
        signed: *signed,
        interval: said.interval,
        parts: found.joints.ranks.len(),
        doubts: found.doubts.iter().map(ToString::to_string).collect(),
        seed: said.seed,
        parameters: said.parameters,
        repeats: again.map(|again| again.count),
        revision: env!("BODYSCHEMA_REVISION"),
        truth: said.truth,
    };
    Ok(write_text(&out.join("summary.json"), &serde_json::to_string_pretty(&summary)?)?)
}
