//! Swing the axes of all joints in a common rhythm, so that waves run through the body and it swims. The paper has no such movement.
//!
//! Axis i has the target q_i(t) = A_i sin(φ(t) − δ_i). One clock drives them all: dφ/dt = 2π f(t), where ln(f / f₀) is an
//! Ornstein–Uhlenbeck process that is drawn at the end of each epoch, and linear between. Amplitudes A_i and lags δ_i are drawn
//! once. The lag of an axis is that of the joint above plus about `phase_lag`; where no joint is above, it is random.

use std::f64::consts::{PI, TAU};

use rand::RngExt;
use rand_distr::StandardNormal;

use super::settings::{Rhythm, Targets};
use crate::numerics::rng::Stream;
use crate::stages::agent::{Freedom, Joint, Vector3};

/// The targets of all joints at a time of a rhythmic movement.
#[derive(Debug, Clone)]
pub(super) struct Oscillators {
    rhythm: Rhythm,
    /// Of each joint; 0 for axes that it does not have.
    axes: Vec<Axes>,
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

/// How the axes of a joint swing.
#[derive(Debug, Clone, Copy, Default)]
struct Axes {
    /// A_i, rad.
    amplitudes: Vector3,
    /// δ_i, rad.
    lags: Vector3,
}

impl Oscillators {
    /// Those of some joints in epochs of so many steps, of which each takes `step` s. Draws amplitude and lag of each axis, joint by
    /// joint, or of each joint where its axes share their targets; then the frequencies of the first epoch.
    pub(super) fn new(
        joints: &[Joint],
        rhythm: &Rhythm,
        targets: Targets,
        (epoch, step): (usize, f64),
        rng: &mut Stream,
    ) -> Self {
        let mut axes: Vec<Axes> = Vec::with_capacity(joints.len());
        for joint in joints {
            let above = above(joints, joint.parent).map(|at| (joints[at].freedom.angles(), axes[at].lags));
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
            axes.push(own);
        }
        let first = rhythm.frequency_spread * rng.sample::<f64, _>(StandardNormal);
        let mut own =
            Self { rhythm: rhythm.clone(), axes, phase: 0.0, deviations: [first; 2], epoch, passed: 0, step };
        own.begin_epoch(rng);
        own
    }

    /// Draws the frequency at the end of the epoch that begins.
    pub(super) fn begin_epoch(&mut self, rng: &mut Stream) {
        let Rhythm { frequency_spread, frequency_time, .. } = self.rhythm;
        let decay = self.epoch as f64 * self.step / frequency_time;
        let [_, now] = self.deviations;
        let news =
            frequency_spread * (-libm::expm1(-2.0 * decay)).sqrt() * rng.sample::<f64, _>(StandardNormal);
        self.deviations = [now, libm::exp(-decay) * now + news];
        self.passed = 0;
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
        let Axes { amplitudes, lags } = self.axes[joint];
        [0, 1, 2].map(|axis| amplitudes[axis] * libm::sin(self.phase - lags[axis]))
    }
}

/// The joint that moves and is next to a part on its way to the root; `None` if all are fixed.
fn above(joints: &[Joint], part: usize) -> Option<usize> {
    // Joint j carries part j + 1.
    let at = part.checked_sub(1)?;
    if joints[at].freedom == Freedom::Fixed { above(joints, joints[at].parent) } else { Some(at) }
}

#[cfg(test)]
mod tests;
