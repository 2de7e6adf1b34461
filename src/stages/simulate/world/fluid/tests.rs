use std::f64::consts::PI;

use super::*;

const DENSITY: f64 = 1010.0;
const UPRIGHT: Pose =
    Pose { position: [0.0; 3], rotation: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] };
const SHAPES: [Shape; 4] = [
    Shape::Cylinder { radius: 0.03, length: 0.5 },
    Shape::Capsule { radius: 0.03, length: 0.5 },
    Shape::Sphere { radius: 0.1 },
    Shape::Box { sides: [0.1, 0.2, 0.3] },
];

fn push(shape: Shape, linear: Vector3, angular: Vector3) -> (Vector3, Vector3) {
    Surface::new(&shape, DENSITY).push(&UPRIGHT, linear, angular)
}

/// Integrals of ρ (ṗ · n)² n over the surface that moves outward.
#[test]
fn forces_are_the_integral_of_the_pressure() {
    let speed = 0.3;
    let dynamic = DENSITY * speed * speed;
    for (shape, direction, area) in [
        // 2 r L ∫ cos³ from 0 to a right angle.
        (SHAPES[0], [1.0, 0.0, 0.0], 4.0 / 3.0 * 0.03 * 0.5),
        // 2 π r² ∫ cos³ sin over the same.
        (SHAPES[2], [0.6, 0.0, 0.8], PI * 0.01 / 2.0),
        (SHAPES[1], [0.0, 1.0, 0.0], 4.0 / 3.0 * 0.03 * 0.5 + PI * 0.0009 / 2.0),
        (SHAPES[3], [0.0, 0.0, -1.0], 0.02),
    ] {
        let (force, torque) = push(shape, direction.map(|x| speed * x), [0.0; 3]);
        for (found, along) in force.iter().zip(direction) {
            let right = -dynamic * area * along;
            assert!((found - right).abs() < 0.03 * dynamic * area, "{shape:?}: {force:?}");
        }
        let lever = torque.iter().map(|x| x.abs()).fold(0.0, f64::max);
        assert!(lever < 0.02 * dynamic * area * shape.half_length(), "{shape:?}: {torque:?}");
    }
}

/// About an axis across it, a slender cylinder has ∫ 4/3 ρ r (ω z)² |z| dz = 4/3 ρ r ω² (L / 2)⁴ / 2.
#[test]
fn a_cylinder_is_held_back_where_it_turns_over_and_not_about_its_axis() {
    let Shape::Cylinder { radius, length } = SHAPES[0] else { unreachable!() };
    let right = 4.0 / 3.0 * DENSITY * radius * 4.0 * (length / 2.0_f64).powi(4) / 2.0;
    let (_, across) = push(SHAPES[0], [0.0; 3], [0.0, 2.0, 0.0]);
    assert!((across[1] + right).abs() < 0.05 * right, "{across:?} {right}");
    let (force, along) = push(SHAPES[0], [0.0; 3], [0.0, 0.0, 2.0]);
    assert!(along.iter().chain(&force).all(|x| x.abs() < 1e-12 * right), "{force:?} {along:?}");
}

#[test]
fn no_movement_gains_energy_and_turning_the_part_turns_the_push() {
    let turn = Pose { rotation: [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], ..UPRIGHT };
    let turned = |x: Vector3| turn.rotation.map(|row| (0..3).map(|i| row[i] * x[i]).sum::<f64>());
    for shape in SHAPES {
        let surface = Surface::new(&shape, DENSITY);
        for (linear, angular) in
            [([0.1, -0.2, 0.3], [0.0; 3]), ([0.0; 3], [1.0, 2.0, -1.0]), ([0.1, 0.0, 0.1], [0.5, 1.0, 2.0])]
        {
            let (force, torque) = surface.push(&UPRIGHT, linear, angular);
            let power: f64 = (0..3).map(|i| force[i] * linear[i] + torque[i] * angular[i]).sum();
            assert!(power < 0.0, "{shape:?}: {power}");
            let (other_force, other_torque) = surface.push(&turn, turned(linear), turned(angular));
            for (found, right) in [(other_force, turned(force)), (other_torque, turned(torque))] {
                assert!((0..3).all(|i| (found[i] - right[i]).abs() < 1e-12), "{found:?} {right:?}");
            }
        }
    }
}
