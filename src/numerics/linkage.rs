//! Hierarchical clustering: cut the tree of merges where the wanted number of clusters is left.
//!
//! The merges are `kodama`'s, which are those of SciPy's `linkage`.

use kodama::{Method, Step, linkage};

use super::partition::named_by_appearance;

/// The cluster of each of n points, numbered in the order of their first points: `clusters` of them, or fewer if there are
/// fewer different points.
///
/// `distance(i, j)` is asked for i < j. Of merges of equal cost, the first one in the order of the points is made.
pub(crate) fn clusters(
    n: usize,
    distance: impl Fn(usize, usize) -> f64,
    method: Method,
    clusters: usize,
) -> Vec<usize> {
    let mut condensed: Vec<f64> =
        (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j))).map(|(i, j)| distance(i, j)).collect();
    cut(linkage(&mut condensed, n, method).steps(), n, clusters.max(1))
}

/// Merge s of `steps` joins two of the n points or of the clusters n, n + 1, … to cluster n + s. Merges at distance 0 are made
/// in any case.
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
    named_by_appearance(&root[..n])
}
