//! Test the spanning tree of least weight against the enumeration of all trees.

use rand::RngExt;

use super::*;
use crate::numerics::rng::stream;

/// Least total weight over all spanning trees of n nodes, by way of their Prüfer codes.
fn least_by_enumeration(n: usize, weight: &dyn Fn(usize, usize) -> f64) -> f64 {
    let total = |mut code: usize| {
        let sequence: Vec<usize> = (0..n - 2).map(|_| (code % n, code /= n).0).collect();
        let mut degree: Vec<usize> =
            (0..n).map(|node| 1 + sequence.iter().filter(|&&other| other == node).count()).collect();
        let mut sum = 0.0;
        for &node in &sequence {
            let leaf = degree.iter().position(|&d| d == 1).unwrap();
            sum += weight(leaf, node);
            degree[leaf] = 0;
            degree[node] -= 1;
        }
        let last: Vec<usize> = (0..n).filter(|&node| degree[node] == 1).collect();
        sum + weight(last[0], last[1])
    };
    (0..n.pow(n as u32 - 2)).map(total).fold(f64::INFINITY, f64::min)
}

#[test]
fn agrees_with_the_enumeration_of_all_trees_up_to_six_nodes() {
    let mut rng = stream(1, 1, "prim", 0);
    for n in 3..=6 {
        for _ in 0..40 {
            let raw: Vec<f64> = (0..n * n).map(|_| rng.random_range(-1.0..1.0)).collect();
            let weight = |a: usize, b: usize| raw[a.min(b) * n + a.max(b)];
            let nodes: Vec<usize> = (0..n).collect();
            let tree = prim(&nodes, weight);
            let sum: f64 = tree.iter().map(|edge| weight(edge.child, edge.parent)).sum();
            assert_eq!(tree.len(), n - 1);
            assert!((sum - least_by_enumeration(n, &weight)).abs() < 1e-12, "n = {n}");
        }
    }
}

#[test]
fn one_node_and_none_have_no_edges() {
    assert!(prim(&[], |_, _| unreachable!()).is_empty());
    assert!(prim(&[3], |_, _| unreachable!()).is_empty());
}

#[test]
fn names_of_nodes_are_kept() {
    let position = |node: usize| [0.0, 9.0, 5.0, 0.0, 7.0][node];
    let tree = prim(&[4, 1, 2], |a, b| f64::abs(position(a) - position(b)));
    assert_eq!(tree, [Edge { child: 1, parent: 4 }, Edge { child: 2, parent: 4 }]);
}
