//! Find where a joint is between two frames, so that its velocity has no steps.
//!
//! Through its places at the frames goes a cubic Hermite curve whose velocity at a frame is the mean of the steps before and
//! after it (Catmull and Rom 1974). Through its rotations goes the same curve on the sphere of quaternions (Kim, Kim and Shin
//! 1995, "A general construction scheme for unit quaternion curves with simple high order derivatives"). A joint that turns or
//! moves evenly does so between frames, too.

use std::ops::Range;

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3 as Column};

use super::rotation::{rotation_of, vector_of};
use super::skeleton::RecordedMovement;

/// Share of a frame below which a time is that of the frame.
const SAME_TIME: f64 = 1e-9;

/// Where `joint` is on what carries it at a time in frames. No frame outside of `frames` counts.
pub(super) fn local_at(
    movement: &RecordedMovement,
    frames: &Range<usize>,
    joint: usize,
    time: f64,
) -> Isometry3<f64> {
    let nearest = time.round();
    if (time - nearest).abs() < SAME_TIME {
        return movement.local(joint, (nearest as usize).clamp(frames.start, frames.end - 1));
    }
    let before = (time as usize).clamp(frames.start, frames.end - 2);
    let share = time - before as f64;
    let at = |frame: usize| movement.local(joint, frame);
    let steps = [
        (before > frames.start).then(|| step(&at(before - 1), &at(before))),
        Some(step(&at(before), &at(before + 1))),
        (before + 2 < frames.end).then(|| step(&at(before + 1), &at(before + 2))),
    ];
    let [start, end] = [mean(steps[0], steps[1]), mean(steps[1], steps[2])];
    let (from, to) = (at(before), at(before + 1));
    Isometry3::from_parts(
        Translation3::from(place_between(&from, &to, start.0, end.0, share)),
        rotation_between(&from.rotation, &to.rotation, start.1, end.1, share),
    )
}

/// How far a joint moves, and how it turns, from one frame to the next.
type Step = (Column<f64>, Column<f64>);

fn step(from: &Isometry3<f64>, to: &Isometry3<f64>) -> Step {
    (to.translation.vector - from.translation.vector, vector_of(from.rotation.inverse() * to.rotation))
}

/// The mean of the steps before and after a frame, of those that there are.
fn mean(before: Option<Step>, after: Option<Step>) -> Step {
    match (before, after) {
        (Some(before), Some(after)) => ((before.0 + after.0) / 2.0, (before.1 + after.1) / 2.0),
        (one, other) => one.or(other).unwrap_or_default(),
    }
}

/// The cubic Hermite curve from one place to another, with these velocities per frame at its ends.
fn place_between(
    from: &Isometry3<f64>,
    to: &Isometry3<f64>,
    start: Column<f64>,
    end: Column<f64>,
    share: f64,
) -> Column<f64> {
    let [first, second, third] = basis(share);
    let way = to.translation.vector - from.translation.vector - (start + end) / 3.0;
    from.translation.vector + start / 3.0 * first + way * second + end / 3.0 * third
}

/// The same of rotations, one factor for each term.
fn rotation_between(
    from: &UnitQuaternion<f64>,
    to: &UnitQuaternion<f64>,
    start: Column<f64>,
    end: Column<f64>,
    share: f64,
) -> UnitQuaternion<f64> {
    let [first, second, third] = basis(share);
    let (start, end) = (start / 3.0, end / 3.0);
    let way = vector_of(rotation_of(-start) * from.inverse() * to * rotation_of(-end));
    from * rotation_of(start * first) * rotation_of(way * second) * rotation_of(end * third)
}

/// The cumulative Bernstein polynomials of third degree, without that which is 1.
fn basis(share: f64) -> [f64; 3] {
    let left = 1.0 - share;
    [1.0 - left * left * left, share * share * (3.0 - 2.0 * share), share * share * share]
}

#[cfg(test)]
mod tests;
