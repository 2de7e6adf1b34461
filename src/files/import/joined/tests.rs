//! Test which parts and joints links become.

use std::f64::consts::FRAC_1_SQRT_2;

use nalgebra::{Isometry3, Vector3 as Column};

use super::*;
use crate::files::import::joints::BETWEEN;
use crate::files::import::placed::Turn;
use crate::stages::agent::{Shape, Vector3};

/// A link at a height of one tenth of its place; a sphere for each of `solids`.
fn link(name: &str, parent: Option<usize>, turns: &[Turn], solids: usize) -> Link {
    let origin = Column::new(0.0, 0.0, 0.1);
    let solid =
        |at: usize| Solid::new(Shape::Sphere { radius: 0.1 }, Isometry3::translation(0.0, 0.0, at as f64));
    let solids = (0..solids).map(solid).collect();
    Link { name: name.to_owned(), parent, origin, turns: turns.to_vec(), solids, ..Link::default() }
}

fn hinge(axis: Vector3) -> Turn {
    Turn::Hinge { anchor: Column::new(1.0, 2.0, 3.0), axis: Column::from(axis) }
}

const X: Vector3 = [1.0, 0.0, 0.0];
const Y: Vector3 = [0.0, 1.0, 0.0];
const Z: Vector3 = [0.0, 0.0, 1.0];
const FIXED: [Turn; 0] = [];

fn joined(word: &str, links: &[Link]) -> Result<(Vec<PartEntry>, Vec<String>), Wrong> {
    let Joined { parts, notes, .. } = super::joined(word, links.to_vec(), &Options::default())?;
    Ok((parts, notes))
}

/// The same, with what a body cannot have refused.
fn strictly(word: &str, links: &[Link]) -> Wrong {
    super::joined(word, links.to_vec(), &Options { strict: true, ..Options::default() }).unwrap_err()
}

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
    // An angle that was written as 1.57 is a right one.
    let (part, notes) = turned(&[hinge(X), hinge([8e-4, 0.0, (1.0 - 64e-8_f64).sqrt()])]).unwrap();
    assert_eq!((part.joint, part.axes, notes.len()), (Some(JointName::Universal), Some(vec![X, Z]), 0));
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

/// Links `a` and `b`, which turns on it.
fn pair(turns: &[Turn]) -> [Link; 2] {
    [link("a", None, &[], 1), link("b", Some(0), turns, 1)]
}

#[test]
fn joints_that_a_body_has_not_are_changed_with_a_note_or_refused() {
    let near = |by: f64| Turn::Hinge { anchor: Column::new(1.0, 2.0, 3.0 + by), axis: Column::from(Y) };
    let (part, notes) = turned(&[hinge(X), near(9e-7)]).unwrap();
    assert_eq!((part.anchor, notes.len()), (Some([1.0, 2.0, 3.0]), 0));
    // Up to 5 cm from the mean place they are one joint there.
    let (part, notes) = turned(&[hinge(X), near(0.08)]).unwrap();
    assert_eq!((part.joint, part.anchor), (Some(JointName::Universal), Some([1.0, 2.0, 3.04])));
    assert_eq!(notes, ["link `b`: its 2 joints, up to 4.0 cm from their mean place, became one joint there"]);
    let message = strictly("link", &pair(&[hinge(X), near(0.08)]));
    assert!(message.starts_with("link `b`: it rotates about 2 points of its parent; give"), "{message}");

    let slide = [Turn::Other("slide"), hinge(Z)];
    let (part, notes) = turned(&slide).unwrap();
    assert_eq!((part.joint, part.axes), (Some(JointName::Hinge), Some(vec![Z])));
    assert_eq!(notes, ["joints that do not turn are held at their rest place (1): b (slide)"]);
    assert_eq!(turned(&slide[..1]).unwrap().0.joint, Some(JointName::Fixed));
    let message = strictly("link", &pair(&slide));
    assert_eq!(message, "link `b`: its joint is `slide`, which is not supported; make it a hinge, or fix it");
}

#[test]
fn between_places_far_apart_is_a_ball_without_skin() {
    let far = Turn::Hinge { anchor: Column::new(1.0, 2.0, 3.4), axis: Column::from(Y) };
    let (parts, notes) = joined("link", &pair(&[hinge(X), hinge(Z), far])).unwrap();
    let [_, ball, b] = &parts[..] else { panic!("{parts:?}") };
    assert_eq!((ball.name.as_str(), ball.parent.as_deref()), ("b/joint-1", Some("a")));
    assert_eq!((ball.joint, ball.anchor), (Some(JointName::Universal), Some([1.0, 2.0, 3.0])));
    assert_eq!((ball.centre, ball.skin.and_then(|skin| skin.sensors)), (Some([1.0, 2.0, 3.2]), Some(0)));
    assert_eq!(
        (b.parent.as_deref(), b.joint, b.anchor),
        (Some("b/joint-1"), Some(JointName::Hinge), Some([1.0, 2.0, 3.4]))
    );
    assert!(notes[0].contains("it rotates about 2 places of its parent"), "{notes:?}");
    let mass = |part: &PartEntry| part.density.unwrap() * part.radius.unwrap().powi(3);
    let link_mass = 1000.0 * 0.1_f64.powi(3);
    assert!((mass(ball) / link_mass - BETWEEN).abs() < 1e-9);
    // In truth the ball is no part, since nothing is felt on it.
    let file =
        crate::files::body::BodyFile { parts, skin: Some(Options::default().skin), ..Default::default() };
    assert_eq!(file.body().unwrap().agent.truth().tree, [(2, 0)]);
}

