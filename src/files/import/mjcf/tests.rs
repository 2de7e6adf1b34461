//! Test that MJCF means what MuJoCo's documentation says, by hand-computed places and axes, and that every mistake is named.

use std::f64::consts::PI;
use std::path::Path;

use nalgebra::Vector3;
use roxmltree::Document;

use super::*;
use crate::stages::agent::Shape;

/// What is read of a description in this folder.
fn read_in(folder: &Path, text: &str, strict: bool) -> Result<Read, Wrong> {
    let files = Located::beside(&folder.join("m.xml"));
    links(Document::parse(text).unwrap().root_element(), &files, strict)
}

fn read(text: &str) -> Result<Vec<Link>, Wrong> {
    read_in(Path::new(""), text, false).map(|read| read.links)
}

/// The bodies of a world, after other sections.
fn world(sections: &str, bodies: &str) -> Result<Vec<Link>, Wrong> {
    read(&format!("<mujoco>{sections}<worldbody>{bodies}</worldbody></mujoco>"))
}

fn solid_of(sections: &str, geom: &str) -> Solid {
    world(sections, &format!("<body name='a'>{geom}</body>")).unwrap()[0].solids[0].clone()
}

#[track_caller]
fn near(found: Vector3<f64>, expected: [f64; 3]) {
    assert!((found - Vector3::from(expected)).norm() < 1e-9, "{found:?} is not {expected:?}");
}

/// Where the x, y and z axes of a solid point.
#[track_caller]
fn axes(solid: &Solid, expected: [[f64; 3]; 3]) {
    for (axis, expected) in [Vector3::x(), Vector3::y(), Vector3::z()].into_iter().zip(expected) {
        near(solid.pose.rotation * axis, expected);
    }
}

const X: [f64; 3] = [1.0, 0.0, 0.0];
const Y: [f64; 3] = [0.0, 1.0, 0.0];
const Z: [f64; 3] = [0.0, 0.0, 1.0];

fn minus(axis: [f64; 3]) -> [f64; 3] {
    axis.map(|x| -x)
}

#[test]
fn lengths_are_halves() {
    let shape = |geom: &str| solid_of("", geom).shape;
    assert_eq!(shape("<geom size='0.1'/>"), Shape::Sphere { radius: 0.1 });
    assert_eq!(shape("<geom type='capsule' size='0.1 0.25'/>"), Shape::Capsule { radius: 0.1, length: 0.5 });
    assert_eq!(
        shape("<geom type='cylinder' size='0.1 0.25 9'/>"),
        Shape::Cylinder { radius: 0.1, length: 0.5 }
    );
    assert_eq!(shape("<geom type='box' size='0.1 0.2 0.3'/>"), Shape::Box { sides: [0.2, 0.4, 0.6] });
}

#[test]
fn two_ends_place_and_turn_a_solid() {
    let capsule =
        solid_of("", "<geom type='capsule' size='0.1' fromto='1 0 0  1 0 3' pos='9 9 9' quat='0 1 0 0'/>");
    assert_eq!(capsule.shape, Shape::Capsule { radius: 0.1, length: 3.0 });
    near(capsule.pose.translation.vector, [1.0, 0.0, 1.5]);
    axes(&capsule, [X, Y, Z]);
    let cylinder = solid_of("", "<geom type='cylinder' size='0.1' fromto='0 0 0  0 -2 0'/>");
    assert_eq!(cylinder.shape, Shape::Cylinder { radius: 0.1, length: 2.0 });
    near(cylinder.pose.translation.vector, [0.0, -1.0, 0.0]);
    axes(&cylinder, [X, Z, minus(Y)]);
    let plank = solid_of("", "<geom type='box' size='0.1' fromto='0 0 0  2 1 2'/>");
    assert_eq!(plank.shape, Shape::Box { sides: [0.2, 0.2, 3.0] });
    // As MuJoCo has it.
    axes(&plank, [[-1.0, -2.0, 2.0], [-2.0, 2.0, 1.0], [-2.0, -1.0, -2.0]].map(|axis| axis.map(|x| x / 3.0)));
}

