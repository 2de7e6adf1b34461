//! Test that bodies have the centre of mass and the inertia that they are given: by what the world reckons with, and by how they turn in the engine.

use super::*;
use crate::stages::agent::{Freedom, Inertia, Joint};
use crate::stages::simulate::fixtures::Scene;
use crate::stages::simulate::world::World;

/// A box of 1 kg, which is turned by a quarter about z.
fn part(x: f64, inertia: Option<Inertia>) -> Part {
    Part {
        shape: Shape::Box { sides: [0.1; 3] },
        centre: [x, 0.0, 0.0],
        rotation: [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
        density: 1000.0,
        inertia,
    }
}

fn fixed(parts: Vec<Part>) -> Agent {
    let joint = |child: usize| Joint { parent: child - 1, child, anchor: [0.0; 3], freedom: Freedom::Fixed };
    Agent { joints: (1..parts.len()).map(joint).collect(), parts, sites: Vec::new() }
}

fn diagonal([x, y, z]: Vector3) -> [Vector3; 3] {
    [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]]
}

/// Mass, centre and tensor of the only body along the axes of the world, as the world reckons with them.
fn found(agent: &Agent) -> (f64, Column<f64>, Matrix3<f64>) {
    let world = World::new(agent, &Scene::new().physics);
    let [body] = world.moving()[..] else { panic!("{} bodies", world.bodies.len()) };
    // A torque about each axis tells a column of the inverse.
    let columns =
        [0, 1, 2].map(|axis| Column::from(body.turned_by([0, 1, 2].map(|at| f64::from(at == axis)))));
    let inverse = Matrix3::from_columns(&columns);
    (body.inertia.mass, body.pose.position.into(), inverse.try_inverse().unwrap())
}

#[track_caller]
fn near(found: Matrix3<f64>, expected: [Vector3; 3]) {
    assert!((found - matrix(&expected)).amax() < 1e-12, "{found:?} is not {expected:?}");
}

#[test]
fn a_part_has_the_inertia_that_it_is_given() {
    let tensor = [[0.3, 0.01, 0.02], [0.01, 0.4, 0.03], [0.02, 0.03, 0.5]];
    let agent = fixed(vec![part(0.0, Some(Inertia { centre: [0.1, 0.2, 0.3], tensor }))]);
    let (mass, centre, own) = found(&agent);
    assert!((mass - 1.0).abs() < 1e-12 && (centre - Column::new(0.1, 0.2, 0.3)).norm() < 1e-12);
    near(own, tensor);
    // The part itself is where it was.
    let pose = World::new(&agent, &Scene::new().physics).pose(0);
    assert!(pose.position.iter().all(|x| x.abs() < 1e-12), "{pose:?}");
    assert_eq!(pose.rotation, part(0.0, None).rotation);
}

#[test]
fn parts_with_and_without_an_inertia_add_up_by_the_parallel_axis_theorem() {
    let given = |x: f64| Some(Inertia { centre: [x, 0.0, 0.0], tensor: diagonal([0.1, 0.2, 0.2]) });
    let (mass, centre, own) =
        found(&fixed(vec![part(0.0, given(0.5)), part(1.0, given(-0.5)), part(3.0, None)]));
    assert!((mass - 3.0).abs() < 1e-12 && (centre - Column::new(1.0, 0.0, 0.0)).norm() < 1e-12, "{centre:?}");
    // An even box has 1/600 kg m². Masses are at -0.5, 0.5 and 3.
    let (box_, apart) = (1.0 / 600.0, 2.25 + 0.25 + 4.0);
    near(own, diagonal([0.2 + box_, 0.4 + box_ + apart, 0.4 + box_ + apart]));
}

#[test]
fn a_body_turns_about_its_centre_of_mass_as_slowly_as_its_inertia_says() {
    let inertia = Inertia { centre: [0.0, 0.2, 0.0], tensor: diagonal([0.3, 0.4, 0.5]) };
    let mut world = World::new(&fixed(vec![part(0.0, Some(inertia))]), &Scene::new().physics);
    for _ in 0..100 {
        // SAFETY: the body is live.
        unsafe { ode::dBodyAddTorque(world.bodies[0], 0.0, 0.0, 0.5) };
        world.step().unwrap();
    }
    // 0.5 N m for 1 s on 0.5 kg m².
    let (linear, angular) = world.body_velocity(0);
    assert!((angular[2] - 1.0).abs() < 1e-9 && linear.iter().all(|x| x.abs() < 1e-12), "{angular:?}");
    let place = Column::from(world.pose(0).position) - Column::new(0.0, 0.2, 0.0);
    // It has turned by some half a radian, and is on its circle.
    assert!((place.norm() - 0.2).abs() < 1e-9 && place.x > 0.08, "{place:?}");
}

#[test]
fn the_engine_has_the_moments_that_shapes_say() {
    for shape in [
        Shape::Cylinder { radius: 0.1, length: 0.4 },
        Shape::Capsule { radius: 0.1, length: 0.4 },
        Shape::Sphere { radius: 0.1 },
        Shape::Box { sides: [0.1, 0.2, 0.4] },
    ] {
        let (mass, tensor) = mass_of(&Part { shape, ..part(0.0, None) });
        assert!((mass - 1000.0 * shape.volume()).abs() < 1e-9 * mass, "{shape:?}");
        assert!(
            (tensor - matrix(&diagonal(shape.moments(mass)))).amax() < 1e-9 * tensor.amax(),
            "{shape:?}: {tensor}"
        );
    }
}
