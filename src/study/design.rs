//! Read the design of a study: a base, the configurations around it, the claims that judge them, and a seed.

mod check;

use std::ops::RangeInclusive;

use serde::Deserialize;
use toml::Table;

use super::choices::{Gains, flat, short};
use super::extends::{BUNDLED, DesignText};
use super::levels::{DrawCounts, Level};
use crate::analysis::published::{Claim, Experiment, Measure};
use crate::settings::{Settings, toml_message};
use crate::tasks::error::ExperimentError;

/// The name of the base among configurations that vary one factor at a time.
pub(super) const BASE: &str = "default";

/// Columns of configurations.csv beside those of the factors.
pub(super) const COLUMNS: [&str; 11] = [
    "configuration",
    "name",
    "movement",
    "distances",
    "maps",
    "resolved",
    "anchor_separation_m",
    "turn",
    "failed",
    "failure",
    "settings",
];

/// A study: what is run, and how it is judged.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Design {
    /// Where it was read, for messages.
    #[serde(skip)]
    pub origin: String,
    /// Title of the page.
    pub title: String,
    /// What the study is for: a paragraph of the page.
    #[serde(default)]
    pub about: String,
    /// Master seed of all simulations. Those of the m-th drawn movement have the seed plus m.
    pub seed: u64,
    /// How the factors make configurations, unless they are drawn.
    #[serde(default)]
    pub vary: Option<Vary>,
    /// How many configurations are drawn from the factors.
    #[serde(default)]
    pub draws: Option<DrawCounts>,
    /// Sections of the page, in their order; without any, those that fit the configurations.
    #[serde(default)]
    pub sections: Vec<Section>,
    /// Names of factors whose options make groups of configurations, whose shares are also shown alone.
    #[serde(default)]
    pub groups: Vec<String>,
    /// What every configuration has instead of the values of `reproduce/paper.toml`.
    #[serde(default)]
    pub settings: Table,
    /// Open settings that no factor varies and values that are no options, with reasons.
    #[serde(default)]
    pub left_out: Vec<LeftOut>,
    /// The claims; without any, those of `reproduce/scored.toml`.
    #[serde(rename = "claim", default)]
    pub claims: Vec<JudgedClaim>,
    /// Named configurations; changes are from the first.
    #[serde(rename = "configuration", default)]
    pub configurations: Vec<NamedConfiguration>,
    /// Open settings, and the values that are tried.
    #[serde(rename = "factor", default)]
    pub factors: Vec<Factor>,
}

/// How factors make configurations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Vary {
    /// The base, and one option of one factor at a time.
    OneAtATime,
    /// All combinations of all options.
    Grid,
}

/// A section of the page.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Section {
    /// Each claim's value by each configuration.
    Values,
    /// How far that is from the first configuration's, paired by simulation.
    Changes,
    /// For each factor, what its options do to parts and tree; for one factor at a time.
    Factors,
    /// In what share of the configurations each claim holds.
    Shares,
    /// The share of a claim's variance that each factor decides.
    Variance,
    /// All values of a claim by size, and the options below.
    Curves,
    /// The configurations by their score.
    Ranking,
    /// Which claims hold together.
    TradeOffs,
}

/// A claim that configurations are judged by.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct JudgedClaim {
    /// Its short name in `reproduce/published.toml`.
    pub id: String,
    /// The experiment that it is judged by.
    pub experiment: Experiment,
    /// What stands above its column, in two lines at most.
    pub label: String,
    /// Its share of the score, before division by the sum of all.
    #[serde(default)]
    pub weight: Option<f64>,
    /// Distance from the accepted range at which no credit is left; credit falls linearly up to there.
    #[serde(default)]
    pub slack: Option<f64>,
}

/// A named configuration.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct NamedConfiguration {
    /// Its name in tables and pictures.
    pub name: String,
    /// What it has instead of the base's values.
    #[serde(default)]
    pub settings: Table,
}

/// An open setting, or several that belong together.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Factor {
    /// Name in tables, pictures and their files.
    pub name: String,
    /// What it is, as a heading; its name if it is empty.
    #[serde(default)]
    pub title: String,
    /// What it decides; for drawn configurations.
    #[serde(default)]
    pub level: Option<Level>,
    /// What the paper says of it, and where.
    pub paper: String,
    /// The settings that it varies, `section.key`; for one factor at a time.
    #[serde(default)]
    pub settings: Vec<String>,
    /// Why the base has the value that it has; for one factor at a time.
    #[serde(default)]
    pub why: String,
    /// The values.
    #[serde(rename = "option")]
    pub options: Vec<Choice>,
}

/// A value of an open setting.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Choice {
    /// Name in tables and pictures; its settings in a line if it is empty.
    #[serde(default)]
    pub label: String,
    /// Why it is reasonable: a source or a reason.
    #[serde(default)]
    pub why: String,
    /// The settings.
    #[serde(default)]
    pub settings: Table,
    /// Gains that go with the body.
    #[serde(default)]
    pub gains: Option<Gains>,
    /// How many shares of the draws it has; 1 without a number.
    #[serde(default)]
    pub weight: Option<usize>,
}

