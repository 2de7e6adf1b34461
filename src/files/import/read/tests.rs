//! Test that both kinds of file give the same body, and that a file which is neither is refused in a line.

use super::*;
use crate::files::body::{JointName, PartEntry, SkinEntry};
use crate::stages::agent::{Freedom, Vector3};

const SKIN: SkinEntry = SkinEntry { sensors: Some(4), per_area: None };

fn imported(text: &str, skin: SkinEntry) -> Result<Imported, Wrong> {
    super::imported(text, &Located::beside(Path::new("")), &Options { skin, ..Options::default() })
}

fn near(a: Vector3, b: Vector3) -> bool {
    a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-9)
}

/// A robot of every shape and joint, all of them turned.
const MJCF: &str = r#"
<mujoco>
  <worldbody>
    <geom type="plane" size="1 1 1"/>
    <body name="trunk" pos="0.1 0.2 0.3" euler="10 20 30">
      <freejoint/>
      <geom type="box" size="0.1 0.2 0.3" pos="0.01 0.02 0.03" euler="30 0 0" mass="2.4"/>
      <body name="arm" pos="0.3 0 0.1" euler="0 90 0">
        <joint axis="0 1 0"/>
        <geom type="cylinder" size="0.05 0.25" pos="0 0 0.25"/>
        <geom type="sphere" size="0.08" pos="0 0 0.6"/>
        <body name="hand" pos="0 0 0.6" euler="0 0 45">
          <joint axis="1 0 0"/>
          <joint axis="0 1 0"/>
          <geom type="capsule" size="0.03 0.1" pos="0 0 0.2"/>
          <body name="thumb" pos="0.05 0 0.2">
            <geom type="sphere" size="0.02"/>
          </body>
        </body>
      </body>
    </body>
  </worldbody>
</mujoco>"#;

/// The same: 10 degrees about x of the frame, then 20 about its y and 30 about its z, are these about fixed axes.
fn urdf() -> String {
    let turn = nalgebra::UnitQuaternion::from_euler_angles(10f64.to_radians(), 0.0, 0.0)
        * nalgebra::UnitQuaternion::from_euler_angles(0.0, 20f64.to_radians(), 0.0)
        * nalgebra::UnitQuaternion::from_euler_angles(0.0, 0.0, 30f64.to_radians());
    let (roll, pitch, yaw) = turn.euler_angles();
    let (right, half) = (std::f64::consts::FRAC_PI_2, std::f64::consts::FRAC_PI_4);
    let shape = |place: &str, rpy: &str, shape: &str| {
        format!("<collision><origin xyz='{place}' rpy='{rpy}'/><geometry>{shape}</geometry></collision>")
    };
    let joint = |name: &str, kind: &str, parent: &str, xyz: &str, rpy: &str, axis: &str| {
        format!(
            "<joint name='to {name}' type='{kind}'><parent link='{parent}'/><child link='{name}'/>\
             <origin xyz='{xyz}' rpy='{rpy}'/>{axis}</joint>"
        )
    };
    let x = "<axis xyz='1 0 0'/>";
    let y = "<axis xyz='0 1 0'/>";
    [
        "<robot name='r'><link name='world'/>".to_owned(),
        joint("thumb", "fixed", "hand", "0.05 0 0.2", "0 0 0", ""),
        joint("trunk", "floating", "world", "0.1 0.2 0.3", &format!("{roll} {pitch} {yaw}"), ""),
        joint("arm", "revolute", "trunk", "0.3 0 0.1", &format!("0 {right} 0"), y),
        joint("wrist", "revolute", "arm", "0 0 0.6", &format!("0 0 {half}"), x),
        joint("hand", "continuous", "wrist", "0 0 0", "0 0 0", y),
        "<link name='wrist'/><link name='hand'>".to_owned(),
        shape("0 0 0.2", "0 0 0", "<capsule radius='0.03' length='0.2'/>"),
        "</link><link name='trunk'><inertial><mass value='2.4'/></inertial>".to_owned(),
        shape("0.01 0.02 0.03", &format!("{} 0 0", 30f64.to_radians()), "<box size='0.2 0.4 0.6'/>"),
        "</link><link name='arm'>".to_owned(),
        shape("0 0 0.25", "0 0 0", "<cylinder radius='0.05' length='0.5'/>"),
        shape("0 0 0.6", "0 0 0", "<sphere radius='0.08'/>"),
        "</link><link name='thumb'><visual><geometry><sphere radius='0.02'/></geometry></visual></link></robot>"
            .to_owned(),
    ]
    .concat()
}

