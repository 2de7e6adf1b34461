//! Settings of multidimensional scaling, `[map]` (section 4.1).

use serde::{Deserialize, Serialize};

use crate::numerics::range::{Checked, check};

/// What is scaled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MapOf {
    /// The distances between the sensors.
    Distances,
    /// The Euclidean distances between the rows of the matrix of distances: each sensor is described by its distances to
    /// all others. That is what scikit-learn's `MDS` does unless it is told that the matrix is `precomputed`.
    Rows,
}

/// The variant of multidimensional scaling.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MapMethod {
    /// Torgerson's classical scaling: the largest eigenvalues of the matrix of inner products.
    Classical,
    /// Metric scaling: minimises the squared differences to the distances, starting from the classical map.
    Smacof,
    /// Metric scaling from random starts, of which the one of least stress is kept, as scikit-learn 0.17 to 0.19 does it.
    SmacofRandom,
    /// Kruskal's nonmetric scaling: uses only the order of the distances, starting from the classical map.
    Nonmetric,
}

/// Multidimensional scaling (section 4.1).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Map {
    /// What is scaled.
    pub of: MapOf,
    /// The variant.
    pub method: MapMethod,
    /// Random starts of `smacof-random`.
    pub starts: usize,
    /// Maximum number of steps of `smacof-random` from each start.
    pub steps: usize,
    /// `smacof-random` stops where a step lowers raw stress over the sum of the points' norms by less than this.
    pub tolerance: f64,
}

impl Map {
    /// Checks the range of each setting.
    ///
    /// # Errors
    /// The first setting that is outside its range.
    pub fn check(&self) -> Checked {
        check("map.starts", self.starts, (1..=1000).contains(&self.starts), "1 to 1000")?;
        check("map.steps", self.steps, (1..=100_000).contains(&self.steps), "1 to 100000")?;
        check("map.tolerance", self.tolerance, (0.0..=1e6).contains(&self.tolerance), "0 to 1000000")
    }
}
