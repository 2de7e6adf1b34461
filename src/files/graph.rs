//! Write a tree of parts for programs that draw and analyse graphs: DOT (Graphviz) and GraphML.
//!
//! Edges have no direction, since no data tell which part is the root.

use std::fmt::Write;

/// A part of a tree.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    /// The number of the part.
    pub part: usize,
    /// How many sensors are on it.
    pub sensors: usize,
    /// The rank of its motion.
    pub rank: usize,
}

/// A joint of a tree.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Link {
    /// Both parts.
    pub parts: [usize; 2],
    /// Correlation of the joint's speed, 0 to 1.
    pub correlation: f64,
    /// Information of the joint, nats.
    pub information: f64,
    /// Bootstrap support, 0 to 1.
    pub support: f64,
}

/// In the language of Graphviz.
pub fn dot(nodes: &[Node], links: &[Link]) -> String {
    let mut text = "graph parts {\n".to_owned();
    for Node { part, sensors, rank } in nodes {
        let label = format!("part {part}\\n{sensors} sensors");
        add(&mut text, format_args!("  {part} [label=\"{label}\", sensors={sensors}, rank={rank}];\n"));
    }
    for Link { parts: [a, b], correlation, information, support } in links {
        let label = format!("{:.0} %", 100.0 * support);
        add(
            &mut text,
            format_args!(
                "  {a} -- {b} [label=\"{label}\", support={support}, correlation={correlation}, information={information}];\n"
            ),
        );
    }
    text + "}\n"
}

/// In GraphML, which networkx, igraph, Gephi and yEd read.
pub fn graphml(nodes: &[Node], links: &[Link]) -> String {
    let mut text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
                    <graphml xmlns=\"http://graphml.graphdrawing.org/xmlns\">\n"
        .to_owned();
    for (name, of, kind) in [
        ("sensors", "node", "int"),
        ("rank", "node", "int"),
        ("correlation", "edge", "double"),
        ("information", "edge", "double"),
        ("support", "edge", "double"),
    ] {
        add(
            &mut text,
            format_args!("  <key id=\"{name}\" for=\"{of}\" attr.name=\"{name}\" attr.type=\"{kind}\"/>\n"),
        );
    }
    text += "  <graph id=\"parts\" edgedefault=\"undirected\">\n";
    for Node { part, sensors, rank } in nodes {
        add(
            &mut text,
            format_args!(
                "    <node id=\"{part}\">{}{}</node>\n",
                data("sensors", sensors),
                data("rank", rank)
            ),
        );
    }
    for Link { parts: [a, b], correlation, information, support } in links {
        let all = [("correlation", correlation), ("information", information), ("support", support)];
        let all = all.map(|(key, value)| data(key, value)).concat();
        add(&mut text, format_args!("    <edge source=\"{a}\" target=\"{b}\">{all}</edge>\n"));
    }
    text + "  </graph>\n</graphml>\n"
}

fn data(key: &str, value: impl std::fmt::Display) -> String {
    format!("<data key=\"{key}\">{value}</data>")
}

fn add(text: &mut String, more: std::fmt::Arguments<'_>) {
    text.write_fmt(more).expect("text grows");
}

#[cfg(test)]
mod tests;
