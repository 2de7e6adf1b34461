//! Stage 7. Samples and ground truth → number of parts, adjusted Rand index, tree right or wrong
//! (section 5.2).

use std::collections::BTreeMap;

use crate::schema::Sample;
use crate::schema::tree::Edge;

/// What the evaluation knows and the method does not.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Truth {
    /// The part of each sensor.
    pub labels: Vec<usize>,
    /// The tree as (child, parent) pairs of parts.
    pub tree: Vec<(usize, usize)>,
}

impl Truth {
    /// Number of parts. One of a single sensor counts, although no estimate can have it.
    pub fn parts(&self) -> usize {
        sizes(&self.labels).len()
    }
}

/// How good one sample is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Score {
    /// Adjusted Rand index of its partition.
    pub ari: f64,
    /// Whether its tree counts: it has the true number of parts, and an ARI of at least
    /// `evaluate.eligible_ari`.
    pub eligible: bool,
    /// Whether its tree is the true one, under the matching of its clusters to the parts.
    pub tree_correct: bool,
}

/// Evaluates a sample; `eligible_ari` is the least ARI at which its tree counts.
pub fn score(sample: &Sample, truth: &Truth, eligible_ari: f64) -> Score {
    let ari = adjusted_rand_index(&sample.labels, &truth.labels);
    Score {
        ari,
        // A rounding below 1 is still 1.
        eligible: parts(&sample.labels) == truth.parts() && ari >= eligible_ari - 1e-12,
        tree_correct: tree_correct(&sample.labels, &sample.tree, truth),
    }
}

/// Number of estimated parts: clusters of more than one sensor.
pub fn parts(labels: &[usize]) -> usize {
    sizes(labels).values().filter(|size| **size > 1).count()
}

fn sizes<T: Ord + Copy>(labels: &[T]) -> BTreeMap<T, usize> {
    let mut sizes = BTreeMap::new();
    for label in labels {
        *sizes.entry(*label).or_default() += 1;
    }
    sizes
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

/// Whether the estimated tree is the true one: every active cluster is matched to the part that most of
/// its sensors are on, every part is matched once, and matched edges are the true edges.
fn tree_correct(labels: &[usize], tree: &[Edge], truth: &Truth) -> bool {
    let mut overlap: BTreeMap<usize, BTreeMap<usize, usize>> = BTreeMap::new();
    for (label, part) in labels.iter().zip(&truth.labels) {
        *overlap.entry(*label).or_default().entry(*part).or_default() += 1;
    }
    let matching: BTreeMap<usize, usize> = overlap
        .into_iter()
        .filter(|(_, parts)| parts.values().sum::<usize>() > 1)
        .filter_map(|(label, parts)| {
            let (part, _) =
                parts.into_iter().reduce(|most, next| if next.1 > most.1 { next } else { most })?;
            Some((label, part))
        })
        .collect();
    let mut matched: Vec<usize> = matching.values().copied().collect();
    matched.sort_unstable();
    matched.dedup();
    if matched.len() != matching.len() || matched.len() != truth.parts() {
        return false;
    }
    let undirected = |a: usize, b: usize| (a.min(b), a.max(b));
    let mut estimated: Vec<_> =
        tree.iter().map(|edge| undirected(matching[&edge.child], matching[&edge.parent])).collect();
    let mut expected: Vec<_> = truth.tree.iter().map(|&(child, parent)| undirected(child, parent)).collect();
    estimated.sort_unstable();
    expected.sort_unstable();
    estimated == expected
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chain_of_three() -> Truth {
        Truth { labels: [[0; 4], [1; 4], [2; 4]].concat(), tree: vec![(1, 0), (2, 1)] }
    }

    fn sample(labels: &[usize], edges: &[(usize, usize)]) -> Sample {
        let tree = edges.iter().map(|&(child, parent)| Edge { child, parent }).collect();
        Sample { chain: 0, sweep: 1, labels: labels.to_vec(), tree, joints: Vec::new(), log_posterior: None }
    }

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
    fn a_tree_is_right_whatever_its_labels_and_directions() {
        let labels = [[7; 4], [2; 4], [5; 4]].concat();
        let right = score(&sample(&labels, &[(7, 2), (5, 2)]), &chain_of_three(), 1.0);
        assert_eq!(right, Score { ari: 1.0, eligible: true, tree_correct: true });
        let wrong = score(&sample(&labels, &[(2, 7), (5, 7)]), &chain_of_three(), 1.0);
        assert_eq!(wrong, Score { ari: 1.0, eligible: true, tree_correct: false });
    }

    #[test]
    fn a_single_sensor_is_no_part_and_spoils_a_perfect_ari() {
        let mut labels = [[0; 4], [1; 4], [2; 4]].concat();
        labels[0] = 9;
        let score_at = |ari| score(&sample(&labels, &[(1, 0), (2, 1)]), &chain_of_three(), ari);
        assert_eq!(parts(&labels), 3);
        assert!(!score_at(1.0).eligible && score_at(0.8).eligible);
        assert!(score_at(0.8).tree_correct);
    }

    #[test]
    fn too_many_parts_or_two_for_one_are_never_right() {
        let four = [[0; 4], [1; 4], [2, 2, 3, 3]].concat();
        let score_four = score(&sample(&four, &[(1, 0), (2, 1), (3, 2)]), &chain_of_three(), 0.0);
        assert!(!score_four.eligible && !score_four.tree_correct);
        let doubled = [[0, 0, 1, 1], [2; 4], [2; 4]].concat();
        let score_doubled = score(&sample(&doubled, &[(1, 0), (2, 1)]), &chain_of_three(), 0.0);
        assert!(score_doubled.eligible && !score_doubled.tree_correct);
    }
}
