//! Test what is included and replicated, where messages say it is, and how text is read.

use std::fs;

use super::*;
use crate::files::import::document::place;

/// Writes files, and the text of the first one, written out.
fn of(files: &[(&str, &[u8])]) -> Result<String, Wrong> {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }
    let path = folder.path().join(files[0].0);
    written_out(&path, &Located::beside(&path))
}

/// Name and place of all elements.
fn elements(text: &str) -> Vec<(String, String)> {
    let document = parsed(text).unwrap();
    let elements = document.descendants().filter(Node::is_element);
    elements
        .map(|node| (node.attribute("name").unwrap_or(node.tag_name().name()).to_owned(), place(node)))
        .collect()
}

#[test]
fn files_are_included_at_any_depth_and_messages_name_their_lines() {
    let text = of(&[
        (
            "m.xml",
            b"<mujoco>\n<body name='a'>\n<include file='sub/b.xml'/>\n<body name='d'/></body>\n</mujoco>",
        ),
        (
            "sub/b.xml",
            b"<mujocoinclude>\n\n<body name='b'/><include file='c.xml'/>\n<body name='e'/></mujocoinclude>",
        ),
        ("c.xml", b"<mujoco>\n<body\nname='c'/></mujoco>"),
    ])
    .unwrap();
    let found = elements(&text);
    let expected = [
        ("mujoco", "line 1"),
        ("a", "line 2"),
        ("b", "b.xml line 3"),
        ("c", "c.xml line 2"),
        ("e", "b.xml line 4"),
        ("d", "m.xml line 4"),
    ];
    assert_eq!(found, expected.map(|(name, place)| (name.to_owned(), place.to_owned())));
}

#[test]
fn loops_and_files_that_are_not_there_are_refused() {
    let loops = of(&[
        ("m.xml", b"<mujoco><include file='b.xml'/></mujoco>"),
        ("b.xml", b"<mujoco>\n<include file='m.xml'/></mujoco>"),
    ]);
    assert_eq!(
        loops.unwrap_err(),
        "b.xml: line 2: include names `m.xml`, which includes this file in turn; remove one of them"
    );
    let gone = of(&[("m.xml", b"<mujoco><include file='b.xml'/></mujoco>")]);
    assert_eq!(gone.unwrap_err(), "line 1: include names `b.xml`, which is not there");
    let cut = of(&[("m.xml", b"<mujoco><include file='b.xml'/></mujoco>"), ("b.xml", b"<mujoco>")]);
    assert!(cut.unwrap_err().starts_with("b.xml: this is not well-formed XML"));
    let entity = of(&[
        ("m.xml", b"<mujoco><include file='b.xml'/></mujoco>"),
        ("b.xml", b"<!DOCTYPE f [<!ENTITY x '<a/>'>]><f><b/>&x;</f>"),
    ]);
    assert_eq!(entity.unwrap_err(), "line 1: f contains entities that stand for elements; write them out");
    // Each file includes the next one twice: more than can be read.
    let names: Vec<String> = (0..40).map(|at| format!("{at}.xml")).collect();
    let texts: Vec<String> = (1..41)
        .map(|at| {
            format!(
                "<mujoco>{}<body name='{}'/></mujoco>",
                format!("<include file='{at}.xml'/>").repeat(if at < 40 { 2 } else { 0 }),
                "x".repeat(1000)
            )
        })
        .collect();
    let files: Vec<(&str, &[u8])> =
        names.iter().zip(&texts).map(|(name, text)| (&**name, text.as_bytes())).collect();
    let many = of(&files).unwrap_err();
    assert!(many.contains("includes and replicates"), "{many}");
}

#[test]
fn copies_are_each_in_the_frame_of_the_one_before() {
    let text = of(&[(
        "m.xml",
        b"<mujoco><replicate count='3' offset='1 0 0' euler='0 0 90' sep='-'><body name='leg'><geom/></body></replicate><body/></mujoco>",
    )])
    .unwrap();
    let document = parsed(&text).unwrap();
    let legs: Vec<_> = document.descendants().filter(|node| node.attribute("name").is_some()).collect();
    assert_eq!(
        legs.iter().map(|leg| leg.attribute("name").unwrap()).collect::<Vec<_>>(),
        ["leg-0", "leg-1", "leg-2"]
    );
    let frames = |node: &Node| node.ancestors().filter(|node| node.has_tag_name("frame")).count();
    assert_eq!(legs.iter().map(frames).collect::<Vec<_>>(), [0, 1, 2]);
    let frame = document.descendants().find(|node| node.has_tag_name("frame")).unwrap();
    assert_eq!((frame.attribute("pos"), frame.attribute("euler")), (Some("1 0 0"), Some("0 0 90")));
    for (count, expected) in
        [("0", "has count 0"), ("2.5", "has count 2.5"), ("1e9", "has count 1000000000, which must be 1 to")]
    {
        let text = format!("<mujoco><replicate count='{count}'/></mujoco>");
        assert!(of(&[("m.xml", text.as_bytes())]).unwrap_err().contains(expected), "{count}");
    }
}

#[test]
fn old_encodings_and_comments_before_the_declaration_are_read() {
    let name = |bytes: &[u8]| elements(&of(&[("m.urdf", bytes)]).unwrap())[0].clone();
    assert_eq!(
        name(b"<!-- by hand\n-->\n<?xml version='1.0'?>\n<robot name='r'/>"),
        ("r".to_owned(), "line 4".to_owned())
    );
    assert_eq!(name(b"\n<?xml version='1.0'?>\n<robot name='r'/>").1, "line 3");
    assert_eq!(name(b"\xef\xbb\xbf<?xml version='1.0'?><robot name='r'/>").0, "r");
    assert_eq!(
        name(b"<?xml version='1.0' encoding='ISO-8859-1'?><robot name='m\xfcller'/>").0,
        "m\u{fc}ller"
    );
    assert_eq!(name(b"<!DOCTYPE robot [<!ENTITY n 'x'>]><robot name='&n;'/>").0, "x");
}

#[test]
fn a_prefix_that_is_not_declared_is_no_mistake() {
    let text = of(&[("m.urdf", b"<robot name='r'><s:camera t:a='1'/><link name='l'/><s:b>x</s:b></robot>")])
        .unwrap();
    let names: Vec<String> = elements(&text).into_iter().map(|(name, _)| name).collect();
    assert_eq!(names, ["r", "s.camera", "l", "s.b"]);
    let declared = "<robot name='r' xmlns:s='a'><s:camera/></robot>";
    assert_eq!(of(&[("m.urdf", declared.as_bytes())]).unwrap(), declared);
    let many = (0..100).map(|at| format!("<p{at}:a/>")).collect::<String>();
    assert!(of(&[("m.xml", format!("<mujoco>{many}</mujoco>").as_bytes())]).unwrap_err().contains("prefix"));
}
