//! Sum up many partitions by one: the one that is nearest to all, and how sure each label is.
//!
//! Labels of different samples do not compare: part 2 of one may be part 0 of another. So samples are compared by their
//! partitions, and labels are matched to those of the consensus.

use std::collections::HashMap;

use crate::numerics::partition::{named_by_appearance, sizes};
use crate::stages::schema::Sample;
use crate::stages::tree::Edge;

/// Posterior samples that are candidates for the consensus, at most: the most frequent partition, and others evenly.
const MOST_CANDIDATES: usize = 100;

/// The consensus of some partitions.
#[derive(Debug, Clone, PartialEq)]
pub struct Consensus {
    /// The part of each sensor: 0, 1, … in order of their first sensors.
    pub labels: Vec<usize>,
    /// Of each sensor, the share of posterior samples that have it in the part that matches its own.
    pub certainty: Vec<f64>,
    /// Mean variation of information between it and the posterior samples, in bits: 0 if all agree.
    pub loss: f64,
}

/// The partition with the least mean variation of information to all samples (Meilă 2007; Wade and Ghahramani 2018), among
/// 100 of those drawn, and those that then give each sensor the part which most samples give it: where many sensors are
/// uncertain, no sample has all of them right.
///
/// # Panics
/// If there is no partition.
pub fn consensus(samples: &[&[usize]]) -> Consensus {
    let mut counts: HashMap<Vec<usize>, usize> = HashMap::new();
    samples.iter().for_each(|labels| *counts.entry(named_by_appearance(labels)).or_default() += 1);
    let mut distinct: Vec<(Vec<usize>, usize)> = counts.into_iter().collect();
    // The order of a map is its own, so equal counts go by their labels.
    distinct.sort_by(|a, b| b.1.cmp(&a.1).then_with(|| a.0.cmp(&b.0)));
    let loss = |labels: &[usize]| {
        let total: f64 = distinct
            .iter()
            .map(|(other, count)| *count as f64 * variation_of_information(labels, other))
            .sum();
        total / samples.len() as f64
    };
    // Of equally frequent ones, the first would be those that merge early sensors.
    let stride = distinct.len().div_ceil(MOST_CANDIDATES);
    let candidates = distinct.iter().step_by(stride).map(|(labels, _)| (loss(labels), labels));
    let (mut least, labels) = candidates
        .reduce(|kept, next| if next.0 < kept.0 { next } else { kept })
        .expect("samples must not be empty");
    let mut labels = labels.clone();
    loop {
        let votes = votes(&labels, &distinct);
        let likeliest = |votes: &Vec<usize>| {
            (0..votes.len()).reduce(|kept, next| if votes[next] > votes[kept] { next } else { kept })
        };
        let by_vote: Option<Vec<usize>> = votes.iter().map(likeliest).collect();
        let by_vote = named_by_appearance(&by_vote.expect("there is a part"));
        let loss = loss(&by_vote);
        if loss < least {
            (least, labels) = (loss, by_vote);
            continue;
        }
        let own = votes.iter().zip(&labels).map(|(votes, label)| votes[*label] as f64 / samples.len() as f64);
        return Consensus { certainty: own.collect(), labels, loss: least };
    }
}

/// Of each sensor, how many posterior samples have it in the part that matches each part of `labels`.
fn votes(labels: &[usize], distinct: &[(Vec<usize>, usize)]) -> Vec<Vec<usize>> {
    let parts = labels.iter().max().map_or(0, |largest| largest + 1);
    let mut votes = vec![vec![0; parts]; labels.len()];
    for (other, count) in distinct {
        let names = matched(labels, other);
        for (votes, other) in votes.iter_mut().zip(other) {
            if let Some(name) = names.get(other) {
                votes[*name] += count;
            }
        }
    }
    votes
}

/// Names the clusters of a sample after the parts of the consensus that they match; those that match none get the numbers
/// after them. Its tree goes with them.
pub(crate) fn named_after(consensus: &[usize], sample: &mut Sample) {
    let mut names = matched(consensus, &sample.labels);
    let mut next = consensus.iter().max().map_or(0, |largest| largest + 1);
    for label in &mut sample.labels {
        *label = *names.entry(*label).or_insert_with(|| (next, next += 1).0);
    }
    for edge in &mut sample.tree {
        let name = |label: usize| names.get(&label).copied().unwrap_or(label);
        *edge = Edge { child: name(edge.child), parent: name(edge.parent) };
    }
}

/// Variation of information of two partitions of the same items, in bits: what each says beyond the other (Meilă 2007).
pub(crate) fn variation_of_information(first: &[usize], second: &[usize]) -> f64 {
    let size = |labels: &[usize]| labels.iter().max().map_or(0, |largest| largest + 1);
    let (rows, columns) = (size(first), size(second));
    let mut both = vec![0usize; rows * columns];
    first.iter().zip(second).for_each(|(row, column)| both[row * columns + column] += 1);
    let total = first.len() as f64;
    let entropy = |counts: &mut dyn Iterator<Item = usize>| {
        let shares = counts.filter(|count| *count > 0).map(|count| count as f64 / total);
        shares.map(|share| -share * share.log2()).sum::<f64>()
    };
    let of_rows = entropy(&mut both.chunks_exact(columns).map(|row| row.iter().sum()));
    let of_columns = entropy(&mut (0..columns).map(|column| both.iter().skip(column).step_by(columns).sum()));
    (2.0 * entropy(&mut both.iter().copied()) - of_rows - of_columns).max(0.0)
}

/// Which label of `labels` each label of `other` stands for: those that share most items first, each once.
fn matched(labels: &[usize], other: &[usize]) -> HashMap<usize, usize> {
    let both: Vec<(usize, usize)> = other.iter().copied().zip(labels.iter().copied()).collect();
    let mut shared: Vec<((usize, usize), usize)> = sizes(&both).into_iter().collect();
    shared.sort_by(|a, b| b.1.cmp(&a.1).then(a.0.cmp(&b.0)));
    let mut names: HashMap<usize, usize> = HashMap::new();
    for ((other, label), _) in shared {
        if !names.contains_key(&other) && !names.values().any(|taken| *taken == label) {
            names.insert(other, label);
        }
    }
    names
}

#[cfg(test)]
mod tests;