#[test]
fn every_way_to_turn_is_read() {
    let turned = |sections: &str, turn: &str| solid_of(sections, &format!("<geom size='1' {turn}/>"));
    let half = std::f64::consts::FRAC_PI_2;
    // A quarter about z: w, x, y, z.
    axes(&turned("", "quat='1 0 0 1'"), [Y, minus(X), Z]);
    axes(&turned("", "axisangle='0 0 2 90'"), [Y, minus(X), Z]);
    axes(&turned("<compiler angle='radian'/>", &format!("axisangle='0 0 2 {half}'")), [Y, minus(X), Z]);
    axes(&turned("", "xyaxes='0 3 0  -2 1 0'"), [Y, minus(X), Z]);
    axes(&turned("", "zaxis='0 0.5 0'"), [X, minus(Z), Y]);
    axes(&turned("", "zaxis='0 0 -1'"), [X, minus(Y), minus(Z)]);
    // About x, then about the new y.
    axes(&turned("", "euler='90 90 0'"), [Y, Z, X]);
    axes(&turned("<compiler eulerseq='XYZ'/>", "euler='90 90 0'"), [minus(Z), X, minus(Y)]);
    axes(&turned("<compiler eulerseq='zyx'/>", "euler='90 0 0'"), [Y, minus(X), Z]);
    axes(&turned("<compiler angle='radian'/>", &format!("euler='0 0 {half}'")), [Y, minus(X), Z]);
}

#[test]
fn anchors_and_axes_of_nested_bodies_are_in_the_common_frame() {
    let links = world(
        "",
        "<body name='a' pos='1 0 0' euler='0 0 90'><geom size='1'/><joint type='free'/>
           <frame pos='0 0 1' euler='90 0 0'>
             <body name='b' pos='2 0 0' quat='1 0 0 1'><geom size='1' pos='0 0 1'/>
               <joint pos='0.5 0 0' axis='0 2 0'/><joint type='ball' pos='0 0 0.5'/></body>
           </frame></body>",
    )
    .unwrap();
    let [a, b] = &links[..] else { panic!("{links:?}") };
    assert_eq!((a.parent, b.parent), (None, Some(0)));
    near(b.origin, [1.0, 2.0, 1.0]);
    // The axes of b: x is up, y is -y, z is x of the world.
    let [Turn::Hinge { anchor, axis }, Turn::Ball { anchor: middle }] = &b.turns[..] else { panic!("{b:?}") };
    near(*anchor, [1.0, 2.0, 1.5]);
    near(*axis, [0.0, -1.0, 0.0]);
    near(*middle, [1.5, 2.0, 1.0]);
    near(b.solids[0].pose.translation.vector, [2.0, 2.0, 1.0]);
}

#[test]
fn old_files_have_all_places_in_the_frame_of_the_world() {
    let legs = |places: [&str; 4]| {
        let [body, joint, geom, foot] = places;
        format!(
            "<body pos='0 0 2'><geom size='0.1'/><body pos='{body}' euler='0 0 90'><joint pos='{joint}' axis='{foot}'/>\
             <geom size='0.1' pos='{geom}'/></body></body>"
        )
    };
    let global = "<compiler coordinate='global'/>";
    let old = world(
        global,
        &legs(["0 0 1", "1 0 1", "0 2 1", "0 1 0"]).replace("'0.1'/><body", "'0.1' pos='0 0 2'/><body"),
    );
    let new = world("", &legs(["0 0 -1", "0 -1 0", "2 0 0", "1 0 0"])).unwrap();
    for (old, new) in old.unwrap().iter().zip(&new) {
        near(old.origin, new.origin.into());
        near(old.solids[0].pose.translation.vector, new.solids[0].pose.translation.vector.into());
        for (old, new) in old.turns.iter().zip(&new.turns) {
            let (Turn::Hinge { anchor, axis }, Turn::Hinge { anchor: a, axis: b }) = (old, new) else {
                panic!()
            };
            near(*anchor, (*a).into());
            near(*axis, (*b).into());
        }
    }
    assert_eq!(new.last().unwrap().turns.len(), 1);
}

