//! Test that URDF means what ROS's documentation says, by hand-computed places and axes, and that every mistake is named.

use std::path::Path;

use roxmltree::Document;

use super::*;

/// What is read of a robot in this folder.
fn read_in(folder: &Path, content: &str) -> Result<Read, Wrong> {
    let text = format!("<robot name='r'>{content}</robot>");
    links(Document::parse(&text).unwrap().root_element(), &Located::beside(&folder.join("r.urdf")), false)
}

fn read(content: &str) -> Result<Vec<Link>, Wrong> {
    read_in(Path::new(""), content).map(|read| read.links)
}

fn joint(kind: &str, parent: &str, child: &str, within: &str) -> String {
    format!(
        "<joint name='{parent}-{child}' type='{kind}'><parent link='{parent}'/><child link='{child}'/>{within}</joint>"
    )
}

fn links_of(names: &str) -> String {
    names.split(' ').map(|name| format!("<link name='{name}'/>")).collect()
}

#[track_caller]
fn near(found: Vector3<f64>, expected: [f64; 3]) {
    assert!((found - Vector3::from(expected)).norm() < 1e-9, "{found:?} is not {expected:?}");
}

const BALL: &str = "<geometry><sphere radius='0.1'/></geometry>";
const MESH: &str = "<geometry><mesh filename='m.stl'/></geometry>";

#[test]
fn an_axis_that_is_not_given_is_x() {
    for axis in ["", "<axis/>"] {
        let links = read(&[links_of("a b"), joint("revolute", "a", "b", axis)].concat()).unwrap();
        let [Turn::Hinge { axis, .. }] = &links[1].turns[..] else { panic!("{links:?}") };
        near(*axis, [1.0, 0.0, 0.0]);
    }
}

#[test]
fn anchors_and_axes_of_nested_links_are_in_the_common_frame() {
    let half = std::f64::consts::FRAC_PI_2;
    let text = [
        // Listed child first.
        joint("continuous", "b", "c", "<origin xyz='0 0 2'/>"),
        // About fixed x, then fixed z: x of b points to y, y to z, z to x.
        joint(
            "revolute",
            "a",
            "b",
            &format!("<origin xyz='1 0 0' rpy='{half} 0 {half}'/><axis xyz='0 3 0'/><limit effort='x'/>"),
        ),
        links_of("c a"),
        "<link name='b'><collision><origin xyz='0 0 1' rpy='0 0 0'/>".to_owned(),
        "<geometry><cylinder radius='0.1' length='2'/></geometry></collision></link>".to_owned(),
    ]
    .concat();
    let links = read(&text).unwrap();
    let [a, b, c] = &links[..] else { panic!("{links:?}") };
    assert_eq!([&a.name, &b.name, &c.name], ["a", "b", "c"]);
    assert_eq!((a.parent, b.parent, c.parent), (None, Some(0), Some(1)));
    assert!(a.turns.is_empty());
    let [Turn::Hinge { anchor, axis }] = &b.turns[..] else { panic!("{b:?}") };
    near(*anchor, [1.0, 0.0, 0.0]);
    near(*axis, [0.0, 0.0, 1.0]);
    let [Turn::Hinge { anchor, axis }] = &c.turns[..] else { panic!("{c:?}") };
    near(*anchor, [3.0, 0.0, 0.0]);
    near(*axis, [0.0, 1.0, 0.0]);
    // A cylinder's length is whole and along its z.
    let Solid { shape, pose, .. } = &b.solids[0];
    assert_eq!(*shape, Shape::Cylinder { radius: 0.1, length: 2.0 });
    near(pose.translation.vector, [2.0, 0.0, 0.0]);
    near(pose.rotation * Vector3::z(), [1.0, 0.0, 0.0]);
}