#[test]
fn both_kinds_of_file_give_the_same_body() {
    let (a, b) = (imported(MJCF, SKIN).unwrap(), imported(&urdf(), SKIN).unwrap());
    assert_eq!((&a.notes[..], &b.notes[..]), (&[][..], &[][..]));
    let names = |file: &BodyFile| file.parts.iter().map(|part| part.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&a.file), ["trunk", "arm", "arm/2", "hand", "thumb"]);
    assert_eq!(names(&a.file), names(&b.file));
    let joints = |file: &BodyFile| file.parts.iter().map(|part| part.joint).collect::<Vec<_>>();
    let all = [
        None,
        Some(JointName::Hinge),
        Some(JointName::Fixed),
        Some(JointName::Universal),
        Some(JointName::Fixed),
    ];
    assert_eq!(joints(&a.file), all);
    assert_eq!(joints(&b.file), all);
    assert!((a.file.parts[0].density.unwrap() - 50.0).abs() < 1e-9, "2.4 kg of 0.048 m³");
    let (a, b) = (a.file.body().unwrap(), b.file.body().unwrap());
    assert_eq!(a.rigid_names(), ["trunk", "arm + arm/2", "hand + thumb"]);
    for (a, b) in a.agent.parts.iter().zip(&b.agent.parts) {
        assert!(
            near(a.centre, b.centre) && (0..3).all(|row| near(a.rotation[row], b.rotation[row])),
            "{a:?} {b:?}"
        );
        assert!(
            (a.density - b.density).abs() < 1e-9 && a.shape.area() - b.shape.area() < 1e-9,
            "{a:?} {b:?}"
        );
    }
    for (a, b) in a.agent.joints.iter().zip(&b.agent.joints) {
        assert_eq!((a.parent, a.child), (b.parent, b.child));
        assert!(near(a.anchor, b.anchor), "{a:?} {b:?}");
        match (a.freedom, b.freedom) {
            (Freedom::Hinge(a), Freedom::Hinge(b)) => assert!(near(a, b), "{a:?} {b:?}"),
            (Freedom::Universal(a), Freedom::Universal(b)) => {
                assert!(near(a[0], b[0]) && near(a[1], b[1]), "{a:?} {b:?}");
            }
            (a, b) => assert_eq!(a, b),
        }
    }
}

/// Entities that stand for a billion letters.
fn bomb() -> String {
    let level = |at: usize| format!("<!ENTITY b{} '{}'>", at + 1, format!("&b{at};").repeat(10));
    let levels: String = (0..9).map(level).collect();
    format!("<!DOCTYPE a [<!ENTITY b0 'x'>{levels}]><mujoco>&b9;</mujoco>")
}

#[test]
fn what_is_neither_kind_is_refused() {
    for (text, expected) in [
        ("", "not well-formed XML"),
        ("<mujoco>", "not well-formed XML"),
        ("<mujoco></robot>", "not well-formed XML"),
        ("{\"mujoco\": 1}", "not well-formed XML"),
        ("<!DOCTYPE a [<!ENTITY b 'c'>]><mujoco>&b;</mujoco>", "has no <worldbody>"),
        (&bomb(), "not well-formed XML"),
        ("<sdf version='1.7'/>", "its root is <sdf>, but must be <mujoco> (MJCF) or <robot> (URDF)"),
        ("<mujoco/>", "has no <worldbody>, in which bodies are"),
        ("<mujoco><worldbody/></mujoco>", "no body has a shape"),
        ("<robot/>", "no link has a shape"),
        ("<robot><link name='a'/></robot>", "no link has a shape"),
    ] {
        let message = imported(text, SKIN).unwrap_err();
        assert!(message.contains(expected), "{text:?} gave {message:?}");
    }
    let path = Path::new("no such file.xml");
    assert!(
        import(path, &Options::default())
            .unwrap_err()
            .to_string()
            .starts_with("no such file.xml: cannot be read")
    );
}

