//! Move a body as a skeleton was recorded to move.

use std::f64::consts::TAU;
use std::ops::Range;

use nalgebra::{Isometry3, Vector3 as Column};
use rayon::prelude::*;

use super::super::movement::{Instants, Resolution, Trajectory};
use super::super::world::Pose;
use super::angles::angles;
use super::attach::Attached;
use super::between::local_at;
use super::skeleton::RecordedMovement;
use crate::stages::agent::{Agent, Joint, Part, Vector3};

/// The moment over which a speed is felt, in samples. A part turns so little meanwhile that the speeds of its points are those of a rigid
/// body. Over a whole sample they are not: the difference of two poses has second-order terms in the turn between them.
const MOMENT: f64 = 1e-3;
/// Largest rotation, rad, and distance, m, of a part on another that counts as none: what rounding leaves.
const STILL: (f64, f64) = (1e-4, 1e-5);

/// Where all joints are at a frame, in the unit of the recording.
pub(super) fn frame_poses(movement: &RecordedMovement, frame: usize) -> Vec<Isometry3<f64>> {
    movement.placed(|joint| movement.local(joint, frame))
}

/// Where the centre of a part is in the world, m, of where its joint is.
pub(super) fn centre(agent: &Agent, attached: &Attached, part: usize, joint: &Isometry3<f64>) -> Column<f64> {
    let arm = Column::from(agent.parts[part].centre) - attached.rest[part];
    attached.scale * joint.translation.vector + joint.rotation * arm
}

/// T, the number of times `interval` (s) apart after the first of so many frames.
pub fn samples(movement: &RecordedMovement, frames: &Range<usize>, interval: f64) -> usize {
    ((frames.len() - 1) as f64 / (interval / movement.frame_time()) + 1e-6) as usize
}

/// The movement of `agent` over `frames` of a recording, sampled every `interval` (s) from the first of them on: the initial pose
/// and `samples` more. Speeds are those at the samples.
///
/// The [`Resolution`] says how far joints come apart, which are no single points in the recording, and the largest turn of a part
/// between two samples.
pub fn play(
    agent: &Agent,
    attached: &Attached,
    movement: &RecordedMovement,
    frames: &Range<usize>,
    interval: f64,
    samples: usize,
) -> Trajectory {
    // 1 exactly, if it is the frame time: then all samples are frames.
    let step = interval / movement.frame_time();
    let placed_at = |time: f64| {
        movement.placed(|joint| local_at(movement, frames, joint, frames.start as f64 + time * step))
    };
    let sampled: Vec<(Vec<Pose>, Vec<Vector3>, f64)> = (0..=samples)
        .into_par_iter()
        .map(|sample| {
            let placed = placed_at(sample as f64);
            let separation = separation(agent, attached, &placed);
            (poses(agent, attached, &placed), joint_angles(agent, attached, &placed), separation)
        })
        .collect();
    let before = (1..=samples).into_par_iter();
    let before =
        before.map(|sample| poses(agent, attached, &placed_at(sample as f64 - MOMENT))).collect::<Vec<_>>();
    let mut trajectory = Trajectory {
        parts: agent.parts.len(),
        joints: agent.joints.len(),
        instants: Some(Instants { before: before.concat(), moment: MOMENT * interval }),
        ..Trajectory::default()
    };
    for (poses, angles, anchor_separation) in sampled {
        let before = trajectory.poses.len().checked_sub(poses.len()).map(|at| &trajectory.poses[at..]);
        let pairs = before.into_iter().flatten().zip(&poses);
        let turn = pairs.map(|(before, now)| angle(before, now) / TAU).fold(0.0, f64::max);
        trajectory.resolution = trajectory.resolution.worse(Resolution { anchor_separation, turn });
        trajectory.poses.extend(poses);
        trajectory.angles.extend(angles);
    }
    trajectory
}

fn poses(agent: &Agent, attached: &Attached, placed: &[Isometry3<f64>]) -> Vec<Pose> {
    let pose = |(at, part): (usize, &Part)| {
        let joint = &placed[attached.joints[at]];
        let turn = joint.rotation.to_rotation_matrix();
        let rotation = [0, 1, 2].map(|row| {
            [0, 1, 2].map(|column| (0..3).map(|k| turn[(row, k)] * part.rotation[k][column]).sum())
        });
        Pose { position: centre(agent, attached, at, joint).into(), rotation }
    };
    agent.parts.iter().enumerate().map(pose).collect()
}

fn joint_angles(agent: &Agent, attached: &Attached, placed: &[Isometry3<f64>]) -> Vec<Vector3> {
    let turned = |part: usize| placed[attached.joints[part]].rotation;
    let angles = |joint: &Joint| angles(&joint.freedom, turned(joint.parent).inverse() * turned(joint.child));
    agent.joints.iter().map(angles).collect()
}

/// Largest distance between the two places that a joint's parts have its anchor at, m.
fn separation(agent: &Agent, attached: &Attached, placed: &[Isometry3<f64>]) -> f64 {
    let apart = |joint: &Joint| {
        let on = |part: usize| {
            let own = &placed[attached.joints[part]];
            let arm = Column::from(joint.anchor) - attached.rest[part];
            attached.scale * own.translation.vector + own.rotation * arm
        };
        (on(joint.parent) - on(joint.child)).norm()
    };
    agent.joints.iter().map(apart).fold(0.0, f64::max)
}

/// For each joint, the part that its child never moves against in a trajectory, if there is one: that which carries it, or else an
/// earlier one that the same part carries, such as the other shoulder.
pub fn still_on(agent: &Agent, trajectory: &Trajectory) -> Vec<Option<usize>> {
    let all = || trajectory.poses.chunks(trajectory.parts);
    let is_still = |on: usize, part: usize| {
        let mut relative = all().map(|poses| relative(&poses[on], &poses[part]));
        let first = relative.next();
        first.is_none_or(|first| {
            relative.all(|now| {
                let way = Column::from(now.position) - Column::from(first.position);
                angle(&first, &now) <= STILL.0 && way.norm() <= STILL.1
            })
        })
    };
    let on = |(at, joint): (usize, &Joint)| {
        let earlier = agent.joints[..at].iter().filter(|other| other.parent == joint.parent);
        let mut candidates = std::iter::once(joint.parent).chain(earlier.map(|other| other.child));
        candidates.find(|&on| is_still(on, joint.child))
    };
    agent.joints.iter().enumerate().map(on).collect()
}

/// The pose of a part in the frame of another.
fn relative(on: &Pose, part: &Pose) -> Pose {
    let columns = [0, 1, 2].map(|column| on.turned_back(part.rotation.map(|row| row[column])));
    Pose {
        position: on.turned_back([0, 1, 2].map(|k| part.position[k] - on.position[k])),
        rotation: [0, 1, 2].map(|row| columns.map(|column| column[row])),
    }
}

/// The angle between the rotations of two poses, rad. The squares of the differences of two rotation matrices sum up to 8 times
/// the squared sine of half of it.
fn angle(a: &Pose, b: &Pose) -> f64 {
    let numbers = |pose: &Pose| pose.rotation.into_iter().flatten();
    let squares: f64 = numbers(a).zip(numbers(b)).map(|(a, b)| (a - b) * (a - b)).sum();
    2.0 * libm::asin((squares / 8.0).sqrt().min(1.0))
}

#[cfg(test)]
mod tests;