#[test]
fn angles_turn_about_fixed_axes_x_first() {
    let half = std::f64::consts::FRAC_PI_2;
    let turned = |rpy: &str| {
        let geometry = "<geometry><box size='1 2 3'/></geometry>";
        let text = format!("<link name='a'><visual><origin rpy='{rpy}'/>{geometry}</visual></link>");
        read(&text).unwrap()[0].solids[0].pose.rotation
    };
    near(turned(&format!("{half} 0 0")) * Vector3::y(), [0.0, 0.0, 1.0]);
    near(turned(&format!("0 {half} 0")) * Vector3::z(), [1.0, 0.0, 0.0]);
    near(turned(&format!("0 0 {half}")) * Vector3::x(), [0.0, 1.0, 0.0]);
    // About x, z goes to -y; y leaves that; about z, -y goes to x.
    near(turned(&format!("{half} {half} {half}")) * Vector3::z(), [1.0, 0.0, 0.0]);
    near(turned(&format!("{half} {half} {half}")) * Vector3::x(), [0.0, 0.0, -1.0]);
}

#[test]
fn shapes_are_those_of_collision_or_else_of_the_picture() {
    let count =
        |shapes: &str| read(&format!("<link name='a'>{shapes}</link>")).map(|links| links[0].solids.len());
    let (visual, collision) = (
        |geometry: &str| format!("<visual>{geometry}</visual>"),
        |geometry: &str| format!("<collision>{geometry}</collision>"),
    );
    assert_eq!(count(&[visual(BALL), visual(BALL), collision(BALL)].concat()), Ok(1));
    assert_eq!(count(&[visual(BALL), visual(BALL)].concat()), Ok(2));
    assert_eq!(count(&[visual(MESH), collision(BALL)].concat()), Ok(1));
    assert_eq!(count(&[visual(BALL), collision(MESH)].concat()), Ok(1));
    assert_eq!(count(""), Ok(0));
    let shape = |geometry: &str| {
        let text = format!("<link name='a'><visual><geometry>{geometry}</geometry></visual></link>");
        read(&text).unwrap()[0].solids[0].shape
    };
    assert_eq!(shape("<box size='1 2 3'/>"), Shape::Box { sides: [1.0, 2.0, 3.0] });
    assert_eq!(shape("<sphere radius='2'/>"), Shape::Sphere { radius: 2.0 });
    assert_eq!(shape("<capsule radius='2' length='3'/>"), Shape::Capsule { radius: 2.0, length: 3.0 });
}

#[test]
fn a_mass_is_spread_over_the_volume_of_a_link() {
    let cube = "<collision><geometry><box size='1 1 1'/></geometry></collision>";
    let densities = |mass: &str| {
        let text = format!("<link name='a'><inertial><mass value='{mass}'/></inertial>{cube}{cube}</link>");
        read(&text).map(|links| links[0].solids.iter().map(Solid::density).collect::<Vec<_>>())
    };
    assert_eq!(densities("3"), Ok(vec![Some(1.5); 2]));
    assert_eq!(densities("0"), Ok(vec![None; 2]));
    assert_eq!(
        densities("").unwrap_err(),
        "line 1: mass of link `a` has value ``, which must be a number up to 1e9"
    );
}

