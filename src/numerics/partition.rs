//! Count, rename and compare partitions.

use std::collections::{BTreeMap, BTreeSet};

/// How many items have each label.
pub fn sizes<T: Ord + Copy>(labels: &[T]) -> BTreeMap<T, usize> {
    let mut sizes = BTreeMap::new();
    for label in labels {
        *sizes.entry(*label).or_default() += 1;
    }
    sizes
}

/// The same partition with its labels named 0, 1, … in order of appearance.
pub fn named_by_appearance(labels: &[usize]) -> Vec<usize> {
    let mut names: BTreeMap<usize, usize> = BTreeMap::new();
    let name = |label: &usize| {
        let next = names.len();
        *names.entry(*label).or_insert(next)
    };
    labels.iter().map(name).collect()
}

/// Adjusted Rand index of two partitions of the same sensors (Hubert & Arabie 1985): 1 for equal ones, 0
/// on average for independent ones. Two partitions that leave nothing to compare (all in one cluster, or
/// each sensor alone, in both) are equal and give 1.
pub fn adjusted_rand_index(first: &[usize], second: &[usize]) -> f64 {
    assert_eq!(first.len(), second.len(), "both partition the same sensors");
    let pairs = |count: usize| count as f64 * (count as f64 - 1.0) / 2.0;
    let both: Vec<(usize, usize)> = first.iter().copied().zip(second.iter().copied()).collect();
    let together: f64 = sizes(&both).values().map(|&count| pairs(count)).sum();
    let in_first: f64 = sizes(first).values().map(|&count| pairs(count)).sum();
    let in_second: f64 = sizes(second).values().map(|&count| pairs(count)).sum();
    let expected = in_first * in_second / pairs(first.len()).max(1.0);
    let largest = 0.5 * (in_first + in_second);
    if largest == expected { 1.0 } else { (together - expected) / (largest - expected) }
}

/// Which items are connected (union–find with path halving).
#[derive(Debug, Clone)]
pub struct Connected {
    /// Each item points towards the representative of all that it is connected with.
    towards: Vec<usize>,
}

impl Connected {
    /// `items` items, each alone.
    pub fn new(items: usize) -> Self {
        Self { towards: (0..items).collect() }
    }

    /// Connects two items. Returns whether they were apart before.
    pub fn connect(&mut self, a: usize, b: usize) -> bool {
        let (a, b) = (self.representative(a), self.representative(b));
        self.towards[a] = b;
        a != b
    }

    /// The same item for all that are connected.
    pub fn representative(&mut self, mut item: usize) -> usize {
        while self.towards[item] != item {
            self.towards[item] = self.towards[self.towards[item]];
            item = self.towards[item];
        }
        item
    }
}

/// Whether edges make a tree over the nodes that they name. No edge does, over one node.
pub fn is_tree(edges: &[(usize, usize)]) -> bool {
    let nodes: BTreeMap<usize, usize> =
        edges.iter().flat_map(|&(a, b)| [a, b]).collect::<BTreeSet<_>>().into_iter().zip(0..).collect();
    let mut connected = Connected::new(nodes.len());
    edges.iter().all(|(a, b)| connected.connect(nodes[a], nodes[b]))
        && (edges.is_empty() || edges.len() + 1 == nodes.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn adjusted_rand_index_of_known_partitions() {
        // Values as sklearn.metrics.adjusted_rand_score documents and prints them.
        for (first, second, expected) in [
            (vec![0, 0, 1, 1], vec![1, 1, 0, 0], 1.0),
            (vec![0, 0, 1, 2], vec![0, 0, 1, 1], 0.571_428_571_428_571_4),
            (vec![0, 0, 0, 0], vec![0, 1, 2, 3], 0.0),
            (vec![0, 0, 1, 1], vec![0, 1, 0, 1], -0.5),
            (vec![0, 0, 0], vec![5, 5, 5], 1.0),
            (vec![0], vec![3], 1.0),
        ] {
            let ari = adjusted_rand_index(&first, &second);
            assert!((ari - expected).abs() < 1e-12, "{first:?} {second:?}: {ari}");
        }
    }

    #[test]
    fn a_tree_connects_all_its_nodes_once() {
        assert!(is_tree(&[]) && is_tree(&[(7, 3)]) && is_tree(&[(7, 3), (9, 3), (1, 9)]));
        assert!(!is_tree(&[(7, 7)]) && !is_tree(&[(1, 2), (2, 1)]) && !is_tree(&[(1, 2), (3, 4)]));
        assert!(!is_tree(&[(1, 2), (2, 3), (3, 1), (4, 5)]));
    }
}
