//! Move the joints at random, in coordination: lock each joint, or drive it to a random target (section 5.1).
//!
//! Every joint is locked at the beginning. At the end of each epoch, each joint is drawn anew: with probability 1 − p it
//! moves to a random target, uniform on [−π, π], under a linear controller; otherwise it is locked at its present angle.
//! The paper leaves open what the controller is, its gains, and whether the two axes of a universal joint share one
//! target.

use std::f64::consts::{PI, TAU};

use rand::RngExt;

use super::settings::{AngleError, Controller, Motion, Targets};
use super::world::World;
use crate::numerics::rng::Stream;

/// The state of every joint's motor.
#[derive(Debug, Clone)]
pub struct Motor {
    /// Targets of both axes, rad, of a joint that moves; `None` where it is locked.
    targets: Vec<Option<[f64; 2]>>,
}

impl Motor {
    /// Motors of `joints` joints, all locked, as a fresh [`World`] has them.
    pub fn new(joints: usize) -> Self {
        Self { targets: vec![None; joints] }
    }

    /// Draws for each joint whether it moves in the epoch that begins, and where to.
    pub fn draw_targets(&mut self, world: &mut World, motion: &Motion, rng: &mut Stream) {
        for (joint, target) in self.targets.iter_mut().enumerate() {
            *target = rng.random_bool(1.0 - motion.coordination).then(|| {
                let mut angle = || rng.random_range(-PI..=PI);
                match motion.targets {
                    Targets::Each => [angle(), angle()],
                    Targets::Shared => [angle(); 2],
                }
            });
            match target {
                Some(_) => world.unlock(joint),
                None => world.lock(joint),
            }
        }
    }

    /// Drives each axis that moves towards its target for the next step.
    pub fn apply(&self, world: &mut World, motion: &Motion) {
        for (joint, target) in self.targets.iter().enumerate() {
            let Some(target) = target else { continue };
            let angles = world.angles(joint);
            let errors = [0, 1].map(|axis| angle_error(target[axis], angles[axis], motion.error));
            match motion.controller {
                Controller::Torque => {
                    let rates = world.rates(joint);
                    let torque = |axis| motion.stiffness * errors[axis] - motion.damping * rates[axis];
                    world.apply_torques(joint, [0, 1].map(torque));
                }
                Controller::Servo => {
                    world.set_motor(
                        joint,
                        errors.map(|error| motion.servo_gain * error),
                        motion.servo_torque,
                    );
                }
            }
        }
    }

    /// Whether a joint is locked in this epoch, for the tests' statistics.
    #[cfg(test)]
    pub fn is_locked(&self, joint: usize) -> bool {
        self.targets[joint].is_none()
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
mod tests {
    use super::super::fixtures::Scene;
    use super::*;
    use crate::numerics::rng::stream;

    #[test]
    fn both_axes_draw_a_target_each_or_share_one() {
        let mut scene = Scene::new();
        scene.motion.coordination = 0.0;
        let agent = scene.agent();
        let mut drawn = |targets| {
            scene.motion.targets = targets;
            let mut motor = Motor::new(agent.joints.len());
            let rng = &mut stream(1, 1, "motion", 0);
            motor.draw_targets(&mut World::new(&agent, &scene.physics), &scene.motion, rng);
            (motor.targets.iter().map(|target| target.expect("p = 0")).collect::<Vec<_>>(), rng.clone())
        };
        // After the draw of whether the joint moves, a draw for each axis or one for both.
        let expected = |shared: bool| {
            let mut rng = stream(1, 1, "motion", 0);
            let target = |_| {
                rng.random_bool(1.0);
                let first = rng.random_range(-PI..=PI);
                [first, if shared { first } else { rng.random_range(-PI..=PI) }]
            };
            (agent.joints.iter().map(target).collect::<Vec<_>>(), rng)
        };
        assert_eq!(drawn(Targets::Each), expected(false));
        assert_eq!(drawn(Targets::Shared), expected(true));
    }

    #[test]
    fn the_shortest_error_goes_the_short_way_round() {
        assert_eq!(angle_error(3.0, -3.0, AngleError::Raw), 6.0);
        assert!((angle_error(3.0, -3.0, AngleError::Shortest) - (6.0 - TAU)).abs() < 1e-12);
        assert_eq!(angle_error(1.0, 0.5, AngleError::Shortest), 0.5);
    }
}
