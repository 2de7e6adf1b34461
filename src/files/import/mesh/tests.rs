//! Test meshes by bodies whose volume, area and box are known, in every format, and what no mesh is.

use std::path::Path;

use super::*;

/// The corners of a box from 0 to these lengths, and its twelve triangles.
fn cuboid(sides: Vector3) -> Mesh {
    let corner = |at: usize| Column::from_fn(|axis, _| if at >> axis & 1 == 1 { sides[axis] } else { 0.0 });
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]);
    Mesh::new(triangles.map(|triangle| triangle.map(corner)).collect()).unwrap()
}

fn turned(mesh: Mesh) -> Mesh {
    let turn = UnitQuaternion::from_euler_angles(0.3, 0.4, 0.5);
    mesh.moved(|corner| turn * corner + Column::new(1.0, 2.0, 3.0))
}

#[test]
fn volume_area_and_box_are_those_of_a_turned_cuboid() {
    let mesh = turned(cuboid([1.0, 2.0, 4.0]));
    assert!((mesh.volume() - 8.0).abs() < 1e-9 && (mesh.signed_volume() - 8.0).abs() < 1e-9);
    assert!((mesh.area() - 28.0).abs() < 1e-9);
    let (mut sides, pose) = mesh.bounds();
    sides.sort_by(f64::total_cmp);
    assert!(sides.iter().zip([1.0, 2.0, 4.0]).all(|(a, b)| (a - b).abs() < 1e-9), "{sides:?}");
    let centre = UnitQuaternion::from_euler_angles(0.3, 0.4, 0.5) * Column::new(0.5, 1.0, 2.0)
        + Column::new(1.0, 2.0, 3.0);
    assert!((pose.translation.vector - centre).norm() < 1e-9);
    // Along the axes it stays so, as a box that can be read.
    assert_eq!(cuboid([1.0, 1.0, 4.0]).bounds().1.rotation, UnitQuaternion::identity());
}

#[test]
fn a_reflection_and_a_surface_that_looks_inward_are_turned_round() {
    let mesh = cuboid([1.0, 2.0, 4.0]).scaled([-1.0, 1.0, 0.5]).unwrap();
    assert!((mesh.signed_volume() - 4.0).abs() < 1e-9);
    let inward = cuboid([1.0; 3]).triangles.into_iter().map(|[a, b, c]| [a, c, b]).collect();
    assert!(Mesh::new(inward).unwrap().scaled([1.0; 3]).unwrap().signed_volume() > 0.9);
    assert!(cuboid([1.0; 3]).scaled([0.0; 3]).unwrap_err().contains("no triangle with an area"));
}

#[test]
fn sensors_lie_on_the_surface_look_outward_and_are_even() {
    let mesh = cuboid([1.0, 2.0, 4.0]);
    for count in [1, 7, 40, 500] {
        let spots = mesh.spread(count);
        assert_eq!(spots.len(), count);
        for spot in &spots {
            let axis = (0..3).find(|axis| spot.normal[*axis].abs() > 0.5).unwrap();
            let place = if spot.normal[axis] > 0.0 { [1.0, 2.0, 4.0][axis] } else { 0.0 };
            assert!((spot.position[axis] - place).abs() < 1e-9, "{spot:?}");
        }
    }
    let spots = mesh.spread(500);
    let on = |axis: usize| spots.iter().filter(|spot| spot.normal[axis].abs() > 0.5).count() as f64 / 500.0;
    for (axis, area) in [16.0, 8.0, 4.0].into_iter().enumerate() {
        assert!((on(axis) - area / 28.0).abs() < 0.06, "{axis}: {}", on(axis));
    }
    let apart = |a: &Spot, b: &Spot| (Column::from(a.position) - Column::from(b.position)).norm();
    let pairs = spots.iter().enumerate().flat_map(|(at, a)| spots[..at].iter().map(move |b| apart(a, b)));
    let pitch = (28.0_f64 / 500.0).sqrt();
    assert!(pairs.fold(f64::INFINITY, f64::min) > 0.5 * pitch);
}

