//! Test that URDF means what ROS's documentation says, by hand-computed places and axes, and that every mistake is named.

use roxmltree::Document;

use super::*;

fn read(content: &str) -> Result<Vec<Link>, Wrong> {
    links(Document::parse(&format!("<robot name='r'>{content}</robot>")).unwrap().root_element())
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
    for meshes in [visual(MESH), collision(MESH), [collision(BALL), collision(MESH)].concat()] {
        let message = count(&meshes).unwrap_err();
        assert_eq!(
            message,
            "line 1: link `a` has a mesh; give it boxes, spheres, cylinders or capsules as its collision"
        );
    }
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
        read(&text).map(|links| links[0].solids.iter().map(|solid| solid.density).collect::<Vec<_>>())
    };
    assert_eq!(densities("3"), Ok(vec![Some(1.5); 2]));
    assert_eq!(densities("0"), Ok(vec![None; 2]));
    assert_eq!(
        densities("").unwrap_err(),
        "line 1: mass of link `a` has value ``, which must be a number up to 1e9"
    );
}

#[test]
fn links_that_are_no_tree_are_refused() {
    for (text, expected) in [
        (links_of("a a"), "link `a` exists twice"),
        (links_of("a b"), "links `a` and `b` are both roots"),
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
        (joined("revolute", "<axis/>"), "axis of joint `a-b` lacks xyz"),
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
