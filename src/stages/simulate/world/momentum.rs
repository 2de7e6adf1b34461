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
mod tests;
