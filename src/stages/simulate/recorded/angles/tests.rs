//! Test that angles are those that the physics engine reads from the same poses.

use nalgebra::{Matrix3, Rotation3};

use super::super::super::fixtures::{INTERVAL, Scene};
use super::super::super::movement::simulate;
use super::*;
use crate::numerics::rng::stream;
use crate::stages::agent::{Agent, across};

#[test]
fn every_kind_of_joint_has_the_angles_of_the_engine() {
    let mut scene = Scene::new();
    (scene.motion.coordination, scene.motion.stiffness, scene.motion.damping) = (0.2, 0.2, 0.1);
    (scene.physics.duration, scene.physics.step) = (60.0, 0.005);
    let chain = scene.agent();
    let axis = across([0.6, 0.0, -0.8]).map(|row| row[2]);
    for freedom in [
        Freedom::Universal([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0]]),
        Freedom::Universal([[0.6, 0.0, -0.8], [0.0, -1.0, 0.0]]),
        Freedom::Hinge(axis),
        Freedom::Ball,
        Freedom::Fixed,
    ] {
        let mut agent =
            Agent { parts: chain.parts[..2].to_vec(), joints: chain.joints[..1].to_vec(), sites: Vec::new() };
        agent.joints[0].freedom = freedom;
        let rng = &mut stream(3, 1, "motion", 0);
        let trajectory = simulate(&agent, &scene.motion, &scene.physics, INTERVAL, rng, &|| ()).unwrap();
        let mut moved = 0.0_f64;
        for (poses, expected) in trajectory.poses.chunks(2).zip(&trajectory.angles) {
            let turned = [0, 1].map(|part| {
                let matrix = |rows: &[Vector3; 3]| {
                    Rotation3::from_matrix_unchecked(Matrix3::from_fn(|row, column| rows[row][column]))
                };
                let since = matrix(&poses[part].rotation) * matrix(&agent.parts[part].rotation).inverse();
                UnitQuaternion::from_rotation_matrix(&since)
            });
            let found = angles(&freedom, turned[0].inverse() * turned[1]);
            for (found, expected) in found.iter().zip(expected) {
                // Half a turn is the same either way; a joint of the engine gives a little.
                let apart = (found - expected + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU);
                assert!((apart - std::f64::consts::PI).abs() < 0.02, "{freedom:?}: {found} {expected}");
                moved = moved.max(expected.abs());
            }
        }
        assert!(moved > 0.3 || freedom == Freedom::Fixed, "{freedom:?}");
    }
}
