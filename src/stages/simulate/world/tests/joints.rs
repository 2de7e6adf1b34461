//! Test every kind of joint and shape on two parts.

use super::*;
use crate::stages::agent::{Freedom, Joint, Part, Shape, across};

/// Two parts of the given shape, the second half as heavy, joined in the middle between them.
fn pair(shape: Shape, freedom: Freedom) -> Agent {
    let rotation = across([1.0, 0.0, 0.0]);
    let part = |x: f64, density: f64| Part { shape, centre: [x, 0.0, 0.0], rotation, density, inertia: None };
    let joint = Joint { parent: 0, child: 1, anchor: [0.0; 3], freedom };
    Agent { parts: vec![part(-0.2, 1000.0), part(0.2, 500.0)], joints: vec![joint], sites: Vec::new() }
}

const CAPSULE: Shape = Shape::Capsule { radius: 0.06, length: 0.2 };
const TILTED: Vector3 = [0.48, 0.6, 0.64];

#[test]
fn every_kind_of_joint_reports_the_rates_of_its_angles_and_turns_towards_a_torque() {
    for (freedom, moving) in [
        (Freedom::Universal([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0]]), 2),
        (Freedom::Hinge(TILTED), 1),
        (Freedom::Ball, 3),
    ] {
        let mut scene = Scene::new();
        scene.physics.step = 1e-4;
        let mut world = World::new(&pair(CAPSULE, freedom), &scene.physics);
        world.unlock(0);
        for _ in 0..2000 {
            world.apply_torques(0, [0.03, -0.02, 0.025]);
            world.step().unwrap();
        }
        let (before, rates) = (world.angles(0), world.rates(0));
        for (axis, sign) in [1.0, -1.0, 1.0].into_iter().enumerate().take(moving) {
            assert!(sign * rates[axis] > 0.1 && sign * before[axis] > 0.01, "{freedom:?}: {rates:?}");
        }
        world.step().unwrap();
        // The vector of a rotation changes at the rates about the axes only as long as it is small.
        let tolerance = if moving == 3 { 0.1 } else { 1e-2 };
        for axis in 0..3 {
            let rate = (world.angles(0)[axis] - before[axis]) / scene.physics.step;
            let scale = norm(rates);
            assert!((rate - rates[axis]).abs() < tolerance * scale, "{freedom:?}: {rate} {rates:?}");
            assert!(axis < moving || rates[axis] == 0.0);
        }
    }
}

#[test]
fn a_locked_joint_of_any_kind_makes_one_rigid_body_of_its_parts() {
    for (freedom, lock) in [
        (Freedom::Universal([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0]]), true),
        (Freedom::Hinge(TILTED), true),
        (Freedom::Ball, true),
        (Freedom::Fixed, true),
        (Freedom::Ball, false),
    ] {
        let agent = pair(CAPSULE, freedom);
        let mut world = World::new(&agent, &Scene::new().physics);
        if !lock {
            world.unlock(0);
        }
        for step in 0..200 {
            if step < 20 {
                // SAFETY: the body is live.
                unsafe { ode::dBodyAddForce(world.bodies[world.mounts[1].body], 0.0, 3.0, 2.0) };
            }
            world.step().unwrap();
        }
        // How far the rotations of both parts differ, and the distance of the anchor's two places.
        let [first, second] = [0, 1].map(|part| world.pose(part));
        let apart: f64 = (0..3)
            .flat_map(|i| (0..3).map(move |j| (i, j)))
            .map(|(i, j)| (first.rotation[i][j] - second.rotation[i][j]).abs())
            .fold(0.0, f64::max);
        let [left, right] = [first.place([0.0, 0.0, 0.2]), second.place([0.0, 0.0, -0.2])];
        let separation = norm([0, 1, 2].map(|i| left[i] - right[i]));
        assert!(norm(world.body_velocity(world.mounts[1].body).0) > 0.05, "{freedom:?} moves");
        assert!(separation < 0.01, "{freedom:?}: {separation}");
        if lock {
            assert!(apart < 0.01, "{freedom:?}: {apart}");
        } else {
            assert!(apart > 0.1, "{freedom:?} is free: {apart}");
        }
    }
}

#[test]
fn a_ball_joint_reaches_a_target_by_the_shorter_way() {
    let target = [1.0, -2.0, 0.5];
    let mut world = World::new(&pair(CAPSULE, Freedom::Ball), &Scene::new().physics);
    let mut errors = Vec::new();
    for _ in 0..1000 {
        let error = ball_error(target, world.angles(0));
        errors.push(norm(error));
        world.set_motor(0, error.map(|error| 2.0 * error), 100.0);
        world.step().unwrap();
    }
    assert!(norm(ball_error(target, world.angles(0))) < 1e-3);
    assert!((0..3).all(|axis| (world.angles(0)[axis] - target[axis]).abs() < 1e-2));
    // Each step leaves nearly 1 − 2 · 0.01 of the way: no detour.
    assert!((errors[100] / errors[0] - 0.98_f64.powi(100)).abs() < 0.05, "{} {}", errors[0], errors[100]);
}

