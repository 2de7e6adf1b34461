//! Sum over all spanning trees of a weighted graph, the probability of each edge, and exact draws of a tree.
//!
//! A tree has the probability ∏ w_e / Z, Z the sum of these products over all spanning trees (Kirchhoff's matrix-tree
//! theorem). Weights are densities, e^±500 apart, so nothing here subtracts, and all sums are of logarithms: nodes are
//! eliminated one after the other. Node v with the weights w_v1, w_v2, …, of sum S, leaves
//!
//! w'_ij = w_ij + w_vi w_vj / S, and Z = S Z'.
//!
//! Wilson's algorithm (1996) draws from the same distribution by random walks. Between two nodes that are joined by a
//! weight e^500 times as large as all others, such a walk does not end in anybody's lifetime. So trees are drawn by the
//! elimination, backwards: an edge of a tree without v is an edge of the graph or a way by way of v, in proportion to the
//! two terms of w'_ij. Without the ways, the tree falls into parts, and v is joined to one node of each, in proportion to
//! w_vj.

use rand::{Rng, RngExt};

use crate::numerics::log_sum::log_sum;

/// A complete graph with a weight for each pair of nodes.
#[derive(Debug, Clone)]
pub struct WeightedGraph {
    nodes: usize,
    /// log w_ij, symmetric, by rows.
    log_weights: Vec<f64>,
}

/// What is left of the graph after each elimination.
struct Elimination {
    /// Log weights before node n − 1, n − 2, …, 1 was eliminated.
    before: Vec<WeightedGraph>,
    /// log S of each of them.
    log_sums: Vec<f64>,
}

impl WeightedGraph {
    /// A graph of `nodes` nodes; `log_weight(i, j)` is asked once for each pair, i > j, and must be finite.
    ///
    /// # Errors
    /// That of the first weight that cannot be computed.
    pub fn new<E>(
        nodes: usize,
        mut log_weight: impl FnMut(usize, usize) -> Result<f64, E>,
    ) -> Result<Self, E> {
        let mut graph = Self { nodes, log_weights: vec![f64::NEG_INFINITY; nodes * nodes] };
        for i in 0..nodes {
            for j in 0..i {
                graph.set(i, j, log_weight(i, j)?);
            }
        }
        Ok(graph)
    }

    /// log w_ij.
    pub fn log_weight(&self, i: usize, j: usize) -> f64 {
        self.log_weights[i * self.nodes + j]
    }

    fn set(&mut self, i: usize, j: usize, log_weight: f64) {
        self.log_weights[i * self.nodes + j] = log_weight;
        self.log_weights[j * self.nodes + i] = log_weight;
    }

    /// log Z. A single node has one tree, without edges: 0.
    pub fn log_sum(&self) -> f64 {
        self.eliminate().log_sums.iter().sum()
    }

    /// Eliminates all nodes but the first.
    fn eliminate(&self) -> Elimination {
        let (mut before, mut log_sums) = (Vec::new(), Vec::new());
        let mut graph = self.clone();
        while graph.nodes > 1 {
            let (less, log_sum) = graph.without_last();
            before.push(graph);
            log_sums.push(log_sum);
            graph = less;
        }
        Elimination { before, log_sums }
    }

    /// The graph with its last node eliminated, and log S of that node.
    fn without_last(&self) -> (Self, f64) {
        let last = self.nodes - 1;
        let log_total = log_sum((0..last).map(|j| self.log_weight(last, j)));
        let through = |i: usize, j: usize| self.log_weight(last, i) + self.log_weight(last, j) - log_total;
        let less = Self::new::<std::convert::Infallible>(last, |i, j| {
            Ok(log_sum([self.log_weight(i, j), through(i, j)].into_iter()))
        });
        let Ok(less) = less;
        (less, log_total)
    }

    /// Probability of each edge, of i and j at i × nodes + j: w_ij over the conductance between i and j.
    pub fn edge_probabilities(&self) -> Vec<f64> {
        let mut probabilities = vec![0.0; self.nodes * self.nodes];
        for i in 0..self.nodes {
            for j in 0..i {
                let mut order = vec![i, j];
                order.extend((0..self.nodes).filter(|node| *node != i && *node != j));
                let mut graph = self.renamed(&order);
                while graph.nodes > 2 {
                    graph = graph.without_last().0;
                }
                let probability = (self.log_weight(i, j) - graph.log_weight(0, 1)).exp();
                probabilities[i * self.nodes + j] = probability;
                probabilities[j * self.nodes + i] = probability;
            }
        }
        probabilities
    }

    /// The same graph, its nodes in another order.
    fn renamed(&self, order: &[usize]) -> Self {
        let graph =
            Self::new::<std::convert::Infallible>(self.nodes, |i, j| Ok(self.log_weight(order[i], order[j])));
        let Ok(graph) = graph;
        graph
    }

    /// Draws a spanning tree: pairs of nodes.
    pub fn draw_tree(&self, rng: &mut impl Rng) -> Vec<(usize, usize)> {
        let mut tree: Vec<(usize, usize)> = Vec::with_capacity(self.nodes.saturating_sub(1));
        let Elimination { before, log_sums } = self.eliminate();
        for (graph, log_total) in before.iter().zip(log_sums).rev() {
            let last = graph.nodes - 1;
            tree.retain(|&(i, j)| {
                let direct = graph.log_weight(i, j);
                let through = graph.log_weight(last, i) + graph.log_weight(last, j) - log_total;
                rng.random::<f64>() < 1.0 / (1.0 + (through - direct).exp())
            });
            for part in parts(last, &tree) {
                let log_weights: Vec<f64> = part.iter().map(|&node| graph.log_weight(last, node)).collect();
                tree.push((last, part[draw(&log_weights, rng)]));
            }
        }
        tree
    }
}

/// Draws a number in proportion to e^`log_weights`.
fn draw(log_weights: &[f64], rng: &mut impl Rng) -> usize {
    let largest = log_weights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let weights: Vec<f64> = log_weights.iter().map(|weight| (weight - largest).exp()).collect();
    let mut threshold = rng.random::<f64>() * weights.iter().sum::<f64>();
    for (at, weight) in weights.iter().enumerate() {
        threshold -= weight;
        if threshold < 0.0 {
            return at;
        }
    }
    weights.len() - 1
}

/// The connected parts of a forest over the nodes 0 to `nodes` − 1, in order of their first nodes.
fn parts(nodes: usize, edges: &[(usize, usize)]) -> Vec<Vec<usize>> {
    let mut part: Vec<usize> = (0..nodes).collect();
    for &(i, j) in edges {
        let (kept, lost) = (part[i].min(part[j]), part[i].max(part[j]));
        part.iter_mut().filter(|of| **of == lost).for_each(|of| *of = kept);
    }
    let mut parts = vec![Vec::new(); nodes];
    part.iter().enumerate().for_each(|(node, &of)| parts[of].push(node));
    parts.retain(|part| !part.is_empty());
    parts
}

#[cfg(test)]
mod tests;
