//! Test that what is attached is what MuJoCo's documentation says: with its own units, defaults, meshes and places, under new names.

use std::fs;

use nalgebra::Vector3;

use super::super::links;
use super::*;
use crate::files::import::placed::{Link, Read, Turn};
use crate::files::import::text::written_out;
use crate::stages::agent::Shape;

/// What is read of the first of these files.
fn read(files: &[(&str, &str)], strict: bool) -> Result<Read, Wrong> {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    let path = folder.path().join(files[0].0);
    let located = Located::beside(&path);
    let text = written_out(&path, &located)?;
    links(parsed(&text)?.root_element(), &located, strict)
}

fn names(links: &[Link]) -> Vec<&str> {
    links.iter().map(|link| &*link.name).collect()
}

#[track_caller]
fn near(found: Vector3<f64>, expected: [f64; 3]) {
    assert!((found - Vector3::from(expected)).norm() < 1e-9, "{found:?} is not {expected:?}");
}

/// A base in degrees that attaches an arm in radians, which has its own defaults and folder of meshes.
const ARM: &str = "<mujoco model='arm'><compiler angle='radian' meshdir='meshes' eulerseq='zyx'/>
<asset><mesh name='m' file='m.obj'/></asset>
<default><geom type='capsule' size='0.1 0.2'/><default class='c'><geom size='0.3'/></default></default>
<worldbody><frame pos='9 9 9'><body name='shoulder' pos='0 0 1' euler='1.5707963267948966 0 0' childclass='c'>
  <joint axis='1 0 0'/><geom/><geom type='mesh' mesh='m' class='main'/>
  <body name='hand' pos='1 0 0'><geom size='0.5'/></body>
</body></frame><body name='other'><geom/></body></worldbody></mujoco>";
const MESH: &str = "v 0 0 0\nv 2 0 0\nv 0 4 0\nv 0 0 6\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

#[test]
fn what_is_attached_keeps_its_units_its_defaults_and_its_meshes() {
    let robot = "<mujoco><default><geom type='box' size='1 1 1'/><default class='c'><geom size='9'/></default></default>
        <asset><model name='a' file='arm/arm.xml'/></asset>
        <worldbody><body name='base' euler='0 0 90'><geom/>
          <frame pos='1 0 0'><attach model='a' body='shoulder' prefix='left-'/></frame>
          <attach model='a' body='shoulder' prefix='right-'/></body></worldbody></mujoco>";
    let Read { links, notes } =
        read(&[("r.xml", robot), ("arm/arm.xml", ARM), ("arm/meshes/m.obj", MESH)], true).unwrap();
    assert_eq!(names(&links), ["base", "left-shoulder", "left-hand", "right-shoulder", "right-hand"]);
    assert_eq!(
        links.iter().map(|link| link.parent).collect::<Vec<_>>(),
        [None, Some(0), Some(1), Some(0), Some(3)]
    );
    assert_eq!(links[0].solids[0].shape, Shape::Box { sides: [2.0; 3] });
    let shapes: Vec<Shape> = links[1].solids.iter().map(|solid| solid.shape).collect();
    assert_eq!(shapes, [Shape::Capsule { radius: 0.3, length: 0.4 }, Shape::Box { sides: [2.0, 4.0, 6.0] }]);
    assert_eq!(links[2].solids[0].shape, Shape::Capsule { radius: 0.5, length: 0.4 });
    // The frame around it in its own model does not count. Both it and the base are turned by a right angle about z.
    near(links[1].origin, [0.0, 1.0, 1.0]);
    near(links[2].origin, [-1.0, 1.0, 1.0]);
    near(links[3].origin, [0.0, 0.0, 1.0]);
    let [Turn::Hinge { axis, .. }] = &links[1].turns[..] else { panic!("{links:?}") };
    near(*axis, [-1.0, 0.0, 0.0]);
    assert!(notes.is_empty(), "{notes:?}");
}

