//! Say what a factor decides, what configurations share by that, and how many are drawn at each level.

use serde::{Deserialize, Serialize};

/// How many are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct DrawCounts {
    /// Draws of the factors at the level of the movement.
    pub movements: usize,
    /// For each movement, draws of the factors at the level of the distances.
    pub distances: usize,
    /// For each matrix of distances, draws of the factors at the level of the body maps.
    #[serde(default = "one")]
    pub maps: usize,
    /// For the body maps of each, draws of the factors at the level of the inference.
    pub inferences: usize,
    /// Probability with which each factor keeps the base's option; without one, all options are drawn by their weights.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub keep: Option<f64>,
}

fn one() -> usize {
    1
}

impl DrawCounts {
    /// Configurations at most, if that is a number.
    pub(crate) fn count(self) -> Option<usize> {
        let Self { movements, distances, maps, inferences, .. } = self;
        [movements, distances, maps, inferences].into_iter().try_fold(1_usize, usize::checked_mul)
    }
}

/// What a factor decides, and all that comes after it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Level {
    /// How the body moves.
    Movement,
    /// What it feels, and the distances between its sensors.
    Distances,
    /// The body maps.
    Map,
    /// What is inferred from them.
    Inference,
    /// How that is judged: every inference is judged by all options, since that takes no time.
    Evaluation,
}

/// Numbers of the movement, the matrix of distances and the body maps of a configuration; those with the same number share it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct SharedStages {
    /// Number of the movement, from 1.
    pub movement: usize,
    /// Number of the matrix of distances, from 1.
    pub distances: usize,
    /// Number of the body maps, from 1.
    pub maps: usize,
}
