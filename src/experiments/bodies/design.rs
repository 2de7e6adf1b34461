//! Read the design of the study of bodies: which bodies, how they move, and how much is recorded.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use toml::Table;

use crate::files::body::{NamedBody, read_body};
use crate::files::sha256;
use crate::settings::Settings;
use crate::tasks::error::ExperimentError;

/// What is simulated, and what is recorded of it.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Design {
    /// Master seed.
    pub seed: u64,
    /// Movements of each body at each p.
    pub movements: usize,
    /// p of the movements.
    pub coordinations: Vec<f64>,
    /// Chains of each mixture that is compared with.
    pub chains: usize,
    /// Files of the bodies, from the folder of the design.
    pub bodies: Vec<PathBuf>,
    /// Kinds of movement; none if there is one, that of the settings.
    #[serde(rename = "movement", default, skip_serializing_if = "Vec::is_empty")]
    pub kinds: Vec<Kind>,
    /// What is recorded of each movement.
    #[serde(rename = "recording")]
    pub recordings: Vec<Recording>,
    /// What is not as in `reproduce/paper.toml`.
    #[serde(default)]
    pub settings: Table,
}

/// A kind of movement, such as a rhythmic one.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Kind {
    /// Its name in tables.
    pub name: String,
    /// What is not as in the settings of the design.
    #[serde(default)]
    pub settings: Table,
}

/// The beginning of a movement, as noisy sensors record it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Recording {
    /// T.
    pub samples: usize,
    /// Standard deviation of the noise that is added to each pressure, over the root mean square of its sensor.
    pub noise: f64,
}

/// How a body moves.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Way<'a> {
    /// The kind of movement; `None` if there is one.
    pub kind: Option<&'a Kind>,
    /// p.
    pub coordination: f64,
}

impl Way<'_> {
    /// The name of the kind.
    pub(crate) fn name(&self) -> Option<&str> {
        self.kind.map(|kind| kind.name.as_str())
    }

    /// In words, such as `p = 0.5` or `rhythmic, p = 0.5`.
    pub(crate) fn words(&self) -> String {
        let kind = self.name().map_or(String::new(), |name| format!("{name}, "));
        format!("{kind}p = {}", self.coordination)
    }
}

/// A body of the study.
pub(crate) struct StudyBody {
    /// The name of its file.
    pub name: String,
    /// The hash of this file.
    pub sha256: String,
    /// The body.
    pub body: NamedBody,
}

impl Design {
    /// Reads a design; `path` is where it is.
    ///
    /// # Errors
    /// If it is no design.
    pub(crate) fn parse(text: &str, path: &Path) -> Result<Self, ExperimentError> {
        let wrong = |message: String| ExperimentError::design(&path.display().to_string(), message);
        let design: Self = toml::from_str(text).map_err(|error| wrong(error.to_string()))?;
        let Self { movements, coordinations, chains, bodies, recordings, .. } = &design;
        if *movements == 0 || *chains == 0 {
            return Err(wrong("movements and chains must be at least 1".to_owned()));
        }
        if coordinations.is_empty() || bodies.is_empty() || recordings.is_empty() {
            return Err(wrong("coordinations, bodies and [[recording]] must not be empty".to_owned()));
        }
        if recordings.iter().any(|one| one.samples < 100 || !(0.0..=10.0).contains(&one.noise)) {
            return Err(wrong(
                "a [[recording]] must have samples of at least 100, and noise from 0 to 10".to_owned(),
            ));
        }
        let plain = |name: &str| name.bytes().all(|letter| letter.is_ascii_alphanumeric() || letter == b'-');
        let kinds: BTreeSet<&str> = design.kinds.iter().map(|kind| kind.name.as_str()).collect();
        if kinds.len() < design.kinds.len() || kinds.iter().any(|name| name.is_empty() || !plain(name)) {
            let rule = "each [[movement]] must have a name of its own, of letters, digits and hyphens";
            return Err(wrong(rule.to_owned()));
        }
        let mut names: Vec<_> = bodies.iter().map(|file| file.file_stem()).collect();
        names.sort_unstable();
        if let Some(pair) = names.windows(2).find(|pair| pair[0] == pair[1]) {
            let name = pair[0].unwrap_or_default().to_string_lossy();
            return Err(wrong(format!("two body files are named {name}; give each a name of its own")));
        }
        Ok(design)
    }

    /// The bodies.
    ///
    /// # Errors
    /// If one cannot be read.
    pub(crate) fn read_bodies(&self, path: &Path) -> Result<Vec<StudyBody>, ExperimentError> {
        let folder = path.parent().unwrap_or(Path::new(""));
        let read = |file: &PathBuf| {
            let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let path = folder.join(file);
            Ok(StudyBody { name, sha256: sha256(&path)?, body: read_body(&path)? })
        };
        self.bodies.iter().map(read).collect()
    }

    /// How bodies move, one way after the other: each kind at each p.
    pub(crate) fn ways(&self) -> Vec<Way<'_>> {
        let kinds: Vec<Option<&Kind>> =
            if self.kinds.is_empty() { vec![None] } else { self.kinds.iter().map(Some).collect() };
        let at_each = |kind| self.coordinations.iter().map(move |&coordination| Way { kind, coordination });
        kinds.into_iter().flat_map(at_each).collect()
    }

    /// The settings of movements of some way, as long as the longest recording.
    ///
    /// # Errors
    /// If they cannot be used.
    pub(crate) fn settings_of(&self, Way { kind, coordination }: Way) -> Result<Settings, ExperimentError> {
        let own = kind.map(|kind| &kind.settings);
        let mut settings = Settings::overlaid([&self.settings].into_iter().chain(own), "the design")?;
        let samples = self.recordings.iter().map(|one| one.samples).max().unwrap_or(0);
        settings.physics.duration = samples as f64 * settings.sense.interval;
        settings.motion.coordination = coordination;
        settings.experiment.seed = self.seed;
        settings.schema.chains = self.chains;
        settings.validate()?;
        Ok(settings)
    }
}
