//! Test that a joint moves evenly between frames if it does at them, and that its velocity has no steps.

use super::super::skeleton::{Channel, RecordedJoint};
use super::*;

const STEP: f64 = 1e-4;

/// A joint that is at x, turned about z, then x.
fn movement(frames: &[[f64; 3]]) -> RecordedMovement {
    let channels = vec![Channel::Position(0), Channel::Rotation(2), Channel::Rotation(0)];
    let joint =
        RecordedJoint { name: "a".to_owned(), parent: None, offset: [0.0; 3], channels, ends: Vec::new() };
    RecordedMovement::new(vec![joint], 0.1, frames.concat())
}

fn at(movement: &RecordedMovement, time: f64) -> Isometry3<f64> {
    local_at(movement, &(0..movement.frames()), 0, time)
}

/// Velocity and angular velocity just before and after a time, per frame.
fn velocities(movement: &RecordedMovement, time: f64) -> [Column<f64>; 4] {
    let [before, now, after] = [-STEP, 0.0, STEP].map(|step| at(movement, time + step));
    let ((a, b), (c, d)) = (step(&before, &now), step(&now, &after));
    [a, b, c, d].map(|way| way / STEP)
}

#[test]
fn an_even_movement_is_even_between_frames() {
    let frames: Vec<[f64; 3]> =
        (0..5).map(|frame| [0.5 * f64::from(frame), 70.0 * f64::from(frame), 0.0]).collect();
    let movement = movement(&frames);
    for time in [0.0, 0.25, 1.0, 1.9, 3.5, 4.0] {
        let pose = at(&movement, time);
        assert!((pose.translation.vector - Column::new(0.5 * time, 0.0, 0.0)).norm() < 1e-12, "{time}");
        let turned = super::super::rotation::about(2, 70.0 * time);
        assert!(pose.rotation.angle_to(&turned) < 1e-7, "{time}: {pose}");
    }
}

#[test]
fn a_curve_goes_through_its_frames_without_a_step_of_velocity() {
    let movement = movement(&[
        [0.0, 0.0, 0.0],
        [1.0, 30.0, -20.0],
        [-2.0, 100.0, 50.0],
        [4.0, 170.0, 60.0],
        [4.0, 200.0, 10.0],
    ]);
    for frame in 0..5 {
        assert_eq!(at(&movement, frame as f64), movement.local(0, frame));
    }
    for frame in 1..4 {
        let [before, turning_before, after, turning_after] = velocities(&movement, frame as f64);
        assert!((before - after).norm() < 0.01, "{frame}: {before} {after}");
        assert!((turning_before - turning_after).norm() < 0.01, "{frame}");
        // As the mean of the steps before and after it.
        let mean =
            (movement.local(0, frame + 1).translation.x - movement.local(0, frame - 1).translation.x) / 2.0;
        assert!((after.x - mean).abs() < 0.01, "{frame}: {after} {mean}");
    }
    // A straight way from frame to frame, which the curve is not, would have them.
    let straight =
        |frame: usize| movement.local(0, frame + 1).translation.x - movement.local(0, frame).translation.x;
    assert!((straight(1) - straight(0)).abs() > 1.0);
}

#[test]
fn what_is_outside_of_the_stretch_does_not_count() {
    let long = movement(&[
        [99.0, 0.0, 0.0],
        [0.0, 0.0, 0.0],
        [1.0, 10.0, 0.0],
        [2.0, 20.0, 0.0],
        [-50.0, 180.0, 90.0],
    ]);
    for time in [1.3, 2.8] {
        let pose = local_at(&long, &(1..4), 0, time);
        assert!((pose.translation.x - (time - 1.0)).abs() < 1e-12, "{time}: {pose}");
    }
    assert_eq!(local_at(&long, &(1..4), 0, 3.0 + 1e-12), long.local(0, 3));
}
