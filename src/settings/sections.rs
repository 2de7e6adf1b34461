//! Compose the settings of all stages, and check what spans several of them.

use serde::{Deserialize, Serialize};

use super::error::SettingsError;
use super::experiment::{ExperimentSettings, rising};
use crate::numerics::range::{Checked, check};
use crate::stages::agent::{Geometry, Skin};
use crate::stages::baselines::Baselines;
use crate::stages::body_map::Map;
use crate::stages::distance::MAX_SENSORS;
use crate::stages::evaluate::Evaluate;
use crate::stages::quantise::Quantise;
use crate::stages::schema::{Schema, matrices_fit};
use crate::stages::sense::Sense;
use crate::stages::simulate::{Motion, Physics};

/// Most samples of a movement, of which 13 GB are poses.
pub(crate) const MAX_SAMPLES: f64 = 2e7;
/// Most pressures of a movement, which are 8 GB.
pub(crate) const MAX_PRESSURES: f64 = 2e9;

/// All settings of a run. Field by field the twin of `reproduce/paper.toml`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// The body (section 5.1, figure 4).
    pub agent: Geometry,
    /// The sensors on it.
    pub skin: Skin,
    /// Coordinated random movement (section 5.1).
    pub motion: Motion,
    /// The physics engine.
    pub physics: Physics,
    /// The tactile sense (equation 27).
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
    pub experiment: ExperimentSettings,
}

impl Settings {
    /// Checks every range that needs no data. So a run asks the physics engine for nothing that it would abort on, fits the
    /// memory of a large computer, and ends in a reasonable time.
    ///
    /// # Errors
    /// [`SettingsError::OutOfRange`] for the first value that cannot be used.
    pub fn validate(&self) -> Result<(), SettingsError> {
        self.agent.check()?;
        self.skin.check()?;
        self.check_sensors()?;
        self.motion.check()?;
        self.physics.check()?;
        self.sense.check()?;
        self.check_times(self.sensors())?;
        self.quantise.check()?;
        self.map.check()?;
        self.schema.check(self.sensors())?;
        self.evaluate.check()?;
        self.experiment.check()?;
        self.check_matrices()?;
        self.baselines.check()?;
        self.check_clusters()?;
        Ok(self.check_posterior_samples()?)
    }

    /// M, the number of sensors on the body.
    pub fn sensors(&self) -> usize {
        self.agent.parts().saturating_mul(self.skin.sensors_per_part())
    }

    /// Checks that the distances between all sensors fit the memory.
    fn check_sensors(&self) -> Checked {
        let each = self.skin.sensors_per_part();
        check(
            "skin.around * skin.along + skin.caps",
            each,
            each <= MAX_SENSORS / self.agent.parts(),
            "at most 4000, which makes 20000 sensors in all",
        )
    }

    /// Checks that samples are whole steps apart, and not too many to keep or to wait for: a billion steps take hours. Checks that a step is short enough for a rhythm.
    ///
    /// # Errors
    /// The first setting that is outside its range for a body with so many sensors.
    pub fn check_times(&self, sensors: usize) -> Checked {
        let (interval, step, duration) = (self.sense.interval, self.physics.step, self.physics.duration);
        let ratio = interval / step;
        let whole = ratio >= 0.5 && (ratio - ratio.round()).abs() < 1e-6 * ratio;
        check("sense.interval", interval, whole, "a whole number of physics.step")?;
        if let Some(rhythm) = self.motion.rhythm() {
            let range = "at most 0.05 / physics.step, which makes a cycle at least 20 steps";
            check("motion.rhythm.frequency", rhythm.frequency, rhythm.frequency * step <= 0.05, range)?;
        }
        let (samples, steps) = (duration / interval, duration / step);
        check(
            "physics.duration",
            duration,
            (1.0 - 1e-9..=MAX_SAMPLES).contains(&samples)
                && samples * sensors as f64 <= MAX_PRESSURES
                && steps <= 1e9
                && duration <= 1e9,
            "at least sense.interval and at most 1000000000, with at most 20 million samples, 2 billion pressures and \
             1 billion steps of physics.step in all",
        )
    }

    /// Checks that the matrices of all components fit the memory in every number of dimensions.
    fn check_matrices(&self) -> Checked {
        let (experiment, components) = (&self.experiment, self.schema.components);
        let largest = experiment.dimensions.last().copied().unwrap_or(0);
        for (key, d) in [("experiment.dimensions", largest), ("experiment.dimension", experiment.dimension)] {
            let range = "such that schema.components times its square is at most 10 million";
            check(key, d, matrices_fit(components, d), range)?;
        }
        Ok(())
    }

    /// Checks that no clustering asks for more clusters than there are sensors.
    fn check_clusters(&self) -> Checked {
        let (clusters, most) = (&self.baselines.clusters, self.sensors().min(1000));
        check(
            "baselines.clusters",
            clusters,
            rising(clusters) && clusters.iter().all(|clusters| (1..=most).contains(clusters)),
            "an increasing list of 1 to 60 numbers from 1 to the number of sensors, at most 1000",
        )
    }

    /// Checks that the posterior samples of all simulations and conditions fit the memory.
    fn check_posterior_samples(&self) -> Checked {
        let simulations = self.experiment.simulations;
        let conditions = (2 * self.experiment.dimensions.len()).max(self.experiment.coordinations.len());
        check(
            "experiment.simulations",
            simulations,
            (1..=10_000).contains(&simulations)
                && simulations * conditions * self.schema.posterior_samples() <= 10_000_000,
            "1 to 10000, with at most 10 million posterior samples (schema.chains, schema.keep) in all conditions",
        )
    }
}
