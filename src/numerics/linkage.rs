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
    cut(linkage(&mut condensed(n, distance), n, method).steps(), n, clusters.max(1))
}

/// The largest clusters of at most `size` points that merge at no more than a distance of `most`, in the order of their merges;
/// each is rising.
///
/// `distance(i, j)` is asked for i < j.
pub(crate) fn largest_clusters(
    n: usize,
    distance: impl Fn(usize, usize) -> f64,
    method: Method,
    size: usize,
    most: f64,
) -> Vec<Vec<usize>> {
    let dendrogram = linkage(&mut condensed(n, distance), n, method);
    let mut members: Vec<Vec<usize>> = (0..n).map(|point| vec![point]).collect();
    for step in dendrogram.steps() {
        let both = [step.cluster1, step.cluster2];
        let is_small =
            both.iter().all(|&at| !members[at].is_empty()) && step.dissimilarity <= most && step.size <= size;
        // A cluster that is too large has no members, and none that contains it has.
        let mut own =
            if is_small { both.map(|at| std::mem::take(&mut members[at])).concat() } else { Vec::new() };
        own.sort_unstable();
        members.push(own);
    }
    members.into_iter().filter(|own| !own.is_empty()).collect()
}

/// The distances of all i < j, by rows, as `kodama` takes them.
fn condensed(n: usize, distance: impl Fn(usize, usize) -> f64) -> Vec<f64> {
    (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j))).map(|(i, j)| distance(i, j)).collect()
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_clusters_are_neither_too_large_nor_too_wide() {
        let places = [0.0_f64, 1.0, 2.0, 10.0, 11.0, 30.0];
        let found = |size, most| {
            let distance = |i: usize, j: usize| (places[i] - places[j]).abs();
            largest_clusters(places.len(), distance, Method::Average, size, most)
        };
        let sorted = |mut clusters: Vec<Vec<usize>>| {
            clusters.sort();
            clusters
        };
        assert_eq!(sorted(found(3, 5.0)), [vec![0, 1, 2], vec![3, 4], vec![5]]);
        assert_eq!(sorted(found(2, 5.0)), [vec![0, 1], vec![2], vec![3, 4], vec![5]]);
        assert_eq!(sorted(found(6, 20.0)), [vec![0, 1, 2, 3, 4], vec![5]]);
        assert_eq!(found(1, 20.0).len(), 6);
    }
}
