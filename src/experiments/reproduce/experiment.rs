//! Run all simulations of an experiment, judge the claims, and write everything into one folder.

use std::path::Path;
use std::time::{Instant, SystemTime};

use serde_json::{Value, json};

use super::beginnings::Beginnings;
use super::interpretation::OtherInterpretation;
use super::run::{Run, preamble};
use super::scenes;
use crate::analysis::claims::{Judged, judge};
use crate::analysis::conditions::{Conditions, baseline_estimates};
use crate::analysis::measure::Evidence;
use crate::analysis::published::{Experiment, figures};
use crate::analysis::single_bodies::add_single_bodies;
use crate::files::FileError;
use crate::files::checkpoint::Checkpoints;
use crate::files::manifest::{HashedFile, Manifest, write_circumstances};
use crate::files::provenance::Provenance;
use crate::files::result_folder::ResultFolder;
use crate::files::ro_crate::RO_CRATE;
use crate::pipeline::{BaselineRecord, Condition, Record};
use crate::report::claims_table::{Row, illustrated, rows};
use crate::report::figures::Figures;
use crate::report::headline::{Headline, claims_page};
use crate::report::page::Page;
use crate::report::plot::Picture;
use crate::settings::Settings;
use crate::stages::agent::Agent;
use crate::stages::schema::Model;
use crate::stages::simulate::Resolution;
use crate::tasks::batch::{Batch, Outcome, TaskOutput};
use crate::tasks::error::ExperimentError;
use crate::tasks::progress::progress;
use crate::tasks::task::{Keep, Task};

/// A finished experiment.
#[derive(Debug)]
pub(crate) struct Finished {
    /// What was run, in words.
    pub preamble: String,
    /// All claims, with the headline by the other interpretation after that of the run.
    pub judged: Vec<Judged>,
    /// The same as a table; of a quick run, without verdicts.
    pub rows: Vec<Row>,
}

/// Runs an experiment: all its simulations, conditions and figures.
///
/// A run that was interrupted goes on from what it finished, and ends with the same files.
///
/// # Errors
/// If a stage fails or a file cannot be written.
pub(crate) fn reproduce(run: &Run) -> Result<Finished, ExperimentError> {
    let begun = (SystemTime::now(), Instant::now());
    let mut folder = ResultFolder::new(run.out);
    folder.remove(made_anew().chain(scenes::made_anew(run.out)))?;
    let checkpoints = Checkpoints::new(run.out, &(run.experiment, run.settings));
    let tasks = tasks(run);
    let other = OtherInterpretation::of(run, &tasks);
    let all = other.as_ref().map_or_else(|| tasks.clone(), |other| other.behind(&tasks));
    let bar = progress(Batch::length(&all), "movement".to_owned());
    let batch = Batch { out: run.out, checkpoints: &checkpoints, bar: &bar };
    let mut beginnings = Beginnings::of_other_coordinations(run)?;
    let (mut found, by_other) = apart(&all, batch.run_in_order(&all)?)?;
    bar.finish_and_clear();
    beginnings.add(&tasks, &mut found)?;
    for kept in found.iter_mut().filter_map(|found| found.kept.as_mut()) {
        folder.remember(std::mem::take(&mut kept.files));
    }

    let (records, baselines) = write_samples(run, &found, &mut folder)?;
    let (mut judged, evidence) = judge_all(run.experiment, run.settings, records, &baselines);
    let pictures = write_figures(run, &tasks, &found, &beginnings, &evidence, &mut folder)?;
    let scenes = scenes::write(run, &tasks, &found, &beginnings, &mut folder)?;
    let resolution =
        found.iter().map(|found| found.resolution).fold(Resolution::default(), Resolution::worse);
    let mut preamble = preamble(run, resolution);
    if let Some(other) = &other {
        let (records, headline) = other.judge(run, by_other);
        folder.write_rows("other-reading.csv", &records)?;
        judged.insert(1, headline);
        preamble += &other.in_words();
    }
    let rows = if run.quick { illustrated(rows(&judged)) } else { rows(&judged) };
    folder.write_rows("claims.csv", &rows)?;
    folder.write_text("claims.md", &claims_page(&preamble, &rows))?;
    folder.write_text("settings.toml", &settings_file(run))?;
    let manifest = folder.write_manifest(manifest(run, &preamble, &tasks, &found, &rows)?)?;
    let page = Page { rows, pictures, scenes, manifest };
    page.write(run.out)?;
    write_circumstances(run.out, begun)?;
    checkpoints.clear()?;
    Ok(Finished { preamble, judged, rows: page.rows })
}

