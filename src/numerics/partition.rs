//! Count, rename and compare partitions.

use std::collections::BTreeMap;

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
}
