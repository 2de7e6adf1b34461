//! Test what a body file means, and that every mistake is named.

use super::*;
use crate::stages::agent::{Freedom, Inertia, Joint, Shape};

const TRUNK: &str =
    "[[part]]\nname = \"trunk\"\nshape = \"capsule\"\nradius = 0.1\nfrom = [0, 0, 0]\nto = [0, 0, 0.5]\n";

fn read(text: &str) -> Result<NamedBody, String> {
    let file = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(file.path(), text).unwrap();
    read_body(file.path()).map_err(|error| {
        let message = error.to_string();
        message.split_once(": ").unwrap().1.to_owned()
    })
}

/// A trunk of 50 sensors, and a part `arm` with these lines.
fn with_arm(lines: &str) -> Result<NamedBody, String> {
    read(&format!("skin = {{ sensors = 50 }}\n{TRUNK}\n[[part]]\nname = \"arm\"\n{lines}"))
}

#[test]
fn a_body_of_every_shape_and_joint_is_read_as_it_is_meant() {
    let body = with_arm(
        "shape = \"box\"\ncentre = [0, 0.3, 0]\nsize = [0.1, 0.2, 0.3]\nquaternion = [1, 0, 0, 1]\nparent = \"trunk\"\n\
         joint = \"hinge\"\nanchor = [0, 0.1, 0]\naxes = [[0, 0, 2]]\ndensity = 500\nskin = { per_area = 100 }\n\
         [[part]]\nname = \"hand\"\nshape = \"sphere\"\ncentre = [0, 0.5, 0]\nradius = 0.05\nparent = \"arm\"\n\
         joint = \"fixed\"\nanchor = [0, 0.45, 0]\nskin = { sensors = 0 }\n\
         [[part]]\nname = \"tool\"\nshape = \"cylinder\"\nfrom = [0, 0.5, 0]\nto = [0, 0.9, 0]\nradius = 0.02\n\
         parent = \"hand\"\njoint = \"universal\"\n",
    )
    .unwrap();
    let Agent { parts, joints, sites } = &body.agent;
    assert_eq!(body.names, ["trunk", "arm", "hand", "tool"]);
    assert_eq!(body.rigid_names(), ["trunk", "arm + hand", "tool"]);
    assert_eq!(parts[0].shape, Shape::Capsule { radius: 0.1, length: 0.5 });
    assert_eq!(
        (parts[0].centre, parts[0].axis(), parts[0].density),
        ([0.0, 0.0, 0.25], [0.0, 0.0, 1.0], 1000.0)
    );
    assert_eq!((parts[1].shape, parts[1].density), (Shape::Box { sides: [0.1, 0.2, 0.3] }, 500.0));
    // A quarter of a turn about z takes x to y.
    let turned = parts[1].rotation.map(|row| row[0]);
    assert!((turned[1] - 1.0).abs() < 1e-12, "{turned:?}");
    assert_eq!(
        joints[0],
        Joint { parent: 0, child: 1, anchor: [0.0, 0.1, 0.0], freedom: Freedom::Hinge([0.0, 0.0, 1.0]) }
    );
    assert_eq!(joints[1].freedom, Freedom::Fixed);
    assert_eq!(joints[2].anchor, [0.0, 0.5, 0.0]);
    let Freedom::Universal(axes) = joints[2].freedom else { panic!("{:?}", joints[2]) };
    assert!(axes.iter().all(|axis| axis[1].abs() < 1e-12), "both are across the tool: {axes:?}");
    // 100 for a square metre of 0.22 m².
    assert_eq!(
        sites.iter().map(|site| site.part).fold([0; 4], |mut all, part| {
            all[part] += 1;
            all
        }),
        [50, 22, 0, 50]
    );
}

