//! Define options that several subcommands share, and options that set a setting.

use std::collections::BTreeMap;
use std::path::PathBuf;

use anyhow::{Result, ensure};
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::analysis::published::Experiment;
use crate::files::tables::read_truth;
use crate::settings::{Base, Settings, read_toml};
use crate::stages::body_map::{MapMethod, MapOf};
use crate::stages::parameters::Parameters;
use crate::stages::quantise::Scheme;
use crate::stages::schema::{EdgeWeight, Keep, Model, Sampler, Start};
use crate::stages::tree::Truth;

/// The number of threads.
#[derive(Args)]
pub(super) struct Threads {
    /// Number of threads; results do not depend on it [default: one per core]
    #[arg(long, value_name = "N")]
    jobs: Option<usize>,
}

impl Threads {
    /// Starts as many threads as the user wants.
    pub(super) fn apply(&self) -> Result<()> {
        if let Some(jobs) = self.jobs {
            ensure!((1..=1024).contains(&jobs), "--jobs is {jobs}, but must be 1 to 1024");
            rayon::ThreadPoolBuilder::new().num_threads(jobs).build_global()?;
        }
        Ok(())
    }
}

/// A settings file.
#[derive(Args)]
pub(super) struct SettingsFile {
    /// Settings that differ from reproduce/paper.toml, which explains all of them
    #[arg(long, value_name = "FILE")]
    pub settings: Option<PathBuf>,
}

impl SettingsFile {
    /// The settings, of a quick run if `quick`.
    pub(super) fn load(&self, quick: bool) -> Result<Settings> {
        Ok(Settings::load(quick, self.settings.as_deref())?)
    }

    /// Whether the user's file has a setting.
    pub(super) fn has(&self, section: &str, key: &str) -> Result<bool> {
        let Some(path) = &self.settings else { return Ok(false) };
        let table: toml::Table = read_toml(path)?.parse()?;
        Ok(table.get(section).and_then(toml::Value::as_table).is_some_and(|own| own.contains_key(key)))
    }
}

/// A settings file and the master seed.
#[derive(Args)]
pub(super) struct SettingsAndSeed {
    #[command(flatten)]
    pub file: SettingsFile,
    #[arg(long, value_name = "S", help = with_default("Master seed of all random numbers", paper().experiment.seed))]
    seed: Option<u64>,
}

impl SettingsAndSeed {
    /// The settings, of a quick run if `quick`.
    pub(super) fn load(&self, quick: bool) -> Result<Settings> {
        Ok(self.seeded(self.file.load(quick)?))
    }

    /// The settings, with those of a file of the project beneath the user's.
    pub(super) fn load_over(&self, base: Base) -> Result<Settings> {
        Ok(self.seeded(Settings::load_over(Some(base), self.file.settings.as_deref())?))
    }

    fn seeded(&self, mut settings: Settings) -> Settings {
        set(&mut settings.experiment.seed, self.seed);
        settings
    }
}

/// Parameters that are not the default.
#[derive(Args)]
pub(super) struct ParameterOptions {
    /// Change a parameter of the method, such as min_saving=0.6; may be repeated (docs/shown/parameters)
    #[arg(long = "parameter", value_name = "NAME=VALUE", value_parser = name_and_value)]
    changed: Vec<(String, f64)>,
}

impl ParameterOptions {
    /// All parameters, of which the user may have changed some.
    pub(super) fn all(&self) -> Result<Parameters> {
        let changes = self.changed.iter().map(|(name, value)| (name.as_str(), *value));
        Ok(Parameters::changed(changes)?)
    }

    /// Those that the user has changed, by their names.
    pub(super) fn changed(&self) -> BTreeMap<String, f64> {
        self.changed.iter().cloned().collect()
    }
}

/// A parameter and its value.
fn name_and_value(text: &str) -> Result<(String, f64), String> {
    let (name, value) = text.split_once('=').ok_or("it must be NAME=VALUE")?;
    let value = value.trim().parse().map_err(|_| format!("`{value}` is not a number"))?;
    Ok((name.trim().to_owned(), value))
}

/// The truth, to compare with.
#[derive(Args)]
pub(super) struct TruthFiles {
    /// True part of each sensor: a .csv file with columns sensor,part
    #[arg(long, value_name = "FILE", requires = "tree")]
    labels: Option<PathBuf>,
    /// True tree: a .csv file with columns child,parent
    #[arg(long, value_name = "FILE", requires = "labels")]
    tree: Option<PathBuf>,
}

impl TruthFiles {
    /// The truth of a body with so many sensors, if it is given.
    pub(super) fn read(&self, sensors: usize) -> Result<Option<Truth>> {
        let files = self.labels.as_ref().zip(self.tree.as_ref());
        Ok(files.map(|(labels, tree)| read_truth(labels, tree, sensors)).transpose()?)
    }
}

/// Replaces a setting if its option was given.
pub(super) fn set<T>(setting: &mut T, option: Option<T>) {
    if let Some(value) = option {
        *setting = value;
    }
}

/// The default settings.
pub(super) fn paper() -> Settings {
    Settings::paper()
}

