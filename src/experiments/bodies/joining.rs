//! A tree over parts by neighbour joining (Saitou and Nei 1987).
//!
//! Neighbour joining puts all parts at the ends of a tree with latent nodes between them. So, shortest first, edges are contracted, as
//! Choi, Tan, Anandkumar and Willsky (2011) do with short ones, unless that would merge two parts. Each latent node is then one with a part.

use nalgebra::DMatrix;

use crate::stages::joints::Joints;
use crate::stages::tree::Edge;

/// Correlation below which two parts have nothing in common.
const LEAST: f64 = 1e-6;

/// The tree over estimated parts, whose distances are −ln r for the correlation r of the speeds of their joint. Labels are 0, 1, ….
pub(super) fn tree(joints: &Joints) -> Vec<Edge> {
    let parts = joints.ranks.len();
    let mut distances = DMatrix::zeros(parts, parts);
    for pair in &joints.pairs {
        let distance = -f64::max(pair.correlation, LEAST).ln();
        (distances[(pair.part, pair.other)], distances[(pair.other, pair.part)]) = (distance, distance);
    }
    joined(&distances)
}

/// The tree over parts with these distances between them, parts × parts, symmetric and finite.
fn joined(distances: &DMatrix<f64>) -> Vec<Edge> {
    let parts = distances.nrows();
    let mut edges = with_latent_nodes(distances);
    edges.sort_by(|a, b| a.2.total_cmp(&b.2));
    // A node for each component, and the part that the component has, if any, by this node.
    let mut component: Vec<usize> = (0..2 * parts).collect();
    let mut part: Vec<Option<usize>> = (0..2 * parts).map(|node| (node < parts).then_some(node)).collect();
    let mut kept = Vec::new();
    for (a, b, length) in edges {
        let (from, to) = (component[a], component[b]);
        if part[from].is_some() && part[to].is_some() {
            kept.push((a, b, length));
            continue;
        }
        part[to] = part[to].or(part[from]);
        component.iter_mut().filter(|own| **own == from).for_each(|own| *own = to);
    }
    let of = |node: usize| part[component[node]].expect("no component is left without a part");
    kept.into_iter().map(|(a, b, _)| Edge { child: of(a), parent: of(b) }).collect()
}

/// The edges between parts and latent nodes, whose numbers follow on those of parts, with their lengths.
fn with_latent_nodes(distances: &DMatrix<f64>) -> Vec<(usize, usize, f64)> {
    let parts = distances.nrows();
    let mut nodes: Vec<usize> = (0..parts).collect();
    let mut d = distances.clone();
    let mut edges = Vec::new();
    for new in parts.. {
        let n = nodes.len();
        if n < 3 {
            break;
        }
        let sums: Vec<f64> = (0..n).map(|i| d.row(i).sum()).collect();
        let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
        let cost = |&(i, j): &(usize, usize)| (n - 2) as f64 * d[(i, j)] - sums[i] - sums[j];
        let best = pairs.reduce(|best, other| if cost(&other) < cost(&best) { other } else { best });
        let (i, j) = best.expect("there are three nodes");
        let to_first = 0.5 * (d[(i, j)] + (sums[i] - sums[j]) / (n - 2) as f64);
        edges.push((nodes[i], new, to_first));
        edges.push((nodes[j], new, d[(i, j)] - to_first));
        // The new node takes the place of the first, and the second goes.
        for k in (0..n).filter(|&k| k != i && k != j) {
            let distance = 0.5 * (d[(i, k)] + d[(j, k)] - d[(i, j)]);
            (d[(i, k)], d[(k, i)]) = (distance, distance);
        }
        nodes[i] = new;
        nodes.remove(j);
        d = d.remove_row(j).remove_column(j);
    }
    if let [a, b] = nodes[..] {
        edges.push((a, b, d[(0, 1)]));
    }
    edges
}

#[cfg(test)]
mod tests;
