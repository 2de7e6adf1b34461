//! TOML → the settings of a run; each value's meaning, unit and source stand in `reproduce/paper.toml`.
//!
//! `reproduce/paper.toml` is compiled in as the default, so that it is the only place where a default is
//! written. A user's file is laid over it; a key that `paper.toml` does not have is an error.

use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use serde::{Deserialize, Serialize};
use toml::{Table, Value};

use crate::agent::PARTS;
use crate::distance::MOST_SENSORS;
use crate::plot::MANY;
use crate::record::one_line;
use crate::schema::{MOST_LABELS, fits};

/// `reproduce/paper.toml` itself, whose comments say where each value is from.
pub const PAPER: &str = include_str!("../reproduce/paper.toml");
const QUICK: &str = include_str!("../reproduce/quick.toml");

/// Longest settings file, in bytes: far above any, and far below what a device or a wrong file may have.
const LONGEST_FILE: u64 = 1 << 20;

/// All settings of a run. Field by field the twin of `reproduce/paper.toml`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// The body (section 5.1, figure 4).
    pub agent: Agent,
    /// The sensors on it.
    pub skin: Skin,
    /// Coordinated random movement (section 5.1).
    pub motion: Motion,
    /// The physics engine.
    pub physics: Physics,
    /// The tactile sense (equation 25).
    pub sense: Sense,
    /// From pressures to symbols (section 4.1).
    pub quantise: Quantise,
    /// From distances to body maps (section 4.1).
    pub map: Map,
    /// The DPGMM-LJ and its sampler (section 3).
    pub schema: Schema,
    /// The clusterings to compare with (section 5.2).
    pub baselines: Baselines,
    /// What counts as a success (section 5.2).
    pub evaluate: Evaluate,
    /// The conditions that are repeated.
    pub experiment: Experiment,
}

/// How the parts are joined.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Morphology {
    /// Five parts in a row.
    Chain,
    /// A trunk with two limbs at each end.
    Star,
    /// A trunk with two arms at right angles on one end, and two further parts in line on the other.
    Tee,
    /// As the tee, with the arms raised by 45°.
    Y,
}

/// Geometry of the body; lengths in m, density in kg/m³.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Agent {
    /// Which part is joined to which.
    pub morphology: Morphology,
    /// Length of each cylinder, m.
    pub part_length: f64,
    /// Radius of each cylinder, m.
    pub part_radius: f64,
    /// Distance between the two ends that a joint connects, m.
    pub gap: f64,
    /// Density of the parts, kg/m³.
    pub density: f64,
}

/// Layout of the sensors on each part.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Skin {
    /// Sensors in a ring around the cylinder.
    pub around: usize,
    /// Rings along the cylinder.
    pub along: usize,
    /// Sensors on both end caps together; half of them on each.
    pub caps: usize,
}

/// What the controller takes as the distance to the target.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum AngleError {
    /// target − angle, with the angle in [−π, π] as ODE reports it.
    Raw,
    /// The same wrapped to [−π, π]: the shorter way round.
    Shortest,
}

/// Where a joint that moves goes to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Targets {
    /// Each of a universal joint's two axes draws a target of its own.
    Each,
    /// Both axes of a joint share one target.
    Shared,
}

/// Coordinated random movement and its controller (section 5.1).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Motion {
    /// p, ratio of motor coordination: the probability that a joint stays locked for an epoch, in [0, 1].
    pub coordination: f64,
    /// Physics steps between two draws.
    pub epoch: usize,
    /// Where a joint that moves goes to.
    pub targets: Targets,
    /// k_p, N·m/rad. Higher is faster, and less stable at a given step.
    pub stiffness: f64,
    /// k_d, N·m·s/rad. Times the step over the part's axial inertia it must stay below about 1.
    pub damping: f64,
    /// What the controller takes as the distance to the target.
    pub error: AngleError,
}

/// Time in the physics engine, s.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Physics {
    /// One step, s.
    pub step: f64,
    /// Simulated time, s.
    pub duration: f64,
    /// Turns a part may make in a step; beyond, the simulation counts as unstable.
    pub turn_limit: f64,
}

/// The tactile sense (equation 25).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sense {
    /// Δt, s: time between two samples, and of the backward difference.
    pub interval: f64,
    /// ρ, kg/m³.
    pub fluid_density: f64,
}

/// How pressures become levels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Scheme {
    /// Level 0 is no pressure; the others hold equally many of that sensor's positive pressures.
    PerSensor,
    /// The same with one set of thresholds for all sensors.
    Pooled,
    /// Levels of equal width between the smallest and the largest pressure of all sensors.
    EqualWidth,
}