#[test]
fn classes_give_what_elements_lack() {
    let sections = "<default><geom type='capsule' size='0.1 0.2' density='500'/><joint axis='1 0 0'/>
        <default class='limb'><geom size='0.3'/>
          <default class='finger'><geom type='sphere' mass='2'/><joint pos='0 0 5' type='ball'/></default>
        </default></default>";
    let links = world(
        sections,
        "<body name='a'><geom/><joint/></body>
         <body name='b' childclass='limb'><geom/><geom class='finger'/><geom class='main' size='0.4 0.5'/>
           <body name='c'><geom/><joint/><joint class='finger'/></body></body>",
    )
    .unwrap();
    let capsule = |radius, length| Shape::Capsule { radius, length };
    assert_eq!(links[0].solids[0].shape, capsule(0.1, 0.4));
    assert_eq!(links[0].solids[0].density(), Some(500.0));
    let shapes: Vec<Shape> = links[1].solids.iter().map(|solid| solid.shape).collect();
    assert_eq!(shapes, [capsule(0.3, 0.4), Shape::Sphere { radius: 0.3 }, capsule(0.4, 1.0)]);
    assert_eq!(links[1].solids[1].mass, Some(2.0));
    assert_eq!(links[2].solids[0].shape, capsule(0.3, 0.4));
    let [Turn::Hinge { axis, .. }, Turn::Ball { anchor }] = &links[2].turns[..] else { panic!("{links:?}") };
    near(*axis, X);
    near(*anchor, [0.0, 0.0, 5.0]);
}

#[test]
fn pictures_are_left_out_beside_what_touches() {
    let picture = "<geom type='mesh' mesh='m' contype='0' conaffinity='0'/>";
    let asset = "<asset><mesh name='m' file='gone.stl'/></asset>";
    let one = world(asset, &format!("<body>{picture}<geom size='1'/></body>")).unwrap();
    assert_eq!(one[0].solids.len(), 1);
    // All are pictures: then they are the body.
    let two = "<body><geom size='1' contype='0' conaffinity='0'/><geom size='2' contype='0' conaffinity='0'/></body>";
    assert_eq!(world("", two).unwrap()[0].solids.len(), 2);
    assert_eq!(
        world("", "<body><geom size='1'/><geom size='2' contype='0'/></body>").unwrap()[0].solids.len(),
        2
    );
}

#[test]
fn masses_of_bodies_are_spread_over_their_volume() {
    let bodies = "<body><inertial pos='0 0 0' mass='3'/><geom type='box' size='0.5 0.5 0.5' mass='9'/>
        <geom type='box' size='0.5 0.5 1' density='9'/></body>";
    let densities =
        |sections| world(sections, bodies).unwrap()[0].solids.iter().map(Solid::density).collect::<Vec<_>>();
    // In the ratio of their own masses, 9 and 18.
    assert_eq!(densities(""), [Some(1.0), Some(1.0)]);
    assert_eq!(densities("<compiler inertiafromgeom='true'/>"), [Some(9.0), Some(9.0)]);
}

#[test]
fn pictures_weigh_and_only_shapes_of_the_named_groups_do() {
    let box_of = |attributes: &str| format!("<geom type='box' size='0.1 0.1 0.1' {attributes}/>");
    let picture = "contype='0' conaffinity='0'";
    let mass = |sections: &str, geoms: &[String]| {
        let links = world(sections, &format!("<body name='a'>{}</body>", geoms.concat())).unwrap();
        (links[0].solids.len(), links[0].solids.iter().map(Solid::own_mass).sum::<f64>() + links[0].bare_mass)
    };
    assert_eq!(mass("", &[box_of("mass='0'"), box_of(&format!("mass='3' {picture}"))]), (1, 3.0));
    let two = [box_of("mass='2' group='1'"), box_of("mass='5' group='3'")];
    assert_eq!(mass("<compiler inertiagrouprange='0 2'/>", &two), (2, 2.0));
    assert_eq!(mass("<compiler settotalmass='21'/>", &two), (2, 21.0));
    let dummy = mass("", &["<geom size='0.0001' mass='4'/>".to_owned()]);
    assert_eq!(dummy, (0, 4.0));
}

