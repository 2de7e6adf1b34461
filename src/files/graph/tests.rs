//! Test trees as graph programs read them.

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
