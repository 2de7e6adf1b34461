//! Read the design of a study: the open settings, their values, and how each configuration is run.

use std::collections::HashSet;

use serde::Deserialize;
use serde_json::Value;
use toml::Table;

use super::super::design::flat;
use super::super::error::ExperimentError;
use crate::settings::{PAPER, Settings};

/// What is varied, and how each configuration is run.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Design {
    /// Master seed of all simulations.
    pub seed: u64,
    /// What every configuration has instead of `reproduce/paper.toml`'s values: how much is simulated and drawn.
    settings: Table,
    /// The open settings.
    #[serde(rename = "part")]
    pub factors: Vec<Factor>,
}

/// An open setting, or several that belong together, and the values that are tried.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Factor {
    /// Short name, for `--only` and for the file of its picture.
    pub name: String,
    /// What it is.
    pub title: String,
    /// What the paper says, and where.
    pub paper: String,
    /// The settings, `section.key`.
    pub settings: Vec<String>,
    /// Why the default is what it is.
    pub why: String,
    /// What is tried instead.
    pub values: Vec<Table>,
}

/// What stands for the default in place of a factor.
pub const DEFAULT: &str = "default";

impl Design {
    /// Reads a design; `origin` says where it is from.
    ///
    /// # Errors
    /// If it is no design, or two factors share a name.
    pub fn parse(text: &str, origin: &str) -> Result<Self, ExperimentError> {
        let wrong = |message: String| ExperimentError::design(origin, message);
        let design: Self = toml::from_str(text).map_err(|error| wrong(error.to_string()))?;
        let paper = design.defaults()?;
        let mut names = HashSet::from([DEFAULT]);
        for factor in &design.factors {
            if !is_plain(&factor.name) || !names.insert(&factor.name) {
                let rule = "cannot name a [[part]]: use letters, digits and -, and each name once";
                return Err(wrong(format!("`{}` {rule}", factor.name)));
            }
            factor.check(&paper).map_err(wrong)?;
        }
        Ok(design)
    }

    /// The same with one factor alone.
    ///
    /// # Errors
    /// If there is no such factor.
    pub fn only(self, name: &str, origin: &str) -> Result<Self, ExperimentError> {
        let names: Vec<&str> = self.factors.iter().map(|factor| factor.name.as_str()).collect();
        if !names.contains(&name) {
            let message = format!("has no [[part]] named `{name}`; it has {}", names.join(", "));
            return Err(ExperimentError::design(origin, message));
        }
        Ok(Self { factors: self.factors.into_iter().filter(|factor| factor.name == name).collect(), ..self })
    }

    fn configure(&self, name: &str, value: &Table) -> Result<Settings, ExperimentError> {
        let origin = format!("the study's {name}");
        let mut settings = Settings::overlaid([&self.settings, value], &origin)?;
        settings.experiment.seed = self.seed;
        Ok(settings)
    }

    /// The settings of the default as the study runs it.
    ///
    /// # Errors
    /// If the design's settings cannot be used.
    pub fn defaults(&self) -> Result<Settings, ExperimentError> {
        self.configure(DEFAULT, &Table::new())
    }

    /// The factor and the value of each configuration, the default's first, and its settings.
    ///
    /// # Errors
    /// If the settings of one cannot be used.
    pub fn configurations(&self) -> Result<Vec<([String; 2], Settings)>, ExperimentError> {
        let mut all = vec![([DEFAULT.to_owned(), String::new()], self.defaults()?)];
        for factor in &self.factors {
            for value in &factor.values {
                let place = [factor.name.clone(), label(value)];
                let settings = self.configure(&place.join(": "), value)?;
                all.push((place, settings));
            }
        }
        Ok(all)
    }

    /// How each configuration is run, in words.
    pub fn summary(&self) -> String {
        format!("{}, seed {}", flat(&self.settings).join(", "), self.seed)
    }
}

/// What a table calls a value: its settings without their sections.
pub fn label(value: &Table) -> String {
    let short = |line: String| line.split_once('.').map_or(line.clone(), |(_, short)| short.to_owned());
    flat(value).into_iter().map(short).collect::<Vec<_>>().join(", ")
}

/// The default of a setting `section.key`, as settings files write it.
pub fn default_value(settings: &Settings, key: &str) -> Option<String> {
    let own = serde_json::to_value(settings).expect("settings are plain data");
    // Settings of a random movement lack the rhythm.
    let paper: Table = PAPER.parse().expect("reproduce/paper.toml is TOML");
    let paper = serde_json::to_value(paper).expect("settings are plain data");
    let within = |all| key.split('.').try_fold(all, |table: &Value, name| table.get(name));
    Some(within(&own).or_else(|| within(&paper))?.to_string().replace('"', ""))
}

impl Factor {
    /// Whether its settings exist and its values differ.
    fn check(&self, paper: &Settings) -> Result<(), String> {
        let mut values = HashSet::new();
        if !self.values.iter().all(|value| values.insert(label(value))) {
            return Err(format!("[[part]] `{}` has a value twice", self.name));
        }
        match self.settings.iter().find(|key| default_value(paper, key).is_none()) {
            Some(key) => Err(format!("[[part]] `{}` names `{key}`, which is not a setting", self.name)),
            None => Ok(()),
        }
    }
}

/// Whether a name can be that of a file.
fn is_plain(name: &str) -> bool {
    !name.is_empty() && name.bytes().all(|letter| letter.is_ascii_alphanumeric() || letter == b'-')
}

#[cfg(test)]
mod tests {
    use super::super::super::design::SENSITIVITY;
    use super::*;

    #[test]
    fn the_design_of_the_repository_can_be_run() {
        let study = Design::parse(SENSITIVITY, "sensitivity.toml").unwrap();
        assert!(study.configurations().unwrap().len() > 60);
    }

    #[test]
    fn a_study_may_vary_the_rhythm_that_the_default_lacks() {
        let default = |key| default_value(&Settings::paper(), key);
        assert_eq!(default("motion.movement"), Some("random".to_owned()));
        assert_eq!(default("motion.rhythm.frequency"), Some("0.2".to_owned()));
        assert_eq!(default("motion.rhythm.speed"), None);
    }

    #[test]
    fn every_setting_that_is_marked_as_ours_is_in_the_study() {
        let study = Design::parse(SENSITIVITY, "sensitivity.toml").unwrap();
        let named: Vec<&String> = study.factors.iter().flat_map(|factor| &factor.settings).collect();
        // How much is run, what only says how a run is judged stable, and what studies of their own are about.
        let spared = [
            "schema.burn_in",
            "baselines.restarts",
            "experiment.simulations",
            "experiment.seed",
            "physics.turn_limit",
            "physics.angular_momentum",
            "physics.fluid_density",
            "sense.threshold",
        ];
        let mut section = "";
        for line in PAPER.lines() {
            if let Some(name) = line.strip_prefix('[') {
                section = name.trim_end_matches(']');
            } else if let Some((name, rest)) = line.split_once(" = ")
                && rest.contains("# ours")
            {
                let key = format!("{section}.{name}");
                let spared = spared.contains(&key.as_str()) || section == "schema.authors";
                assert!(named.contains(&&key) || spared, "{key}");
            }
        }
    }
}