#[test]
fn an_inertia_is_that_of_the_file_and_about_the_middle_if_it_names_no_centre() {
    let of = |inertia: &str| {
        let text = format!("skin = {{ sensors = 8 }}\n{TRUNK}inertia = {{ {inertia} }}\n");
        read(&text).unwrap().agent.parts[0].inertia.unwrap()
    };
    assert_eq!(
        of("moments = [2, 2.5, 3], products = [0.1, 0.2, 0.3], centre = [4, 5, 6]"),
        Inertia { centre: [4.0, 5.0, 6.0], tensor: [[2.0, 0.1, 0.2], [0.1, 2.5, 0.3], [0.2, 0.3, 3.0]] }
    );
    assert_eq!(of("moments = [1, 1, 1]").centre, [0.0, 0.0, 0.25]);
}

#[test]
fn what_is_written_is_read_again() {
    let inertia = "inertia = { moments = [1.0, 2.0, 3.0] }\nplaces = [[0.0, 0.0, 0.0, 0.0, 0.0, 1.0]]\n";
    let file: BodyFile =
        toml::from_str(&format!("density = 900.0\nskin = {{ sensors = 8 }}\n{TRUNK}{inertia}")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("body.toml");
    write_body(&path, "Two lines\nof remark", &file).unwrap();
    assert!(std::fs::read_to_string(&path).unwrap().starts_with("# Two lines\n# of remark\n"));
    assert_eq!(read_body(&path).unwrap(), file.body().unwrap());
}

#[test]
fn every_mistake_is_one_line_that_names_the_part() {
    let joined = "parent = \"trunk\"\njoint = \"ball\"\n";
    let rod = "shape = \"cylinder\"\nfrom = [0, 0, 0]\nto = [0, 0, 1]\nradius = 0.1\n";
    for (lines, expected) in [
        (format!("{rod}radus = 0.1\n{joined}"), "line 15: unknown field `radus`"),
        (
            format!("{rod}centre = [0, 0, 0]\n{joined}"),
            "part `arm`: it has centre, which a cylinder does not have",
        ),
        (
            format!("shape = \"sphere\"\nradius = 0.1\n{joined}"),
            "part `arm`: it lacks centre, which a sphere needs",
        ),
        (format!("shape = \"cone\"\n{joined}"), "unknown variant `cone`"),
        (format!("{}{joined}", rod.replace("radius = 0.1", "radius = nan")), "part `arm`: radius is NaN"),
        (
            format!("{}{joined}", rod.replace("to = [0, 0, 1]", "to = [0, 0, 0]")),
            "the distance of from and to is 0",
        ),
        (
            format!("{}{joined}", rod.replace("to = [0, 0, 1]", "to = [0, 0, inf]")),
            "part `arm`: to is [0.0, 0.0, inf]",
        ),
        (
            format!("{}{joined}", rod.replace("to = [0, 0, 1]", "to = [0, 0, 1, 1]")),
            "part `arm`: to has 4 numbers, but needs 3",
        ),
        (
            format!("{rod}parent = \"trunk\"\njoint = \"hinge\"\naxes = [[0, 0, 1, 2]]\n"),
            "part `arm`: axes has 4 numbers",
        ),
        (
            format!("{rod}{joined}inertia = {{ moments = [1, 1, 3] }}\n"),
            "part `arm`: its inertia must have no principal moment above the sum of the other two",
        ),
        (
            format!("{rod}{joined}inertia = {{ moments = [1, 1, 0] }}\n"),
            "part `arm`: its inertia must have principal moments of the mass times the square of",
        ),
        (
            format!("{rod}{joined}inertia = {{ centre = [0, 0, inf], moments = [1, 1, 1] }}\n"),
            "part `arm`: inertia.centre is [0.0, 0.0, inf]",
        ),
        (
            format!("{rod}{joined}inertia = {{ moments = [1, 1, 1, 1] }}\n"),
            "part `arm`: moments has 4 numbers, but needs 3",
        ),
        (format!("{rod}{joined}inertia = {{ centre = [0, 0, 0] }}\n"), "missing field `moments`"),
        (format!("{rod}density = 0\n{joined}"), "part `arm`: density is 0"),
        (rod.to_owned(), "part `arm`: it lacks parent"),
        (
            format!("{rod}parent = \"leg\"\njoint = \"ball\"\n"),
            "part `arm`: its parent `leg` is not an earlier part",
        ),
        (format!("{rod}parent = \"trunk\"\n"), "part `arm`: it lacks joint"),
        (format!("{rod}parent = \"trunk\"\njoint = \"hinge\"\n"), "part `arm`: a hinge needs axes"),
        (format!("{rod}{joined}axes = [[0, 0, 1]]\n"), "part `arm`: it has axes"),
        (
            format!("{rod}parent = \"trunk\"\njoint = \"hinge\"\naxes = [[0, 0, 0]]\n"),
            "part `arm`: an axis is",
        ),
        (
            format!("{rod}parent = \"trunk\"\njoint = \"universal\"\naxes = [[0, 0, 1], [0, 1, 1]]\n"),
            "part `arm`: its axes are not at right angles",
        ),
        (format!("{rod}{joined}skin = {{ sensors = 9, per_area = 9 }}\n"), "part `arm`: skin has both"),
        (format!("{rod}{joined}skin = {{ sensors = 30000 }}\n"), "part `arm`: it has 30000 sensors"),
        (format!("{rod}{joined}skin = {{ per_area = -1 }}\n"), "part `arm`: skin.per_area is -1"),
        (
            format!(
                "shape = \"box\"\ncentre = [0, 0, 0]\nsize = [1, 1, 1]\nquaternion = [0, 0, 0, 0]\n{joined}"
            ),
            "part `arm`: quaternion is",
        ),
        (
            format!("shape = \"box\"\ncentre = [0, 0, 0]\nsize = [1, 1, 1]\n{joined}"),
            "part `arm`: it lacks anchor",
        ),
    ] {
        let message = with_arm(&lines).unwrap_err();
        assert!(message.contains(expected) && !message.contains('\n'), "{lines:?} gave {message:?}");
    }
    assert!(read("").unwrap_err().contains("0 parts ([[part]])"));
    assert!(read(TRUNK).unwrap_err().contains("no sensors"));
    assert!(read(&format!("{TRUNK}joint = \"ball\"\n")).unwrap_err().contains("a joint but no parent"));
    assert!(read(&format!("{TRUNK}{TRUNK}")).unwrap_err().contains("another part has this name"));
    assert!(read("[[part]\n").unwrap_err().contains("line 1"));
}

#[test]
fn sensors_at_given_places_are_in_the_frame_of_their_part() {
    let turned = "[[part]]\nname = \"a\"\nshape = \"box\"\nsize = [1, 1, 1]\ncentre = [0, 0, 2]\nquaternion = [1, 0, 0, 1]\n";
    let body = read(&format!("{turned}places = [[0, 0.5, 2, 0, 3, 0], [0, 0, 2.5, 0, 0, 1]]")).unwrap();
    let [first, second] = &body.agent.sites[..] else { panic!("{:?}", body.agent.sites) };
    // A quarter of a turn about z: what is y in the file is x on the part.
    let near =
        |found: Vector3, expected: Vector3| found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12);
    assert!(near(first.position, [0.5, 0.0, 0.0]) && near(first.normal, [1.0, 0.0, 0.0]), "{first:?}");
    assert!(near(second.position, [0.0, 0.0, 0.5]) && near(second.normal, [0.0, 0.0, 1.0]), "{second:?}");
    for (places, expected) in [
        ("places = [[0, 0, 0, 0, 0, 0]]", "the direction of a place is [0.0, 0.0, 0.0], but must be"),
        ("places = [[0, 0, nan, 0, 0, 1]]", "a place is [0.0, 0.0, NaN], but must be numbers"),
        ("places = [[0, 0, 0, 0, 0, 1, 2]]", "places has 7 numbers, but needs 6"),
        ("places = []\nskin = { sensors = 3 }", "it has both skin and places; give one"),
        ("places = []", "it has no sensors"),
    ] {
        let message = read(&format!("{turned}{places}")).unwrap_err();
        assert!(message.contains(expected), "{places}: {message}");
    }
}