/// Quantisation (section 4.1).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Quantise {
    /// How levels are placed.
    pub scheme: Scheme,
    /// N, number of levels, 2 to 256.
    pub levels: usize,
}

/// The variant of multidimensional scaling.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum MapMethod {
    /// Torgerson's: the largest eigenvalues of the inner products.
    Classical,
    /// Metric: the least sum of squared differences to the distances, from the classical map on.
    Smacof,
    /// Kruskal's: the same to numbers that only rise as the distances do.
    Nonmetric,
}

/// Multidimensional scaling (section 4.1).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Map {
    /// Its variant.
    pub method: MapMethod,
}

/// The weight of an edge in the update of the tree (equation 21).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum EdgeWeight {
    /// Each child keeps the joint q_s it has, whichever parent is weighed.
    Literal,
    /// A joint is drawn for each pair of active components, and weighs that pair.
    Pairwise,
    /// The joint is integrated out: −log N(μ_s; μ_c, Σ_s + Σ_c).
    Collapsed,
}

/// The labels that a chain starts with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Start {
    /// Uniform over the K components.
    Uniform,
    /// The K clusters of k-means from one random start.
    KMeans,
    /// All points in one component.
    Single,
}

/// Which draws of a chain are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Keep {
    /// The last one.
    Last,
    /// Every one after burn-in.
    All,
}

/// The mixture, its prior and its sampler (section 3).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Schema {
    /// K, truncation of the weak limit.
    pub components: usize,
    /// γ of Dir(γ/K).
    pub concentration: f64,
    /// k₀, weight of the prior mean, in observations.
    pub mean_weight: f64,
    /// ν₀ − d, where ν₀ > d − 1 are the degrees of freedom of the inverse Wishart.
    pub extra_freedom: f64,
    /// Multiplies the prior scale Ψ₀ = covariance(x) / K^(2/d) of Fraley & Raftery (2007).
    pub scale: f64,
    /// Weight of the tree's edges.
    pub edge_weight: EdgeWeight,
    /// The labels that a chain starts with.
    pub start: Start,
    /// Gibbs sweeps of each chain.
    pub sweeps: usize,
    /// Independent chains.
    pub chains: usize,
    /// Which draws are kept.
    pub keep: Keep,
    /// Sweeps dropped where every draw is kept.
    pub burn_in: usize,
}

/// What counts as a success (section 5.2).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Evaluate {
    /// Least adjusted Rand index at which a tree is counted.
    pub eligible_ari: f64,
}

/// The clusterings of figure 8a, which need the number of clusters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Baselines {
    /// Numbers of clusters.
    pub clusters: Vec<usize>,
    /// Starts of k-means and of GMM, of which the best is kept.
    pub restarts: usize,
}

/// The conditions that an experiment repeats.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Experiment {
    /// d of the body maps of experiment 1.
    pub dimensions: Vec<usize>,
    /// p of experiment 2.
    pub coordinations: Vec<f64>,
    /// d of the body maps of experiment 2.
    pub dimension: usize,
    /// Independent simulations.
    pub simulations: usize,
    /// Master seed.
    pub seed: u64,
}

/// A settings file or value that cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum SettingsError {
    /// The file cannot be read.
    #[error("{}: cannot read the settings: {reason}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: io::Error,
    },
    /// The file is no TOML, or a value has the wrong type.
    #[error("{origin}: {message}")]
    Malformed {
        /// The file.
        origin: String,
        /// What is wrong, on one line.
        message: String,
    },
    /// A key that does not exist.
    #[error("{origin}: unknown setting `{key}`; reproduce/paper.toml lists all of them")]
    Unknown {
        /// The file.
        origin: String,
        /// The key, with its section.
        key: String,
    },
    /// A value outside its range.
    #[error("setting `{key}` is {value}, but must be {range}")]
    OutOfRange {
        /// The key, with its section.
        key: &'static str,
        /// The value.
        value: String,
        /// What is allowed.
        range: &'static str,
    },
}

impl Settings {
    /// The settings of the replication: `reproduce/paper.toml`.
    pub fn paper() -> Self {
        Table::try_into(paper_table()).expect("reproduce/paper.toml matches Settings; a test checks it")
    }

