//! Read the design of a multiverse: the open settings, their reasonable values, and how many readings are drawn.

use std::collections::HashSet;
use std::f64::consts::PI;

use serde::Deserialize;
use toml::{Table, Value};

use super::super::compared::Compared;
use super::super::design::merge;
use super::super::draws::{Draws, Level};
use super::super::error::ExperimentError;
use crate::analysis::published::claims;
use crate::settings::Settings;

/// Most specifications of a design, and most factors: what the sequence has that they are drawn by.
const MOST_SPECIFICATIONS: usize = 1 << 16;
const MOST_FACTORS: usize = 1 << 8;

/// Columns of specifications.csv beside those of the factors.
pub const COLUMNS: [&str; 9] = [
    "specification",
    "movement",
    "distances",
    "maps",
    "resolved",
    "anchor_separation_m",
    "turn",
    "failed",
    "failure",
];

/// What is drawn, and how each specification is run.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Design {
    /// Seed of the draws, and of the movements: those of the m-th have the seed plus m.
    pub seed: u64,
    /// How many specifications are drawn.
    pub draws: Draws,
    /// What every specification has instead of `reproduce/paper.toml`'s values: how much is simulated and drawn.
    pub settings: Table,
    /// The claims that are judged.
    #[serde(rename = "claim")]
    pub claims: Vec<Compared>,
    /// Names of factors whose options make groups of specifications that are also looked at alone.
    #[serde(default)]
    pub groups: Vec<String>,
    /// The open settings.
    #[serde(rename = "factor")]
    pub factors: Vec<Factor>,
}

/// An open setting, or several that belong together, and its reasonable values.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Factor {
    /// Name in tables and pictures.
    pub name: String,
    /// What it decides.
    pub decides: Level,
    /// What the paper says of it, and where.
    pub paper: String,
    /// The values.
    #[serde(rename = "option")]
    pub options: Vec<Choice>,
}

/// A value of an open setting.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Choice {
    /// Name in tables and pictures.
    pub label: String,
    /// Why it is reasonable: a source or a reason.
    pub why: String,
    /// The settings.
    #[serde(default)]
    pub settings: Table,
    /// Gains that go with the body.
    #[serde(default)]
    pub gains: Option<Gains>,
}

/// The gains of a torque, by what they do to the body that they are for.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Gains {
    /// Natural frequency of a part that swings about its end, rad/s: √(stiffness / (m L² / 3)).
    pub frequency: f64,
    /// Damping times the step over the axial inertia of a part, m r² / 2; beyond 1 a spin is overshot in one step.
    pub spin_damping: f64,
}

impl Design {
    /// Reads a design; `origin` says where it is from.
    ///
    /// # Errors
    /// If it is no design, a factor has no option, or a claim is not there.
    pub fn parse(text: &str, origin: &str) -> Result<Self, ExperimentError> {
        let wrong = |message: String| ExperimentError::design(origin, message);
        let design: Self = toml::from_str(text).map_err(|error| wrong(error.to_string()))?;
        if let Some(empty) = design.factors.iter().find(|factor| factor.options.is_empty()) {
            let message =
                format!("has a factor `{}` without an option; give it one or remove it", empty.name);
            return Err(wrong(message));
        }
        let known = |name: &String| design.factors.iter().any(|factor| factor.name == *name);
        if let Some(unknown) = design.groups.iter().find(|name| !known(name)) {
            return Err(wrong(format!("groups by `{unknown}`, which is not a factor")));
        }
        let Draws { movements, distances, maps, inferences } = design.draws;
        let numbers = [movements, distances, maps, inferences];
        if numbers.contains(&0) {
            let message = "draws nothing: movements, distances, maps and inferences must be positive";
            return Err(wrong(message.to_owned()));
        }
        let points = numbers.into_iter().try_fold(1_usize, usize::checked_mul);
        if points.is_none_or(|points| points > MOST_SPECIFICATIONS) || design.factors.len() > MOST_FACTORS {
            let message = format!(
                "draws more than {MOST_SPECIFICATIONS} specifications, or of more than {MOST_FACTORS} factors"
            );
            return Err(wrong(message));
        }
        design.check_names().map_err(wrong)?;
        design.check_gains().map_err(wrong)?;
        if design.claims.is_empty() {
            return Err(wrong("judges no claim; add a [[claim]]".to_owned()));
        }
        Compared::check(&design.claims, &claims()).map_err(wrong)?;
        Ok(design)
    }