/// A help text with a setting's default.
pub(super) fn with_default(text: &str, default: impl Serialize) -> String {
    format!("{text} [default: {}]", name(&default))
}

/// The name of a setting's value, as settings files write it.
fn name(value: &impl Serialize) -> String {
    serde_json::to_value(value).expect("a setting's value is plain data").to_string().replace('"', "")
}

/// A setting with a fixed set of values.
pub(super) trait Choice: Clone + Send + Sync + Serialize + DeserializeOwned + 'static {
    /// All values, each with what it means.
    const VALUES: &'static [(Self, &'static str)];
}

/// Reads a [`Choice`] from the command line, and explains its values in the help text.
pub(super) fn choice<T: Choice>() -> impl TypedValueParser<Value = T> {
    let values = T::VALUES.iter().map(|(value, help)| PossibleValue::new(name(value)).help(*help));
    let read = |text: String| serde_json::from_value(text.into()).expect("clap admits the named values only");
    PossibleValuesParser::new(values).map(read)
}

impl Choice for Scheme {
    const VALUES: &'static [(Self, &'static str)] = &[
        (
            Self::PerSensor,
            "Equal-frequency levels of each sensor's positive pressures; level 0 is no pressure",
        ),
        (Self::Pooled, "As per-sensor, but with the same thresholds for all sensors"),
        (Self::EqualWidth, "Levels of equal width between the smallest and the largest pressure"),
    ];
}

impl Choice for MapMethod {
    const VALUES: &'static [(Self, &'static str)] = &[
        (Self::Classical, "Classical scaling (Torgerson), from the eigenvectors of the inner products"),
        (Self::Smacof, "Metric scaling by majorisation (SMACOF), starting from the classical map"),
        (
            Self::SmacofRandom,
            "Metric scaling by majorisation (SMACOF), the best of several random starts, as in scikit-learn 0.19",
        ),
        (Self::Nonmetric, "Nonmetric scaling (Kruskal), from the rank order of the distances"),
    ];
}

impl Choice for MapOf {
    const VALUES: &'static [(Self, &'static str)] = &[
        (Self::Distances, "The distances themselves"),
        (Self::Rows, "Euclidean distances between the rows of the distance matrix"),
    ];
}

impl Choice for Sampler {
    const VALUES: &'static [(Self, &'static str)] = &[
        (
            Self::Equations,
            "Gibbs sampler of the paper's equations (Algorithm 1); for equation 22, see --edge-weight",
        ),
        (
            Self::AuthorsCode,
            "Gibbs sampler of the first author's public code; [schema.authors] of paper.toml lists its departures",
        ),
        (
            Self::SplitMerge,
            "Split-merge sampler (not in the paper), with the settings of split-merge.toml; also writes a posterior summary",
        ),
    ];
}

impl Choice for Model {
    const VALUES: &'static [(Self, &'static str)] = &[
        (Self::Dpgmm, "Dirichlet-process Gaussian mixture; its tree is found afterwards by Prim's algorithm"),
        (Self::DpgmmLj, "DPGMM with latent joints (DPGMM-LJ), the paper's method"),
    ];
}

impl Choice for EdgeWeight {
    const VALUES: &'static [(Self, &'static str)] = &[
        (
            Self::Literal,
            "Equation 22 to the letter: each child keeps its joint, whatever parent is considered",
        ),
        (
            Self::Pairwise,
            "A joint is sampled for each pair of active components, as in the first author's code; deviates from equation 22",
        ),
        (Self::Collapsed, "The joint is integrated out"),
    ];
}

impl Choice for Start {
    const VALUES: &'static [(Self, &'static str)] = &[
        (Self::Uniform, "Each sensor in a component drawn uniformly at random"),
        (Self::KMeans, "The clusters of k-means from one random start"),
        (Self::Single, "All sensors in one component"),
        (
            Self::StickBreaking,
            "Weights by stick-breaking, labels drawn from them, means by k-means, identity covariances",
        ),
        (Self::Overdispersed, "Overdispersed starts: one chain after the other single, k-means, uniform"),
    ];
}

impl Choice for Keep {
    const VALUES: &'static [(Self, &'static str)] =
        &[(Self::Last, "The last sample of each chain"), (Self::All, "Every sample after burn-in")];
}

impl Choice for Experiment {
    const VALUES: &'static [(Self, &'static str)] = &[
        (Self::Exp1, "Section 5: body schema estimation over the dimensions d of the body map"),
        (Self::Exp2, "Section 6: body schema estimation over the ratio p of motor coordination"),
    ];
}

/// A length of time above 0, s.
pub(super) fn seconds(text: &str) -> Result<f64, String> {
    let seconds: f64 = text.parse().map_err(|_| "it must be a number of seconds".to_owned())?;
    if seconds.is_finite() && seconds > 0.0 { Ok(seconds) } else { Err("it must be above 0".to_owned()) }
}

/// A length above 0, m.
pub(super) fn metres(text: &str) -> Result<f64, String> {
    let metres: f64 = text.parse().map_err(|_| "it must be a number of metres".to_owned())?;
    if (1e-6..=1e6).contains(&metres) { Ok(metres) } else { Err("it must be 0.000001 to 1000000".to_owned()) }
}

#[cfg(test)]
mod tests;
