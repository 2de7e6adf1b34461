//! Rotations and their vectors (axis times angle), with the same bits on every machine.

use nalgebra::{Quaternion, UnitQuaternion, Vector3 as Column};

/// Angle below which a rotation is its own first order, rad.
const SMALL: f64 = 1e-12;

/// The rotation about the axis x, y or z (0 to 2) by an angle in degrees.
pub(super) fn about(axis: usize, degrees: f64) -> UnitQuaternion<f64> {
    let mut vector = Column::zeros();
    vector[axis] = degrees.to_radians();
    rotation_of(vector)
}

/// The rotation of a vector, rad.
pub(super) fn rotation_of(vector: Column<f64>) -> UnitQuaternion<f64> {
    let angle = vector.norm();
    let (sine, cosine) = libm::sincos(angle / 2.0);
    let factor = if angle < SMALL { 0.5 } else { sine / angle };
    UnitQuaternion::new_unchecked(Quaternion::from_parts(cosine, vector * factor))
}

/// The vector of a rotation, rad: the shorter way round.
pub(super) fn vector_of(rotation: UnitQuaternion<f64>) -> Column<f64> {
    let way = if rotation.w < 0.0 { -1.0 } else { 1.0 };
    let (sine, cosine) = (rotation.imag().norm(), way * rotation.w);
    let factor = if sine < SMALL { 2.0 } else { 2.0 * libm::atan2(sine, cosine) / sine };
    rotation.imag() * (way * factor)
}

/// How far apart two rotations are, rad.
pub(super) fn angle_between(a: &UnitQuaternion<f64>, b: &UnitQuaternion<f64>) -> f64 {
    vector_of(a.inverse() * b).norm()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn a_rotation_of_a_vector_has_that_vector() {
        for vector in [
            Column::zeros(),
            Column::new(1e-14, 0.0, 0.0),
            Column::new(0.3, -0.2, 0.9),
            Column::new(0.0, 3.1, 0.0),
            Column::new(-PI + 1e-9, 0.0, 0.0),
        ] {
            assert!((vector_of(rotation_of(vector)) - vector).norm() < 1e-9, "{vector}");
        }
        // The longer way round is the shorter one of the other direction.
        assert!((vector_of(about(2, 270.0)) - Column::new(0.0, 0.0, -PI / 2.0)).norm() < 1e-12);
        assert!((about(0, 90.0) * Column::y() - Column::z()).norm() < 1e-12);
        assert!((angle_between(&about(1, 350.0), &about(1, 20.0)) - PI / 6.0).abs() < 1e-12);
    }
}
