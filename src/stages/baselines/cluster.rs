//! Cluster a body map by one of the three methods that the paper compares its mixtures with (section 5.2, figure 8a).
//!
//! No method finds the number of clusters, so each is given it. The results are equal up to rounding for maps
//! in other units, moved or turned: no method has a constant with a unit.

use serde::{Deserialize, Serialize};

use super::gmm::gmm;
use super::ward::ward;
use crate::numerics::range::{Checked, check};
use crate::numerics::rng::Stream;
use crate::stages::body_map::BodyMap;
use crate::stages::mixture::k_means;

/// The clusterings of figure 8a, which need the number of clusters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Baselines {
    /// Numbers of clusters.
    pub clusters: Vec<usize>,
    /// Starts of k-means and of GMM, of which the best is kept.
    pub restarts: usize,
}

impl Baselines {
    /// Checks the range of each setting, all but the largest number of clusters, which depends on the body.
    ///
    /// # Errors
    /// The first setting that is outside its range.
    pub fn check(&self) -> Checked {
        check("baselines.restarts", self.restarts, (1..=1000).contains(&self.restarts), "1 to 1000")
    }
}

/// The method to cluster by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ClusteringMethod {
    /// Ward's method: merges the two clusters whose union adds the least to the sum of squares.
    Ward,
    /// k-means: the least sum of squares that Lloyd's algorithm finds.
    KMeans,
    /// Gaussian mixture model: the greatest likelihood that expectation–maximisation finds.
    Gmm,
}

impl ClusteringMethod {
    /// All three, in the order of figure 8a.
    pub const ALL: [Self; 3] = [Self::Ward, Self::KMeans, Self::Gmm];

    /// Name on the command line and in every file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ward => "ward",
            Self::KMeans => "k-means",
            Self::Gmm => "gmm",
        }
    }
}

/// Clusters a body map (n × d) by one method, and returns the cluster of each of the n points, below `clusters`.
///
/// k-means and the mixture take the best of `restarts` random starts; Ward's method has no start and draws
/// nothing. `clusters` and `restarts` of 0 count as 1. Points that coincide share a cluster, so that there
/// are no more clusters than different points; a mixture may also find fewer. Labels of clusters that are not found
/// do not occur. The coordinates and their squares must be finite.
pub fn cluster(
    method: ClusteringMethod,
    map: &BodyMap,
    clusters: usize,
    restarts: usize,
    rng: &mut Stream,
) -> Vec<usize> {
    match method {
        ClusteringMethod::Ward => ward(map, clusters),
        ClusteringMethod::KMeans => k_means(map, clusters, restarts, rng).labels,
        ClusteringMethod::Gmm => gmm(map, clusters, restarts, rng).labels,
    }
}

#[cfg(test)]
mod tests;
