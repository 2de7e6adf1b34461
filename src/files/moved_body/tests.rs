//! Test what is written of a body that moved.

use super::*;
use crate::stages::agent::across;

#[test]
fn a_quaternion_turns_as_its_matrix() {
    for axis in [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.6, 0.0, -0.8], [0.48, -0.6, 0.64], [0.0, 0.0, -1.0]] {
        let rows = across(axis);
        let [w, x, y, z] = quaternion(&rows);
        let turned = [2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)];
        let along = [rows[0][2], rows[1][2], rows[2][2]];
        assert!(turned.iter().zip(along).all(|(a, b)| (a - b).abs() < 1e-12), "{axis:?}: {turned:?}");
        assert!((w * w + x * x + y * y + z * z - 1.0).abs() < 1e-12);
    }
}

#[test]
fn what_is_written_is_read_back_and_files_that_do_not_fit_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let shapes = vec![
        Shape::Cylinder { radius: 0.1, length: 0.4 },
        Shape::Capsule { radius: 0.1, length: 0.3 },
        Shape::Sphere { radius: 0.2 },
        Shape::Box { sides: [0.1, 0.2, 0.3] },
    ];
    let sites: Vec<Site> =
        (0..4).map(|part| Site { part, position: [0.1, 0.0, 0.2], normal: [1.0, 0.0, 0.0] }).collect();
    let poses = vec![[0.5, 0.25, 0.0, 1.0, 0.0, 0.0, 0.0]; 8];
    let body = MovedBody { shapes, sites, poses };
    body.write(folder.path(), &[0, 1, 2, 2]).unwrap();
    assert_eq!(MovedBody::read(folder.path()).unwrap(), body);

    let fewer = MovedBody { shapes: body.shapes[..2].to_vec(), sites: body.sites[..2].to_vec(), ..body };
    fewer.write(folder.path(), &[0, 1]).unwrap();
    std::fs::write(
        folder.path().join("solids.csv"),
        "solid,part,shape,radius_m,length_m,x_m,y_m,z_m\n0,0,sphere,0.1,,,,\n",
    )
    .unwrap();
    assert!(MovedBody::read(folder.path()).unwrap_err().to_string().contains("sensor 1 is on solid 1"));
}

#[test]
fn a_movement_keeps_its_places() {
    let trajectory = Trajectory {
        parts: 1,
        poses: vec![Pose { position: [1.0, 2.0, 3.0], rotation: across([0.0, 0.0, 1.0]) }],
        ..Trajectory::default()
    };
    let agent = Agent { parts: Vec::new(), joints: Vec::new(), sites: Vec::new() };
    let body = MovedBody::of(&agent, &trajectory);
    assert_eq!(body.poses[0][..3], [1.0, 2.0, 3.0]);
}
