use super::super::fixtures::{INTERVAL, Scene};
use super::*;
use crate::numerics::rng::stream;

fn run_with_seed(seed: u64, change: impl Fn(&mut Scene)) -> Result<Trajectory, Unstable> {
    let mut scene = Scene::new();
    change(&mut scene);
    let rng = &mut stream(seed, 1, "motion", 0);
    simulate(&scene.agent(), &scene.motion, &scene.physics, INTERVAL, rng, &|| ())
}

fn run(change: impl Fn(&mut Scene)) -> Result<Trajectory, Unstable> {
    run_with_seed(2017, change)
}

#[test]
fn the_same_seed_gives_the_same_bits_in_threads_beside_each_other() {
    let alone = run(|_| ()).unwrap();
    let threads: Vec<_> = (0..3).map(|_| std::thread::spawn(|| run(|_| ()).unwrap())).collect();
    for thread in threads {
        assert_eq!(thread.join().unwrap(), alone);
    }
    assert_ne!(run_with_seed(2, |_| ()).unwrap(), alone);
}

#[test]
fn fully_coordinated_movement_is_no_movement() {
    let trajectory = run(|scene| scene.motion.coordination = 1.0).unwrap();
    let first = &trajectory.poses[..trajectory.parts];
    assert!(trajectory.poses.chunks(trajectory.parts).all(|poses| poses == first));
}

#[test]
fn joints_are_locked_for_the_first_epoch_and_drawn_at_its_end() {
    for (epoch, samples) in [(500, 50), (200, 20)] {
        let trajectory = run(|scene| {
            scene.motion.coordination = 0.0;
            scene.motion.epoch = epoch;
        })
        .unwrap();
        let angles: Vec<_> = trajectory.angles.chunks(trajectory.joints).collect();
        let moved = |sample: usize| angles[sample].iter().flatten().any(|angle| angle.abs() > 1e-9);
        assert!((0..=samples).all(|sample| !moved(sample)), "epoch {epoch}");
        assert!(moved(samples + 1), "epoch {epoch}");
    }
}

#[test]
fn moving_joints_come_to_rest_under_the_controller() {
    // Well damped and with time to settle, every axis that moves must come to rest somewhere: its
    // angle no longer changes at the end of the epoch. The opposite sign of torque would never settle.
    let trajectory = run(|scene| {
        scene.motion.coordination = 0.0;
        scene.motion.epoch = 10_000;
        scene.geometry.part_radius = 0.08;
        scene.motion.stiffness = 2.0;
        scene.motion.damping = 2.0;
    })
    .unwrap();
    let last = |back: usize| &trajectory.angles[trajectory.angles.len() - 4 * (1 + back)..][..4];
    for (now, before) in last(0).iter().zip(last(50)) {
        assert!((0..2).all(|axis| (now[axis] - before[axis]).abs() < 0.05), "{now:?} {before:?}");
        assert!(now.iter().any(|angle| angle.abs() > 0.1), "{now:?} moved");
    }
}

/// Without damping nothing takes energy out of a joint that moves, which is no error.
#[test]
fn a_torque_without_damping_is_admitted() {
    let gentle = |scene: &mut Scene| {
        (scene.motion.damping, scene.motion.stiffness, scene.motion.coordination) = (0.0, 0.01, 0.5);
    };
    let trajectory = run(gentle).unwrap();
    assert!(trajectory.angles.iter().flatten().any(|angle| angle.abs() > 0.1));
    assert!(trajectory.resolution.anchor_separation > 0.0 && trajectory.resolution.turn > 0.0);
}

#[test]
fn gains_beyond_stability_are_an_error_and_no_abort() {
    let error = run(|scene| {
        scene.geometry.part_radius = 0.05;
        scene.geometry.part_length = 0.3;
        scene.geometry.gap = 0.0;
        scene.motion.coordination = 0.0;
        scene.motion.stiffness = 2.0;
        scene.motion.damping = 2.0;
    })
    .unwrap_err();
    assert!(error.to_string().contains("lower motion.stiffness"), "{error}");
}