#[test]
fn an_ellipsoid_has_its_volume_and_extent() {
    let mesh = Mesh::ellipsoid([0.1, 0.2, 0.3]).unwrap();
    let volume = 4.0 / 3.0 * PI * 0.006;
    assert!((mesh.signed_volume() / volume - 1.0).abs() < 0.02, "{}", mesh.signed_volume() / volume);
    let (sides, _) = mesh.bounds();
    assert!(sides.iter().zip([0.2, 0.4, 0.6]).all(|(a, b)| (a - b).abs() < 1e-9), "{sides:?}");
}

#[test]
fn sensors_are_on_the_ellipsoid_itself_and_look_along_its_gradient() {
    let half_axes = Column::new(0.1, 0.2, 0.3);
    for Spot { position, normal } in Mesh::ellipsoid(half_axes.into()).unwrap().spread(100) {
        let scaled = Column::from(position).component_div(&half_axes);
        assert!((scaled.norm() - 1.0).abs() < 1e-12, "{position:?}");
        let gradient = scaled.component_div(&half_axes).normalize();
        assert!((gradient - Column::from(normal)).norm() < 1e-12, "{position:?}: {normal:?}");
    }
    // What is moved is a mesh like any other.
    let moved = Mesh::ellipsoid(half_axes.into()).unwrap().moved(|corner| corner + Column::x());
    assert!(moved.spread(100).iter().all(|spot| (spot.position[0] - 1.0).abs() < 0.1));
}