#[test]
fn a_mesh_that_is_there_is_a_box_around_it_and_one_that_is_not_is_a_box_of_the_inertia() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(
        folder.path().join("m.obj"),
        "v 0 0 0\nv 2 0 0\nv 0 4 0\nv 0 0 6\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n",
    )
    .unwrap();
    let mesh = |file: &str| {
        format!(
            "<collision><origin xyz='0 0 1'/><geometry><mesh filename='{file}' scale='0.5 0.5 0.5'/></geometry></collision>"
        )
    };
    let link = |within: &str| format!("<link name='a'>{within}</link>");
    let read = |within: &str| read_in(folder.path(), &link(within)).unwrap();
    let there = read(&format!("<inertial><mass value='3'/></inertial>{}", mesh("m.obj")));
    let [solid] = &there.links[0].solids[..] else { panic!("{there:?}") };
    assert_eq!((solid.shape, solid.mass), (Shape::Box { sides: [1.0, 2.0, 3.0] }, Some(3.0)));
    near(solid.pose.translation.vector, [0.5, 1.0, 2.5]);
    assert!(solid.mesh.is_some() && there.notes.is_empty());

    // A box of 1 kg and 0.2 x 0.4 x 0.6 m, turned about z by a right angle.
    let inertia = "<inertial><origin xyz='0 0 2' rpy='0 0 1.5707963267948966'/><mass value='1'/>
        <inertia ixx='0.0433333333' iyy='0.0333333333' izz='0.0166666667'/></inertial>";
    let absent = read(&format!("{inertia}{}", mesh("gone.stl")));
    let [solid] = &absent.links[0].solids[..] else { panic!("{absent:?}") };
    let Shape::Box { sides } = solid.shape else { panic!("{solid:?}") };
    assert!(sides.iter().zip([0.2, 0.4, 0.6]).all(|(a, b)| (a - b).abs() < 1e-6), "{sides:?}");
    near(solid.pose.translation.vector, [0.0, 0.0, 2.0]);
    near(solid.pose.rotation * Vector3::x(), [0.0, 1.0, 0.0]);
    assert_eq!(
        absent.notes,
        ["link `a`: mesh `gone.stl` is not there; a box with its inertia stands for it"]
    );
    // A part of its shapes stands for all of them, and without any the mass is kept.
    assert_eq!(read(&format!("<collision>{BALL}</collision>{}", mesh("gone.stl"))).links[0].solids.len(), 1);
    let bare = read(&format!("<inertial><mass value='7'/></inertial>{}", mesh("gone.stl")));
    assert_eq!((bare.links[0].solids.len(), bare.links[0].bare_mass), (0, 7.0));

    std::fs::write(folder.path().join("cut.obj"), "f 1 2 3\n").unwrap();
    let wrong = read_in(folder.path(), &link(&mesh("cut.obj"))).unwrap_err();
    assert!(wrong.starts_with("line 1: mesh of link `a` cannot be read: cut.obj: "), "{wrong}");
}

#[test]
fn what_only_marks_a_place_is_left_out() {
    let ball =
        |tag: &str, radius: f64| format!("<{tag}><geometry><sphere radius='{radius}'/></geometry></{tag}>");
    let of = |within: &str| read_in(Path::new(""), &format!("<link name='a'>{within}</link>")).unwrap();
    let marked = of(&(ball("collision", 0.001) + &ball("visual", 0.1)));
    assert_eq!(marked.links[0].solids[0].shape, Shape::Sphere { radius: 0.1 });
    let dummy = of(&format!("<inertial><mass value='1e-12'/></inertial>{}", ball("visual", 0.1)));
    assert!(dummy.links[0].solids.is_empty());
    assert_eq!(dummy.notes, ["link `a`: 1 of 1 shapes are too small or too light and left out"]);
}

#[test]
fn calls_of_macros_that_are_gone_are_left_out_with_a_note() {
    let text = links_of("a b")
        + &joint("revolute", "a", "b", "")
        + "<x:camera xmlns:x='http://www.ros.org/wiki/xacro'/>";
    let found = read_in(Path::new(""), &text).unwrap();
    assert_eq!(found.notes, ["macros of xacro that were not expanded are left out (1): camera"]);
    // As `text` writes a prefix that is not declared.
    let undeclared = links_of("a") + "<xacro.camera/>";
    assert_eq!(read_in(Path::new(""), &undeclared).unwrap().notes, found.notes);
    for builds in ["<xacro.if value='1'><link name='b'/></xacro.if>", "<xacro.element name='link'/>"] {
        let expected = "is an element of xacro; expand the file first: xacro FILE > robot.urdf";
        assert!(read(&(links_of("a") + builds)).unwrap_err().contains(expected), "{builds}");
    }
}

