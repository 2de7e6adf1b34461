//! Settings of the movement, `[motion]`, and of the physics engine, `[physics]`.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use crate::numerics::range::{Checked, check, count, gain, moderate, positive};

/// How joints move that are not locked.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Movement {
    /// To a random target in each epoch, as in the paper.
    #[default]
    Random,
    /// To and fro by a [`Rhythm`], as a body that swims.
    Rhythmic,
}

impl Movement {
    /// Whether it is the paper's.
    pub fn is_random(&self) -> bool {
        *self == Self::Random
    }
}

/// What the controller takes as the distance to the target.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum AngleError {
    /// target − angle, with the angle in [−π, π] as ODE reports it.
    Raw,
    /// target − angle wrapped to [−π, π]: the shorter way round.
    Shortest,
}

/// Where a joint that moves goes to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Targets {
    /// Each of a universal joint's two axes draws a target of its own.
    Each,
    /// Both axes of a joint share one target.
    Shared,
}

/// The "simple linear controller" that moves a joint to its target (section 5.1).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Controller {
    /// A torque: stiffness × error − damping × rate, applied explicitly at each step.
    Torque,
    /// The engine's motor: its velocity is gain × error, and it has a largest torque. The engine solves for it within
    /// the step, so that it does not become unstable as an explicit torque does.
    Servo,
}

/// Coordinated random movement and its controller (section 5.1), or rhythmic movement in its place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Motion {
    /// p, ratio of motor coordination: the probability that a joint stays locked for an epoch, in [0, 1].
    pub coordination: f64,
    /// Physics steps of an epoch, after which each joint is drawn anew: whether it is locked.
    pub epoch: usize,
    /// Where a joint that moves goes to.
    pub targets: Targets,
    /// How a joint is moved to its target.
    pub controller: Controller,
    /// k_p of the torque, N·m/rad. Higher is faster, and less stable at a given step.
    pub stiffness: f64,
    /// k_d of the torque, N·m·s/rad; may be 0. Times the step over the part's axial inertia it must stay below about 1.
    pub damping: f64,
    /// k of the servo, 1/s: the motor's velocity over the distance to the target.
    pub servo_gain: f64,
    /// Largest torque of the servo, N·m.
    pub servo_torque: f64,
    /// What the controller takes as the distance to the target.
    pub error: AngleError,
    /// How joints move that are not locked. Files of a random movement do not name it, as before there was another.
    #[serde(default, skip_serializing_if = "Movement::is_random")]
    pub movement: Movement,
    /// The rhythm of a rhythmic movement; settings that were read have none for a random one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rhythm: Option<Rhythm>,
}

impl Motion {
    /// The rhythm of a rhythmic movement; `None` of a random one.
    pub fn rhythm(&self) -> Option<&Rhythm> {
        self.rhythm.as_ref().filter(|_| self.movement == Movement::Rhythmic)
    }

    /// Checks the range of each setting.
    ///
    /// # Errors
    /// The first setting that is outside its range.
    pub fn check(&self) -> Checked {
        let p = self.coordination;
        check("motion.coordination", p, (0.0..=1.0).contains(&p), "a probability, 0 to 1")?;
        count("motion.epoch", self.epoch)?;
        gain("motion.stiffness", self.stiffness)?;
        gain("motion.damping", self.damping)?;
        moderate("motion.servo_gain", self.servo_gain)?;
        let torque = self.servo_torque;
        let range = "0.000001 to 1000000 (a servo without torque moves nothing)";
        check("motion.servo_torque", torque, (1e-6..=1e6).contains(&torque), range)?;
        let complete = self.movement.is_random() || self.rhythm.is_some();
        check("motion.rhythm", self.rhythm.as_ref(), complete, "given for a rhythmic movement")?;
        self.rhythm.as_ref().map_or(Ok(()), Rhythm::check)
    }
}