/// Files of an earlier run that must not stand beside those of this one while it works.
fn made_anew() -> impl Iterator<Item = String> {
    let pictures = figures()
        .into_iter()
        .flat_map(|figure| ["csv", "svg"].map(|extension| format!("figures/{}.{extension}", figure.name)));
    let names = [
        "other-reading.csv",
        "claims.csv",
        "claims.md",
        "report.html",
        "manifest.json",
        RO_CRATE,
        "run.json",
    ];
    names.map(str::to_owned).into_iter().chain(pictures)
}

/// One task for each simulation, in experiment 2 at each p.
fn tasks(run: &Run) -> Vec<Task> {
    let experiment = &run.settings.experiment;
    let simulations = 1..=experiment.simulations;
    let task = |name: String, coordination: f64, simulation, dimensions: &[usize], models: &[Model]| {
        let mut settings = run.settings.clone();
        settings.motion.coordination = coordination;
        let at = |dimension: &usize| {
            let dimension = *dimension;
            models.iter().map(move |&model| Condition { model, coordination, dimension })
        };
        let conditions = dimensions.iter().flat_map(at).collect();
        let (clustered, keep) = (Vec::new(), Keep::Maps);
        Task { name, settings, simulation, conditions, clustered, keep }
    };
    match run.experiment {
        Experiment::Exp1 => simulations
            .map(|simulation| {
                let name = format!("simulation-{simulation}");
                let p = run.settings.motion.coordination;
                let task = task(name, p, simulation, &experiment.dimensions, &Model::ALL);
                Task { clustered: experiment.dimensions.clone(), keep: Keep::MapsAndDistances, ..task }
            })
            .collect(),
        Experiment::Exp2 => experiment
            .coordinations
            .iter()
            .flat_map(|&p| simulations.clone().map(move |simulation| (p, simulation)))
            .map(|(p, simulation)| {
                let name = format!("p-{p}/simulation-{simulation}");
                // For each p, distances would come to a quarter of a gigabyte; the body maps hold all that
                // the inference sees.
                task(name, p, simulation, &[experiment.dimension], &[Model::DpgmmLj])
            })
            .collect(),
    }
}

/// What the tasks of the run found, and what became of those of the other interpretation, which alone may fail.
fn apart(all: &[Task], outcomes: Vec<Outcome>) -> Result<(Vec<TaskOutput>, Vec<Outcome>), ExperimentError> {
    let (run, other): (Vec<_>, Vec<_>) =
        all.iter().zip(outcomes).partition(|(task, _)| task.keep != Keep::Nothing);
    let found = run.into_iter().map(|(_, outcome)| outcome.map_err(ExperimentError::Stage));
    Ok((found.collect::<Result<_, _>>()?, other.into_iter().map(|(_, outcome)| outcome).collect()))
}

/// Writes all posterior samples, and in experiment 1 all clusterings, and returns them.
fn write_samples(
    run: &Run,
    found: &[TaskOutput],
    folder: &mut ResultFolder,
) -> Result<(Vec<Record>, Vec<BaselineRecord>), FileError> {
    let records: Vec<_> = found.iter().flat_map(|found| &found.records).copied().collect();
    folder.write_rows("samples.csv", &records)?;
    let baselines: Vec<_> = found.iter().flat_map(|found| &found.baselines).copied().collect();
    if run.experiment == Experiment::Exp1 {
        folder.write_rows("baselines.csv", &baselines)?;
    }
    Ok((records, baselines))
}

