//! Settings of multidimensional scaling, `[map]` (section 4.1).

use serde::{Deserialize, Serialize};

/// The variant of multidimensional scaling.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MapMethod {
    /// Torgerson's classical scaling: the largest eigenvalues of the matrix of inner products.
    Classical,
    /// Metric scaling: minimises the squared differences to the distances, starting from the classical map.
    Smacof,
    /// Kruskal's nonmetric scaling: uses only the order of the distances, starting from the classical map.
    Nonmetric,
}

/// Multidimensional scaling (section 4.1).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Map {
    /// The variant.
    pub method: MapMethod,
}
