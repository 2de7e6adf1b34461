//! Test where joints are by hand: orders of rotations, places that channels set, and joints that travel.

use super::*;
use Channel::{Position, Rotation};

fn joint(name: &str, parent: Option<usize>, offset: Vector3, channels: &[Channel]) -> RecordedJoint {
    RecordedJoint { name: name.to_owned(), parent, offset, channels: channels.to_vec(), ends: Vec::new() }
}

#[track_caller]
fn near(found: Column<f64>, expected: Vector3) {
    assert!((found - Column::from(expected)).norm() < 1e-12, "{found:?} is not {expected:?}");
}

const TRAVELS: [Channel; 6] = [Position(0), Position(1), Position(2), Rotation(2), Rotation(0), Rotation(1)];

#[test]
fn rotations_are_applied_in_the_order_of_their_channels() {
    // A quarter turn about z, then about the x that it turned, take y to z: about z first, y becomes -x, and what was x is y.
    for (channels, numbers, expected) in [
        ([Rotation(2), Rotation(0), Rotation(1)], [90.0, 90.0, 0.0], [0.0, 0.0, 1.0]),
        ([Rotation(0), Rotation(2), Rotation(1)], [90.0, 90.0, 0.0], [-1.0, 0.0, 0.0]),
        ([Rotation(1), Rotation(0), Rotation(2)], [90.0, 0.0, 90.0], [0.0, 0.0, 1.0]),
        ([Rotation(2), Rotation(1), Rotation(0)], [0.0, 90.0, 90.0], [1.0, 0.0, 0.0]),
        ([Rotation(0), Rotation(1), Rotation(0)], [90.0, 180.0, -90.0], [0.0, -1.0, 0.0]),
    ] {
        let movement =
            RecordedMovement::new(vec![joint("a", None, [0.0; 3], &channels)], 0.1, numbers.to_vec());
        near(movement.local(0, 0).rotation * Column::y(), expected);
    }
}

#[test]
fn places_add_up_along_the_skeleton() {
    let joints = vec![
        joint("root", None, [9.0, 9.0, 9.0], &TRAVELS),
        joint("arm", Some(0), [2.0, 0.0, 0.0], &[Rotation(2)]),
        joint("hand", Some(1), [1.0, 0.0, 0.0], &[]),
        joint("leg", Some(0), [0.0, -3.0, 0.0], &[Position(1), Rotation(0)]),
    ];
    // The root is where its channels say, turned by a quarter about z; the arm turns back.
    let frame = vec![1.0, 2.0, 3.0, 90.0, 0.0, 0.0, -90.0, -3.0, 0.0];
    let movement = RecordedMovement::new(joints, 0.1, [frame.clone(), frame].concat());
    assert_eq!((movement.frames(), movement.repeated_frames()), (2, 1));
    let placed = movement.placed(|at| movement.local(at, 1));
    let places: Vec<Column<f64>> = placed.iter().map(|pose| pose.translation.vector).collect();
    near(places[0], [1.0, 2.0, 3.0]);
    near(places[1], [1.0, 4.0, 3.0]);
    near(places[2], [2.0, 4.0, 3.0]);
    near(places[3], [4.0, 2.0, 3.0]);
    // At rest nothing is turned, and the root is the origin.
    let rest = movement.rest();
    near(rest[0], [0.0; 3]);
    near(rest[2], [3.0, 0.0, 0.0]);
    near(rest[3], [0.0, -3.0, 0.0]);
}

#[test]
fn a_joint_that_travels_has_no_bone_to_it() {
    let bone = |on: usize, offset: Vector3, places: &[f64]| {
        let joints = vec![
            joint("a", None, [0.0; 3], &[Rotation(0)]),
            joint("b", Some(0), [1.0, 0.0, 0.0], &[]),
            joint("c", Some(on), offset, &[Position(0)]),
        ];
        let values = places.iter().flat_map(|place| [0.0, *place]).collect();
        let movement = RecordedMovement::new(joints, 0.1, values);
        assert_eq!((movement.bone(0), movement.bone(1)), (None, Some(Column::x())));
        movement.bone(2)
    };
    // It stays, stretches a little, is always elsewhere than its offset, drifts, or travels.
    assert_eq!(bone(1, [2.0, 1.0, 0.0], &[2.0, 2.0]), Some(Column::new(2.0, 1.0, 0.0)));
    assert_eq!(bone(1, [2.0, 1.0, 0.0], &[2.1, 1.9]), Some(Column::new(2.0, 1.0, 0.0)));
    assert_eq!(bone(1, [0.0, 1.0, 0.0], &[5.0, 5.1]), Some(Column::new(5.0, 1.0, 0.0)));
    assert_eq!(bone(1, [2.0, 1.0, 0.0], &[2.0, 2.5]), Some(Column::new(2.25, 1.0, 0.0)));
    assert_eq!(bone(1, [2.0, 1.0, 0.0], &[2.0, 4.0]), None);
    // On a mark on the floor, a body may do little more than breathe.
    assert_eq!(bone(0, [2.0, 1.0, 0.0], &[2.0001, 2.0]), Some(Column::new(2.0, 1.0, 0.0)));
    assert_eq!(bone(0, [2.0, 1.0, 0.0], &[2.01, 2.0]), None);
    // So do two bodies on a mark that stays; not two legs on hips that move.
    let two = |turned: f64| {
        let place =
            |name: &str, x: f64| joint(name, (name != "a").then_some(0), [x, 0.0, 0.0], &[Position(0)]);
        let joints = vec![joint("a", None, [0.0; 3], &[Rotation(0)]), place("b", 3.0), place("c", -3.0)];
        RecordedMovement::new(joints, 0.1, vec![0.0, 3.0, -3.0, turned, 3.5, -3.5]).bone(1)
    };
    assert_eq!((two(0.0), two(1.0)), (None, Some(Column::new(3.25, 0.0, 0.0))));
}
