//! Test which parts and joints links become.

use std::f64::consts::FRAC_1_SQRT_2;

use nalgebra::Isometry3;

use super::*;
use crate::files::import::placed::Solid;
use crate::stages::agent::Shape;

/// A link at a height of one tenth of its place; a sphere for each of `solids`.
fn link(name: &str, parent: Option<usize>, turns: &[Turn], solids: usize) -> Link {
    let origin = Column::new(0.0, 0.0, 0.1);
    let solid = |at: usize| Solid {
        shape: Shape::Sphere { radius: 0.1 },
        pose: Isometry3::translation(0.0, 0.0, at as f64),
        density: None,
    };
    let solids = (0..solids).map(solid).collect();
    Link { name: name.to_owned(), parent, origin, turns: turns.to_vec(), solids }
}

fn hinge(axis: Vector3) -> Turn {
    Turn::Hinge { anchor: Column::new(1.0, 2.0, 3.0), axis: Column::from(axis) }
}

const X: Vector3 = [1.0, 0.0, 0.0];
const Y: Vector3 = [0.0, 1.0, 0.0];
const Z: Vector3 = [0.0, 0.0, 1.0];
const FIXED: [Turn; 0] = [];

type Row = (String, Option<String>, Option<JointName>);

/// Name, parent and joint of each part.
fn rows(links: &[Link]) -> Vec<Row> {
    let parts = joined("link", links).unwrap().0;
    parts.into_iter().map(|part| (part.name, part.parent, part.joint)).collect()
}

fn row(name: &str, parent: &str, joint: JointName) -> Row {
    (name.to_owned(), Some(parent.to_owned()), Some(joint))
}

fn root(name: &str) -> Row {
    (name.to_owned(), None, None)
}

/// The part of a link on another one with these turns, and the notes.
fn turned(turns: &[Turn]) -> Result<(PartEntry, Vec<String>), Wrong> {
    let (mut parts, notes) = joined("link", &[link("a", None, &[], 1), link("b", Some(0), turns, 1)])?;
    Ok((parts.pop().unwrap(), notes))
}

#[test]
fn hinges_at_one_place_become_one_joint() {
    let (part, notes) = turned(&[hinge(X)]).unwrap();
    assert_eq!(
        (part.joint, part.anchor, part.axes),
        (Some(JointName::Hinge), Some([1.0, 2.0, 3.0]), Some(vec![X]))
    );
    assert!(notes.is_empty());
    let (part, notes) = turned(&[hinge(Z), hinge(X)]).unwrap();
    assert_eq!((part.joint, part.axes), (Some(JointName::Universal), Some(vec![Z, X])));
    assert!(notes.is_empty());
    // The second axis is turned within the plane of both.
    let (part, notes) = turned(&[hinge(X), hinge([FRAC_1_SQRT_2, 0.0, FRAC_1_SQRT_2])]).unwrap();
    assert_eq!((part.joint, part.axes), (Some(JointName::Universal), Some(vec![X, Z])));
    assert!(notes[0].starts_with("link `b`: its two hinges are at 45.0 degrees"), "{notes:?}");
    let (part, notes) = turned(&[hinge(X), hinge([-1.0, 0.0, 0.0])]).unwrap();
    assert_eq!((part.joint, part.axes), (Some(JointName::Hinge), Some(vec![X])));
    assert!(notes[0].contains("have the same axis"), "{notes:?}");
    let (part, notes) = turned(&[hinge(X), hinge(X), hinge(X)]).unwrap();
    assert_eq!((part.joint, part.axes), (Some(JointName::Hinge), Some(vec![X])));
    assert!(notes[0].contains("its 3 hinges have the same axis"), "{notes:?}");
    let (part, notes) = turned(&[hinge(X), hinge(Y), hinge(Z)]).unwrap();
    assert_eq!((part.joint, part.anchor, part.axes), (Some(JointName::Ball), Some([1.0, 2.0, 3.0]), None));
    assert!(notes[0].contains("its 3 joints at one place became a ball joint"), "{notes:?}");
    let ball = Turn::Ball { anchor: Column::new(1.0, 2.0, 3.0) };
    let (part, notes) = turned(std::slice::from_ref(&ball)).unwrap();
    assert_eq!((part.joint, notes.len()), (Some(JointName::Ball), 0));
    let (part, notes) = turned(&[ball, hinge(X)]).unwrap();
    assert_eq!((part.joint, notes.len()), (Some(JointName::Ball), 1));
}

#[test]
fn joints_that_a_body_has_not_are_refused() {
    let near = |by: f64| Turn::Hinge { anchor: Column::new(1.0, 2.0, 3.0 + by), axis: Column::from(Y) };
    assert!(turned(&[hinge(X), near(9e-7)]).is_ok());
    let message = turned(&[hinge(X), near(1.1e-6)]).unwrap_err();
    assert!(message.starts_with("link `b`: it rotates about 2 points of its parent; give"), "{message}");
    let message = turned(&[Turn::Other("slide")]).unwrap_err();
    assert_eq!(message, "link `b`: its joint is `slide`, which is not supported; make it a hinge, or fix it");
}

