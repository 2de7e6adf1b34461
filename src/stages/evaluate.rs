//! Stage 7, `evaluate`: compare estimated parts and tree with the truth (section 5.2).
//!
//! In: the part of each sensor and a tree over the parts, such as those of a posterior sample, and the [`Truth`]. Out: a
//! [`Score`]: the adjusted Rand index, whether the tree is eligible, and whether it is right.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

pub use crate::numerics::partition::adjusted_rand_index;
use crate::numerics::partition::{Connected, is_tree, sizes};
use crate::numerics::range::{Checked, check};
use crate::stages::tree::{Edge, Truth};

/// What counts as a success (section 5.2).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Evaluate {
    /// Minimum adjusted Rand index of an eligible posterior sample, whose tree counts for the success rate.
    pub eligible_ari: f64,
}

impl Evaluate {
    /// Checks the range of each setting.
    ///
    /// # Errors
    /// The first setting that is outside its range.
    pub fn check(&self) -> Checked {
        let ari = self.eligible_ari;
        check("evaluate.eligible_ari", ari, (0.0..=1.0).contains(&ari), "0 to 1")
    }
}

/// How good one posterior sample is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Score {
    /// Adjusted Rand index of its partition, at most 1.
    pub ari: f64,
    /// Whether its tree counts for the success rate: the sample has the true number of parts, and an ARI of at least
    /// `evaluate.eligible_ari`.
    pub eligible: bool,
    /// Whether its tree is the true one, under the matching of its clusters to the parts.
    pub tree_correct: bool,
}

/// Evaluates estimated parts and their tree against the truth (section 5.2); `eligible_ari` is the minimum ARI at which its
/// tree counts.
///
/// # Panics
/// If there are not as many labels as true ones.
pub fn score(labels: &[usize], tree: &[Edge], truth: &Truth, eligible_ari: f64) -> Score {
    let ari = adjusted_rand_index(labels, &truth.labels);
    Score {
        ari,
        eligible: parts(labels) == truth.parts() && is_eligible(ari, eligible_ari),
        tree_correct: tree_correct(labels, tree, truth),
    }
}

/// Whether an ARI is at least the minimum; a rounding below 1 is still 1.
pub fn is_eligible(ari: f64, eligible_ari: f64) -> bool {
    ari >= eligible_ari - 1e-12
}

/// Number of estimated parts: clusters of more than one sensor.
pub fn parts(labels: &[usize]) -> usize {
    sizes(labels).values().filter(|size| **size > 1).count()
}

/// The part that most sensors of each active cluster are on.
fn majority(labels: &[usize], truth: &Truth) -> BTreeMap<usize, usize> {
    let mut overlap: BTreeMap<usize, BTreeMap<usize, usize>> = BTreeMap::new();
    for (label, part) in labels.iter().zip(&truth.labels) {
        *overlap.entry(*label).or_default().entry(*part).or_default() += 1;
    }
    overlap
        .into_iter()
        .filter(|(_, parts)| parts.values().sum::<usize>() > 1)
        .filter_map(|(label, parts)| {
            let (part, _) =
                parts.into_iter().reduce(|most, next| if next.1 > most.1 { next } else { most })?;
            Some((label, part))
        })
        .collect()
}

/// The part that each active cluster is matched to, that which most of its sensors are on; `None` unless every part is matched
/// once.
fn matching(labels: &[usize], truth: &Truth) -> Option<BTreeMap<usize, usize>> {
    let matching = majority(labels, truth);
    let mut matched: Vec<usize> = matching.values().copied().collect();
    matched.sort_unstable();
    matched.dedup();
    (matched.len() == matching.len() && matched.len() == truth.parts()).then_some(matching)
}

/// Whether every cluster is one part by most of its sensors, and every part one cluster.
pub fn parts_match(labels: &[usize], truth: &Truth) -> bool {
    matching(labels, truth).is_some()
}

/// Whether an edge joins clusters whose parts are joined, or turn about one place; each cluster is the part of most of its sensors.
pub fn joins(labels: &[usize], edge: &Edge, truth: &Truth) -> bool {
    let parts = majority(labels, truth);
    parts.get(&edge.child).zip(parts.get(&edge.parent)).is_some_and(|(&a, &b)| truth.meet(a, b))
}

/// How many joints of the true tree an estimated tree has, by the edges that [join](joins) what is joined. A joint that several edges
/// join counts once.
pub fn joints_right(labels: &[usize], tree: &[Edge], truth: &Truth) -> usize {
    let parts = majority(labels, truth);
    let mut connected = Connected::new(truth.labels.iter().max().map_or(0, |last| last + 1));
    let pairs = tree.iter().filter_map(|edge| parts.get(&edge.child).zip(parts.get(&edge.parent)));
    pairs.filter(|&(&a, &b)| truth.meet(a, b) && connected.connect(a, b)).count()
}

/// Whether the estimated tree is the true one: every active cluster is matched to the part that most of
/// its sensors are on, every part is matched once, and matched edges are the true edges, or others that connect parts which turn
/// about the same place.
fn tree_correct(labels: &[usize], tree: &[Edge], truth: &Truth) -> bool {
    let Some(matching) = matching(labels, truth) else { return false };
    // A node of a single sensor, which the authors' code has, matches no part.
    let parts = |edge: &Edge| Some((*matching.get(&edge.child)?, *matching.get(&edge.parent)?));
    let Some(estimated) = tree.iter().map(parts).collect::<Option<Vec<_>>>() else { return false };
    estimated.len() == truth.tree.len()
        && estimated.iter().all(|&(a, b)| truth.meet(a, b))
        && is_tree(&estimated)
}

#[cfg(test)]
mod tests;