#[test]
fn the_mass_of_what_has_no_shape_goes_to_what_carries_it() {
    let mut links = [
        link("world", None, &[], 0),
        link("a", Some(0), &FIXED, 2),
        link("motor", Some(1), &FIXED, 0),
        link("rotor", Some(1), &[hinge(X)], 0),
        link("b", Some(1), &[hinge(X)], 1),
    ];
    links
        .iter_mut()
        .enumerate()
        .for_each(|(at, link)| link.bare_mass = if link.solids.is_empty() { 1.0 + at as f64 } else { 0.0 });
    let one = 1000.0 * 4.0 / 3.0 * std::f64::consts::PI * 0.001;
    let parts = joined("link", &links).unwrap().0;
    let mass = |part: &PartEntry| part.density.unwrap_or(1000.0) * one / 1000.0;
    let masses: Vec<f64> = parts.iter().map(mass).collect();
    for (found, expected) in masses.iter().zip([one + 4.0, one + 4.0, one]) {
        assert!(
            (found - expected).abs() < 1e-6,
            "{masses:?}: of the world 1, the motor 3, the rotor 4 kg, by volume"
        );
    }
    // A heavy link with a tiny shape is as dense as the rigid body that it is part of.
    let mut links = [link("a", None, &[], 1), link("b", Some(0), &FIXED, 1)];
    links[1].solids[0].shape = Shape::Sphere { radius: 0.002 };
    links[1].solids[0].mass = Some(100.0);
    let densities =
        joined("link", &links).unwrap().0.iter().map(|part| part.density.unwrap()).collect::<Vec<_>>();
    assert!((densities[0] / densities[1] - 1.0).abs() < 1e-9 && densities[0] > 20_000.0, "{densities:?}");
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
    // Two that turn on it would turn as one if they went to its parent: so it is a ball without skin.
    let links = [&links[..3], &[link("c", Some(1), &[hinge(Z)], 1)]].concat();
    let expected = [
        root("a"),
        row("v", "a", JointName::Hinge),
        row("b", "v", JointName::Hinge),
        row("c", "v", JointName::Hinge),
    ];
    assert_eq!(rows(&links), expected);
    let (parts, notes) = joined("link", &links).unwrap();
    assert_eq!((parts[1].radius, parts[1].skin.and_then(|skin| skin.sensors)), (Some(0.01), Some(0)));
    assert_eq!(
        notes,
        ["what has no shape, but carries several that rotate on it, became a ball without skin (1): v"]
    );
    let message = strictly("link", &links);
    assert!(message.starts_with("link `v` has no shape, but several others rotate on it"), "{message}");
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
    assert_eq!(
        rows(&links),
        [root("world"), row("a", "world", JointName::Hinge), row("b", "world", JointName::Hinge)]
    );
}

#[test]
fn the_body_is_the_largest_tree_or_that_of_a_name() {
    let links = [
        link("floor", None, &[], 0),
        link("target", None, &[], 1),
        link("b", None, &[Turn::Other("free")], 0),
        link("c", Some(2), &[hinge(X)], 1),
        link("d", Some(3), &[hinge(X)], 2),
        link("ball", Some(4), &[Turn::Other("floating")], 1),
    ];
    let (parts, notes) = joined("body", &links).unwrap();
    let names = |parts: &[PartEntry]| parts.iter().map(|part| part.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&parts), ["c", "d", "d/2"]);
    assert_eq!(
        notes[0],
        "the body is the tree of `b`; other trees are left out (--root keeps another) (2): target, ball"
    );
    let of = |name: &str| {
        let options = Options { root: Some(name.to_owned()), ..Options::default() };
        super::joined("body", links.to_vec(), &options).map(|joined| names(&joined.parts))
    };
    assert_eq!(of("target").unwrap(), ["target"]);
    assert_eq!(of("d").unwrap(), ["d", "d/2"]);
    assert_eq!(of("x").unwrap_err(), "no body is called `x` (--root); give the name of one");
    let message = strictly("body", &links);
    assert!(
        message.starts_with("`b` and others are bodies without a joint between them; name one with --root"),
        "{message}"
    );
    let message = joined("body", &[link("a", None, &[], 0)]).unwrap_err();
    assert_eq!(message, "no body has a shape; give it a box, sphere, cylinder, capsule or mesh");
}