    /// Whether every name is of one thing alone.
    fn check_names(&self) -> Result<(), String> {
        let once = |names: Vec<&str>, what: &str| {
            let mut known = HashSet::new();
            match names.into_iter().find(|name| !known.insert(*name)) {
                Some(twice) => Err(format!("has two of `{twice}` among {what}; give each a name of its own")),
                None => Ok(()),
            }
        };
        let factors = self.factors.iter().map(|factor| factor.name.as_str());
        once(COLUMNS.into_iter().chain(factors).collect(), "factors and columns of specifications.csv")?;
        once(self.claims.iter().map(|claim| claim.id.as_str()).collect(), "claims")?;
        let grouping = self.factors.iter().filter(|factor| self.groups.contains(&factor.name));
        once(grouping.flat_map(Factor::labels).collect(), "options that make groups")?;
        self.factors
            .iter()
            .try_for_each(|factor| once(factor.labels().collect(), &format!("options of {}", factor.name)))
    }

    /// Whether gains come from one place alone.
    fn check_gains(&self) -> Result<(), String> {
        let with_gains = |factor: &&Factor| factor.options.iter().any(|option| option.gains.is_some());
        if self.factors.iter().filter(with_gains).count() > 1 {
            return Err("has gains in two factors; put them into one".to_owned());
        }
        let both = |option: &&Choice| option.gains.is_some() && option.settings.contains_key("motion");
        match self.factors.iter().flat_map(|factor| &factor.options).find(both) {
            Some(option) => Err(format!(
                "has gains and settings of motion in `{}`; give one of them (gains are those of a torque)",
                option.label
            )),
            None => Ok(()),
        }
    }

    /// The settings of a specification, given the option of each factor, and the seed of its movement.
    ///
    /// # Errors
    /// If they cannot be used.
    pub fn settings(&self, options: &[usize], seed: u64, name: &str) -> Result<Settings, ExperimentError> {
        let mut table = self.settings.clone();
        let mut gains = None;
        for (factor, &option) in self.factors.iter().zip(options) {
            let choice = &factor.options[option];
            merge(&mut table, &choice.settings);
            gains = choice.gains.or(gains);
        }
        let origin = format!("specification {name}");
        let mut settings = Settings::overlaid([&table], &origin)?;
        if let Some(gains) = gains {
            let motion = Table::from_iter([("motion".to_owned(), Value::Table(gains.of(&settings)))]);
            settings = Settings::overlaid([&table, &motion], &origin)?;
        }
        settings.experiment.seed = seed;
        if settings.experiment.simulations < 2 {
            let message = "has one simulation; simulations differ, so use at least two";
            return Err(ExperimentError::design(&origin, message));
        }
        Ok(settings)
    }
}

impl Factor {
    fn labels(&self) -> impl Iterator<Item = &str> {
        self.options.iter().map(|option| option.label.as_str())
    }
}

impl Gains {
    /// `[motion]` for a body, in three digits.
    fn of(self, settings: &Settings) -> Table {
        let Settings { agent, physics, .. } = settings;
        let mass = agent.density * PI * agent.part_radius.powi(2) * agent.part_length;
        let stiffness = self.frequency.powi(2) * mass * agent.part_length.powi(2) / 3.0;
        let damping = self.spin_damping * mass * agent.part_radius.powi(2) / 2.0 / physics.step;
        let digits = |value: f64| format!("{value:.2e}").parse().expect("it is a number");
        let number = |value: f64| Value::Float(digits(value));
        Table::from_iter([
            ("controller".to_owned(), Value::String("torque".to_owned())),
            ("stiffness".to_owned(), number(stiffness)),
            ("damping".to_owned(), number(damping)),
        ])
    }
}
