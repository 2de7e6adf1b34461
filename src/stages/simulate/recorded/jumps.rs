//! Find the longest stretch of a recording in which nothing jumps.
//!
//! A recording may begin with a rest pose, be pasted from several takes, or lose a marker: from one frame to the next, a part is
//! then elsewhere, and its speed would be none that a body has.

use std::ops::Range;

use nalgebra::{Isometry3, UnitQuaternion};

use super::attach::Attached;
use super::play::{centre, frame_poses};
use super::rotation::angle_between;
use super::skeleton::RecordedMovement;
use crate::stages::agent::{Agent, Vector3};

/// Frames without a jump between them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Stretch {
    /// The frames, from 0.
    pub frames: Range<usize>,
    /// Frames of the recording at which a part is elsewhere than just before, rising.
    pub jumps: Vec<usize>,
}

impl Stretch {
    /// Fastest rotation that is no jump, turns a second; twice what a hand reaches in sports.
    pub const TURNS: f64 = 10.0;
    /// Largest speed of a part's centre that is no jump, m/s; twice what a throwing hand reaches.
    pub const SPEED: f64 = 50.0;

    /// The whole of a recording, whatever jumps.
    pub fn whole(movement: &RecordedMovement) -> Self {
        Self { frames: 0..movement.frames(), jumps: Vec::new() }
    }
}

/// The longest stretch without a jump of any part; the first of those that are as long.
pub fn longest_stretch(agent: &Agent, attached: &Attached, movement: &RecordedMovement) -> Stretch {
    let pose = |frame: usize| parts(agent, attached, movement, frame);
    let (mut jumps, mut before) = (Vec::new(), pose(0));
    for frame in 1..movement.frames() {
        let now = pose(frame);
        if before.iter().zip(&now).any(|(before, now)| is_jump(before, now, movement.frame_time())) {
            jumps.push(frame);
        }
        before = now;
    }
    let starts = std::iter::once(0).chain(jumps.iter().copied());
    let ends = jumps.iter().copied().chain([movement.frames()]);
    let longest = starts
        .zip(ends)
        .reduce(|longest, next| if next.1 - next.0 > longest.1 - longest.0 { next } else { longest });
    let (start, end) = longest.unwrap_or_default();
    Stretch { frames: start..end, jumps }
}

/// Where the centre of each part is, m, and how it is turned.
fn parts(
    agent: &Agent,
    attached: &Attached,
    movement: &RecordedMovement,
    frame: usize,
) -> Vec<(Vector3, UnitQuaternion<f64>)> {
    let placed: Vec<Isometry3<f64>> = frame_poses(movement, frame);
    let part = |part: usize| {
        let joint = &placed[attached.joints[part]];
        (centre(agent, attached, part, joint).into(), joint.rotation)
    };
    (0..agent.parts.len()).map(part).collect()
}

fn is_jump(
    before: &(Vector3, UnitQuaternion<f64>),
    now: &(Vector3, UnitQuaternion<f64>),
    frame_time: f64,
) -> bool {
    let way: f64 = before.0.iter().zip(now.0).map(|(before, now)| (now - before).powi(2)).sum();
    let turns = angle_between(&before.1, &now.1) / std::f64::consts::TAU;
    turns > Stretch::TURNS * frame_time || way.sqrt() > Stretch::SPEED * frame_time
}