    /// `reproduce/paper.toml`, with `reproduce/quick.toml` over it if `quick`, and `file` over both.
    ///
    /// # Errors
    /// If the file cannot be read, is malformed, has an unknown key, or a value is out of range.
    pub fn load(quick: bool, file: Option<&Path>) -> Result<Self, SettingsError> {
        let mut table = paper_table();
        let mut origin = "reproduce/paper.toml".to_owned();
        if quick {
            overlay(&mut table, parse(QUICK, "reproduce/quick.toml")?, "", "reproduce/quick.toml")?;
        }
        if let Some(path) = file {
            let text = read(path)?;
            origin = path.display().to_string();
            overlay(&mut table, parse(&text, &origin)?, "", &origin)?;
        }
        Self::checked(table, &origin)
    }

    /// `reproduce/paper.toml` with tables laid over it, one after the other; `origin` says where they are from.
    ///
    /// # Errors
    /// If a key is unknown, or a value is out of range.
    pub fn overlaid<'a>(
        tables: impl IntoIterator<Item = &'a Table>,
        origin: &str,
    ) -> Result<Self, SettingsError> {
        let mut table = paper_table();
        for over in tables {
            overlay(&mut table, over.clone(), "", origin)?;
        }
        Self::checked(table, origin)
    }

    fn checked(table: Table, origin: &str) -> Result<Self, SettingsError> {
        let settings: Self = table.try_into().map_err(|error: toml::de::Error| SettingsError::Malformed {
            message: one_line(&error.to_string()),
            origin: origin.to_owned(),
        })?;
        settings.validate()?;
        Ok(settings)
    }

    /// Checks every range that needs no data, so that a run neither asks the physics engine for what it would abort on
    /// nor takes more memory than a large computer has, or more time than a life.
    ///
    /// # Errors
    /// [`SettingsError::OutOfRange`] for the first value that cannot be used.
    pub fn validate(&self) -> Result<(), SettingsError> {
        let positive = |key, value: f64| {
            check(key, value, value.is_finite() && value > 0.0, "a positive, finite number")
        };
        // Far beyond any body, and far within what the physics engine computes without overflow and a picture shows.
        let length = |key, value: f64| check(key, value, (1e-3..=1e3).contains(&value), "0.001 to 1000");
        let physical =
            |key, value: f64| check(key, value, (1e-6..=1e6).contains(&value), "0.000001 to 1000000");
        let gain = |key, value: f64| check(key, value, (0.0..=1e6).contains(&value), "0 to 1000000");
        let count = |key, value: usize| check(key, value, value >= 1, "at least 1");

        length("agent.part_length", self.agent.part_length)?;
        length("agent.part_radius", self.agent.part_radius)?;
        let flattest = 10.0 * self.agent.part_length;
        check(
            "agent.part_radius",
            self.agent.part_radius,
            self.agent.part_radius <= flattest,
            "at most ten times agent.part_length",
        )?;
        check("agent.gap", self.agent.gap, (0.0..=1e3).contains(&self.agent.gap), "0 to 1000")?;
        physical("agent.density", self.agent.density)?;

        count("skin.around", self.skin.around)?;
        count("skin.along", self.skin.along)?;
        check("skin.caps", self.skin.caps, self.skin.caps.is_multiple_of(2), "even: half on each cap")?;
        let each = self.skin.around.saturating_mul(self.skin.along).saturating_add(self.skin.caps);
        check(
            "skin.around * skin.along + skin.caps",
            each,
            each <= MOST_SENSORS / PARTS,
            "at most 4000, which makes 20000 sensors in all",
        )?;
        let sensors = PARTS * each;

        let p = self.motion.coordination;
        check("motion.coordination", p, (0.0..=1.0).contains(&p), "a probability, 0 to 1")?;
        count("motion.epoch", self.motion.epoch)?;
        gain("motion.stiffness", self.motion.stiffness)?;
        gain("motion.damping", self.motion.damping)?;

        physical("physics.step", self.physics.step)?;
        positive("physics.duration", self.physics.duration)?;
        let turns = self.physics.turn_limit;
        check("physics.turn_limit", turns, (0.001..=1e6).contains(&turns), "0.001 to 1000000")?;
        positive("sense.interval", self.sense.interval)?;
        physical("sense.fluid_density", self.sense.fluid_density)?;
        let ratio = self.sense.interval / self.physics.step;
        let whole = ratio >= 0.5 && (ratio - ratio.round()).abs() < 1e-6 * ratio;
        check("sense.interval", self.sense.interval, whole, "a whole number of physics.step")?;
        // Before anything is allocated: 2 billion pressures are 8 GB, 20 million samples 13 GB of poses. A billion
        // steps take hours; of a longer time, figures show nothing.
        let duration = self.physics.duration;
        let (samples, steps) = (duration / self.sense.interval, duration / self.physics.step);
        check(
            "physics.duration",
            duration,
            (1.0 - 1e-9..=2e7).contains(&samples)
                && samples * sensors as f64 <= 2e9
                && steps <= 1e9
                && duration <= 1e9,
            "at least sense.interval and at most 1000000000, with at most 20 million samples, 2 billion pressures and \
             1 billion steps of physics.step in all",
        )?;

        let levels = self.quantise.levels;
        check("quantise.levels", levels, (2..=256).contains(&levels), "2 to 256")?;

        let schema = &self.schema;
        check("schema.components", schema.components, (1..=1000).contains(&schema.components), "1 to 1000")?;
        physical("schema.concentration", schema.concentration)?;
        physical("schema.mean_weight", schema.mean_weight)?;
        let freedom = schema.extra_freedom;
        check("schema.extra_freedom", freedom, (-0.99..=1e6).contains(&freedom), "-0.99 to 1000000")?;
        physical("schema.scale", schema.scale)?;
        count("schema.sweeps", schema.sweeps)?;
        check("schema.chains", schema.chains, (1..=1_000_000).contains(&schema.chains), "1 to 1000000")?;
        let sweeps = schema.chains.saturating_mul(schema.sweeps);
        check("schema.chains * schema.sweeps", sweeps, sweeps <= 1_000_000_000, "at most 1000000000")?;
        if schema.keep == Keep::All {
            check("schema.burn_in", schema.burn_in, schema.burn_in < schema.sweeps, "below schema.sweeps")?;
        }
        let draws = schema.draws();
        check(
            "schema.chains * (schema.sweeps - schema.burn_in)",
            draws,
            draws <= 1_000_000 && draws * sensors <= MOST_LABELS,
            "at most 1000000 draws where all are kept, and at most 1000000000 labels with all sensors",
        )?;

        let ari = self.evaluate.eligible_ari;
        check("evaluate.eligible_ari", ari, (0.0..=1.0).contains(&ari), "0 to 1")?;

        let dimensions = &self.experiment.dimensions;
        check(
            "experiment.dimensions",
            dimensions,
            rising(dimensions) && dimensions[0] >= 1,
            "a rising list of 1 to 60 dimensions, each at least 1",
        )?;
        let coordinations = &self.experiment.coordinations;
        check(
            "experiment.coordinations",
            coordinations,
            rising(coordinations) && coordinations.iter().all(|p| (0.0..=1.0).contains(p)),
            "a rising list of 1 to 60 probabilities, 0 to 1",
        )?;
        count("experiment.dimension", self.experiment.dimension)?;
        for (key, d) in [
            ("experiment.dimensions", dimensions.last()),
            ("experiment.dimension", Some(&self.experiment.dimension)),
        ] {
            check(
                key,
                d.copied().unwrap_or(0),
                d.is_none_or(|&d| fits(schema.components, d)),
                "such that schema.components times its square is at most 10 million",
            )?;
        }
        let clusters = &self.baselines.clusters;
        check(
            "baselines.clusters",
            clusters,
            rising(clusters) && clusters.iter().all(|clusters| (1..=sensors.min(1000)).contains(clusters)),
            "a rising list of 1 to 60 numbers from 1 to the number of sensors, at most 1000",
        )?;
        let restarts = self.baselines.restarts;
        check("baselines.restarts", restarts, (1..=1000).contains(&restarts), "1 to 1000")?;
        let simulations = self.experiment.simulations;
        let conditions = (2 * dimensions.len()).max(coordinations.len());
        check(
            "experiment.simulations",
            simulations,
            (1..=10_000).contains(&simulations) && simulations * conditions * draws <= 10_000_000,
            "1 to 10000, with at most 10 million draws (schema.chains, schema.keep) in all conditions",
        )
    }

    /// Physics steps between two samples.
    pub fn steps_per_sample(&self) -> usize {
        (self.sense.interval / self.physics.step).round() as usize
    }

    /// T, the number of samples.
    pub fn samples(&self) -> usize {
        (self.physics.duration / self.sense.interval + 1e-6).floor() as usize
    }
}

