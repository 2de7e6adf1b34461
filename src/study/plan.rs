//! Plan a study: list its configurations. They are named one by one, change one factor of a base at a time, form a full factorial grid, or
//! are a quasi-random (Sobol) sample.

use std::collections::HashMap;
use std::ops::RangeInclusive;
use std::str::FromStr;

use toml::Table;

use super::choices::{flat, merge};
use super::design::{BASE, Choice, Design, Factor, NamedConfiguration, Vary};
use super::draw::{Drawn, drawn};
use super::levels::{DrawCounts, SharedStages};
use crate::settings::Settings;
use crate::tasks::cache::Keys;
use crate::tasks::error::ExperimentError;

/// One way to run the experiments.
#[derive(Debug, Clone)]
pub(crate) struct Configuration {
    /// Its number, from 1.
    pub number: usize,
    /// Its name.
    pub name: String,
    /// Numbers of its movement, distances and maps; equal numbers are computed once.
    pub shared_stages: SharedStages,
    /// The label of the option of each factor of the design; empty where it has the base's value, or later ones override it.
    pub labels: Vec<String>,
    /// What it has instead of the base's values, gains computed.
    pub changes: Table,
    /// All settings.
    pub settings: Settings,
}

/// The configurations that `--only` selects: those of a number, a name, a range of drawn movements, or a factor.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Selection(String);

impl FromStr for Selection {
    type Err = std::convert::Infallible;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Ok(Self(text.to_owned()))
    }
}

/// What distinguishes a configuration from the others of its design.
struct Point<'a> {
    name: String,
    shared_stages: SharedStages,
    seed: u64,
    /// The option of each factor, if it does not have the base's value.
    choices: Vec<Option<&'a Choice>>,
}

/// All configurations of a design.
///
/// # Errors
/// If the settings of one cannot be used; the message names it.
pub(crate) fn plan(design: &Design) -> Result<Vec<Configuration>, ExperimentError> {
    let as_choice = |own: &NamedConfiguration| Choice { settings: own.settings.clone(), ..Choice::default() };
    let named: Vec<Choice> = design.configurations.iter().map(as_choice).collect();
    let points = match (design.vary, design.draws) {
        (_, Some(draws)) => drawn_points(design, draws),
        (Some(Vary::Grid), None) => grid(design),
        (Some(Vary::OneAtATime), None) => one_at_a_time(design),
        (None, None) => {
            let names = design.configurations.iter().map(|own| own.name.clone());
            names.zip(&named).map(|(name, choice)| unnumbered(design, name, vec![Some(choice)])).collect()
        }
    };
    let configurations = points.into_iter().enumerate().map(|(at, point)| configuration(design, at, point));
    let mut all = configurations.collect::<Result<Vec<_>, _>>()?;
    check_simulations(design, &all)?;
    if design.draws.is_none() {
        number_stages(&mut all);
    }
    Ok(all)
}

/// Configurations that are drawn.
fn drawn_points(design: &Design, draws: DrawCounts) -> Vec<Point<'_>> {
    let point = |(at, drawn): (usize, Drawn)| Point {
        name: (at + 1).to_string(),
        shared_stages: drawn.shared_stages,
        seed: design.seed + drawn.shared_stages.movement as u64,
        choices: chosen(design, &drawn.options),
    };
    drawn(design, draws).into_iter().enumerate().map(point).collect()
}

/// All combinations of options.
fn grid(design: &Design) -> Vec<Point<'_>> {
    let point = |options: Vec<usize>| {
        let options: Vec<Option<usize>> = options.into_iter().map(Some).collect();
        let choices = chosen(design, &options);
        let labels: Vec<&str> = choices.iter().flatten().map(|choice| choice.label.as_str()).collect();
        unnumbered(design, labels.join("; "), choices)
    };
    combinations(design).into_iter().map(point).collect()
}

/// The base, and each option alone.
fn one_at_a_time(design: &Design) -> Vec<Point<'_>> {
    let nothing = vec![None; design.factors.len()];
    let mut points = vec![unnumbered(design, BASE.to_owned(), nothing.clone())];
    for (at, factor) in design.factors.iter().enumerate() {
        for choice in &factor.options {
            let mut choices = nothing.clone();
            choices[at] = Some(choice);
            points.push(unnumbered(design, format!("{}: {}", factor.name, choice.label), choices));
        }
    }
    points
}

/// A point that is not drawn, with the seed of the design.
fn unnumbered<'a>(design: &Design, name: String, choices: Vec<Option<&'a Choice>>) -> Point<'a> {
    Point { name, shared_stages: UNNUMBERED, seed: design.seed, choices }
}

/// Of configurations that are not drawn, before the plan numbers what they share.
const UNNUMBERED: SharedStages = SharedStages { movement: 1, distances: 1, maps: 1 };

/// The options of a drawn configuration or of one of a grid.
fn chosen<'a>(design: &'a Design, options: &[Option<usize>]) -> Vec<Option<&'a Choice>> {
    let choice =
        |(factor, option): (&'a Factor, &Option<usize>)| option.map(|option| &factor.options[option]);
    design.factors.iter().zip(options).map(choice).collect()
}

/// All combinations of options, the last factor's first to change.
fn combinations(design: &Design) -> Vec<Vec<usize>> {
    let extend = |all: Vec<Vec<usize>>, factor: &Factor| {
        let each = |one: &Vec<usize>| {
            (0..factor.options.len()).map(|option| [&one[..], &[option]].concat()).collect::<Vec<_>>()
        };
        all.iter().flat_map(each).collect()
    };
    design.factors.iter().fold(vec![Vec::new()], extend)
}

