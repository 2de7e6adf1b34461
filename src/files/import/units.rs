//! Guess how long a unit of a recording is: the one that makes the skeleton nearest to a person.

use nalgebra::Vector3 as Column;

use crate::stages::simulate::recorded::RecordedMovement;

/// The longest way along the bones of a grown person, m: from the tip of a hand to that of a foot. It is 2.2 to 2.4 m in public
/// recordings, and does not depend on the pose at rest.
const PERSON: f64 = 2.4;

/// Units in m, and what messages call them.
const UNITS: [(f64, &str); 5] = [
    (1.0, "metres"),
    (0.0254 / 0.45, "units of 0.05644 m (inches / 0.45, as in conversions of the CMU database)"),
    (0.0254, "inches"),
    (0.01, "centimetres"),
    (0.001, "millimetres"),
];

/// The unit in which a longest way is nearest to that of a person, by ratio.
pub(super) fn unit(way: f64) -> (f64, &'static str) {
    let off = |scale: f64| (way * scale / PERSON).ln().abs();
    UNITS
        .into_iter()
        .reduce(|best, next| if off(next.0) < off(best.0) { next } else { best })
        .unwrap_or(UNITS[0])
}

/// The longest way along the bones of a skeleton, in its unit.
pub(super) fn longest_way(movement: &RecordedMovement) -> f64 {
    let joints = movement.joints();
    // From each joint, the longest way up.
    let mut up = vec![0.0_f64; joints.len()];
    let mut longest = 0.0_f64;
    let mut add = |up: &mut f64, branch: f64| {
        longest = longest.max(*up + branch);
        *up = up.max(branch);
    };
    for (at, joint) in joints.iter().enumerate().rev() {
        for end in &joint.ends {
            add(&mut up[at], Column::from(*end).norm());
        }
        if let (Some(parent), Some(bone)) = (joint.parent, movement.bone(at)) {
            let branch = up[at] + bone.norm();
            add(&mut up[parent], branch);
        }
    }
    longest
}

#[cfg(test)]
mod tests;
