//! Hold a recorded movement: a skeleton of joints, and the number that each of their channels has at each frame.
//!
//! A joint is carried by an earlier one. It is at its offset from that, or where its position channels say, and it is turned by
//! its rotation channels, one after the other about axes that turn with it. At rest, all rotations are 0.

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3 as Column};

use super::rotation::about;
use crate::stages::agent::Vector3;

/// Share of its length by which a bone may stretch and still be one.
const STRETCH: f64 = 0.05;
/// The same, root mean square, about its mean. Suits of inertial sensors write joints that drift apart by some centimetres.
const DRIFT: f64 = 0.25;
/// Share of the longest offset that is no travel, but rounding.
const ROUNDING: f64 = 1e-4;

/// What a number of a frame is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Channel {
    /// Place along the axis x, y or z (0 to 2) of what carries the joint, in the unit of the recording. It takes the place of
    /// the offset.
    Position(usize),
    /// Rotation about the axis x, y or z (0 to 2), degrees.
    Rotation(usize),
}

/// A joint of a skeleton, with the bones that turn with it.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedJoint {
    /// Its name, which no other joint has.
    pub name: String,
    /// The earlier joint that carries it; the first has none.
    pub parent: Option<usize>,
    /// Where it is on that, in the unit of the recording.
    pub offset: Vector3,
    /// Its numbers in a frame, in their order.
    pub channels: Vec<Channel>,
    /// Where its bones end that lead to no other joint, in the unit of the recording.
    pub ends: Vec<Vector3>,
}

impl RecordedJoint {
    /// Whether it has a channel for its place.
    fn is_placed(&self) -> bool {
        self.channels.iter().any(|channel| matches!(channel, Channel::Position(_)))
    }

    /// Where it is and how it is turned by these numbers of its channels.
    fn pose(&self, numbers: &[f64]) -> Isometry3<f64> {
        let (mut place, mut rotation) = (self.offset, UnitQuaternion::identity());
        for (channel, &number) in self.channels.iter().zip(numbers) {
            match *channel {
                Channel::Position(axis) => place[axis] = number,
                Channel::Rotation(axis) => rotation *= about(axis, number),
            }
        }
        Isometry3::from_parts(Translation3::from(Column::from(place)), rotation)
    }
}

/// A skeleton and how it moved.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedMovement {
    joints: Vec<RecordedJoint>,
    /// Where the numbers of each joint begin in a frame.
    firsts: Vec<usize>,
    /// Numbers of a frame.
    width: usize,
    frame_time: f64,
    values: Vec<f64>,
}

impl RecordedMovement {
    /// A skeleton, the time from one frame to the next in s, and the numbers of all channels, by joint within frame.
    ///
    /// # Panics
    /// If there is no joint or no frame, if a joint is not carried by an earlier one, or if the numbers are not whole frames.
    pub fn new(joints: Vec<RecordedJoint>, frame_time: f64, values: Vec<f64>) -> Self {
        let carried = |(at, joint): (usize, &RecordedJoint)| match joint.parent {
            Some(parent) => parent < at,
            None => at == 0,
        };
        assert!(
            !joints.is_empty() && joints.iter().enumerate().all(carried),
            "joints come after what carries them"
        );
        let mut firsts = Vec::with_capacity(joints.len());
        let mut width = 0;
        for joint in &joints {
            firsts.push(width);
            width += joint.channels.len();
        }
        assert!(width > 0 && !values.is_empty() && values.len().is_multiple_of(width), "frames are whole");
        Self { joints, firsts, width, frame_time, values }
    }

    /// The joints, each after the one that carries it.
    pub fn joints(&self) -> &[RecordedJoint] {
        &self.joints
    }

    /// Time from one frame to the next, s.
    pub fn frame_time(&self) -> f64 {
        self.frame_time
    }

    /// Number of frames, at least one.
    pub fn frames(&self) -> usize {
        self.values.len() / self.width
    }

    /// How many frames are the same as the one before.
    pub fn repeated_frames(&self) -> usize {
        let frames: Vec<&[f64]> = self.values.chunks(self.width).collect();
        frames.windows(2).filter(|pair| pair[0] == pair[1]).count()
    }

    /// Where a joint is and how it is turned at a frame, relative to what carries it.
    pub fn local(&self, joint: usize, frame: usize) -> Isometry3<f64> {
        let numbers = &self.values[frame * self.width + self.firsts[joint]..];
        self.joints[joint].pose(numbers)
    }

    /// Where all joints are and how they are turned in the world, of where each is on what carries it.
    pub fn placed(&self, local: impl Fn(usize) -> Isometry3<f64>) -> Vec<Isometry3<f64>> {
        let mut placed: Vec<Isometry3<f64>> = Vec::with_capacity(self.joints.len());
        for (at, joint) in self.joints.iter().enumerate() {
            let own = local(at);
            placed.push(joint.parent.map_or(own, |parent| placed[parent] * own));
        }
        placed
    }

    /// Where a joint is on what carries it: its offset or, if it is always elsewhere, where its position channels say, at the first frame or
    /// on average. `None` of the first joint, and of one that travels: by more than a twentieth of that distance, and by more than a
    /// quarter of it on average. On a first joint that never moves or carries one such joint only, as
    /// a mark on the floor does, a joint travels if it moves at all.
    pub fn bone(&self, joint: usize) -> Option<Column<f64>> {
        let RecordedJoint { parent, offset, .. } = &self.joints[joint];
        let offset = Column::from(*offset);
        parent.as_ref()?;
        if !self.joints[joint].is_placed() {
            return Some(offset);
        }
        let longest = self.joints.iter().map(|joint| Column::from(joint.offset).norm()).fold(0.0, f64::max);
        let place = |frame: usize| self.local(joint, frame).translation.vector;
        let places = || (0..self.frames()).map(place);
        let on_first = self.joints.iter().filter(|joint| joint.parent == Some(0) && joint.is_placed());
        let rests = || (0..self.frames()).all(|frame| self.local(0, frame) == self.local(0, 0));
        let is_on_mark = *parent == Some(0) && (on_first.count() == 1 || rests());
        let steady = [offset, place(0)].into_iter().find(|rest| {
            let stretch = if is_on_mark { 0.0 } else { STRETCH * rest.norm() };
            places().all(|place| (place - rest).norm() <= stretch + ROUNDING * longest)
        });
        steady.or_else(|| {
            let mean = places().sum::<Column<f64>>() / self.frames() as f64;
            let variance =
                places().map(|place| (place - mean).norm_squared()).sum::<f64>() / self.frames() as f64;
            (!is_on_mark && variance.sqrt() <= DRIFT * mean.norm()).then_some(mean)
        })
    }

    /// Where all joints are at rest, from the first one. One that travels is where it is at the first frame.
    pub fn rest(&self) -> Vec<Column<f64>> {
        let mut rest: Vec<Column<f64>> = Vec::with_capacity(self.joints.len());
        for (at, joint) in self.joints.iter().enumerate() {
            let on = joint.parent.map(|parent| rest[parent]);
            let own = || self.bone(at).unwrap_or_else(|| self.local(at, 0).translation.vector);
            rest.push(on.map_or_else(Column::zeros, |on| on + own()));
        }
        rest
    }
}

#[cfg(test)]
mod tests;
