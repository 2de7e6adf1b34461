//! The angular momentum of a body about its centre of mass, and the rotation of the whole body that changes it.
//!
//! Only a fluid acts on the body from outside, if any does, and it starts at rest. So its momentum is what the fluid has given it,
//! or 0. A step of ODE keeps the linear one, but not the angular one: forces of joints act where anchors are, which come apart
//! a little, and rotations are advanced in turn with velocities. While all joints are locked the body is rigid, and what was
//! added makes it turn.

use nalgebra::{Matrix3, Vector3 as Column};

use super::Pose;
use crate::stages::agent::Vector3;

/// How hard a part is to move.
#[derive(Debug, Clone, Copy)]
pub(super) struct Inertia {
    /// kg.
    pub mass: f64,
    /// About the centre of mass in the part's frame, kg m².
    tensor: Matrix3<f64>,
    inverse: Matrix3<f64>,
}

impl Inertia {
    /// Of a mass, kg, and a tensor about its centre, kg m², by rows.
    pub(super) fn new(mass: f64, tensor: [Vector3; 3]) -> Self {
        let tensor = matrix(&tensor);
        Self { mass, tensor, inverse: tensor.try_inverse().expect("a part has a volume") }
    }
}

/// A part that moves.
#[derive(Debug, Clone, Copy)]
pub(super) struct Moving {
    pub inertia: Inertia,
    pub pose: Pose,
    /// m/s, in the world's frame.
    pub linear: Vector3,
    /// rad/s, in the world's frame.
    pub angular: Vector3,
}

impl Moving {
    /// The angular acceleration, rad/s², by a torque, N m, both in the world's frame.
    pub(super) fn turned_by(&self, torque: Vector3) -> Vector3 {
        let turned = matrix(&self.pose.rotation);
        (turned * (self.inertia.inverse * (turned.transpose() * Column::from(torque)))).into()
    }
}

/// The centre of mass of a body.
pub(super) fn centre_of_mass(parts: &[Moving]) -> Vector3 {
    let mass: f64 = parts.iter().map(|part| part.inertia.mass).sum();
    let moment: Column<f64> =
        parts.iter().map(|part| part.inertia.mass * Column::from(part.pose.position)).sum();
    (moment / mass).into()
}

/// Linear and angular velocities of all parts with a rotation of the whole body about its centre of mass added that makes its
/// angular momentum, kg m²/s, the one that is wanted. The rates of joints stay as they are.
pub(super) fn with_angular_momentum(wanted: Vector3, parts: &[Moving]) -> Vec<(Vector3, Vector3)> {
    let centre = Column::from(centre_of_mass(parts));
    let mut momentum = -Column::from(wanted);
    let mut inertia = Matrix3::zeros();
    for part in parts {
        let turned = matrix(&part.pose.rotation);
        let own = turned * part.inertia.tensor * turned.transpose();
        let place = Column::from(part.pose.position) - centre;
        let mass = part.inertia.mass;
        momentum += own * Column::from(part.angular) + mass * place.cross(&Column::from(part.linear));
        inertia +=
            own + mass * (Matrix3::from_diagonal_element(place.norm_squared()) - place * place.transpose());
    }
    let inertia = inertia.cholesky().expect("parts have a volume");
    let rotation = inertia.solve(&momentum);
    let rest = |part: &Moving| {
        let place = Column::from(part.pose.position) - centre;
        let linear = Column::from(part.linear) - rotation.cross(&place);
        (linear.into(), (Column::from(part.angular) - rotation).into())
    };
    parts.iter().map(rest).collect()
}

pub(super) fn matrix(rows: &[Vector3; 3]) -> Matrix3<f64> {
    Matrix3::from_fn(|row, column| rows[row][column])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(position: Vector3, linear: Vector3, angular: Vector3) -> Moving {
        let tensor = [[0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.02]];
        // A quarter of a turn about x.
        let rotation = [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]];
        Moving { inertia: Inertia::new(2.0, tensor), pose: Pose { position, rotation }, linear, angular }
    }

    fn off(found: (Vector3, Vector3), expected: (Vector3, Vector3)) -> f64 {
        let difference = |a: Vector3, b: Vector3| (Column::from(a) - Column::from(b)).norm();
        difference(found.0, expected.0) + difference(found.1, expected.1)
    }

    #[test]
    fn a_body_that_turns_as_one_comes_to_rest_and_goes_on_along_its_way() {
        // About (1, 0, 0), at 0.5 rad/s about z, and 3 m/s along x.
        let parts = [-1.0, 3.0].map(|x| part([x, 0.0, 0.0], [3.0, 0.5 * (x - 1.0), 0.0], [0.0, 0.0, 0.5]));
        for found in with_angular_momentum([0.0; 3], &parts) {
            assert!(off(found, ([3.0, 0.0, 0.0], [0.0; 3])) < 1e-12, "{found:?}");
        }
    }

    /// Of a rigid motion any inertia takes off all; here only the right one does.
    #[test]
    fn one_part_that_turns_alone_has_the_momentum_of_its_inertia() {
        let spin = [0.0, 0.3, 0.4];
        let parts = [part([-1.0, 0.0, 0.0], [0.0; 3], spin), part([1.0, 0.0, 0.0], [0.0; 3], [0.0; 3])];
        // The part's long axis, of 0.02 kg m², lies along −y: so it has 0.02 of y and 0.1 of z. Both parts and their places,
        // 2 kg at 1 m each, have 0.2 about x, 0.04 + 4 about y and 0.2 + 4 about z.
        let rotation = [0.0, 0.02 * 0.3 / 4.04, 0.1 * 0.4 / 4.2];
        for (found, (part, way)) in
            with_angular_momentum([0.0; 3], &parts).into_iter().zip(parts.iter().zip([-1.0, 1.0]))
        {
            let angular = [0, 1, 2].map(|i| part.angular[i] - rotation[i]);
            // Less rotation × place.
            let linear = [0.0, -rotation[2] * way, rotation[1] * way];
            assert!(off(found, (linear, angular)) < 1e-12, "{found:?}");
        }
    }

    #[test]
    fn a_body_at_rest_gets_the_momentum_that_is_wanted() {
        let parts = [-1.0, 1.0].map(|x| part([x, 0.0, 0.0], [0.0; 3], [0.0; 3]));
        // Moments as above: 4.04 about y.
        for (found, way) in with_angular_momentum([0.0, 0.808, 0.0], &parts).into_iter().zip([-1.0, 1.0]) {
            assert!(off(found, ([0.0, 0.0, -0.2 * way], [0.0, 0.2, 0.0])) < 1e-12, "{found:?}");
        }
    }

    #[test]
    fn parts_that_turn_against_each_other_are_left_alone() {
        let parts = [-1.0, 1.0].map(|x| part([x, 0.0, 0.0], [0.0; 3], [0.0, 0.0, x]));
        for (found, part) in with_angular_momentum([0.0; 3], &parts).into_iter().zip(&parts) {
            assert!(off(found, (part.linear, part.angular)) < 1e-12, "{found:?}");
        }
    }
}