#[test]
fn worlds_frames_and_bodies_of_the_model_itself_are_attached() {
    let arm = ("arm.xml", ARM);
    let mesh = ("meshes/m.obj", MESH);
    let of = |inside: &str| {
        let robot = format!(
            "<mujoco><asset><model file='arm.xml'/></asset><worldbody><body name='base'><geom size='1'/>{inside}</body></worldbody></mujoco>"
        );
        read(&[("r.xml", &robot), arm, mesh], true).unwrap().links
    };
    let world = of("<attach model='arm' prefix='a/'/>");
    assert_eq!(names(&world), ["base", "a/shoulder", "a/hand", "a/other"]);
    near(world[1].origin, [9.0, 9.0, 10.0]);
    let own = of("<frame name='f' pos='1 0 0'><body name='leg' pos='0 1 0'><geom size='1'/></body></frame>
        <frame pos='0 0 5'><attach frame='f' prefix='b-'/><attach body='leg' prefix='c-'/></frame>");
    assert_eq!(names(&own), ["base", "leg", "b-leg", "c-leg"]);
    near(own[2].origin, [1.0, 1.0, 5.0]);
    near(own[3].origin, [0.0, 1.0, 5.0]);
    let copies = of("<replicate count='2' sep='_'><attach model='arm' body='other' prefix='x'/></replicate>");
    assert_eq!(names(&copies), ["base", "xother_0", "xother_1"]);
}

#[test]
fn models_attach_models_and_their_names_add_up() {
    let of = |file: &str, model: &str| {
        format!(
            "<mujoco model='{model}'><asset><model name='next' file='{file}'/></asset><worldbody><body name='{model}'>
             <geom size='1'/><attach model='next' prefix='{model}-'/></body></worldbody>
             <equality><weld body1='{model}' body2='{model}-c'/></equality></mujoco>"
        )
    };
    let last = "<mujoco><worldbody><body name='c'><geom size='1'/></body></worldbody></mujoco>";
    let texts = [of("b/b.xml", "a"), of("c.xml", "b")];
    let files = [("a.xml", &*texts[0]), ("b/b.xml", &*texts[1]), ("b/c.xml", last)];
    let found = read(&files, false).unwrap();
    assert_eq!(names(&found.links), ["a", "a-b", "a-b-c"]);
    // That of the first names `a-c`, which nobody has: it is a mistake of theirs, and told as they have it.
    assert_eq!(
        found.notes,
        ["ties between bodies beside the tree are left out (2): a with a-c, a-b with a-b-c"]
    );
}

#[test]
fn what_cannot_be_attached_is_refused_with_its_file_and_line() {
    let robot = |inside: &str| {
        format!(
            "<mujoco><asset><model name='a' file='a.xml'/></asset><worldbody><body name='base'>\n{inside}</body></worldbody></mujoco>"
        )
    };
    let good = "<mujoco>\n<worldbody><body name='arm'><geom size='1'/></body></worldbody></mujoco>";
    for (inside, other, expected) in [
        (
            "<attach model='b' prefix=''/>",
            good,
            "line 2: attach of body `base` has model `b`, which no asset is",
        ),
        ("<attach model='a'/>", good, "line 2: attach of body `base` lacks prefix"),
        ("<attach prefix=''/>", good, "lacks model, body and frame"),
        ("<attach model='a' body='leg' prefix=''/>", good, "has body `leg`, which its model does not have"),
        ("<attach body='base' prefix='x'/>", good, "attaches what contains it"),
        (
            "<attach model='a' prefix=''/>",
            "<robot/>",
            "a.xml: its root is <robot>, but what is attached must be",
        ),
        ("<attach model='a' prefix=''/>", "<mujoco>", "a.xml: this is not well-formed XML"),
        (
            "<attach model='a' prefix='x-'/>",
            "<mujoco>\n<worldbody><body name='arm'>\n<geom size='b'/></body></worldbody></mujoco>",
            "a.xml line 3: geom of body `x-arm` has size `b`",
        ),
        (
            "<attach model='a' prefix=''/>",
            "<mujoco><asset><model name='r' file='r.xml'/></asset>\n<worldbody><body><attach model='r' prefix='y'/></body></worldbody></mujoco>",
            "attaches what contains it",
        ),
    ] {
        let message = read(&[("r.xml", &robot(inside)), ("a.xml", other)], false).unwrap_err();
        assert!(message.contains(expected), "{inside} gave {message}");
    }
    let gone = read(&[("r.xml", &robot("<attach model='a' prefix=''/>"))], false).unwrap_err();
    assert!(gone.contains("model names `a.xml`, which is not there"), "{gone}");
    // Each attaches the one before twice.
    let many: String = (1..40)
        .map(|at| {
            let below = at - 1;
            format!("<frame name='{at}'><attach frame='{below}' prefix='{at}a'/><attach frame='{below}' prefix='{at}b'/></frame>")
        })
        .collect();
    let many =
        read(&[("r.xml", &robot(&format!("<frame name='0'><site/></frame>{many}"))), ("a.xml", good)], false);
    assert!(many.unwrap_err().contains("and others attach more than"));
}

#[test]
fn soft_bodies_and_plugins_are_left_out_with_a_note() {
    let of = |inside: &str, strict| {
        let robot = format!(
            "<mujoco><worldbody><body name='a'><geom size='1'/>{inside}</body></worldbody>
             <deformable><flex name='skin' body='a'/></deformable></mujoco>"
        );
        read(&[("r.xml", &robot)], strict)
    };
    let rope = "<composite type='cable' prefix='rope' count='9 1 1'><joint kind='main'/><geom size='.1'/></composite>";
    let rest = "<flexcomp name='cloth' type='grid'><edge/><pin id='1'/></flexcomp><plugin plugin='p'/>";
    let found = of(&format!("{rope}{rest}"), false).unwrap();
    assert_eq!(names(&found.links), ["a"]);
    assert_eq!(
        found.notes,
        [
            "soft bodies (composite, flex) are no rigid parts and left out (3): rope, cloth, skin",
            "plugins of bodies are left out (1): p"
        ]
    );
    assert!(of(rope, true).unwrap_err().contains("composite of body `a` is a soft body, and no rigid part"));
    assert!(of("", true).unwrap_err().contains("flex is a soft body"));
}