#[test]
fn meshes_and_ellipsoids_are_boxes_around_them() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("parts")).unwrap();
    let corners = "v 1 1 1\nv 3 1 1\nv 1 5 1\nv 1 1 7\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    std::fs::write(folder.path().join("parts/m.obj"), corners).unwrap();
    let text = |asset: &str, geom: &str| {
        format!(
            "<mujoco><compiler meshdir='parts'/><asset>{asset}</asset><worldbody><body name='a'>
             <inertial pos='0 0 0' mass='6' diaginertia='1 1 1'/>{geom}</body></worldbody></mujoco>"
        )
    };
    let read = |asset: &str, geom: &str| read_in(folder.path(), &text(asset, geom), false).unwrap();
    let geom = "<geom type='mesh' mesh='m' pos='0 0 10'/>";
    let found = read("<mesh file='m.obj' scale='1 1 0.5' refpos='1 1 1'/>", geom);
    let solid = &found.links[0].solids[0];
    assert_eq!((solid.shape, solid.mass), (Shape::Box { sides: [2.0, 4.0, 3.0] }, Some(6.0)));
    near(solid.pose.translation.vector, [1.0, 2.0, 11.5]);
    // Not there: the box that has the inertia.
    let absent = read("<mesh name='m' file='gone.stl'/>", geom);
    assert_eq!(absent.links[0].solids[0].shape, Shape::Box { sides: [1.0; 3] });
    assert!(absent.notes[0].starts_with("body `a`: mesh `gone.stl` is not there"), "{:?}", absent.notes);

    let ellipsoid = solid_of("", "<geom type='ellipsoid' size='0.1 0.2 0.3'/>");
    let Shape::Box { sides } = ellipsoid.shape else { panic!("{ellipsoid:?}") };
    assert!(sides.iter().zip([0.2, 0.4, 0.6]).all(|(a, b)| (a - b).abs() < 1e-9), "{sides:?}");
    assert!((ellipsoid.own_mass() - 1000.0 * 4.0 / 3.0 * PI * 0.006).abs() < 1e-9);
    assert!(
        world("", "<body name='a'><geom size='1'/><geom type='plane' size='1 1 1'/></body>").unwrap()[0]
            .solids
            .len()
            == 1
    );
}

#[test]
fn bodies_without_a_name_get_one_that_is_free() {
    let links = world("", "<body/><body name='body2'><body/></body><body/>").unwrap();
    let names: Vec<&str> = links.iter().map(|link| link.name.as_str()).collect();
    assert_eq!(names, ["body1", "body2", "body3", "body4"]);
}

#[test]
fn the_world_is_no_body() {
    let links = world(
        "",
        "<geom type='plane' size='x'/><geom type='hfield'/><light/><body name='a'><geom size='1'/></body>",
    );
    assert_eq!(links.unwrap().len(), 1);
}

