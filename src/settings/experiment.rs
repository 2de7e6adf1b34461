//! Settings of the experiments, `[experiment]`: conditions, number of simulations, and the master seed.

use serde::{Deserialize, Serialize};

use crate::numerics::range::{Checked, check, count};

/// Maximum number of values in a list of settings: far above how many panels or curves a picture can show.
pub const MAX_LISTED: usize = 60;

/// The conditions that an experiment repeats.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExperimentSettings {
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

impl ExperimentSettings {
    /// Checks the range of each setting.
    ///
    /// # Errors
    /// The first setting that is outside its range.
    pub fn check(&self) -> Checked {
        let dimensions = &self.dimensions;
        check(
            "experiment.dimensions",
            dimensions,
            rising(dimensions) && dimensions[0] >= 1,
            "an increasing list of 1 to 60 dimensions, each at least 1",
        )?;
        let coordinations = &self.coordinations;
        check(
            "experiment.coordinations",
            coordinations,
            rising(coordinations) && coordinations.iter().all(|p| (0.0..=1.0).contains(p)),
            "an increasing list of 1 to 60 probabilities, 0 to 1",
        )?;
        count("experiment.dimension", self.dimension)
    }
}

/// Whether a list is not empty, rises strictly, and has at most [`MAX_LISTED`] values.
pub(super) fn rising<T: PartialOrd>(values: &[T]) -> bool {
    (1..=MAX_LISTED).contains(&values.len()) && values.windows(2).all(|pair| pair[0] < pair[1])
}
