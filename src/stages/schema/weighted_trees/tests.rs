use std::collections::BTreeMap;

use rand::RngExt;

use super::*;
use crate::numerics::rng::{Stream, stream};
use crate::numerics::testing::{ALPHA, chi_squared};

/// All spanning trees of n nodes, by way of their Prüfer codes; edges have the larger node first and are sorted.
fn all_trees(n: usize) -> Vec<Vec<(usize, usize)>> {
    if n < 3 {
        return vec![(1..n).map(|node| (node, 0)).collect()];
    }
    let tree = |mut code: usize| {
        let sequence: Vec<usize> = (0..n - 2).map(|_| (code % n, code /= n).0).collect();
        let mut degree: Vec<usize> =
            (0..n).map(|node| 1 + sequence.iter().filter(|&&other| other == node).count()).collect();
        let mut edges = Vec::new();
        for &node in &sequence {
            let leaf = degree.iter().position(|&d| d == 1).unwrap();
            edges.push((leaf, node));
            degree[leaf] = 0;
            degree[node] -= 1;
        }
        let last: Vec<usize> = (0..n).filter(|&node| degree[node] == 1).collect();
        edges.push((last[0], last[1]));
        sorted(edges)
    };
    (0..n.pow(n as u32 - 2)).map(tree).collect()
}

fn sorted(edges: Vec<(usize, usize)>) -> Vec<(usize, usize)> {
    let mut edges: Vec<(usize, usize)> = edges.into_iter().map(|(i, j)| (i.max(j), i.min(j))).collect();
    edges.sort_unstable();
    edges
}

fn graph(nodes: usize, spread: f64, rng: &mut Stream) -> WeightedGraph {
    let Ok(graph) =
        WeightedGraph::new::<std::convert::Infallible>(nodes, |_, _| Ok(rng.random_range(-spread..=spread)));
    graph
}

fn log_product(graph: &WeightedGraph, tree: &[(usize, usize)]) -> f64 {
    tree.iter().map(|&(i, j)| graph.log_weight(i, j)).sum()
}

#[test]
fn the_sum_and_the_edges_agree_with_the_enumeration_of_all_trees_up_to_six_nodes() {
    let mut rng = stream(1, 1, "trees", 0);
    for nodes in 1..=6 {
        let trees = all_trees(nodes);
        for spread in [0.0, 2.0, 20.0, 500.0] {
            for _ in 0..5 {
                let graph = graph(nodes, spread, &mut rng);
                let products: Vec<f64> = trees.iter().map(|tree| log_product(&graph, tree)).collect();
                let expected = log_sum(products.iter().copied());
                assert!((graph.log_sum() - expected).abs() < 1e-10 * expected.abs().max(1.0));
                let probabilities = graph.edge_probabilities();
                for i in 0..nodes {
                    for j in 0..i {
                        let with = trees.iter().zip(&products).filter(|(tree, _)| tree.contains(&(i, j)));
                        let expected = (log_sum(with.map(|(_, product)| *product)) - expected).exp();
                        assert!((probabilities[i * nodes + j] - expected).abs() < 1e-9, "{nodes} {spread}");
                    }
                }
            }
        }
    }
}

#[test]
fn weights_that_no_float_holds_still_have_a_sum() {
    let pair = |i: usize, j: usize| if (i, j) == (1, 0) { 3000.0 } else { -3000.0 };
    let Ok(graph) = WeightedGraph::new::<std::convert::Infallible>(3, |i, j| Ok(pair(i, j)));
    // Of the three trees, two have the heavy edge: twice e^0.
    assert!((graph.log_sum() - 2f64.ln()).abs() < 1e-9);
    let probabilities = graph.edge_probabilities();
    assert!((probabilities[1] - 1.0).abs() < 1e-12 && (probabilities[2] - 0.5).abs() < 1e-12);
    let mut rng = stream(1, 1, "trees", 1);
    assert!((0..50).all(|_| sorted(graph.draw_tree(&mut rng)).contains(&(1, 0))));
}

/// Wilson's algorithm: loop-erased random walks to the tree.
fn wilson(graph: &WeightedGraph, rng: &mut Stream) -> Vec<(usize, usize)> {
    let mut next: Vec<Option<usize>> = vec![None; graph.nodes];
    let mut inside = vec![false; graph.nodes];
    inside[0] = true;
    for start in 1..graph.nodes {
        let mut at = start;
        while !inside[at] {
            let weights: Vec<f64> = (0..graph.nodes).map(|node| graph.log_weight(at, node)).collect();
            let to = draw(&weights, rng);
            next[at] = Some(to);
            at = to;
        }
        at = start;
        while !inside[at] {
            inside[at] = true;
            at = next[at].unwrap();
        }
    }
    sorted(next.into_iter().enumerate().filter_map(|(node, next)| Some((node, next?))).collect())
}

/// p value of a χ² test of drawn trees against their probabilities.
fn fit(
    trees: &[Vec<(usize, usize)>],
    expected: &[f64],
    mut draw: impl FnMut() -> Vec<(usize, usize)>,
) -> f64 {
    let mut counts: BTreeMap<Vec<(usize, usize)>, f64> = BTreeMap::new();
    (0..20_000).for_each(|_| *counts.entry(draw()).or_default() += 1.0);
    let counts: Vec<f64> = trees.iter().map(|tree| counts.get(tree).copied().unwrap_or(0.0)).collect();
    chi_squared(&counts, expected)
}

#[test]
fn drawn_trees_and_those_of_wilsons_algorithm_follow_the_product_of_weights() {
    let mut rng = stream(1, 1, "trees", 2);
    for nodes in 3..=6 {
        let trees = all_trees(nodes);
        let graph = graph(nodes, 1.5, &mut rng);
        let log_total = graph.log_sum();
        let expected: Vec<f64> =
            trees.iter().map(|tree| (log_product(&graph, tree) - log_total).exp()).collect();
        let mut walks = stream(1, 1, "trees", 3);
        assert!(fit(&trees, &expected, || sorted(graph.draw_tree(&mut rng))) > ALPHA, "{nodes} nodes");
        assert!(fit(&trees, &expected, || wilson(&graph, &mut walks)) > ALPHA, "Wilson, {nodes} nodes");
        // A twin that forgets one weight is rejected.
        let mut broken = graph.clone();
        broken.set(1, 0, graph.log_weight(1, 0) + 0.4);
        assert!(fit(&trees, &expected, || sorted(broken.draw_tree(&mut rng))) < ALPHA, "{nodes} nodes");
    }
}
