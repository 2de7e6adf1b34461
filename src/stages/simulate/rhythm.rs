//! Swing the axes of all joints in a common rhythm, so that waves run through the body and it swims. The paper has no such movement.
//!
//! Axis i has the target q_i(t) = A_i sin(φ(t) − δ_i). One clock drives them all: dφ/dt = 2π f(t), where ln(f / f₀) is an
//! Ornstein–Uhlenbeck process that is drawn at the end of each epoch, and linear between. Amplitudes A_i and lags δ_i are a gait.
//! The lag of an axis is that of the joint above plus about `phase_lag`; where no joint is above, it is random. One gait is drawn for
//! the whole movement, or one each `gait_time`, and amplitudes and lags go linearly from each gait to the next.

use std::f64::consts::{PI, TAU};

use rand::RngExt;
use rand_distr::StandardNormal;

use super::settings::{Rhythm, Targets};
use crate::numerics::rng::Stream;
use crate::stages::agent::{Freedom, Joint, Vector3};

/// The targets of all joints at a time of a rhythmic movement.
#[derive(Debug, Clone)]
pub(super) struct Oscillators {
    joints: Vec<Joint>,
    rhythm: Rhythm,
    targets: Targets,
    /// The gaits before and after; the same if the gait never changes.
    gaits: [Gait; 2],
    /// Epochs that lead from one gait to the next; `None` if the gait never changes.
    epochs: Option<usize>,
    /// Epochs since the gait before, with this one.
    begun: usize,
    /// φ, rad in [0, 2π).
    phase: f64,
    /// ln(f / f₀) at the beginning and at the end of this epoch.
    deviations: [f64; 2],
    /// Physics steps of an epoch.
    epoch: usize,
    /// Steps of this epoch that have passed.
    passed: usize,
    /// Duration of a step, s.
    step: f64,
}

/// How all joints swing, in their order; 0 for axes that a joint does not have.
type Gait = Vec<Axes>;

/// How the axes of a joint swing.
#[derive(Debug, Clone, Copy, Default)]
struct Axes {
    /// A_i, rad.
    amplitudes: Vector3,
    /// δ_i, rad.
    lags: Vector3,
}

impl Oscillators {
    /// Those of some joints in epochs of so many steps, of which each takes `step` s. Draws the first gait, and the frequencies of the first
    /// epoch.
    pub(super) fn new(
        joints: &[Joint],
        rhythm: &Rhythm,
        targets: Targets,
        (epoch, step): (usize, f64),
        rng: &mut Stream,
    ) -> Self {
        let gait = gait(joints, rhythm, targets, rng);
        let first = rhythm.frequency_spread * rng.sample::<f64, _>(StandardNormal);
        let epochs = (rhythm.gait_time / (epoch as f64 * step)).round().max(1.0) as usize;
        let mut own = Self {
            joints: joints.to_vec(),
            rhythm: rhythm.clone(),
            targets,
            gaits: [gait.clone(), gait],
            epochs: (rhythm.gait_time > 0.0).then_some(epochs),
            begun: epochs,
            phase: 0.0,
            deviations: [first; 2],
            epoch,
            passed: 0,
            step,
        };
        own.begin_epoch(rng);
        own
    }

    /// Draws the frequency at the end of the epoch that begins and, where a gait is reached, the next one.
    pub(super) fn begin_epoch(&mut self, rng: &mut Stream) {
        let Rhythm { frequency_spread, frequency_time, .. } = self.rhythm;
        let decay = self.epoch as f64 * self.step / frequency_time;
        let [_, now] = self.deviations;
        let news =
            frequency_spread * (-libm::expm1(-2.0 * decay)).sqrt() * rng.sample::<f64, _>(StandardNormal);
        self.deviations = [now, libm::exp(-decay) * now + news];
        self.passed = 0;
        let Some(epochs) = self.epochs else { return };
        self.begun += 1;
        if self.begun > epochs {
            self.gaits.swap(0, 1);
            self.gaits[1] = gait(&self.joints, &self.rhythm, self.targets, rng);
            self.begun = 1;
        }
    }

    /// f at the middle of the next step, Hz.
    fn frequency(&self) -> f64 {
        let [from, to] = self.deviations;
        let share = (self.passed as f64 + 0.5) / self.epoch as f64;
        self.rhythm.frequency * libm::exp(from + share * (to - from))
    }

    /// Goes on by a step.
    pub(super) fn advance(&mut self) {
        self.phase = (self.phase + TAU * self.frequency() * self.step) % TAU;
        self.passed += 1;
    }

    /// The target of a joint, rad: its angles or, of a ball joint, the vector of its rotation.
    pub(super) fn target(&self, joint: usize) -> Vector3 {
        let [from, to] = [0, 1].map(|at| self.gaits[at][joint]);
        let share = self.epochs.map_or(0.0, |epochs| {
            ((self.begun - 1) as f64 + self.passed as f64 / self.epoch as f64) / epochs as f64
        });
        let between = |from: Vector3, to: Vector3, axis: usize| from[axis] + share * (to[axis] - from[axis]);
        [0, 1, 2].map(|axis| {
            let amplitude = between(from.amplitudes, to.amplitudes, axis);
            amplitude * libm::sin(self.phase - between(from.lags, to.lags, axis))
        })
    }
}

/// Draws amplitude and lag of each axis, joint by joint, or of each joint where its axes share their targets.
fn gait(joints: &[Joint], rhythm: &Rhythm, targets: Targets, rng: &mut Stream) -> Gait {
    let mut gait = Gait::with_capacity(joints.len());
    for joint in joints {
        let above = above(joints, joint.parent).map(|at| (joints[at].freedom.angles(), gait[at].lags));
        let mut own = Axes::default();
        for axis in 0..joint.freedom.angles() {
            if axis > 0 && targets == Targets::Shared {
                (own.amplitudes[axis], own.lags[axis]) = (own.amplitudes[0], own.lags[0]);
                continue;
            }
            own.amplitudes[axis] = rng.random_range(rhythm.least_amplitude..=rhythm.largest_amplitude);
            let off = rng.random_range(-1.0..=1.0);
            own.lags[axis] = match above {
                Some((count, lags)) if axis < count => {
                    lags[axis] + rhythm.phase_lag + off * rhythm.phase_spread
                }
                _ => off * PI,
            };
        }
        gait.push(own);
    }
    gait
}

/// The joint that moves and is next to a part on its way to the root; `None` if all are fixed.
fn above(joints: &[Joint], part: usize) -> Option<usize> {
    // Joint j carries part j + 1.
    let at = part.checked_sub(1)?;
    if joints[at].freedom == Freedom::Fixed { above(joints, joints[at].parent) } else { Some(at) }
}

#[cfg(test)]
mod tests;
