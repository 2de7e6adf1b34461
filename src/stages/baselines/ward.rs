//! Cluster a body map by Ward's method: cut the tree of merges where the wanted number of clusters is left (section
//! 5.2).
//!
//! Ward (1963), "Hierarchical grouping to optimize an objective function". The merges are `kodama`'s, which
//! are those of SciPy's `linkage(method="ward")`.

use kodama::{Method, Step, linkage};

use crate::stages::body_map::BodyMap;

/// Clusters a body map (n × d) by Ward's method, and returns the cluster of each of the n points: `clusters` clusters, or
/// fewer if there are fewer different points.
///
/// Of merges of equal cost, the first one in the order of the points is made.
pub fn ward(map: &BodyMap, clusters: usize) -> Vec<usize> {
    let n = map.points();
    let row = |i: usize| &map.coordinates[i * map.dims..][..map.dims];
    let distance = |i, j| row(i).iter().zip(row(j)).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
    let mut condensed: Vec<f64> =
        (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j))).map(|(i, j)| distance(i, j)).collect();
    cut(linkage(&mut condensed, n, Method::Ward).steps(), n, clusters.max(1))
}

/// The clusters that are left when only `clusters` are, numbered in the order of their first points.
///
/// Merge s of `steps` joins two of the n points or of the clusters n, n + 1, … to cluster n + s. Merges at
/// distance 0 are made in any case.
fn cut(steps: &[Step<f64>], n: usize, clusters: usize) -> Vec<usize> {
    let made = steps
        .iter()
        .enumerate()
        .take_while(|(s, step)| s + clusters < n || step.dissimilarity == 0.0)
        .count();
    let mut root: Vec<usize> = (0..n + made).collect();
    for (s, step) in steps[..made].iter().enumerate().rev() {
        root[step.cluster1] = root[n + s];
        root[step.cluster2] = root[n + s];
    }
    let mut seen = Vec::new();
    root[..n]
        .iter()
        .map(|root| {
            seen.iter().position(|other| other == root).unwrap_or_else(|| {
                seen.push(*root);
                seen.len() - 1
            })
        })
        .collect()
}
