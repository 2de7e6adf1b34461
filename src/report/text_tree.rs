//! Draw a tree of parts in plain text.

use std::collections::BTreeMap;

/// The lines of a tree. `edges` are pairs of nodes, each with a note; `name` gives the words for a node. The node with most
/// edges is the root, the first of equal ones; nodes that no edge reaches follow, each a line.
pub(crate) fn text_tree(
    nodes: usize,
    edges: &[(usize, usize, String)],
    name: &dyn Fn(usize) -> String,
) -> Vec<String> {
    let mut near: BTreeMap<usize, Vec<(usize, &str)>> = (0..nodes).map(|node| (node, Vec::new())).collect();
    for (a, b, note) in edges {
        near.entry(*a).or_default().push((*b, note));
        near.entry(*b).or_default().push((*a, note));
    }
    let mut lines = Vec::new();
    let mut left: Vec<usize> = (0..nodes).collect();
    // Sorting is stable: of equal ones the first stays first.
    left.sort_by_key(|node| std::cmp::Reverse(near[node].len()));
    while let Some(&root) = left.first() {
        lines.push(name(root));
        left.retain(|node| *node != root);
        branches(root, "", &near, name, &mut left, &mut lines);
    }
    lines
}

fn branches(
    node: usize,
    indent: &str,
    near: &BTreeMap<usize, Vec<(usize, &str)>>,
    name: &dyn Fn(usize) -> String,
    left: &mut Vec<usize>,
    lines: &mut Vec<String>,
) {
    let below: Vec<(usize, &str)> =
        near[&node].iter().copied().filter(|(other, _)| left.contains(other)).collect();
    left.retain(|other| !below.iter().any(|(child, _)| child == other));
    for (at, (child, note)) in below.iter().enumerate() {
        let last = at + 1 == below.len();
        lines.push(format!("{indent}{} {note} ─ {}", if last { "└─" } else { "├─" }, name(*child)));
        let deeper = format!("{indent}{}", if last { "   " } else { "│  " });
        branches(*child, &deeper, near, name, left, lines);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tree_hangs_from_the_node_with_most_edges() {
        let edges = [
            (0, 1, "99 %".to_owned()),
            (1, 2, "80 %".to_owned()),
            (1, 3, "70 %".to_owned()),
            (3, 4, "60 %".to_owned()),
        ];
        let found = text_tree(6, &edges, &|node| format!("part {node}"));
        let expected = [
            "part 1",
            "├─ 99 % ─ part 0",
            "├─ 80 % ─ part 2",
            "└─ 70 % ─ part 3",
            "   └─ 60 % ─ part 4",
            "part 5",
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn no_node_and_no_edge_are_no_error() {
        assert!(text_tree(0, &[], &|_| unreachable!()).is_empty());
        assert_eq!(text_tree(1, &[], &|_| "one".to_owned()), ["one"]);
    }
}
