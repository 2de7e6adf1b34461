//! `bodyschema body import` as a user meets it: descriptions of both kinds, and mistakes.

use std::f32::consts::{PI, TAU};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use bodyschema::files::body::{NamedBody, read_body};
use bodyschema::stages::agent::{Freedom, Shape};

use crate::support::folder::Folder;
use crate::support::repository::repository;
use crate::support::said::Said;

fn data(name: &str) -> PathBuf {
    repository("tests/data/import").join(name)
}

/// Makes `body.toml` of a description.
fn import(folder: &Folder, file: &Path, options: &str) -> Said {
    Said::by(folder.command(&format!("body import {options} --out body.toml")).arg(file))
}

/// The body that a description becomes, and what the program says of it.
fn imported(name: &str, options: &str) -> (NamedBody, String) {
    let folder = Folder::new();
    let said = import(&folder, &data(name), options);
    assert_eq!((said.status, &*said.err), (Some(0), ""), "{said:?}");
    (read_body(&folder.at("body.toml")).unwrap(), said.out)
}

#[track_caller]
fn near(found: [f64; 3], expected: [f64; 3]) {
    assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9), "{found:?} is not {expected:?}");
}

#[test]
fn mjcf_becomes_a_body() {
    let (body, told) = imported("arm.xml", "");
    assert!(told.starts_with("5 parts, in "), "{told}");
    assert!(told.contains("joints: 1 universal, 2 hinge, 0 ball, 1 fixed\n"), "{told}");
    assert_eq!(body.rigid_names(), ["trunk", "upper arm", "forearm", "hand + hand/2"]);
    let agent = &body.agent;
    assert_eq!(agent.sites.len(), 5 * 40);
    assert!(agent.parts.iter().all(|part| part.density == 1100.0));
    assert_eq!(agent.parts[0].shape, Shape::Box { sides: [0.2, 0.3, 0.5] });
    // The arm's z points to y of the world.
    near(agent.parts[1].axis(), [0.0, 1.0, 0.0]);
    near(agent.parts[1].centre, [0.0, 0.35, 1.2]);
    near(agent.joints[1].anchor, [0.0, 0.55, 1.2]);
    let Freedom::Hinge(axis) = agent.joints[1].freedom else { panic!("{:?}", agent.joints) };
    near(axis, [0.0, 0.0, -1.0]);
    let Freedom::Universal([first, second]) = agent.joints[2].freedom else { panic!("{:?}", agent.joints) };
    near(first, [1.0, 0.0, 0.0]);
    near(second, [0.0, 0.0, -1.0]);
}

#[test]
fn urdf_becomes_a_body() {
    let (body, told) = imported("arm.urdf", "--per-area 100");
    assert!(told.contains("joints: 0 universal, 1 hinge, 0 ball, 1 fixed\n"), "{told}");
    assert_eq!(body.rigid_names(), ["base", "arm + tool"]);
    let agent = &body.agent;
    near(agent.parts[0].centre, [0.0, 0.0, 0.1]);
    assert!((agent.parts[0].density - 3.0 / (0.002 * std::f64::consts::PI)).abs() < 1e-6);
    near(agent.parts[1].axis(), [1.0, 0.0, 0.0]);
    near(agent.parts[2].centre, [0.4, 0.0, 0.25]);
    near(agent.joints[0].anchor, [0.0, 0.0, 0.25]);
    assert_eq!(agent.joints[0].freedom, Freedom::Hinge([0.0, 1.0, 0.0]));
    let sensors = |at: usize| agent.sites.iter().filter(|site| site.part == at).count();
    assert_eq!([0, 1, 2].map(sensors), [19, 11, 1]);
    let (body, _) = imported("arm.urdf", "--sensors-per-part 7");
    assert_eq!(body.agent.sites.len(), 21);
}

