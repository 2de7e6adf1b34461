//! What a fluid that pushes does to a whole body.

use super::*;

/// A straight locked body that glides sideways: m dv/dt = −4/3 ρ r L v², so v = v₀ / (1 + c v₀ t).
#[test]
fn a_fluid_slows_a_body_down_by_the_closed_form() {
    let (agent, mut scene) = agent_and_scene();
    let start = 0.5;
    let speed_after = |physics: &Physics, time: f64| {
        let mut world = World::new(&agent, physics);
        let across = world.pose(0).rotation.map(|row| row[0]);
        for body in &world.bodies {
            // SAFETY: the body is live.
            unsafe {
                ode::dBodySetLinearVel(*body, start * across[0], start * across[1], start * across[2]);
            }
        }
        (0..(time / physics.step).round() as usize).for_each(|_| world.step().unwrap());
        norm(world.body_velocity(2).0)
    };
    assert!((speed_after(&scene.physics, 1.0) - start).abs() < 1e-9, "no fluid pushes in the fixture");
    scene.physics.fluid_density = 1010.0;
    let (mass, ..) = inertia(&scene);
    let (radius, length) = (scene.geometry.part_radius, scene.geometry.part_length);
    let c = 4.0 / 3.0 * 1010.0 * radius * length / mass;
    for time in [0.5, 2.0, 8.0] {
        let (found, right) = (speed_after(&scene.physics, time), start / (1.0 + c * start * time));
        assert!((found - right).abs() < 0.03 * right, "after {time} s: {found}, {right}");
    }
}

/// The same, spun end over end about its middle: dω/dt = −c ω², so ω = ω₀ / (1 + c ω₀ t).
#[test]
fn a_fluid_slows_a_spin_down_by_the_closed_form() {
    let (agent, mut scene) = agent_and_scene();
    scene.physics.fluid_density = 1010.0;
    let start = 3.0;
    let (mass, across, _) = inertia(&scene);
    let (radius, length) = (scene.geometry.part_radius, scene.geometry.part_length);
    let middles = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|at| at * length);
    let whole: f64 = middles.iter().map(|middle| across + mass * middle * middle).sum();
    // 4/3 ρ r ∫ |z|³ over the whole body, which is five lengths long; the ends, 6 % of its area, take some more.
    let c = 4.0 / 3.0 * 1010.0 * radius * (2.5 * length).powi(4) / 2.0 / whole;
    let mut world = World::new(&agent, &scene.physics);
    let (centre, axis) = (world.pose(2).position, world.pose(2).rotation.map(|row| row[0]));
    for (part, body) in world.bodies.iter().enumerate() {
        let [x, y, z] = [0, 1, 2].map(|i| world.pose(part).position[i] - centre[i]);
        let [a, b, c] = axis.map(|x| start * x);
        // SAFETY: the body is live.
        unsafe {
            ode::dBodySetAngularVel(*body, a, b, c);
            ode::dBodySetLinearVel(*body, b * z - c * y, c * x - a * z, a * y - b * x);
        }
    }
    let mut time = 0.0;
    for until in [0.2, 0.5, 1.0] {
        while time < until - 1e-9 {
            world.step().unwrap();
            time += scene.physics.step;
        }
        let (found, right) = (norm(world.body_velocity(2).1), start / (1.0 + c * start * until));
        assert!((found - right).abs() < 0.05 * right, "after {until} s: {found}, {right}");
    }
}

/// However fast a part is, no step of the fluid gives it energy.
#[test]
fn a_fluid_takes_energy_from_whatever_moves() {
    let (agent, mut scene) = agent_and_scene();
    (scene.physics.fluid_density, scene.physics.step) = (1010.0, 0.01);
    for speed in [5.0, 20.0, 80.0] {
        let mut world = World::new(&agent, &scene.physics);
        (0..world.joints.len()).for_each(|joint| world.unlock(joint));
        let energy = |world: &World| -> f64 {
            let (mass, across, along) = inertia(&scene);
            let part = |part: usize| {
                let (v, spin) = world.body_velocity(part);
                let axial: f64 = (0..3).map(|i| world.pose(part).rotation[i][2] * spin[i]).sum();
                mass * norm(v).powi(2) + across * (norm(spin).powi(2) - axial * axial) + along * axial * axial
            };
            (0..5).map(part).sum()
        };
        // SAFETY: the bodies are live.
        world
            .bodies
            .iter()
            .for_each(|body| unsafe { ode::dBodySetLinearVel(*body, speed, 0.3 * speed, 0.1) });
        let mut before = energy(&world);
        for _ in 0..50 {
            world.step().unwrap();
            let now = energy(&world);
            assert!(now <= before * (1.0 + 1e-9), "{speed} m/s: {before} {now}");
            before = now;
        }
    }
}

#[test]
fn angular_momentum_is_what_the_fluid_gives_where_it_is_conserved() {
    let (agent, mut scene) = agent_and_scene();
    (scene.motion.coordination, scene.motion.controller) = (0.3, Controller::Servo);
    scene.physics.fluid_density = 1010.0;
    let mut largest = |kept| {
        scene.physics.angular_momentum = kept;
        let mut world = World::new(&agent, &scene.physics);
        let (mut off, mut given) = (0.0_f64, 0.0_f64);
        move_about(&mut world, &scene, 2_000, |world, _| {
            let parts = world.moving();
            let centre = momentum::centre_of_mass(&parts);
            let mass: f64 = parts.iter().map(|part| part.inertia.mass).sum();
            let drift = [0, 1, 2]
                .map(|i| parts.iter().map(|part| part.inertia.mass * part.linear[i]).sum::<f64>() / mass);
            // About the centre of mass: that about the origin, less that of the centre.
            let [[x, y, z], [u, v, w]] = [centre, drift];
            let own = [y * w - z * v, z * u - x * w, x * v - y * u].map(|turn| mass * turn);
            let about = angular_momentum(world, &scene);
            off = off.max(norm([0, 1, 2].map(|i| about[i] - own[i] - world.given[i])));
            given = given.max(norm(world.given));
        });
        (off, given)
    };
    let (conserved, engine) = (largest(AngularMomentum::Conserved), largest(AngularMomentum::Engine));
    assert!(conserved.0 < 1e-9 && conserved.1 > 1e-2, "{conserved:?}");
    assert!(engine.0 > 1e-4, "{engine:?}");
}
