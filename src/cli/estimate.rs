//! The subcommand estimate.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result, ensure};
use clap::Args;
use serde::Serialize;

use super::options::SettingsAndSeed;
use super::output::say;
use super::tree;
use crate::analysis::estimate::estimate;
use crate::experiments::progress::progress;
use crate::files::tables::{read_truth, write_rows};
use crate::files::{npy, prepare_folder, write_text};
use crate::numerics::rng::stream;
use crate::settings::Base;
use crate::stages::tree::Truth;
use crate::stages::usable::{Usable, usable};

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
    /// True part of each sensor: a .csv file with columns sensor,part
    #[arg(long, value_name = "FILE", requires = "tree")]
    labels: Option<PathBuf>,
    /// True tree: a .csv file with columns child,parent
    #[arg(long, value_name = "FILE", requires = "labels")]
    tree: Option<PathBuf>,
    /// Folder to write to
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

#[derive(Serialize)]
struct SensorRow {
    sensor: usize,
    part: usize,
    probability: f64,
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
        let truth = self.labels.as_ref().zip(self.tree.as_ref());
        let truth = truth.map(|(labels, tree)| read_truth(labels, tree, count)).transpose()?;
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
        let rows = found.labels.iter().zip(&found.certainty).zip(&sensors);
        let row = |((&part, &probability), &sensor): ((&usize, &f64), &usize)| SensorRow {
            sensor,
            part,
            probability,
        };
        write_rows(&out.join("parts.csv"), rows.map(row))?;
        let fault = |(sensor, fault): &(usize, _)| DroppedRow { sensor: *sensor, fault: format!("{fault}") };
        write_rows(&out.join("dropped.csv"), dropped.iter().map(fault))?;
        tree::write(out, &found.tree)?;
        let summary = Summary {
            samples: tactile.samples,
            sensors: count,
            dropped: dropped.len(),
            dimensions: found.map.dims,
            parts: found.tree.parts.len(),
            mended_sensors: found.mended,
            seed,
            revision: env!("BODYSCHEMA_REVISION"),
        };
        write_text(&out.join("summary.json"), &serde_json::to_string_pretty(&summary)?)?;
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
            tree::print_score(found.labels, found.tree.tree, &Truth { labels: own, tree: truth.tree })?;
        }
        if let Some(what) = found.posterior.unmixed() {
            eprintln!("bodyschema: the chains have not mixed: {what}; more schema.sweeps may help");
        }
        Ok(ExitCode::SUCCESS)
    }
}