#[test]
fn a_robot_of_meshes_is_felt_on_its_meshes() {
    let folder = Folder::new();
    let said = import(&folder, &data("robot/urdf/robot.urdf"), "--sensors-per-part 30");
    assert_eq!((said.status, &*said.err), (Some(0), ""), "{said:?}");
    for note in [
        "link `tool`: mesh `package://robot/meshes/gone.stl` is not there; a box with its inertia",
        "joints that do not turn are held at their rest place (1): slider (prismatic)",
        "the body is the tree of `base`; other trees are left out (--root keeps another) (1): target",
    ] {
        assert!(said.out.contains(note), "{said:?} lacks {note}");
    }
    let body = read_body(&folder.at("body.toml")).unwrap();
    assert_eq!(body.rigid_names(), ["base", "arm + tool + slider"]);
    let agent = &body.agent;
    // The mesh is an upright roof of 0.2 x 0.3 m, 0.1 m high, and both of its scales are millimetres.
    assert_eq!(agent.parts[0].shape, Shape::Box { sides: [0.2, 0.3, 0.1] });
    let on_base = agent.sites.iter().filter(|site| site.part == 0);
    let slope = (0.1_f64 / 0.15).atan();
    let mut slanted = 0;
    for site in on_base {
        let [x, y, z] = [0, 1, 2].map(|axis| site.position[axis] + agent.parts[0].centre[axis]);
        let on_roof = (z - 0.1 * (1.0 - y.abs() / 0.15)).abs() < 1e-9;
        assert!(on_roof || z.abs() < 1e-9 || (x.abs() - 0.1).abs() < 1e-9, "{site:?} lies on no face");
        if site.normal[2] > 0.0 {
            slanted += 1;
            assert!((site.normal[2] - slope.cos()).abs() < 1e-9, "{site:?}");
        }
    }
    assert!((10..20).contains(&slanted), "{slanted} of 30: two of five faces, with 45 % of the area");
    let mass: f64 = agent.parts.iter().map(|part| part.density * volume(&part.shape)).sum();
    assert!((mass - 6.0).abs() < 1e-6, "{mass} kg");
    folder.run("simulate --body body.toml --duration 2 --out felt");
}

fn volume(shape: &Shape) -> f64 {
    match *shape {
        Shape::Box { sides } => sides.iter().product(),
        _ => panic!("{shape:?} is no box"),
    }
}

/// A mesh of 10 MB as two links, with 500 MiB of memory for the whole process.
#[test]
fn a_large_mesh_takes_little_memory() {
    let folder = Folder::new();
    let side = 316;
    let place = |i: usize, j: usize| {
        let (around, along) = (i as f32 / side as f32 * TAU, j as f32 / side as f32 * PI);
        [0.1 * along.sin() * around.cos(), 0.1 * along.sin() * around.sin(), 0.15 * along.cos()]
    };
    let mut mesh = vec![0; 80];
    mesh.extend(((2 * side * side) as u32).to_le_bytes());
    for (i, j) in (0..side).flat_map(|i| (0..side).map(move |j| (i, j))) {
        let [a, b, c, d] = [place(i, j), place(i + 1, j), place(i + 1, j + 1), place(i, j + 1)];
        for triangle in [[[0.0; 3], a, c, b], [[0.0; 3], a, d, c]] {
            mesh.extend(triangle.iter().flatten().flat_map(|number| number.to_le_bytes()));
            mesh.extend([0; 2]);
        }
    }
    assert!(mesh.len() > 9_900_000);
    folder.write("ball.stl", mesh);
    let link = |name: &str| {
        format!(
            "<link name=\"{name}\"><collision><geometry><mesh filename=\"ball.stl\"/></geometry></collision></link>"
        )
    };
    let joint = "<joint name=\"j\" type=\"revolute\"><parent link=\"a\"/><child link=\"b\"/><origin xyz=\"0 0 0.3\"/></joint>";
    folder.write("balls.urdf", format!("<robot name=\"r\">{}{}{joint}</robot>", link("a"), link("b")));
    let program = env!("CARGO_BIN_EXE_bodyschema");
    let limited = format!("ulimit -v {}; exec {program} body import balls.urdf --out body.toml", 500 * 1024);
    let said = Said::by(Command::new("bash").args(["-c", &limited]).current_dir(folder.path()));
    assert_eq!((said.status, &*said.err), (Some(0), ""), "{said:?}");
    assert!(said.out.starts_with("2 parts, in body.toml"), "{said:?}");
}