impl Schema {
    /// Number of draws that are kept.
    pub fn draws(&self) -> usize {
        match self.keep {
            Keep::Last => self.chains,
            Keep::All => self.chains.saturating_mul(self.sweeps.saturating_sub(self.burn_in)),
        }
    }
}

/// Whether a list of conditions is in order, without a twin, and short enough for a figure.
fn rising<T: PartialOrd>(values: &[T]) -> bool {
    (1..=MANY).contains(&values.len()) && values.windows(2).all(|pair| pair[0] < pair[1])
}

/// The text of a file of settings or of a design.
///
/// # Errors
/// If it cannot be read, or is too long to be one.
pub fn read(path: &Path) -> Result<String, SettingsError> {
    let mut text = String::new();
    let read = File::open(path).and_then(|file| file.take(LONGEST_FILE + 1).read_to_string(&mut text));
    match read {
        Ok(length) if length as u64 > LONGEST_FILE => {
            Err(io::Error::other(format!("it is longer than {LONGEST_FILE} bytes")))
        }
        Ok(_) => Ok(text),
        Err(error) => Err(error),
    }
    .map_err(|reason| SettingsError::Unreadable { path: path.to_owned(), reason })
}

fn check(
    key: &'static str,
    value: impl std::fmt::Debug,
    within: bool,
    range: &'static str,
) -> Result<(), SettingsError> {
    if within {
        Ok(())
    } else {
        Err(SettingsError::OutOfRange { key, value: one_line(&format!("{value:?}")), range })
    }
}

