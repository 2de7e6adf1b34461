//! Read the design of a comparison: the configurations, and the claims that they are compared by.

use std::collections::HashSet;

use serde::Deserialize;
use toml::Table;

use super::super::compared::Compared;
use super::super::design::ABLATION;
use super::super::error::ExperimentError;
use crate::analysis::published::claims;
use crate::settings::Settings;

/// What is compared, and how each configuration is run.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Design {
    /// Title of the page.
    pub title: String,
    /// What the comparison is for: a paragraph of the page.
    pub about: String,
    /// Master seed of all simulations.
    pub seed: u64,
    /// What every configuration has instead of `reproduce/paper.toml`'s values: how much is simulated and drawn.
    pub settings: Table,
    /// The claims; without any, those of `reproduce/ablation.toml`.
    #[serde(rename = "claim", default)]
    pub claims: Vec<Compared>,
    /// The configurations; all others are compared with the first.
    #[serde(rename = "configuration")]
    pub configurations: Vec<Configuration>,
}

/// A configuration.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Configuration {
    /// Its name in tables and pictures.
    pub name: String,
    /// What it has instead of the first one's values.
    pub settings: Table,
}

impl Design {
    /// Reads a design; `origin` says where it is from.
    ///
    /// # Errors
    /// If it is no design, names a claim that is not there, or gives two configurations one name.
    pub fn parse(text: &str, origin: &str) -> Result<Self, ExperimentError> {
        let wrong = |message: String| ExperimentError::design(origin, message);
        let read = |text: &str| toml::from_str::<Self>(text).map_err(|error| wrong(error.to_string()));
        let mut design = read(text)?;
        if design.claims.is_empty() {
            design.claims = read(ABLATION)?.claims;
        }
        if design.configurations.len() < 2 {
            return Err(wrong("needs at least two [[configuration]]".to_owned()));
        }
        let mut names = HashSet::new();
        if let Some(twice) = design.configurations.iter().find(|one| !names.insert(&one.name)) {
            return Err(wrong(format!(
                "has two configurations `{}`; give each a name of its own",
                twice.name
            )));
        }
        Compared::check(&design.claims, &claims()).map_err(wrong)?;
        Ok(design)
    }

    /// The settings of every configuration.
    ///
    /// # Errors
    /// If those of one cannot be used.
    pub fn all_settings(&self) -> Result<Vec<Settings>, ExperimentError> {
        let base = &self.configurations[0].settings;
        let of = |configuration: &Configuration| {
            let origin = format!("the configuration {}", configuration.name);
            let mut settings = Settings::overlaid([&self.settings, base, &configuration.settings], &origin)?;
            settings.experiment.seed = self.seed;
            Ok(settings)
        };
        let all: Vec<Settings> =
            self.configurations.iter().map(of).collect::<Result<_, ExperimentError>>()?;
        let simulations = all[0].experiment.simulations;
        match self.configurations.iter().zip(&all).find(|(_, one)| one.experiment.simulations != simulations)
        {
            None => Ok(all),
            Some((other, _)) => {
                let message = "has another number of simulations than the first; give all of them the same";
                Err(ExperimentError::design(&format!("the configuration {}", other.name), message))
            }
        }
    }
}