/// Judges all claims of an experiment by its samples and clusterings, with how many single simulations show each; and what they are
/// judged by.
pub(super) fn judge_all(
    experiment: Experiment,
    settings: &Settings,
    records: Vec<Record>,
    baselines: &[BaselineRecord],
) -> (Vec<Judged>, Evidence) {
    let (simulations, seed) = (settings.experiment.simulations, settings.experiment.seed);
    let reading = settings.schema.sampler;
    let conditions = Conditions::new(records, simulations, seed);
    let evidence = Evidence { conditions, baselines: baseline_estimates(baselines), reading };
    let of = |simulation: usize| {
        let baselines: Vec<_> =
            baselines.iter().filter(|record| record.simulation == simulation).copied().collect();
        Evidence {
            conditions: evidence.conditions.redrawn(&[simulation]),
            baselines: baseline_estimates(&baselines),
            reading,
        }
    };
    let alone: Vec<Evidence> = (1..=simulations).map(of).collect();
    let mut judged = judge(experiment, &evidence);
    add_single_bodies(experiment, &mut judged, &alone);
    (judged, evidence)
}

/// Writes the table and the picture of every figure that the experiment shows.
fn write_figures(
    run: &Run,
    tasks: &[Task],
    found: &[TaskOutput],
    beginnings: &Beginnings,
    evidence: &Evidence,
    folder: &mut ResultFolder,
) -> Result<Vec<Picture>, FileError> {
    let mut figures = Figures::new(folder)?;
    if run.experiment == Experiment::Exp1 {
        let Settings { agent, skin, sense, experiment, .. } = run.settings;
        let agent = Agent::new(agent, skin);
        let trajectories: Vec<_> = experiment.coordinations.iter().map(|&p| (p, beginnings.at(p))).collect();
        figures.agent(&agent, &trajectories[0].1.poses[..agent.parts.len()])?;
        figures.angles(&trajectories, sense.interval)?;
        for (condition, sample) in tasks[0].conditions.iter().zip(&found[0].best) {
            if let Some(body) = &found[0].body
                && let Some(maps) = &body.maps
                && condition.model == Model::DpgmmLj
                && (2..=3).contains(&condition.dimension)
            {
                figures.map(&maps.in_dims(condition.dimension), &body.truth.labels, sample)?;
            }
        }
    }
    write_curves(run.experiment, evidence, figures)
}

/// Writes the tables of the figures that samples and clusterings give, and the picture of every table in the folder.
pub(super) fn write_curves(
    experiment: Experiment,
    evidence: &Evidence,
    mut figures: Figures,
) -> Result<Vec<Picture>, FileError> {
    let best = evidence.conditions.best();
    match experiment {
        Experiment::Exp1 => {
            figures.baselines(&evidence.baselines)?;
            figures.by_dimension(&evidence.conditions, &best)?;
        }
        Experiment::Exp2 => figures.by_coordination(&evidence.conditions, &best)?,
    }
    figures.draw()
}

/// All settings of a run, with which anyone can repeat it.
fn settings_file(run: &Run) -> String {
    let settings = toml::to_string(run.settings).expect("settings are tables");
    let use_it = format!("bodyschema reproduce {} --settings settings.toml --out DIR", run.experiment.name());
    format!("# Use: {use_it}\n{settings}")
}

/// What the results depend on; their hashes come with the folder.
fn manifest(
    run: &Run,
    preamble: &str,
    tasks: &[Task],
    found: &[TaskOutput],
    rows: &[Row],
) -> Result<Manifest, FileError> {
    let settings = run.settings;
    let hash = |path: &Path| HashedFile::new(&path.display().to_string(), path);
    let inputs = run.settings_file.into_iter().map(hash).collect::<Result<_, _>>()?;
    let body = |(task, found): (&Task, &TaskOutput)| -> Value {
        json!({
            "coordination": task.settings.motion.coordination,
            "simulation": task.simulation,
            "facts": found.kept.as_ref().map(|kept| &kept.facts),
        })
    };
    Ok(Manifest {
        experiment: Some(run.experiment.name().to_owned()),
        summary: Some(preamble.to_owned()),
        headline: Headline::of(rows).map(|headline| headline.sentence).into_iter().collect(),
        quick: Some(run.quick),
        seed: settings.experiment.seed,
        provenance: Provenance::here(),
        bodies: Some(tasks.iter().zip(found).map(body).collect()),
        settings: Some(serde_json::to_value(settings).expect("settings are plain data")),
        inputs: Some(inputs),
        ..Manifest::default()
    })
}