#[test]
fn a_mistake_is_one_line_and_leaves_no_file() {
    let folder = Folder::new();
    for (name, expected) in [
        ("mesh.xml", "mesh.xml: line 6: geom of body `arm` has mesh `arm`, which no asset is; add it"),
        ("cut-mesh.urdf", "cut-mesh.urdf: line 4: mesh of link `a` cannot be read: cut.stl: "),
        ("cut.xml", "cut.xml: this is not well-formed XML"),
        ("loop.urdf", "loop.urdf: link `a` is in a loop of joints"),
        ("number.urdf", "number.urdf: line 2: sphere of link `a` has radius `wide`, which must be a number"),
        ("absent.xml", "absent.xml: cannot be read"),
    ] {
        let said = import(&folder, &data(name), "");
        said.is_refused(expected);
        assert!(said.err.starts_with("bodyschema: "), "{name}: {}", said.err);
        assert!(!folder.at("body.toml").exists(), "{name}");
    }
    // Files that would lead out of the folder, into a loop, or to more text than there is memory.
    let deep = folder.at("1/2/3/4/5");
    fs::create_dir_all(&deep).unwrap();
    fs::copy(data("cut.stl"), folder.at("far.stl")).unwrap();
    let level = |at: usize| format!("<!ENTITY b{} '{}'>", at + 1, format!("&b{at};").repeat(10));
    let levels: String = (0..9).map(level).collect();
    let bomb = |tag: &str| format!("<!DOCTYPE a [<!ENTITY b0 'x'>{levels}]><{tag}>&b9;</{tag}>");
    let far = "<mujoco><asset><mesh name='m' file='../../../../../far.stl'/></asset>\
               <worldbody><body name='a'><geom type='mesh' mesh='m'/></body></worldbody></mujoco>";
    for (name, text, expected) in [
        ("loop.xml", "<mujoco><include file='loop.xml'/></mujoco>", "which includes this file in turn"),
        (
            "bomb.xml",
            &*bomb("mujoco"),
            "bomb.xml: this is not well-formed XML: a possible entity reference loop",
        ),
        (
            "bomb.urdf",
            &*bomb("robot"),
            "bomb.urdf: this is not well-formed XML: a possible entity reference loop",
        ),
        ("far.xml", far, "more than 4 folders above; copy it beside the description"),
    ] {
        fs::write(deep.join(name), text).unwrap();
        import(&folder, &deep.join(name), "").is_refused(expected);
        assert!(!folder.at("body.toml").exists(), "{name}");
    }
    let robot = data("robot/urdf/robot.urdf");
    import(&folder, &robot, "--per-area 1e15")
        .is_refused("link `base`: skin.per_area is 1000000000000000, but must be");
    import(&folder, &robot, "--sensors-per-part 999999999999")
        .is_refused("link `base`: it has 999999999999 sensors, but");
    import(&folder, &data("slide.urdf"), "--strict")
        .is_refused("slide.urdf: link `b`: its joint is `prismatic`");
    import(&folder, &data("arm.xml"), "--root arm")
        .is_refused("arm.xml: no body is called `arm` (--root); give the name");
    // The description itself is not written over.
    fs::copy(data("arm.xml"), folder.at("arm.xml")).unwrap();
    folder.refuse("body import arm.xml --out arm.xml", "is the input file");
    assert_eq!(folder.bytes("arm.xml"), fs::read(data("arm.xml")).unwrap());
    let both = import(&folder, &data("arm.xml"), "--per-area 9 --sensors-per-part 9");
    assert_eq!(both.status, Some(2));
    assert!(!folder.at("body.toml").exists());
}
