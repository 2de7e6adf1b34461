//! Cluster a body map by Ward's method (section 5.2).
//!
//! Ward (1963), "Hierarchical grouping to optimize an objective function".

use kodama::Method;

use crate::numerics::linkage;
use crate::stages::body_map::BodyMap;

/// Clusters a body map (n × d) by Ward's method, and returns the cluster of each of the n points: `clusters` clusters, or
/// fewer if there are fewer different points.
///
/// Of merges of equal cost, the first one in the order of the points is made.
pub fn ward(map: &BodyMap, clusters: usize) -> Vec<usize> {
    let row = |i: usize| &map.coordinates[i * map.dims..][..map.dims];
    let distance = |i, j| row(i).iter().zip(row(j)).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
    linkage::clusters(map.points(), distance, Method::Ward, clusters)
}
