//! Sample the tree over the parts of a given partition, with the probability of each edge.

use std::collections::BTreeMap;

use super::chain::{SplitMerge, Target};
use crate::numerics::partition::sizes;
use crate::numerics::rng::Stream;
use crate::stages::mixture::Rounding;

/// Draws of the Gaussians over which probabilities are averaged, and those before that are dropped.
const DRAWS: usize = 500;
const BURN_IN: usize = 50;

/// The posterior of the tree over the parts of a partition.
#[derive(Debug, Clone, PartialEq)]
pub struct TreePosterior {
    /// Every pair of parts, the smaller number first, with the probability that an edge joins them.
    pub edges: Vec<(usize, usize, f64)>,
    /// The likeliest tree among those drawn: pairs of parts, the smaller number first.
    pub tree: Vec<(usize, usize)>,
    /// Its probability.
    pub probability: f64,
}

/// The tree over the parts that `labels` name, 0 to K − 1, given them: the Gaussians of the parts are drawn given the trees
/// and joints, and of each draw the exact probability of every edge and tree is taken (matrix-tree theorem).
///
/// # Errors
/// [`Rounding`].
pub(crate) fn tree_given(
    target: &Target,
    labels: &[usize],
    rng: &mut Stream,
) -> Result<TreePosterior, Rounding> {
    let mut chain = SplitMerge::start(target, labels, rng)?;
    let mut graphs = Vec::with_capacity(DRAWS);
    let mut trees: BTreeMap<Vec<(usize, usize)>, f64> = BTreeMap::new();
    for draw in 0..BURN_IN + DRAWS {
        chain.draw_gaussians_alone(rng)?;
        if draw >= BURN_IN {
            let graph = chain.graph()?;
            trees.insert(sorted(graph.draw_tree(rng)), 0.0);
            graphs.push(graph);
        }
    }
    let parts = labels.iter().max().map_or(0, |largest| largest + 1);
    assert_eq!(sizes(labels).len(), parts, "each label from 0 to K − 1 must occur");
    let mut probabilities = vec![0.0; parts * parts];
    for graph in &graphs {
        let own = graph.edge_probabilities();
        probabilities.iter_mut().zip(own).for_each(|(sum, probability)| *sum += probability / DRAWS as f64);
        let log_total = graph.log_sum();
        for (tree, sum) in &mut trees {
            let product: f64 = tree.iter().map(|&(i, j)| graph.log_weight(i, j)).sum();
            *sum += (product - log_total).exp() / DRAWS as f64;
        }
    }
    let pairs = (0..parts).flat_map(|i| (i + 1..parts).map(move |j| (i, j)));
    let edges = pairs.map(|(i, j)| (i, j, probabilities[i * parts + j])).collect();
    let likeliest = trees.into_iter().reduce(|kept, next| if next.1 > kept.1 { next } else { kept });
    let (tree, probability) = likeliest.expect("there are draws");
    Ok(TreePosterior { edges, tree, probability })
}

fn sorted(tree: Vec<(usize, usize)>) -> Vec<(usize, usize)> {
    let mut tree: Vec<(usize, usize)> = tree.into_iter().map(|(i, j)| (i.min(j), i.max(j))).collect();
    tree.sort_unstable();
    tree
}
