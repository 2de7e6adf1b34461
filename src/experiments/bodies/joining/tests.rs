//! Test neighbour joining on distances along trees.

use super::*;

/// Distances along a tree of edges of these lengths.
fn along(parts: usize, edges: &[(usize, usize, f64)]) -> DMatrix<f64> {
    let mut d = DMatrix::from_fn(parts, parts, |i, j| if i == j { 0.0 } else { 1e9 });
    for &(a, b, length) in edges {
        (d[(a, b)], d[(b, a)]) = (length, length);
    }
    for k in 0..parts {
        for i in 0..parts {
            for j in 0..parts {
                d[(i, j)] = f64::min(d[(i, j)], d[(i, k)] + d[(k, j)]);
            }
        }
    }
    d
}

#[test]
fn distances_along_a_tree_give_that_tree() {
    for edges in [
        vec![(0, 1, 1.0)],
        vec![(0, 1, 1.0), (1, 2, 0.5)],
        vec![(0, 1, 1.0), (0, 2, 2.0), (0, 3, 0.7), (0, 4, 1.5)],
        vec![(0, 1, 1.0), (1, 2, 0.3), (2, 3, 0.9), (3, 4, 0.4), (2, 5, 1.1)],
    ] {
        let parts = edges.len() + 1;
        let found = joined(&along(parts, &edges));
        let mut pairs: Vec<_> =
            found.iter().map(|edge| (edge.child.min(edge.parent), edge.child.max(edge.parent))).collect();
        pairs.sort_unstable();
        let mut expected: Vec<_> = edges.iter().map(|&(a, b, _)| (a, b)).collect();
        expected.sort_unstable();
        assert_eq!(pairs, expected);
    }
    assert_eq!(joined(&DMatrix::zeros(1, 1)), []);
}