#[test]
fn joints_that_follow_others_are_noted() {
    let text = links_of("a b c")
        + &joint("revolute", "a", "b", "")
        + &joint("revolute", "a", "c", "<mimic joint='other' multiplier='-1'/>");
    let notes = read_in(Path::new(""), &text).unwrap().notes;
    let [note] = &notes[..] else { panic!("{notes:?}") };
    assert!(note.starts_with("joints that follow others (mimic) move by themselves (1): "), "{note}");
}

#[test]
fn the_world_needs_no_link_to_carry_others() {
    let arms = joint("fixed", "world", "a", "<origin xyz='1 0 0'/>") + &joint("fixed", "world", "b", "");
    let implied = read_in(Path::new(""), &(links_of("a b") + &arms)).unwrap();
    let declared = read_in(Path::new(""), &(links_of("a b world") + &arms)).unwrap();
    assert!(implied.notes.is_empty());
    let tree = |read: &Read| {
        read.links.iter().map(|link| (link.name.clone(), link.parent, link.origin)).collect::<Vec<_>>()
    };
    assert_eq!(tree(&implied), tree(&declared));
    assert_eq!(implied.links[1].parent, Some(0), "{:?}", tree(&implied));
    let misspelt = links_of("a") + &joint("fixed", "world", "b", "");
    assert!(read(&misspelt).unwrap_err().contains("has child `b`, which is not a link"));
}

#[test]
fn an_origin_may_have_a_quaternion() {
    let at = |turn: &str| {
        let ball = format!(
            "<link name='a'><visual><origin {turn}/><geometry><box size='1 2 3'/></geometry></visual></link>"
        );
        read(&ball).map(|links| links[0].solids[0].pose.rotation)
    };
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let quaternion = at(&format!("quat_xyzw='{half} 0 0 {half}'")).unwrap();
    assert!(quaternion.angle_to(&at("rpy='1.5707963267948966 0 0'").unwrap()) < 1e-9);
    assert!(at("quat_xyzw='0 0 0 0'").unwrap_err().contains("has quat_xyzw of length 0"));
}

#[test]
fn a_small_shape_beside_a_mesh_that_is_missing_does_not_stand_for_the_link() {
    let link = |radius: &str, mass: &str| {
        format!(
            "<link name='a'><inertial><mass value='{mass}'/><inertia ixx='0.1' iyy='0.1' izz='0.1'/></inertial>\
             <collision>{MESH}</collision><collision><geometry><sphere radius='{radius}'/></geometry></collision></link>"
        )
    };
    let note = |radius, mass| {
        let Read { links, notes } = read_in(Path::new(""), &link(radius, mass)).unwrap();
        assert!(
            (links[0].solids.iter().map(Solid::own_mass).sum::<f64>() - mass.parse::<f64>().unwrap()).abs()
                < 1e-9
        );
        (links[0].solids.len(), notes.concat())
    };
    let (count, said) = note("0.1", "10");
    assert!(count == 1 && said.contains("its other shapes stand for it"), "{said}");
    let (count, said) = note("0.01", "10");
    assert!(count == 2 && said.contains("a box with its inertia stands for it"), "{said}");
    // Without an inertia the small one is all that there is.
    let bare = link("0.01", "10").replace("<inertia ixx='0.1' iyy='0.1' izz='0.1'/>", "");
    let Read { links, notes } = read_in(Path::new(""), &bare).unwrap();
    assert!(links[0].solids.len() == 1 && notes[0].contains("its other shapes stand for it"), "{notes:?}");
}

