//! Test how joints are locked and driven.

use super::super::fixtures::Scene;
use super::*;
use crate::numerics::rng::stream;

#[test]
fn both_axes_draw_a_target_each_or_share_one() {
    let mut scene = Scene::new();
    scene.motion.coordination = 0.0;
    let agent = scene.agent();
    let mut drawn = |targets| {
        scene.motion.targets = targets;
        let rng = &mut stream(1, 1, "motion", 0);
        let mut motor = Motor::new(&agent.joints, &scene.motion, scene.physics.step, rng);
        motor.draw_targets(&mut World::new(&agent, &scene.physics), &scene.motion, rng);
        (motor.targets.iter().map(|target| target.expect("p = 0")).collect::<Vec<_>>(), rng.clone())
    };
    // After the draw of whether the joint moves, a draw for each axis or one for both.
    let expected = |shared: bool| {
        let mut rng = stream(1, 1, "motion", 0);
        let target = |_| {
            rng.random_bool(1.0);
            let first = rng.random_range(-PI..=PI);
            [first, if shared { first } else { rng.random_range(-PI..=PI) }, 0.0]
        };
        (agent.joints.iter().map(target).collect::<Vec<_>>(), rng)
    };
    assert_eq!(drawn(Targets::Each), expected(false));
    assert_eq!(drawn(Targets::Shared), expected(true));
}

#[test]
fn the_shortest_error_goes_the_short_way_round() {
    assert_eq!(angle_error(3.0, -3.0, AngleError::Raw), 6.0);
    assert!((angle_error(3.0, -3.0, AngleError::Shortest) - (6.0 - TAU)).abs() < 1e-12);
    assert_eq!(angle_error(1.0, 0.5, AngleError::Shortest), 0.5);
}
