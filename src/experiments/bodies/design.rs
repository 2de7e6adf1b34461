//! Read the design of the study of bodies: which bodies, how they move, and how much is recorded.

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
pub struct Design {
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
    /// What is recorded of each movement.
    #[serde(rename = "recording")]
    pub recordings: Vec<Recording>,
    /// What is not as in `reproduce/paper.toml`.
    #[serde(default)]
    pub settings: Table,
}

/// The beginning of a movement, as noisy sensors record it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Recording {
    /// T.
    pub samples: usize,
    /// Standard deviation of the noise that is added to each pressure, over the root mean square of its sensor.
    pub noise: f64,
}

/// A body of the study.
pub struct StudyBody {
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
    pub fn parse(text: &str, path: &Path) -> Result<Self, ExperimentError> {
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
    pub fn read_bodies(&self, path: &Path) -> Result<Vec<StudyBody>, ExperimentError> {
        let folder = path.parent().unwrap_or(Path::new(""));
        let read = |file: &PathBuf| {
            let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let path = folder.join(file);
            Ok(StudyBody { name, sha256: sha256(&path)?, body: read_body(&path)? })
        };
        self.bodies.iter().map(read).collect()
    }

    /// The settings of the movements at p, as long as the longest recording.
    ///
    /// # Errors
    /// If they cannot be used.
    pub fn settings_at(&self, coordination: f64) -> Result<Settings, ExperimentError> {
        let mut settings = Settings::overlaid([&self.settings], "the design")?;
        let samples = self.recordings.iter().map(|one| one.samples).max().unwrap_or(0);
        settings.physics.duration = samples as f64 * settings.sense.interval;
        settings.motion.coordination = coordination;
        settings.experiment.seed = self.seed;
        settings.schema.chains = self.chains;
        settings.validate()?;
        Ok(settings)
    }
}