#[test]
fn what_is_thinner_than_a_part_may_be_becomes_thicker_and_keeps_its_mass() {
    let disc = "<link name='a'><collision><geometry><cylinder radius='0.1' length='0.0001'/></geometry></collision></link>";
    let Read { links, notes } = read_in(Path::new(""), disc).unwrap();
    let [solid] = &links[0].solids[..] else { panic!() };
    assert_eq!(solid.shape, Shape::Cylinder { radius: 0.1, length: 0.001 });
    assert!((solid.own_mass() - 1000.0 * std::f64::consts::PI * 0.01 * 0.0001).abs() < 1e-12);
    assert_eq!(notes, ["link `a`: 1 of 1 shapes have a length or radius below 1 mm, which became 1 mm"]);
}

#[test]
fn links_that_are_no_tree_are_refused() {
    for (text, expected) in [
        (links_of("a a"), "link `a` exists twice"),
        (
            links_of("a b c") + &joint("fixed", "b", "c", "") + &joint("fixed", "c", "b", ""),
            "link `b` is in a loop",
        ),
        (
            links_of("a b") + &joint("fixed", "a", "b", "") + &joint("fixed", "b", "a", ""),
            "link `a` is in a loop",
        ),
        (
            links_of("a b") + &joint("fixed", "a", "a", ""),
            "link `a` is in a loop of joints or on one; remove",
        ),
        (
            links_of("a b c") + &joint("fixed", "a", "c", "") + &joint("fixed", "b", "c", ""),
            "joint `b-c` carries `c`, as another joint does",
        ),
        (links_of("a") + &joint("fixed", "a", "b", ""), "joint `a-b` has child `b`, which is not a link"),
        (links_of("a") + &joint("fixed", "b", "a", ""), "joint `b-a` has parent `b`, which is not a link"),
    ] {
        let message = read(&text).unwrap_err();
        assert!(message.contains(expected), "{text:?} gave {message:?}");
    }
}

#[test]
fn every_mistake_is_named_with_its_line_and_link() {
    let shaped =
        |geometry: &str| format!("<link name='a'><visual><geometry>{geometry}</geometry></visual></link>");
    let joined = |kind: &str, within: &str| links_of("a b") + &joint(kind, "a", "b", within);
    for (text, expected) in [
        ("\n<link/>".to_owned(), "line 2: link lacks name; add it"),
        (links_of("a") + "<joint/>", "joint lacks name"),
        (links_of("a") + "<joint name='j'/>", "joint `j` lacks <parent>; add it"),
        (links_of("a") + "<joint name='j'><parent link='a'/></joint>", "joint `j` lacks <child>; add it"),
        (links_of("a") + "<joint name='j'><parent/></joint>", "parent of joint `j` lacks link"),
        (
            links_of("a b") + "<joint name='j'><parent link='a'/><child link='b'/></joint>",
            "joint `j` lacks type",
        ),
        (joined("screw", ""), "joint `a-b` has type `screw`"),
        (joined("revolute", "<axis xyz='0 0 0'/>"), "axis of joint `a-b` has xyz of length 0"),
        (
            joined("fixed", "<origin xyz='1 2'/>"),
            "origin of joint `a-b` has xyz `1 2`, which must be 3 numbers",
        ),
        (joined("fixed", "<origin rpy='0 0 ${pi}'/>"), "has rpy `0 0 ${pi}`"),
        ("<link name='a'><visual/></link>".to_owned(), "link `a` has a visual without geometry"),
        (shaped(""), "link `a` has a visual without geometry"),
        (shaped("<cone/>"), "cone of link `a` is not supported; make it a box"),
        (shaped("<sphere/>"), "sphere of link `a` lacks radius"),
        (shaped("<cylinder radius='1'/>"), "cylinder of link `a` lacks length"),
        (shaped("<box/>"), "box of link `a` lacks size"),
        (shaped("<box size='1 1 NaN'/>"), "box of link `a` has size `1 1 NaN`"),
        (
            "<x:macro xmlns:x='http://www.ros.org/wiki/xacro'/>".to_owned(),
            "macro is an element of xacro; expand the file first",
        ),
    ] {
        let message = read(&text).unwrap_err();
        assert!(message.contains(expected), "{text:?} gave {message:?}");
    }
}