fn paper_table() -> Table {
    parse(PAPER, "reproduce/paper.toml").expect("reproduce/paper.toml is TOML; a test checks it")
}

fn parse(text: &str, origin: &str) -> Result<Table, SettingsError> {
    text.parse().map_err(|error: toml::de::Error| {
        let line = error
            .span()
            .map_or(String::new(), |span| format!("line {}: ", 1 + text[..span.start].matches('\n').count()));
        SettingsError::Malformed {
            origin: origin.to_owned(),
            message: one_line(&format!("{line}{}", error.message())),
        }
    })
}

/// Lays `over` on `base`, key by key; `section` and `origin` are for the message.
fn overlay(base: &mut Table, over: Table, section: &str, origin: &str) -> Result<(), SettingsError> {
    for (name, value) in over {
        let key = format!("{section}{}", name.escape_debug());
        match (base.get_mut(&name), value) {
            (Some(Value::Table(base)), Value::Table(over)) => {
                overlay(base, over, &format!("{key}."), origin)?
            }
            // TOML writes 1 for 1.0; a person does too.
            (Some(slot @ Value::Float(_)), Value::Integer(whole)) => *slot = Value::Float(whole as f64),
            (Some(slot), value) if slot.same_type(&value) => *slot = value,
            (Some(slot), value) => {
                return Err(SettingsError::Malformed {
                    origin: origin.to_owned(),
                    message: format!(
                        "`{key}` has type {}, but must have type {}",
                        value.type_str(),
                        slot.type_str()
                    ),
                });
            }
            (None, _) => return Err(SettingsError::Unknown { origin: origin.to_owned(), key }),
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn load(text: &str) -> Result<Settings, SettingsError> {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        Settings::load(false, Some(file.path()))
    }

    #[test]
    fn both_files_of_the_repository_load() {
        let paper = Settings::load(false, None).unwrap();
        assert_eq!(paper, Settings::paper());
        assert_eq!((paper.samples(), paper.steps_per_sample()), (100_000, 10));
        assert!(Settings::load(true, None).unwrap().samples() < paper.samples());
    }

    #[test]
    fn a_file_changes_only_what_it_names() {
        let mut expected = Settings::paper();
        expected.motion.coordination = 1.0;
        expected.schema.edge_weight = EdgeWeight::Collapsed;
        assert_eq!(
            load("[motion]\ncoordination = 1\n[schema]\nedge_weight = \"collapsed\"").unwrap(),
            expected
        );
    }

    #[test]
    fn mistakes_are_named() {
        for (text, expected) in [
            ("[motion]\nspeed = 3", "unknown setting `motion.speed`"),
            ("[moton]\nepoch = 3", "unknown setting `moton`"),
            ("[motion]\nepoch = \"long\"", "`motion.epoch` has type string, but must have type integer"),
            ("[motion]\nepoch = -3", "motion.epoch"),
            ("[motion\nepoch = 3", "line 1:"),
            ("[schema]\ncomponents = 0", "`schema.components` is 0, but must be 1 to 1000"),
            ("[schema]\nedge_weight = \"prim\"", "unknown variant `prim`"),
            ("[physics]\nstep = nan", "`physics.step` is NaN"),
            ("[agent]\ndensity = 1e-320", "agent.density"),
            ("[physics]\nduration = 1e9", "`physics.duration` is 1000000000"),
            ("[physics]\nstep = 0.03", "a whole number of physics.step"),
            ("[skin]\ncaps = 3", "even"),
            ("[experiment]\ndimensions = []", "experiment.dimensions"),
        ] {
            let message = load(text).unwrap_err().to_string();
            assert!(message.contains(expected), "{text:?} gave {message:?}");
            assert!(!message.contains('\n'), "{message:?} is one line");
        }
    }
}