#[test]
fn further_solids_and_fixed_links_are_fixed_parts() {
    let links = [
        link("a", None, &[], 3),
        link("b", Some(0), &[hinge(X)], 1),
        link("c", Some(0), &FIXED, 1),
        link("d", Some(2), &[hinge(Y)], 1),
        link("e", Some(2), &FIXED, 2),
    ];
    let expected = [
        root("a"),
        row("a/2", "a", JointName::Fixed),
        row("a/3", "a", JointName::Fixed),
        row("c", "a", JointName::Fixed),
        row("e", "c", JointName::Fixed),
        row("e/2", "e", JointName::Fixed),
        row("b", "a", JointName::Hinge),
        row("d", "c", JointName::Hinge),
    ];
    assert_eq!(rows(&links), expected);
    let parts = joined("link", &links).unwrap().0;
    assert_eq!(parts[3].anchor, Some([0.0, 0.0, 0.1]), "the origin of the link");
}

#[test]
fn links_without_shape_go_to_what_they_are_on() {
    // Between two links, fixed on one side, with a leaf and joints that matter to nothing.
    let links = [
        link("a", None, &[], 1),
        link("v", Some(0), &[hinge(X)], 0),
        link("w", Some(1), &FIXED, 0),
        link("b", Some(2), &[hinge(Y)], 1),
        link("leaf", Some(3), &[Turn::Other("slide")], 0),
        link("frame", Some(0), &FIXED, 0),
        link("c", Some(5), &[hinge(Z)], 1),
    ];
    let expected = [root("a"), row("b", "a", JointName::Universal), row("c", "a", JointName::Hinge)];
    assert_eq!(rows(&links), expected);
    let axes = joined("link", &links).unwrap().0.remove(1).axes;
    assert_eq!(axes, Some(vec![X, Y]), "from the parent on");
    // What is fixed to a link without shape takes its place, even if it comes later.
    let links = [
        link("a", None, &[], 1),
        link("v", Some(0), &[hinge(X)], 0),
        link("b", Some(1), &[hinge(Y)], 1),
        link("c", Some(1), &FIXED, 1),
        link("d", Some(1), &FIXED, 1),
    ];
    let expected = [
        root("a"),
        row("c", "a", JointName::Hinge),
        row("d", "c", JointName::Fixed),
        row("b", "c", JointName::Hinge),
    ];
    assert_eq!(rows(&links), expected);
    // Two that turn on it would turn as one if they went to its parent.
    let links = [&links[..3], &[link("c", Some(1), &[hinge(Z)], 1)]].concat();
    let message = joined("link", &links).unwrap_err();
    assert!(
        message.starts_with("link `v` has no shape, but `b` and `c` rotate on it; give it a shape"),
        "{message}"
    );
}

#[test]
fn the_root_is_the_first_that_has_a_shape() {
    let links = [
        link("world", None, &[], 0),
        link("base", Some(0), &[Turn::Other("floating")], 0),
        link("a", Some(1), &FIXED, 1),
        link("b", Some(2), &[hinge(X)], 1),
    ];
    assert_eq!(rows(&links), [root("a"), row("b", "a", JointName::Hinge)]);
    assert!(joined("link", &links).unwrap().1.is_empty());
    // Joints with the world, as of a leg that is held in a plane.
    let links = [link("a", None, &[Turn::Other("slide"), hinge(Y)], 1)];
    let (parts, notes) = joined("body", &links).unwrap();
    assert_eq!(
        (parts[0].joint, &notes[..]),
        (None, &["body `a` is the root: its joints with the world are ignored".to_owned()][..])
    );
    let links =
        [link("world", None, &[], 0), link("a", Some(0), &[hinge(X)], 1), link("b", Some(0), &[hinge(X)], 1)];
    let message = joined("link", &links).unwrap_err();
    assert!(message.starts_with("link `world` has no shape, but `a` and `b` rotate on it"), "{message}");
}

#[test]
fn there_is_one_body() {
    let links = [
        link("floor", None, &[], 0),
        link("a", None, &[], 1),
        link("b", None, &[Turn::Other("free")], 0),
        link("c", Some(2), &[hinge(X)], 1),
    ];
    let message = joined("body", &links).unwrap_err();
    assert_eq!(message, "`a` and `b` are two bodies without a joint between them; keep one");
    let message = joined("body", &[link("a", None, &[], 0)]).unwrap_err();
    assert_eq!(message, "no body has a shape; give it a box, sphere, cylinder or capsule");
}