#[test]
fn the_limits_are_those_of_the_format() {
    let body =
        |geom: &str| format!("<mujoco><worldbody><body name='a'><geom {geom}/></body></worldbody></mujoco>");
    let refused = |geom: &str| imported(&body(geom), SKIN).unwrap_err();
    let thin = imported(&body("type='cylinder' size='0.0009 1' mass='0.1'"), SKIN).unwrap();
    assert_eq!(thin.file.parts[0].radius, Some(0.001));
    assert_eq!(thin.notes, ["body `a`: 1 of 1 shapes have a length or radius below 1 mm, which became 1 mm"]);
    assert_eq!(refused("size='-1' mass='1'"), "part `a`: radius is -1, but must be 0.001 to 1000 (m)");
    assert!(refused("size='2000'").contains("radius is 2000"));
    assert!(refused("size='1' pos='0 0 5000'").contains("centre is [0.0, 0.0, 5000.0]"));
    assert!(refused("size='1' mass='1e9'").contains("density is 238732414"));
    assert!(refused("size='1' mass='-1'").contains("density is -0.23"));
    assert_eq!(imported(&body("size='1' mass='0'"), SKIN).unwrap().file.parts[0].density, None);
    let skin = |per_area| SkinEntry { sensors: None, per_area: Some(per_area) };
    assert!(imported(&body("size='1'"), skin(f64::NAN)).unwrap_err().contains("skin.per_area is NaN"));
    assert!(imported(&body("size='1'"), skin(1e8)).unwrap_err().contains("sensors, but a body has at most"));
    assert!(imported(&body("size='1'"), skin(0.0)).unwrap_err().contains("it has no sensors"));
    assert_eq!(imported(&body("size='1'"), skin(10.0)).unwrap().file.body().unwrap().agent.sites.len(), 126);
}

#[test]
fn deep_nesting_ends_in_a_message() {
    let depth = 50_000;
    let nested = |open: &str, close: &str| format!("{}{}", open.repeat(depth), close.repeat(depth));
    let mjcf = |inner: &str| format!("<mujoco><worldbody>{inner}</worldbody></mujoco>");
    let bodies = nested("<body><joint/><geom size='0.1'/>", "</body>");
    assert!(imported(&mjcf(&bodies), SKIN).unwrap_err().contains("it has 50000 parts"));
    for inner in [nested("<body pos='1e9 0 0'><joint/>", "</body>"), nested("<frame>", "</frame>")] {
        assert!(imported(&mjcf(&inner), SKIN).unwrap_err().contains("no body has a shape"));
    }
    let links: String = (0..depth)
        .map(|at| {
            format!(
                "<link name='{at}'/><joint name='{at}' type='fixed'><parent link='{at}'/><child link='{}'/></joint>",
                at + 1
            )
        })
        .collect();
    let last = "<visual><geometry><sphere radius='1'/></geometry></visual>";
    let urdf = format!("<robot>{links}<link name='{depth}'>{last}</link></robot>");
    let PartEntry { name, joint, .. } = &imported(&urdf, SKIN).unwrap().file.parts[0];
    assert_eq!((name.as_str(), joint), ("50000", &None));
}

#[test]
fn parts_that_turn_at_one_place_are_named() {
    let leg = |name: &str, x: f64| {
        format!("<body name='{name}'><joint pos='{x} 0 0'/><geom size='0.1' pos='0 0 {x}'/></body>")
    };
    let robot = |apart: f64| {
        let [left, right] = [leg("left", 0.0), leg("right", apart)];
        format!(
            "<mujoco><worldbody><body name='trunk'><geom size='0.2'/>{left}{right}</body></worldbody></mujoco>"
        )
    };
    let notes = |apart: f64| imported(&robot(apart), SKIN).unwrap().notes;
    let note = "several parts turn about one place, where touch cannot tell which of them carries which (3): trunk, left, right";
    assert_eq!(notes(0.0009), [note]);
    assert!(notes(0.0011).is_empty());
    // What has no skin is not felt, so that its joints are at one place, too.
    let bare = "<mujoco><worldbody><body name='trunk'><joint/><body name='a' pos='1 0 0'><joint/><geom size='0.1'/></body>
        <body name='b' pos='-1 0 0'><joint/><geom size='0.1'/></body></body><body name='d'/></worldbody></mujoco>";
    let found = imported(bare, SKIN).unwrap().notes;
    assert!(found.iter().all(|note| !note.contains("one place")), "two parts have one joint: {found:?}");
    let three = bare.replace("<body name='d'/>", "").replace(
        "</body></worldbody>",
        "<body name='c' pos='0 1 0'><joint/><geom size='0.1'/></body></body></worldbody>",
    );
    assert!(imported(&three, SKIN).unwrap().notes.iter().any(|note| note.ends_with("(3): a, b, c")));
}

