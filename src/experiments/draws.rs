//! Say how configurations are drawn: nested, so that many share a movement, of these some the distances, and of these some
//! the body maps.

use serde::Deserialize;

/// How many are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Draws {
    /// Draws of the factors that decide the movement.
    pub movements: usize,
    /// For each movement, draws of the factors that decide the distances.
    pub distances: usize,
    /// For each matrix of distances, draws of the factors that decide the body maps.
    #[serde(default = "one")]
    pub maps: usize,
    /// For the body maps of each, draws of all other factors: one configuration each.
    pub inferences: usize,
}

fn one() -> usize {
    1
}

/// What a factor decides, and all that comes after it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Level {
    /// How the body moves.
    Movement,
    /// What it feels, and the distances between its sensors.
    Distances,
    /// The body maps.
    Map,
    /// What is inferred from them.
    Inference,
}
