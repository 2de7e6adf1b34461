//! An experiment of the paper → a folder with its samples, figures, verdicts, manifest and report.

mod manifest;
mod work;

use std::path::Path;

use clap::ValueEnum;
use indicatif::ProgressBar;
use serde::{Deserialize, Serialize};

use self::work::Work;
use crate::agent::Agent;
use crate::claims::{self, Evidence, Judged, table};
use crate::conditions::{Conditions, baseline_estimates};
use crate::figures::Figures;
use crate::pipeline::StageError;
use crate::plot;
use crate::record::{FileError, tables};
use crate::report;
use crate::schema::Model;
use crate::settings::Settings;
use crate::simulate::simulate;
use crate::streams::stream;
use crate::study::is_held_out;

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
/// A run that was interrupted goes on from the parts that it finished, and ends with the same files.
///
/// # Errors
/// If a stage fails or a file cannot be written.
pub fn reproduce(run: &Run) -> Result<Vec<Judged>, ReproduceError> {
    let Run { experiment, settings, out, .. } = *run;
    remove_what_stood_there(out)?;
    let folder = out.join("figures");
    let mut figures = Figures::new(&folder)?;
    let mut work = Work::new(run);
    match experiment {
        Experiment::Exp1 => {
            body_and_movement(settings, &mut figures)?;
            for simulation in 1..=settings.experiment.simulations {
                over_dimensions(&mut work, settings, simulation, &mut figures)?;
            }
        }
        Experiment::Exp2 => {
            for &coordination in &settings.experiment.coordinations {
                let mut settings = settings.clone();
                settings.motion.coordination = coordination;
                for simulation in 1..=settings.experiment.simulations {
                    let place = format!("p-{coordination}/simulation-{simulation}");
                    // For each p, distances would come to a quarter of a gigabyte; the body maps hold all that
                    // the inference sees.
                    let body = work.map_body(&settings, simulation, &place, false)?;
                    let at = (settings.experiment.dimension, Model::DpgmmLj);
                    let bar = work.chains(&place, 1);
                    work.infer(&settings, &body, at, simulation, &place, &bar)?;
                    bar.finish_and_clear();
                }
            }
        }
    }

    tables::write_rows(&out.join("samples.csv"), &work.records)?;
    work.outputs.push("samples.csv".to_owned());
    let (simulations, seed) = (settings.experiment.simulations, settings.experiment.seed);
    let evidence = Evidence {
        conditions: Conditions::new(std::mem::take(&mut work.records), simulations, seed),
        baselines: baseline_estimates(&work.baselines),
    };
    let best = evidence.conditions.best();
    match experiment {
        Experiment::Exp1 => {
            tables::write_rows(&out.join("baselines.csv"), &work.baselines)?;
            work.outputs.push("baselines.csv".to_owned());
            figures.baselines(&evidence.baselines)?;
            figures.by_dimension(&evidence.conditions, &best)?;
        }
        Experiment::Exp2 => figures.by_coordination(&evidence.conditions, &best)?,
    }
    let judged = claims::judge(experiment, &evidence);
    tables::write_rows(&out.join("claims.csv"), table::rows(&judged))?;
    table::write_markdown(&out.join("claims.md"), &preamble(run), &judged)?;
    let pictures = plot::draw(&folder)?;
    work.outputs.extend(figures.names.into_iter().chain(pictures).map(|name| format!("figures/{name}")));
    work.outputs.extend(["claims.csv", "claims.md"].map(str::to_owned));
    manifest::write(run, &judged, &work.bodies, &work.outputs)?;
    report::write(out)?;
    manifest::write_circumstances(run, work.begun)?;
    work.checkpoints.clear()?;
    Ok(judged)
}

/// What an earlier run found must not stand beside what this one is about to write.
fn remove_what_stood_there(out: &Path) -> Result<(), FileError> {
    let pictures = claims::figures()
        .into_iter()
        .flat_map(|figure| ["csv", "svg"].map(|extension| format!("figures/{}.{extension}", figure.name)));
    let names = ["claims.csv", "claims.md", "report.html", "manifest.json", "run.json"];
    for name in names.map(str::to_owned).into_iter().chain(pictures) {
        let path = out.join(name);
        if path.exists() {
            std::fs::remove_file(&path)
                .map_err(|error| FileError::new(&path, format!("cannot be replaced: {error}")))?;
        }
    }
    Ok(())
}

/// Experiment 1 of one body: every d, by both mixtures and by the clusterings; and figure 6.
fn over_dimensions(
    work: &mut Work,
    settings: &Settings,
    simulation: usize,
    figures: &mut Figures,
) -> Result<(), ReproduceError> {
    let place = format!("simulation-{simulation}");
    let dimensions = &settings.experiment.dimensions;
    let body = work.map_body(settings, simulation, &place, true)?;
    let bar = work.chains(&place, dimensions.len() * Model::ALL.len());
    for &d in dimensions {
        work.cluster(settings, &body, d, simulation, &place)?;
        for model in Model::ALL {
            let best = work.infer(settings, &body, (d, model), simulation, &place, &bar)?;
            if let Some(maps) = &body.maps
                && simulation == 1
                && model == Model::DpgmmLj
                && (2..=3).contains(&d)
            {
                figures.map(&maps.in_dims(d), &body.truth.labels, &best)?;
            }
        }
    }
    bar.finish_and_clear();
    Ok(())
}

/// Figures 4 and 5: the agent, and how it moves at first for each p of experiment 2.
fn body_and_movement(settings: &Settings, figures: &mut Figures) -> Result<(), ReproduceError> {
    // Some twenty epochs, s, and a sample every so often, s.
    const SHOWN: f64 = 100.0;
    const EVERY: f64 = 0.2;
    let agent = Agent::new(&settings.agent, &settings.skin);
    let mut settings = settings.clone();
    settings.sense.interval *= (EVERY / settings.sense.interval).round().max(1.0);
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
    figures.angles(&trajectories, settings.sense.interval)?;
    Ok(())
}

impl Run<'_> {
    /// Number of sensors on its body.
    pub fn sensors(&self) -> usize {
        let Settings { agent, skin, .. } = self.settings;
        Agent::new(agent, skin).sites.len()
    }

    /// d of its body maps, rising.
    pub fn dimensions(&self) -> &[usize] {
        let settings = &self.settings.experiment;
        match self.experiment {
            Experiment::Exp1 => &settings.dimensions,
            Experiment::Exp2 => std::slice::from_ref(&settings.dimension),
        }
    }

    /// The largest of them.
    pub fn largest_dimension(&self) -> usize {
        *self.dimensions().last().expect("validated as not empty")
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
    let seed = match is_held_out(experiment.seed) {
        true => "held out: neither the search for the default settings nor the study of them used it",
        false => "used by the search for the default settings or the study of them",
    };
    let scope = match experiment.simulations {
        1 => "Intervals are over the chains of this one simulation; another can differ by more.",
        _ => "Intervals are over simulations (bootstrap).",
    };
    format!(
        "{what}; {} simulation(s), {} chains of {} sweeps for each condition, seed {} ({seed}), revision {}.{caution} {scope} \
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
