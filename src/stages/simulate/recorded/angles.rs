//! Read the angles of a joint from how its parts are turned, as the physics engine counts them.

use nalgebra::{UnitQuaternion, Vector3 as Column};

use super::rotation::vector_of;
use crate::stages::agent::{Freedom, Vector3};

/// The angles of a joint, rad in [−π, π]: the parent relative to the child, 0 in the rest pose. `turned` is the rotation of the
/// child relative to the parent. Angles that the joint does not have are 0; of a ball joint, they are the vector of that
/// rotation. What a hinge or universal joint cannot do is left out.
pub(super) fn angles(freedom: &Freedom, turned: UnitQuaternion<f64>) -> Vector3 {
    match *freedom {
        Freedom::Fixed => [0.0; 3],
        Freedom::Ball => (-vector_of(turned)).into(),
        Freedom::Hinge(axis) => {
            let way = if turned.w < 0.0 { -1.0 } else { 1.0 };
            [-2.0 * libm::atan2(way * turned.imag().dot(&Column::from(axis)), way * turned.w), 0.0, 0.0]
        }
        Freedom::Universal([first, second]) => {
            let (first, second) = (Column::from(first), Column::from(second));
            let third = first.cross(&second);
            // About the first axis, then about the second, which is turned with it: columns of the product.
            let (from_first, from_second) = (turned * first, turned * second);
            let third_turned = turned * third;
            let about_first = libm::atan2(from_second.dot(&third), from_second.dot(&second));
            let about_second = libm::atan2(third_turned.dot(&first), from_first.dot(&first));
            [-about_first, -about_second, 0.0]
        }
    }
}

#[cfg(test)]
mod tests;
