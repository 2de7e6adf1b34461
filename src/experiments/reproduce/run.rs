//! Say which experiment is run, how, and where to.

use std::path::Path;

use crate::analysis::published::Experiment;
use crate::settings::Settings;
use crate::stages::simulate::Resolution;
use crate::tasks::seeds::used_before;

/// How an experiment is run.
#[derive(Debug)]
pub(crate) struct Run<'a> {
    /// The experiment.
    pub experiment: Experiment,
    /// Its settings.
    pub settings: &'a Settings,
    /// The user's settings file, for the manifest.
    pub settings_file: Option<&'a Path>,
    /// Whether it is a small run that only shows the program working.
    pub quick: bool,
    /// The folder for all files.
    pub out: &'a Path,
}

impl Run<'_> {
    /// The largest d of its body maps.
    pub(crate) fn largest_dimension(&self) -> usize {
        let settings = &self.settings.experiment;
        match self.experiment {
            Experiment::Exp1 => *settings.dimensions.last().expect("validated as not empty"),
            Experiment::Exp2 => settings.dimension,
        }
    }
}

/// Conditions, amounts, seed and revision of a run, and how well its movements were resolved, in words: what stands above
/// the table of claims.
pub(super) fn preamble(run: &Run, resolution: Resolution) -> String {
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
    let seed = experiment.seed;
    let used = used_before(seed..=seed).unwrap_or_else(|| {
        format!("Seed {seed} is held out: no search, result or study of this repository used it.")
    });
    let (simulations, scope) = match experiment.simulations {
        1 => (
            "1 simulation".to_owned(),
            "Intervals are over the chains of this one simulation; another can differ by more.",
        ),
        several => (format!("{several} simulations"), "Intervals are over simulations (bootstrap)."),
    };
    let resolved = resolution.in_words("the movements");
    format!(
        "{what}. Size: {simulations}, {} chains of {} sweeps for each condition, seed {seed}, revision {}. {used} \
         Resolution: {resolved}.{caution} {scope} Rows marked extension count only the most probable sample of each \
         simulation (highest log posterior), which the paper does not do.",
        schema.chains,
        schema.sweeps,
        env!("BODYSCHEMA_REVISION"),
    )
}

fn list<T: ToString>(values: &[T]) -> String {
    values.iter().map(T::to_string).collect::<Vec<_>>().join(", ")
}
