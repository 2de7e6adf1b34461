//! Move an agent for a given time and record its trajectory (section 5.1).

use serde::{Deserialize, Serialize};

use super::motor::Motor;
use super::settings::{Motion, Physics};
use super::world::{Pose, Unstable, World};
use crate::numerics::rng::Stream;
use crate::stages::agent::{Agent, Vector3};

/// The movement of an agent, sampled every Δt.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Trajectory {
    /// Number of parts.
    pub parts: usize,
    /// Number of joints.
    pub joints: usize,
    /// (T + 1) × parts, by time: the pose of each part at 0, Δt, 2Δt, …
    pub poses: Vec<Pose>,
    /// Poses a moment before each sample but the first, if speeds are to be felt at the samples, and not over Δt.
    pub instants: Option<Instants>,
    /// (T + 1) × joints, by time: the angles of each joint, rad in [−π, π]; those that it does not have are 0.
    pub angles: Vec<Vector3>,
    /// How well the physics step resolved it.
    pub resolution: Resolution,
}

/// Where the parts are a moment before each sample: what a speed at the sample is the backward difference of.
#[derive(Debug, Clone, PartialEq)]
pub struct Instants {
    /// T × parts, by time.
    pub before: Vec<Pose>,
    /// The moment, s.
    pub moment: f64,
}

/// How well the physics step resolves a movement: the largest value over all steps.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Resolution {
    /// Distance by which an anchor comes apart, m.
    pub anchor_separation: f64,
    /// Turns that a part makes in a step.
    pub turn: f64,
}

impl Resolution {
    /// Largest separation of an anchor at which a movement counts as resolved, m.
    pub const SEPARATION: f64 = 0.01;
    /// Largest turn of a part in a step at which a movement counts as resolved, in turns.
    pub const TURN: f64 = 0.1;

    /// Whether the step resolves the movement: anchors stay within 1 cm, and no part turns by more than a tenth of a
    /// turn in a step. A movement that is not resolved is no evidence on what a real body would feel. One that is may still
    /// rest on what steps add to its [angular momentum](super::AngularMomentum).
    pub fn is_resolved(&self) -> bool {
        self.anchor_separation <= Self::SEPARATION && self.turn <= Self::TURN
    }

    /// Whether the step resolves `what`, and how well, in words.
    pub fn in_words(&self, what: &str) -> String {
        format!(
            "the time step {} {what}: joint anchors separate by at most {:.2} mm, and a part rotates by at most {:.3} revolutions \
             in a step (limits: {:.0} mm and {})",
            if self.is_resolved() { "resolves" } else { "is too long for" },
            1e3 * self.anchor_separation,
            self.turn,
            1e3 * Self::SEPARATION,
            Self::TURN
        )
    }

    /// The worse of two in each respect.
    #[must_use]
    pub fn worse(self, other: Self) -> Self {
        Self {
            anchor_separation: self.anchor_separation.max(other.anchor_separation),
            turn: self.turn.max(other.turn),
        }
    }
}

impl Trajectory {
    /// T, the number of samples after the initial pose.
    pub fn samples(&self) -> usize {
        self.poses.len() / self.parts - 1
    }
}

/// Moves `agent` for `physics.duration`, and records a sample every `interval` (Δt, s), T + 1 in all (section 5.1).
///
/// Calls `tick` once for each sample.
///
/// # Errors
/// [`Unstable`] if the gains are too high for the step.
pub fn simulate(
    agent: &Agent,
    motion: &Motion,
    physics: &Physics,
    interval: f64,
    rng: &mut Stream,
    tick: &dyn Fn(),
) -> Result<Trajectory, Unstable> {
    let (parts, joints) = (agent.parts.len(), agent.joints.len());
    let (samples, steps_per_sample) = (physics.samples(interval), physics.steps_per_sample(interval));
    let mut world = World::new(agent, physics);
    let mut motor = Motor::new(&agent.joints, motion, physics.step, rng);
    let mut trajectory = Trajectory {
        parts,
        joints,
        poses: Vec::with_capacity((samples + 1) * parts),
        angles: Vec::with_capacity((samples + 1) * joints),
        ..Trajectory::default()
    };
    for step in 0..=samples * steps_per_sample {
        if step % steps_per_sample == 0 {
            trajectory.poses.extend((0..parts).map(|part| world.pose(part)));
            trajectory.angles.extend((0..joints).map(|joint| world.angles(joint)));
            tick();
        }
        if step == samples * steps_per_sample {
            break;
        }
        if step > 0 && step % motion.epoch == 0 {
            motor.draw_targets(&mut world, motion, rng);
        }
        motor.apply(&mut world, motion);
        world.step()?;
        let now = Resolution { anchor_separation: world.anchor_separation(), turn: world.turn() };
        trajectory.resolution = trajectory.resolution.worse(now);
    }
    Ok(trajectory)
}

#[cfg(test)]
mod tests;