#[test]
fn each_shape_has_its_mass_and_inertia() {
    // The same push for a step: speed is force times time over mass, and a torque tells the moment about x, which is the
    // parts' z.
    let moved = |shape: Shape| {
        let mut world = World::new(&pair(shape, Freedom::Ball), &Scene::new().physics);
        // SAFETY: both bodies are live.
        unsafe {
            ode::dBodyAddForce(world.bodies[0], 1.0, 0.0, 0.0);
            ode::dBodyAddForce(world.bodies[1], 0.5, 0.0, 0.0);
        }
        world.unlock(0);
        world.apply_torques(0, [1e-3, 0.0, 0.0]);
        world.step().unwrap();
        let (linear, angular) = world.body_velocity(0);
        (0.01 / linear[0], 1e-5 / angular[0])
    };
    let pi = std::f64::consts::PI;
    let ball = 1000.0 * 4.0 / 3.0 * pi * 0.1_f64.powi(3);
    let rod = 1000.0 * pi * 0.01 * 0.2;
    for (shape, mass, moment) in [
        (Shape::Sphere { radius: 0.1 }, ball, 0.4 * ball * 0.01),
        (Shape::Cylinder { radius: 0.1, length: 0.2 }, rod, 0.5 * rod * 0.01),
        (Shape::Capsule { radius: 0.1, length: 0.2 }, ball + rod, (0.4 * ball + 0.5 * rod) * 0.01),
        (Shape::Box { sides: [0.1, 0.2, 0.3] }, 6.0, 6.0 * (0.01 + 0.04) / 12.0),
    ] {
        let found = moved(shape);
        assert!((found.0 / mass - 1.0).abs() < 1e-6, "{shape:?}: {found:?}, not {mass}");
        assert!((found.1 / moment - 1.0).abs() < 1e-3, "{shape:?}: {found:?}, not {moment}");
    }
}

#[test]
fn parts_that_are_fixed_move_as_one_body_with_the_mass_and_inertia_of_all() {
    // A bar of two cubes of 1 kg, and the same as a box: both turn alike by a torque, and both are pushed alike by a fluid.
    let cube = |x: f64| Part {
        shape: Shape::Box { sides: [0.1; 3] },
        centre: [x, 0.0, 0.0],
        rotation: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        density: 1000.0,
        inertia: None,
    };
    let fixed = Joint { parent: 0, child: 1, anchor: [0.0; 3], freedom: Freedom::Fixed };
    let two = Agent { parts: vec![cube(-0.05), cube(0.05)], joints: vec![fixed], sites: Vec::new() };
    let bar = Part { shape: Shape::Box { sides: [0.2, 0.1, 0.1] }, ..cube(0.0) };
    let one = Agent { parts: vec![bar], joints: Vec::new(), sites: Vec::new() };
    for density in [0.0, 1000.0] {
        let moved = |agent: &Agent| {
            let mut world = World::new(agent, &Physics { fluid_density: density, ..Scene::new().physics });
            assert_eq!(world.bodies.len(), 1);
            for step in 0..100 {
                if step < 10 {
                    // In a fluid across the bar only: along it, the cubes' faces inside are pushed, too.
                    let along = if density == 0.0 { 1.0 } else { 0.0 };
                    // SAFETY: the body is live.
                    unsafe {
                        ode::dBodyAddTorque(world.bodies[0], 0.0, 0.01 * along, 0.02 * along);
                        ode::dBodyAddForce(world.bodies[0], along, 2.0, 0.5);
                    }
                }
                world.step().unwrap();
            }
            let first = world.pose(0);
            let place = if agent.parts.len() == 2 { first.place([0.05, 0.0, 0.0]) } else { first.position };
            (place, world.body_velocity(0), world.pose(agent.parts.len() - 1))
        };
        let (of_two, of_one) = (moved(&two), moved(&one));
        let off = |a: Vector3, b: Vector3| norm([0, 1, 2].map(|i| a[i] - b[i]));
        let near = 1e-9;
        assert!(norm(of_one.1.0) > 0.05 && off(of_two.0, of_one.0) < near, "{of_two:?} {of_one:?}");
        assert!(
            off(of_two.1.0, of_one.1.0) < near && off(of_two.1.1, of_one.1.1) < near,
            "{of_two:?} {of_one:?}"
        );
        let end = of_one.2.place([0.05, 0.0, 0.0]);
        assert!(off(of_two.2.position, end) < near, "{of_two:?} {of_one:?}");
    }
}