#[test]
fn every_mistake_is_named_with_its_line_and_body() {
    for (bodies, expected) in [
        (
            "\n<body name='a'><geom type='sdf'/></body>",
            "line 2: geom of body `a` is of type `sdf`; make it a box",
        ),
        ("<body name='a'><geom type='mesh'/></body>", "geom of body `a` lacks mesh; add it"),
        ("<body name='a'><geom mesh='m' size='1'/></body>", "has mesh `m`, which no asset is"),
        ("<body name='a'><geom type='ellipsoid' size='1 1'/></body>", "but a ellipsoid needs 3"),
        ("<body name='a'><geom/></body>", "geom of body `a` has 0 numbers of size, but a sphere needs 1"),
        (
            "<body name='a'><geom type='capsule' size='1'/></body>",
            "has 1 numbers of size, but a capsule needs 2",
        ),
        ("<body name='a'><geom type='box' size='1 1'/></body>", "has 2 numbers of size, but a box needs 3"),
        ("<body name='a'><geom size='1 x'/></body>", "has size `1 x`, which must be numbers"),
        ("<body name='a'><geom size='nan'/></body>", "has size `nan`"),
        ("<body name='a'><geom size='1e10'/></body>", "has size `1e10`, which must be numbers up to 1e9"),
        ("<body name='a'><geom size='1' pos='1 2'/></body>", "has pos `1 2`, which must be 3 numbers"),
        ("<body name='a'><geom size='1' mass='inf'/></body>", "has mass `inf`, which must be a number"),
        ("<body name='a'><geom size='1' contype='a'/></body>", "has contype `a`"),
        ("<body name='a'><geom size='1' class='b'/></body>", "has class `b`, which no default has"),
        ("<body name='a' childclass='b'><geom size='1'/></body>", "has class `b`, which no default has"),
        ("<body name='a' quat='0 0 0 0'/>", "body `a` has quat of length 0"),
        ("<body name='a' axisangle='0 0 0 1'/>", "body `a` has axisangle of length 0"),
        ("<body name='a' xyaxes='1 0 0 2 0 0'/>", "body `a` has xyaxes of length 0"),
        ("<body name='a' zaxis='0 0 0'/>", "body `a` has zaxis of length 0"),
        ("<body name='a' euler='1 2'/>", "body `a` has euler `1 2`"),
        (
            "<body name='a'><geom type='capsule' size='1' fromto='1 1 1 1 1 1'/></body>",
            "has fromto of length 0",
        ),
        ("<body name='a'><joint axis='0 0 0'/></body>", "joint of body `a` has axis of length 0"),
        ("<body name='a'><joint type='screw'/></body>", "joint of body `a` has type `screw`"),
        ("<body name='a'><inertial/></body>", "inertial of body `a` lacks mass"),
    ] {
        let message = world("", bodies).unwrap_err();
        assert!(message.contains(expected), "{bodies:?} gave {message:?}");
    }
    for (sections, expected) in [
        ("<compiler settotalmass='x'/>", "compiler has settotalmass `x`, which must be a number"),
        ("<compiler angle='turn'/>", "compiler has angle `turn`"),
        ("<compiler coordinate='polar'/>", "compiler has coordinate `polar`"),
        ("<compiler eulerseq='xy'/>", "compiler has eulerseq `xy`"),
        ("<compiler eulerseq='abc'/>", "compiler has eulerseq `abc`"),
        ("<default><default/></default>", "line 1: default lacks class"),
    ] {
        let message = world(sections, "<body/>").unwrap_err();
        assert!(message.contains(expected), "{sections:?} gave {message:?}");
    }
}

#[test]
fn what_a_tree_has_not_or_nobody_knows_is_refused() {
    let pair = "<body name='a'><geom size='0.1'/><body name='b'><joint/><geom size='0.1'/></body></body>";
    for tie in ["<weld body1='a' body2='b'/>", "<connect body1='a' body2='b' anchor='0 0 0'/>"] {
        let text = |before: &str, tie: &str| {
            format!("<mujoco>{before}<equality>{tie}</equality><worldbody>{pair}</worldbody></mujoco>")
        };
        let read = |before: &str, tie: &str, strict| read_in(Path::new(""), &text(before, tie), strict);
        assert!(read("", tie, true).unwrap_err().contains("joins bodies in addition to the tree"));
        let note = "ties between bodies beside the tree are left out (1): a with b";
        assert_eq!(read("", tie, false).unwrap().notes, [note]);
        let loose = tie.replace("/>", " active='false'/>");
        let world = tie.replace("'a'", "'world'");
        let by_default = "<default><equality active='false'/></default>";
        let follows = "<joint joint1='x' joint2='y'/>";
        for (before, tie) in [("", &*loose), ("", &*world), (by_default, tie), (by_default, follows)] {
            assert!(read(before, tie, true).unwrap().notes.is_empty(), "{before} {tie}");
        }
        let note = "joints that follow others (equality) move by themselves (1): x";
        assert_eq!(read("", follows, true).unwrap().notes, [note]);
    }
    for (inside, expected) in [
        ("<bodi/>", "bodi of body `a` is unknown here"),
        ("<geom size='0.1'><geom size='0.1'/></geom>", "geom is within an element that cannot contain it"),
        ("<geom size='0.1' fromto='0 0 0 0 0 1'/>", "has fromto, but is a sphere"),
    ] {
        let message = world("", &format!("<body name='a'>{inside}</body>")).unwrap_err();
        assert!(message.contains(expected), "{message}");
    }
    assert!(world("", "<a/>").unwrap_err().contains("a is unknown here"));
    assert!(read("<mujoco><asset/></mujoco>").unwrap_err().starts_with("has no <worldbody>"));
}
