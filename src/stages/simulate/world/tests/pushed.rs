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
        norm(world.velocity(2).0)
    };
    assert!((speed_after(&scene.physics, 1.0) - start).abs() < 1e-9, "no fluid pushes by default");
    scene.physics.fluid_density = 1010.0;
    let (mass, ..) = inertia(&scene);
    let (radius, length) = (scene.geometry.part_radius, scene.geometry.part_length);
    let c = 4.0 / 3.0 * 1010.0 * radius * length / mass;
    for time in [0.5, 2.0, 8.0] {
        let (found, right) = (speed_after(&scene.physics, time), start / (1.0 + c * start * time));
        assert!((found - right).abs() < 0.03 * right, "after {time} s: {found}, {right}");
    }
}
