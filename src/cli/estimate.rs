//! The subcommand estimate.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, ensure};
use clap::Args;
use serde::Serialize;

use super::options::{SettingsAndSeed, TruthFiles};
use super::output::say;
use super::posterior::write_parts;
use super::tree;
use crate::analysis::estimate::{self, estimate};
use crate::experiments::progress::progress;
use crate::files::tables::write_rows;
use crate::files::{npy, prepare_folder, write_text};
use crate::numerics::rng::stream;
use crate::settings::Base;
use crate::stages::sense::Tactile;
use crate::stages::tree::Truth;
use crate::stages::usable::{Fault, Usable, usable};

/// Parts and tree of any body, from touch alone: for one's own robot (not in the paper).
///
/// Reads pressures (T x M, any numbers) and writes into DIR: parts.csv (sensor,part,probability), tree.csv
/// (child,parent,confidence), edges.csv (part,other,agreement,confidence,in_tree), dropped.csv (sensor,fault: those that are
/// dead, constant or no number) and summary.json. Distances, body map and parts are found as by `distance`, `map` and
/// `infer --sampler split-merge`; parts are then mended so that each is rigid, and joined as by `tree`.
#[derive(Args)]
pub struct Estimate {
    /// Pressures: a .npy file with a row for each sample and a column for each sensor
    tactile: PathBuf,
    #[command(flatten)]
    common: SettingsAndSeed,
    #[command(flatten)]
    truth: TruthFiles,
    /// Folder to write to
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

#[derive(Serialize)]
struct DroppedRow {
    sensor: usize,
    fault: String,
}

/// summary.json.
#[derive(Serialize)]
struct Summary {
    samples: usize,
    sensors: usize,
    dropped: usize,
    dimensions: usize,
    parts: usize,
    mended_sensors: usize,
    seed: u64,
    revision: &'static str,
}

impl Estimate {
    /// Runs the subcommand.
    pub fn run(self) -> Result<ExitCode> {
        let settings = self.common.load_over(Base::SPLIT_MERGE)?;
        settings.validate()?;
        let (input, out, seed) = (&self.tactile, &self.out, settings.experiment.seed);
        let in_file = || input.display().to_string();
        let all = npy::read_any_tactile(input)?;
        let count = all.sensors();
        let truth = self.truth.read(count)?;
        let Usable { tactile, sensors, dropped } = usable(all);
        if let Some((first, fault)) = dropped.first() {
            eprintln!(
                "bodyschema: {}: {} of {count} sensors are left out (the first, {first}, is {fault}); see dropped.csv",
                input.display(),
                dropped.len()
            );
        }
        ensure!(
            sensors.len() >= 4,
            "{}: {} sensors feel anything; four are the least",
            in_file(),
            sensors.len()
        );
        prepare_folder(out)?;
        let bar = progress(settings.schema.chains as u64, "estimate".to_owned());
        let mut rng = stream(seed, 1, "co-motion", 0);
        let found = estimate(&tactile, &settings.quantise, &settings.schema, seed, &mut rng, &|| bar.inc(1))
            .with_context(in_file)?;
        bar.finish_and_clear();
        let summary = write(out, &found, &tactile, &sensors, &dropped, seed)?;
        say(format!(
            "{} parts of {} sensors over {} samples (body map of {} dimensions; {} sensors mended), in {}",
            summary.parts,
            sensors.len(),
            summary.samples,
            summary.dimensions,
            summary.mended_sensors,
            out.display()
        ))?;
        tree::print(&found.tree, &found.labels)?;
        if let Some(truth) = truth {
            let own = sensors.iter().map(|&sensor| truth.labels[sensor]).collect();
            let draw = tree::draw_of(found.labels, found.tree.tree);
            tree::print_score(&draw, &Truth { labels: own, tree: truth.tree }, 1.0)?;
        }
        if let Some(what) = found.posterior.unmixed() {
            eprintln!("bodyschema: the chains have not mixed: {what}; more schema.sweeps may help");
        }
        Ok(ExitCode::SUCCESS)
    }
}

/// Writes all files.
fn write(
    out: &Path,
    found: &estimate::Estimate,
    tactile: &Tactile,
    sensors: &[usize],
    dropped: &[(usize, Fault)],
    seed: u64,
) -> Result<Summary> {
    write_parts(out, sensors.iter().copied(), &found.labels, &found.certainty)?;
    let row = |(sensor, fault): &(usize, Fault)| DroppedRow { sensor: *sensor, fault: fault.to_string() };
    write_rows(&out.join("dropped.csv"), dropped.iter().map(row))?;
    tree::write(out, &found.tree)?;
    let summary = Summary {
        samples: tactile.samples,
        sensors: sensors.len() + dropped.len(),
        dropped: dropped.len(),
        dimensions: found.map.dims,
        parts: found.tree.parts.len(),
        mended_sensors: found.mended,
        seed,
        revision: env!("BODYSCHEMA_REVISION"),
    };
    write_text(&out.join("summary.json"), &serde_json::to_string_pretty(&summary)?)?;
    Ok(summary)
}
