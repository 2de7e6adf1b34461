//! Settings of multidimensional scaling, `[map]` (section 4.1).

use serde::{Deserialize, Serialize};

/// The variant of multidimensional scaling.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MapMethod {
    /// Torgerson's: the largest eigenvalues of the inner products.
    Classical,
    /// Metric: the least sum of squared differences to the distances, from the classical map on.
    Smacof,
    /// Kruskal's: the same to numbers that only rise as the distances do.
    Nonmetric,
}

/// Multidimensional scaling (section 4.1).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Map {
    /// Its variant.
    pub method: MapMethod,
}