fn configuration(design: &Design, at: usize, point: Point) -> Result<Configuration, ExperimentError> {
    let Point { name, shared_stages, seed, choices } = point;
    let (mut changes, mut gains) = (Table::new(), None);
    for choice in choices.iter().flatten() {
        merge(&mut changes, &choice.settings);
        gains = choice.gains.or(gains);
    }
    let overlaid = |changes: &Table| settings_of(design, &name, [&design.settings, changes]);
    let mut settings = overlaid(&changes)?;
    if let Some(gains) = gains {
        merge(&mut changes, &gains.settings(&settings));
        settings = overlaid(&changes)?;
    }
    settings.experiment.seed = seed;
    // Named ones have no factors.
    let of_factors = choices.iter().take(design.factors.len());
    let labels =
        of_factors.map(|choice| choice.map_or(String::new(), |choice| choice.label.clone())).collect();
    Ok(Configuration { number: at + 1, name, shared_stages, labels, changes, settings })
}

/// Tables of settings over the defaults.
fn settings_of<'a>(
    design: &Design,
    name: &str,
    tables: impl IntoIterator<Item = &'a Table> + Clone,
) -> Result<Settings, ExperimentError> {
    let origin = described(design, name);
    let has_seed =
        |table: &&Table| table.get("experiment").is_some_and(|section| section.get("seed").is_some());
    if tables.clone().into_iter().any(|table| has_seed(&table)) {
        let message = "sets `experiment.seed`; use the key `seed` of the design, or --seed";
        return Err(ExperimentError::design(&origin, message));
    }
    Settings::overlaid(tables, &origin).map_err(|error| {
        let message = error.to_string();
        let bare = message.strip_prefix(&format!("{origin}: ")).unwrap_or(&message);
        ExperimentError::design(&origin, bare)
    })
}

/// A configuration, for messages.
fn described(design: &Design, name: &str) -> String {
    format!("{}: configuration `{name}`", design.origin)
}

/// Numbers of movements, distances and maps, by what they depend on: equal ones have one number.
fn number_stages(all: &mut [Configuration]) {
    let mut known: [HashMap<String, usize>; 3] = Default::default();
    for one in all {
        let keys = Keys::of(&one.settings, 1, &one.settings.experiment.dimensions);
        let mut number = |stage: usize, key: String| {
            let next = known[stage].len() + 1;
            *known[stage].entry(key).or_insert(next)
        };
        one.shared_stages = SharedStages {
            movement: number(0, keys.movement),
            distances: number(1, keys.distances),
            maps: number(2, keys.maps),
        };
    }
}

/// That all configurations, of which there is one at least, have the same number of simulations, and drawn ones at least two.
fn check_simulations(design: &Design, all: &[Configuration]) -> Result<(), ExperimentError> {
    let wrong = |one: &Configuration, message: &str| {
        Err(ExperimentError::design(&described(design, &one.name), message))
    };
    if design.draws.is_some()
        && let Some(one) = all.iter().find(|one| one.settings.experiment.simulations < 2)
    {
        return wrong(
            one,
            "has one simulation; simulations differ, so use at least two (experiment.simulations)",
        );
    }
    let simulations = all[0].settings.experiment.simulations;
    match all.iter().find(|one| one.settings.experiment.simulations != simulations) {
        None => Ok(()),
        Some(other) => {
            wrong(other, "has another number of simulations than the first; give all of them the same")
        }
    }
}

impl Selection {
    /// The configurations that it names, numbered as in the whole design. Unless configurations are drawn, the first comes too: changes are
    /// measured from it.
    ///
    /// # Errors
    /// If it names none.
    pub(crate) fn select(
        &self,
        design: &Design,
        all: Vec<Configuration>,
    ) -> Result<Vec<Configuration>, ExperimentError> {
        let Self(wanted) = self;
        let range = wanted.strip_prefix("movements-").and_then(|range| range.split_once('-'));
        let range: Option<RangeInclusive<usize>> =
            range.and_then(|(first, last)| Some(first.parse().ok()?..=last.parse().ok()?));
        let range = range.filter(|_| design.draws.is_some());
        let factor = design.factors.iter().position(|factor| factor.name == *wanted);
        let factor = factor.filter(|_| design.vary == Some(Vary::OneAtATime));
        let named = |one: &Configuration| {
            one.number.to_string() == *wanted
                || range.as_ref().is_some_and(|range| range.contains(&one.shared_stages.movement))
                || one.name == *wanted
                || factor.is_some_and(|at| !one.labels[at].is_empty())
        };
        if !all.iter().any(named) {
            let factors: Vec<&str> = match design.vary {
                Some(Vary::OneAtATime) => design.factors.iter().map(|factor| factor.name.as_str()).collect(),
                _ => Vec::new(),
            };
            let or = if design.draws.is_some() {
                ", or a range of drawn movements, such as movements-1-8".to_owned()
            } else if factors.is_empty() {
                String::new()
            } else {
                format!(", or a factor: {}", factors.join(", "))
            };
            let message = format!(
                "there is no configuration `{wanted}`; give a number from 1 to {}, a name{or}",
                all.len()
            );
            return Err(ExperimentError::design("--only", message));
        }
        let base = design.draws.is_none();
        Ok(all.into_iter().filter(|one| named(one) || (base && one.number == 1)).collect())
    }
}

impl Configuration {
    /// What it has instead of the base's values, in a line.
    pub(crate) fn in_a_line(&self) -> String {
        flat(&self.changes).join(", ")
    }
}