#[test]
fn each_shape_has_a_sensor_where_some_are_wanted() {
    let robot = "<mujoco><worldbody><body name='a'><geom size='0.1'/><body name='b' pos='1 0 0'><joint/><geom size='0.01'/></body>
        <body name='c' pos='2 0 0'><joint/><geom type='ellipsoid' size='0.008 0.008 0.01'/></body></body></worldbody></mujoco>";
    let skin = SkinEntry { sensors: None, per_area: Some(300.0) };
    let Imported { file, notes, .. } = imported(robot, skin).unwrap();
    let agent = file.body().unwrap().agent;
    let count = |part: usize| agent.sites.iter().filter(|site| site.part == part).count();
    assert_eq!([0, 1, 2].map(count), [38, 1, 1]);
    assert_eq!(notes, ["parts too small for a sensor at this number per area have one (2): b, c"]);
    let none = SkinEntry { sensors: None, per_area: Some(0.0) };
    assert!(imported(robot, none).unwrap_err().contains("it has no sensors"));
}

#[test]
fn a_body_of_millimetres_is_told() {
    let robot = |size: &str| {
        format!("<mujoco><worldbody><body name='a'><geom size='{size}'/></body></worldbody></mujoco>")
    };
    let notes = imported(&robot("300"), SKIN).unwrap().notes;
    assert!(
        notes[0].starts_with("the body spans 300 m; if its lengths or meshes are in millimetres"),
        "{notes:?}"
    );
    assert!(imported(&robot("3"), SKIN).unwrap().notes.is_empty());
}

#[test]
fn a_misspelt_attribute_is_told() {
    let mjcf = "<mujoco><worldbody>\n<body name='a'><geom size='1' mas='3'/></body></worldbody></mujoco>";
    let urdf = "<robot><link name='a'>\n<collision><geometry><sphere radius='1' mas='3'/></geometry></collision></link></robot>";
    for (text, tag) in [(mjcf, "geom"), (urdf, "sphere")] {
        let note = format!("attributes that are not known are ignored (1): `mas` of {tag} (line 2)");
        assert_eq!(imported(text, SKIN).unwrap().notes, [note]);
        let strict = Options { skin: SKIN, strict: true, ..Options::default() };
        let refused = super::imported(text, &Located::beside(Path::new("")), &strict).unwrap_err();
        assert_eq!(
            refused,
            format!("line 2: {tag} has an attribute `mas`, which is not known; correct or remove it")
        );
    }
}

/// Every prefix of a file, and every file with a character changed, gives a body or a line.
#[test]
fn damaged_files_give_a_body_or_a_line() {
    for text in [MJCF.to_owned(), urdf()] {
        let mut bodies = 0;
        for at in (0..text.len()).filter(|&at| text.is_char_boundary(at)) {
            for with in ["", "\"", "-", "9", "e", " ", "<"] {
                let rest = text[at..].chars().next().map_or(0, char::len_utf8);
                let damaged = format!("{}{with}{}", &text[..at], &text[at + rest..]);
                match imported(&damaged, SKIN) {
                    Ok(found) => {
                        bodies += 1;
                        let agent = found.file.body().unwrap().agent;
                        assert!(agent.parts.iter().all(|part| part.centre.iter().all(|x| x.is_finite())));
                    }
                    Err(message) => assert!(!message.is_empty()),
                }
            }
            assert!(imported(&text[..at], SKIN).is_err());
        }
        assert!(bodies > 100, "{bodies}");
    }
}
