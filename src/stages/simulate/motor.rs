//! Move the joints in coordination: lock each joint, or drive it to a random target (section 5.1) or along a sinusoid.
//!
//! Every joint is locked at the beginning. At the end of each epoch, each joint is drawn anew: with probability 1 − p it
//! moves to a random target, uniform on [−π, π], under a linear controller; otherwise it is locked at its present angle.
//! The paper leaves open what the controller is, its gains, and whether the two axes of a universal joint share one
//! target. In a rhythmic movement, the target of a joint that moves is that of the oscillators, which never stop.

use std::f64::consts::{PI, TAU};

use nalgebra::Rotation3;
use rand::RngExt;

use super::rhythm::Oscillators;
use super::settings::{AngleError, Controller, Motion, Targets};
use super::world::{World, ball_error};
use crate::numerics::rng::Stream;
use crate::stages::agent::{Freedom, Joint, Vector3};

/// The state of every joint's motor.
#[derive(Debug, Clone)]
pub(super) struct Motor {
    /// How each joint turns.
    freedoms: Vec<Freedom>,
    /// Targets of the angles, rad, of a joint that moves; `None` where it is locked.
    targets: Vec<Option<Vector3>>,
    /// Where the targets come from that move on; `None` where they stay for an epoch.
    oscillators: Option<Oscillators>,
    /// Duration of a physics step, s.
    step: f64,
}

impl Motor {
    /// Motors of joints that are all locked, as a fresh [`World`] of steps of `step` s has them. Draws the rhythm, if there is one.
    pub(super) fn new(joints: &[Joint], motion: &Motion, step: f64, rng: &mut Stream) -> Self {
        let freedoms = joints.iter().map(|joint| joint.freedom).collect();
        let draw = |rhythm| Oscillators::new(joints, rhythm, motion.targets, (motion.epoch, step), rng);
        let oscillators = motion.rhythm().map(draw);
        Self { freedoms, targets: vec![None; joints.len()], oscillators, step }
    }

    /// Draws for each joint whether it moves in the epoch that begins, and where to. Nothing is drawn for one that is fixed.
    pub(super) fn draw_targets(&mut self, world: &mut World, motion: &Motion, rng: &mut Stream) {
        for (joint, (freedom, target)) in self.freedoms.iter().zip(&mut self.targets).enumerate() {
            if *freedom == Freedom::Fixed {
                continue;
            }
            let moves = rng.random_bool(1.0 - motion.coordination);
            *target = moves.then(|| match &self.oscillators {
                Some(oscillators) => oscillators.target(joint),
                None => draw_target(freedom, motion.targets, &mut || rng.random_range(-PI..=PI)),
            });
            match target {
                Some(_) => world.unlock(joint),
                None => world.lock(joint),
            }
        }
        if let Some(oscillators) = &mut self.oscillators {
            oscillators.begin_epoch(rng);
        }
    }

    /// Drives each axis that moves towards its target for the next step, and as fast as a target that moves does.
    pub(super) fn apply(&mut self, world: &mut World, motion: &Motion) {
        if let Some(oscillators) = &mut self.oscillators {
            oscillators.advance();
        }
        for (joint, (freedom, target)) in self.freedoms.iter().zip(&mut self.targets).enumerate() {
            let Some(target) = target else { continue };
            let difference = |to: Vector3, from: Vector3| match freedom {
                Freedom::Ball => ball_error(to, from),
                _ => [0, 1, 2].map(|axis| angle_error(to[axis], from[axis], motion.error)),
            };
            let errors = difference(*target, world.angles(joint));
            let wanted = match &self.oscillators {
                None => [0.0; 3],
                Some(oscillators) => {
                    let next = oscillators.target(joint);
                    difference(next, std::mem::replace(target, next)).map(|way| way / self.step)
                }
            };
            match motion.controller {
                Controller::Torque => {
                    let rates = world.rates(joint);
                    let torque = |axis| {
                        motion.stiffness * errors[axis] + motion.damping * (wanted[axis] - rates[axis])
                    };
                    world.apply_torques(joint, [0, 1, 2].map(torque));
                }
                Controller::Servo => {
                    let velocity = |axis| motion.servo_gain * errors[axis] + wanted[axis];
                    world.set_motor(joint, [0, 1, 2].map(velocity), motion.servo_torque);
                }
            }
        }
    }

    /// Whether a joint is locked in this epoch, for the tests' statistics.
    #[cfg(test)]
    pub(super) fn is_locked(&self, joint: usize) -> bool {
        self.targets[joint].is_none()
    }
}

/// Random angles of a joint; a ball joint turns by them about x, y and z, one after the other.
fn draw_target(freedom: &Freedom, targets: Targets, angle: &mut dyn FnMut() -> f64) -> Vector3 {
    let mut drawn = [0.0; 3];
    let own = &mut drawn[..freedom.angles()];
    match targets {
        Targets::Each => own.fill_with(angle),
        Targets::Shared => own.fill(angle()),
    }
    match freedom {
        Freedom::Ball => Rotation3::from_euler_angles(drawn[0], drawn[1], drawn[2]).scaled_axis().into(),
        _ => drawn,
    }
}

fn angle_error(target: f64, angle: f64, kind: AngleError) -> f64 {
    let error = target - angle;
    match kind {
        AngleError::Raw => error,
        AngleError::Shortest => error - TAU * (error / TAU).round(),
    }
}

#[cfg(test)]
mod tests;