/// A tetrahedron in every format: its corners at 0 and at 1, 2 and 3 along x, y and z.
fn written(folder: &Path) -> Vec<std::path::PathBuf> {
    let corners = [[0.0_f32; 3], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]];
    let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let floats =
        |numbers: &[f32]| numbers.iter().flat_map(|number| number.to_le_bytes()).collect::<Vec<u8>>();
    let obj = corners.map(|[x, y, z]| format!("v {x} {y} {z}\n")).concat()
        + "mtllib gone.mtl\n"
        + &faces.map(|[a, b, c]| format!("f {} {} {}\n", a + 1, b + 1, c + 1)).concat();
    let facet = |face: [usize; 3]| {
        let corners =
            face.map(|at| format!("vertex {} {} {}\n", corners[at][0], corners[at][1], corners[at][2]));
        format!("facet normal 0 0 0\nouter loop\n{}endloop\nendfacet\n", corners.concat())
    };
    let text = format!("solid t\n{}endsolid t\n", faces.map(facet).concat());
    let mut binary = [&[0; 80][..], &4_u32.to_le_bytes()].concat();
    for face in faces {
        binary.extend(floats(&[0.0; 3]));
        face.iter().for_each(|at| binary.extend(floats(&corners[*at])));
        binary.extend([0, 0]);
    }
    let called_text = [b"solid t\n", &binary[8..]].concat();
    let mut msh: Vec<u8> = [4_u32, 0, 0, 4].iter().flat_map(|count| count.to_le_bytes()).collect();
    msh.extend(floats(&corners.concat()));
    msh.extend(faces.concat().iter().flat_map(|at| (*at as u32).to_le_bytes()));
    let list = |numbers: Vec<String>| numbers.join(" ");
    let dae = format!(
        "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">
        <asset><unit meter=\"0.5\"/></asset><library_geometries><geometry id=\"g\"><mesh>
        <source id=\"p\"><float_array id=\"a\" count=\"12\">{}</float_array><technique_common>
        <accessor source=\"#a\" count=\"4\" stride=\"3\"><param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/>
        <param name=\"Z\" type=\"float\"/></accessor></technique_common></source>
        <vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices>
        <triangles count=\"4\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>{}</p></triangles></mesh></geometry>
        </library_geometries><library_visual_scenes><visual_scene id=\"s\"><node id=\"n\"><instance_geometry url=\"#g\"/></node>
        </visual_scene></library_visual_scenes><scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>",
        list(corners.concat().iter().map(|number| (2.0 * number).to_string()).collect()),
        list(faces.concat().iter().map(ToString::to_string).collect()),
    );
    // Its y is up.
    let mut own = floats(&corners.map(|[x, y, z]| [x, z, -y]).concat());
    own.extend(faces.concat().iter().flat_map(|at| (*at as u16).to_le_bytes()));
    let gltf = |uri: &str| {
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[
            {{"attributes":{{"POSITION":0}},"indices":1}}]}}],"accessors":[{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}},
            {{"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}}],"bufferViews":[{{"buffer":0,"byteLength":48}},
            {{"buffer":0,"byteOffset":48,"byteLength":24}}],"buffers":[{{"byteLength":72{uri}}}]}}"#
        )
    };
    let chunk = |kind: &[u8], bytes: &[u8]| [&(bytes.len() as u32).to_le_bytes(), kind, bytes].concat();
    let glb = [chunk(b"JSON", gltf("").as_bytes()), chunk(b"BIN\0", &own)].concat();
    let glb = [&b"glTF\x02\0\0\0"[..], &(12 + glb.len() as u32).to_le_bytes(), &glb].concat();
    let code = base64::Engine::encode(&base64::engine::general_purpose::STANDARD, &own);
    let gltf = gltf(&format!(r#","uri":"data:application/octet-stream;base64,{code}""#));
    let files = [
        ("t.obj", obj.into_bytes()),
        ("text.STL", text.into_bytes()),
        ("binary.stl", binary),
        ("called-text.stl", called_text),
        ("t.msh", msh),
        ("t.dae", dae.into_bytes()),
        ("t.gltf", gltf.into_bytes()),
        ("t.glb", glb),
    ];
    let write = |(name, bytes): (&str, Vec<u8>)| {
        std::fs::write(folder.join(name), bytes).unwrap();
        folder.join(name)
    };
    files.into_iter().map(write).collect()
}

#[test]
fn every_format_gives_the_same_mesh() {
    let folder = tempfile::tempdir().unwrap();
    for path in written(folder.path()) {
        let mesh = read(&path).unwrap_or_else(|wrong| panic!("{}: {wrong}", path.display()));
        assert_eq!(mesh.triangles.len(), 4, "{}", path.display());
        assert!((mesh.signed_volume() - 1.0).abs() < 1e-6, "{}: {}", path.display(), mesh.signed_volume());
        assert_eq!(mesh.bounds().0, [1.0, 2.0, 3.0], "{}", path.display());
    }
}

/// Every prefix of a file, and every file with a byte changed, gives a mesh or a line.
#[test]
fn damaged_files_give_a_mesh_or_a_line() {
    let folder = tempfile::tempdir().unwrap();
    for path in written(folder.path()) {
        let bytes = std::fs::read(&path).unwrap();
        let damaged = folder.path().join(format!("damaged.{}", path.extension().unwrap().display()));
        let mut refused = 0;
        let mut attempt = |bytes: &[u8]| {
            std::fs::write(&damaged, bytes).unwrap();
            match read(&damaged) {
                Ok(mesh) => assert!(mesh.area() > 0.0),
                Err(wrong) => {
                    assert!(wrong.starts_with("damaged.") && !wrong.contains('\n'), "{wrong}");
                    refused += 1;
                }
            }
        };
        for at in 0..bytes.len() {
            attempt(&bytes[..at]);
            for with in [0, b'9', b'-', b'<', 0xff] {
                let mut changed = bytes.clone();
                changed[at] = with;
                attempt(&changed);
            }
        }
        assert!(refused > 10, "{}: {refused}", path.display());
    }
    std::fs::write(folder.path().join("a.ply"), "ply").unwrap();
    assert!(
        read(&folder.path().join("a.ply"))
            .unwrap_err()
            .contains("is none of .stl, .obj, .dae, .gltf, .glb and .msh")
    );
    assert!(read(&folder.path().join("b.stl")).unwrap_err().contains("cannot be read"));
}

/// The mesh of the COLLADA file with pieces of its text replaced.
fn read_with(folder: &Path, pieces: &[(&str, &str)]) -> Result<Mesh, Wrong> {
    let path = written(folder).into_iter().find(|path| path.ends_with("t.dae")).unwrap();
    let mut text = std::fs::read_to_string(path).unwrap();
    for (from, to) in pieces {
        assert!(text.contains(from));
        text = text.replace(from, to);
    }
    std::fs::write(folder.join("m.dae"), text).unwrap();
    read(&folder.join("m.dae"))
}

#[test]
fn what_would_not_end_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let read_as = |from: &str, to: &str| read_with(folder.path(), &[(from, to)]);
    assert!(read_as("offset=\"0\"", "offset=\"18446744073709551615\"").unwrap_err().contains("no triangle"));
    let twice = "<instance_node url=\"#n\"/><instance_node url=\"#n\"/>";
    let wrong = read_as("<instance_geometry url=\"#g\"/>", twice).unwrap_err();
    assert!(wrong.contains("nodes within each other"), "{wrong}");
    assert!(read_as("</node>", &format!("{}</node>", "<instance_geometry url=\"#g\"/>".repeat(9))).is_ok());
}