/// The rhythm of a rhythmic movement: each axis of each joint swings as a sinusoid.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rhythm {
    /// f₀, Hz: the median of the frequency f, which all axes share. Higher is faster, and travels farther.
    pub frequency: f64,
    /// Standard deviation of ln(f / f₀); with 0 the frequency never changes.
    pub frequency_spread: f64,
    /// Time, s, over which a deviation of ln(f / f₀) falls to 1/e of itself on average. Longer is slower.
    pub frequency_time: f64,
    /// Time, s, in which amplitudes and lags go from one random gait to the next; with 0 the first gait never changes.
    pub gait_time: f64,
    /// Least amplitude of an axis, rad; amplitudes are uniform from it to the largest.
    pub least_amplitude: f64,
    /// Largest amplitude of an axis, rad.
    pub largest_amplitude: f64,
    /// How far the phase of a joint lies behind that of the joint above it, rad, on average: a wave has 2π / lag joints.
    pub phase_lag: f64,
    /// Largest difference from this lag, rad, drawn uniformly to both sides; with π, phases of neighbours have nothing in common.
    pub phase_spread: f64,
}

impl Rhythm {
    /// Checks the range of each setting.
    ///
    /// # Errors
    /// The first setting that is outside its range.
    pub fn check(&self) -> Checked {
        let within = |key, value: f64, (low, high): (f64, f64), range| {
            check(key, value, (low..=high).contains(&value), range)
        };
        within("motion.rhythm.frequency", self.frequency, (1e-4, 10.0), "0.0001 to 10 (Hz)")?;
        within("motion.rhythm.frequency_spread", self.frequency_spread, (0.0, 1.0), "0 to 1")?;
        moderate("motion.rhythm.frequency_time", self.frequency_time)?;
        let is_slow = self.gait_time == 0.0 || (1.0 / self.frequency..=1e6).contains(&self.gait_time);
        let range = "0, or from 1 / motion.rhythm.frequency to 1000000 (s)";
        check("motion.rhythm.gait_time", self.gait_time, is_slow, range)?;
        let largest = self.largest_amplitude;
        within("motion.rhythm.largest_amplitude", largest, (0.0, PI), "0 to pi (rad)")?;
        let range = "0 to motion.rhythm.largest_amplitude (rad)";
        within("motion.rhythm.least_amplitude", self.least_amplitude, (0.0, largest), range)?;
        within("motion.rhythm.phase_lag", self.phase_lag, (-PI, PI), "-pi to pi (rad)")?;
        within("motion.rhythm.phase_spread", self.phase_spread, (0.0, PI), "0 to pi (rad)")
    }
}

/// The angular momentum of a body on which nothing but a fluid acts from outside. It should stay what the fluid gives, or 0, but the
/// engine's steps add to it, so that the whole body slowly turns even while all joints are locked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum AngularMomentum {
    /// As the engine's steps leave it.
    Engine,
    /// What the fluid has given, or 0: after each step, the rotation of the whole body is taken off that goes beyond.
    Conserved,
}

/// Time in the physics engine, s, and what its steps leave.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Physics {
    /// Duration of one step, s.
    pub step: f64,
    /// Simulated time, s.
    pub duration: f64,
    /// Maximum number of turns of a part in one step; above it, the simulation counts as unstable.
    pub turn_limit: f64,
    /// What becomes of the angular momentum that steps add.
    pub angular_momentum: AngularMomentum,
    /// ρ of a fluid that pushes the parts, kg/m³, by the formula of equation 27 at their momentary speed, on all of their
    /// surface. With 0 the fluid is felt, but does not push.
    pub fluid_density: f64,
}

impl Physics {
    /// Steps of the physics engine between two samples that are `interval` s apart.
    pub fn steps_per_sample(&self, interval: f64) -> usize {
        (interval / self.step).round() as usize
    }

    /// T, the number of samples that are `interval` s apart.
    pub fn samples(&self, interval: f64) -> usize {
        (self.duration / interval + 1e-6).floor() as usize
    }

    /// Checks the range of each setting.
    ///
    /// # Errors
    /// The first setting that is outside its range.
    pub fn check(&self) -> Checked {
        moderate("physics.step", self.step)?;
        positive("physics.duration", self.duration)?;
        gain("physics.fluid_density", self.fluid_density)?;
        let turns = self.turn_limit;
        check("physics.turn_limit", turns, (0.001..=1e6).contains(&turns), "0.001 to 1000000")
    }
}