/// Open settings that no factor varies, or values that are no options.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct LeftOut {
    /// `section.key`, `section` for all of a section, or `section.key = value`.
    pub what: Vec<String>,
    /// Why.
    #[cfg_attr(not(test), expect(dead_code, reason = "whoever reads the design reads it"))]
    pub why: String,
}

impl Choice {
    /// The settings that it decides, `section.key`.
    pub(crate) fn keys(&self) -> Vec<String> {
        let motion = ["controller", "stiffness", "damping"].map(|name| format!("motion.{name}"));
        let of_gains = motion.into_iter().filter(|_| self.gains.is_some());
        let name = |line: String| line.split(" = ").next().unwrap_or_default().to_owned();
        flat(&self.settings).into_iter().map(name).chain(of_gains).collect()
    }
}

impl Design {
    /// Reads a design.
    ///
    /// # Errors
    /// If it is not a design, or names what is not there. The message names the file, the key, and what is allowed.
    pub(crate) fn parse(source: &DesignText) -> Result<Self, ExperimentError> {
        let wrong = |message: String| ExperimentError::design(&source.origin, message);
        let mut design: Self =
            toml::from_str(&source.text).map_err(|error| wrong(toml_message(&source.text, &error)))?;
        design.origin.clone_from(&source.origin);
        if design.claims.is_empty() {
            design.claims = scored();
        }
        for option in design.factors.iter_mut().flat_map(|factor| &mut factor.options) {
            if option.label.is_empty() {
                let gains = option.gains.map(|gains| gains.in_words());
                option.label = Some(short(&option.settings))
                    .filter(|words| !words.is_empty())
                    .or(gains)
                    .unwrap_or_default();
            }
        }
        if design.sections.is_empty() {
            design.sections = design.usual_sections();
        }
        design.check().map_err(wrong)?;
        Ok(design)
    }

    /// What the page shows if the design does not say.
    fn usual_sections(&self) -> Vec<Section> {
        match (self.vary, self.draws) {
            (Some(Vary::OneAtATime), _) => vec![Section::Factors],
            (None, None) => vec![Section::Values, Section::Changes],
            _ => vec![Section::Shares, Section::Variance, Section::Curves],
        }
    }

    /// The seeds of all its movements.
    pub(crate) fn seeds(&self) -> RangeInclusive<u64> {
        match self.draws {
            Some(draws) => self.seed + 1..=self.seed + draws.movements as u64,
            None => self.seed..=self.seed,
        }
    }

    /// Whether the page has a section.
    pub(crate) fn has(&self, section: Section) -> bool {
        self.sections.contains(&section)
    }
}

/// The claims of `reproduce/scored.toml`, with their weights in the score.
fn scored() -> Vec<JudgedClaim> {
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Scored {
        #[serde(rename = "claim")]
        claims: Vec<JudgedClaim>,
    }
    let (_, text) = BUNDLED.iter().find(|(name, _)| *name == "scored").expect("it is bundled");
    let Scored { claims } = toml::from_str(text).expect("reproduce/scored.toml has claims; a test checks it");
    claims
}

impl JudgedClaim {
    /// The claim.
    pub(crate) fn find<'a>(&self, claims: &'a [Claim]) -> Option<&'a Claim> {
        let same = |claim: &&Claim| claim.id == self.id && claim.experiments.contains(&self.experiment);
        claims.iter().find(same).filter(|claim| claim.accept.is_some() && is_of_samples(&claim.measure))
    }

    /// Its label in one line.
    pub(crate) fn name(&self) -> String {
        self.label.replace('\n', " ")
    }
}

/// Whether it is a value of samples alone, and no test of them.
fn is_of_samples(measure: &Measure) -> bool {
    !matches!(
        measure,
        Measure::BaselineShare { .. }
            | Measure::BaselineLoss { .. }
            | Measure::TreeDependence {}
            | Measure::Nothing { .. }
    )
}

impl Factor {
    /// Names of its options.
    pub(crate) fn labels(&self) -> impl Iterator<Item = &str> {
        self.options.iter().map(|option| option.label.as_str())
    }

    /// The option at a place of [0, 1), of which each option has a part by its weight.
    pub(crate) fn at(&self, place: f64) -> usize {
        let weights = || self.options.iter().map(|option| option.weight.unwrap_or(1));
        let slot = (place * weights().sum::<usize>() as f64) as usize;
        let mut ends = weights().scan(0, |end, weight| {
            *end += weight;
            Some(*end)
        });
        ends.position(|end| slot < end).unwrap_or(self.options.len() - 1)
    }

    /// The option that changes nothing of the base.
    pub(crate) fn of_base(&self, design: &Design) -> Option<usize> {
        let overlaid = |tables: &[&Table]| Settings::overlaid(tables.iter().copied(), "").ok();
        let base = overlaid(&[&design.settings]);
        let is_base = |option: &Choice| {
            option.gains.is_none() && overlaid(&[&design.settings, &option.settings]) == base
        };
        self.options.iter().position(is_base).filter(|_| base.is_some())
    }

    /// What it is, as a heading.
    pub(crate) fn heading(&self) -> &str {
        if self.title.is_empty() { &self.name } else { &self.title }
    }
}

#[cfg(test)]
mod tests;