/// As wheels and legs are drawn: one, and the other one as its mirror image.
#[test]
fn mirror_images_in_a_collada_look_outward_too() {
    let folder = tempfile::tempdir().unwrap();
    let shown = "<instance_geometry url=\"#g\"/>";
    let both = format!("{shown}<scale>-1 1 1</scale>{shown}");
    let strip = [("triangles", "tristrips"), ("0 2 1 0 1 3 0 3 2 1 2 3", "0 2 1 3 0 2")];
    for kind in [&strip[..0], &strip] {
        let mesh = read_with(folder.path(), &[&[(shown, &*both)], kind].concat()).unwrap();
        assert!((mesh.signed_volume() - 2.0).abs() < 1e-6, "{kind:?}: {}", mesh.signed_volume());
    }
}

#[test]
fn a_plate_has_a_thickness() {
    let [a, b, c, d] = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]].map(|[x, y]| Column::new(x, y, 0.0));
    let plate = Mesh::new(vec![[a, b, c], [a, c, d]]).unwrap();
    assert!((plate.volume() - 0.001).abs() < 1e-12);
    let turn = UnitQuaternion::from_euler_angles(0.0, 0.0, 0.6);
    let mut sides = plate.moved(|corner| turn * corner).bounds().0;
    sides.sort_by(f64::total_cmp);
    assert!(sides.iter().zip([0.0, 1.0, 2.0]).all(|(a, b)| (a - b).abs() < 1e-9), "{sides:?}");
}

#[test]
fn an_obj_is_read_by_its_vertices_and_faces_alone() {
    let folder = tempfile::tempdir().unwrap();
    let read_as = |text: &str| {
        std::fs::write(folder.path().join("m.obj"), text).unwrap();
        read(&folder.path().join("m.obj"))
    };
    let corners = "v 0 0 0\nv 1 0 0 1.0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\n";
    for face in ["f 1 2 3 4", "f 1//1 2 3/7 4/7/1", "f -4 -3 -2 -1"] {
        let mesh = read_as(&format!("{corners}o x\ng y\nusemtl z\n{face}\n")).unwrap();
        assert!((mesh.area() - 1.0).abs() < 1e-9 && mesh.triangles.len() == 2, "{face}");
    }
    for face in ["f 1 2 5", "f 0 1 2", "f -5 1 2", "f 1 2 x", "v 1 2"] {
        let wrong = read_as(&format!("{corners}{face}\n")).unwrap_err();
        assert!(wrong.starts_with("m.obj: line 6: "), "{face}: {wrong}");
    }
}

#[test]
fn a_fine_mesh_is_drawn_by_fewer_triangles_that_enclose_nearly_the_same() {
    let cuboid = cuboid([1.0, 2.0, 4.0]);
    assert_eq!(cuboid.simplified(), cuboid.triangles);
    // A globe of 2304 triangles, each halved twice.
    let halved = |mesh: Mesh| {
        let halves = mesh.triangles.iter().flat_map(|[a, b, c]| {
            let middle = (b + c) / 2.0;
            [[*a, *b, middle], [*a, middle, *c]]
        });
        Mesh::new(halves.collect()).unwrap()
    };
    let fine = halved(halved(Mesh::ellipsoid([0.5, 1.0, 2.0]).unwrap()));
    let drawn = Mesh::new(fine.simplified()).unwrap();
    assert!(drawn.triangles.len() < fine.triangles.len() / 2, "{}", drawn.triangles.len());
    // It is closed still, and looks outward.
    assert!((drawn.signed_volume() / fine.signed_volume() - 1.0).abs() < 0.05, "{}", drawn.signed_volume());
}
