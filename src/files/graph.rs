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
mod tests {
    use super::*;

    fn tree() -> ([Node; 2], [Link; 1]) {
        let node = |part| Node { part, sensors: 40, rank: 6 };
        ([node(0), node(3)], [Link { parts: [0, 3], correlation: 0.998, information: 2.5, support: 1.0 }])
    }

    #[test]
    fn graphviz_has_all_parts_and_joints() {
        let (nodes, links) = tree();
        assert_eq!(
            dot(&nodes, &links),
            "graph parts {\n  0 [label=\"part 0\\n40 sensors\", sensors=40, rank=6];\n  \
             3 [label=\"part 3\\n40 sensors\", sensors=40, rank=6];\n  \
             0 -- 3 [label=\"100 %\", support=1, correlation=0.998, information=2.5];\n}\n"
        );
        assert_eq!(dot(&[], &[]), "graph parts {\n}\n");
    }

    #[test]
    fn graphml_is_sound_and_names_what_it_uses() {
        let (nodes, links) = tree();
        let text = graphml(&nodes, &links);
        let document = roxmltree::Document::parse(&text).unwrap();
        let named = |name: &str| {
            let space = "http://graphml.graphdrawing.org/xmlns";
            document.descendants().filter(|node| node.has_tag_name((space, name))).collect::<Vec<_>>()
        };
        let keys: Vec<_> = named("key").iter().filter_map(|key| key.attribute("id")).collect();
        assert!(named("data").iter().all(|data| keys.contains(&data.attribute("key").unwrap())));
        let ids: Vec<_> = named("node").iter().filter_map(|node| node.attribute("id")).collect();
        assert_eq!(ids, ["0", "3"]);
        let edge = named("edge")[0];
        assert_eq!((edge.attribute("source"), edge.attribute("target")), (Some("0"), Some("3")));
        assert!(text.contains("<data key=\"support\">1</data>"));
    }
}
