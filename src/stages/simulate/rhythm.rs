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
mod tests {
    use super::*;
    use crate::numerics::rng::stream;

    const RHYTHM: Rhythm = Rhythm {
        frequency: 0.2,
        frequency_spread: 0.3,
        frequency_time: 100.0,
        least_amplitude: 0.25,
        largest_amplitude: 0.75,
        phase_lag: 1.0,
        phase_spread: 0.5,
    };

    fn joint(parent: usize, child: usize, freedom: Freedom) -> Joint {
        Joint { parent, child, anchor: [0.0; 3], freedom }
    }

    fn drawn(joints: &[Joint], targets: Targets, rhythm: &Rhythm, seed: u64) -> Vec<Axes> {
        Oscillators::new(joints, rhythm, targets, (500, 0.01), &mut stream(seed, 1, "motion", 0)).axes
    }

    #[test]
    fn amplitudes_are_uniform_and_a_joint_lags_behind_the_one_above() {
        const UNIVERSAL: Freedom = Freedom::Universal([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0]]);
        // A chain with a part that is fixed, and a hinge that has no second axis to follow.
        let joints = [
            joint(0, 1, UNIVERSAL),
            joint(1, 2, Freedom::Fixed),
            joint(2, 3, UNIVERSAL),
            joint(0, 4, Freedom::Hinge([1.0, 0.0, 0.0])),
            joint(4, 5, UNIVERSAL),
        ];
        let (mut amplitudes, mut lags, mut alone) = (Vec::new(), Vec::new(), Vec::new());
        for seed in 0..400 {
            let axes = drawn(&joints, Targets::Each, &RHYTHM, seed);
            assert_eq!((axes[1].amplitudes, axes[3].amplitudes[1]), ([0.0; 3], 0.0), "no axes");
            amplitudes
                .extend(axes.iter().flat_map(|own| own.amplitudes).filter(|amplitude| *amplitude > 0.0));
            lags.extend([0, 1].map(|axis| axes[2].lags[axis] - axes[0].lags[axis]));
            lags.push(axes[4].lags[0] - axes[3].lags[0]);
            alone.extend([axes[0].lags[0], axes[0].lags[1], axes[3].lags[0], axes[4].lags[1]]);
            let shared = drawn(&joints, Targets::Shared, &RHYTHM, seed);
            assert!(shared.iter().all(|own| own.amplitudes[1] == 0.0 || own.lags[0] == own.lags[1]));
            assert_eq!(shared[2].amplitudes[0], shared[2].amplitudes[1]);
        }
        // Mean and extremes of a uniform distribution; means within four standard errors.
        for (values, low, high) in [(amplitudes, 0.25, 0.75), (lags, 0.5, 1.5), (alone, -PI, PI)] {
            let (n, width) = (values.len() as f64, high - low);
            let mean = values.iter().sum::<f64>() / n;
            assert!((mean - (low + high) / 2.0).abs() < 4.0 * width / (12.0 * n).sqrt(), "{mean}");
            let ends = values.iter().fold((f64::MAX, f64::MIN), |ends, &x| (ends.0.min(x), ends.1.max(x)));
            assert!(ends.0 >= low && ends.1 <= high, "{ends:?}");
            assert!(ends.0 < low + 0.02 * width && ends.1 > high - 0.02 * width, "{ends:?}");
        }
    }

    /// Standard deviation of ln(f / f₀), and its correlation after a time constant.
    fn wander(spread: f64, time: f64) -> (f64, f64) {
        let rhythm = Rhythm { frequency_spread: spread, frequency_time: time, ..RHYTHM };
        let rng = &mut stream(1, 1, "motion", 0);
        // An epoch of 20 s.
        let mut own = Oscillators::new(&[], &rhythm, Targets::Each, (2000, 0.01), rng);
        let mut values = Vec::new();
        for _ in 0..20_000 {
            own.begin_epoch(rng);
            // The middle of its first step is nearly its beginning.
            values.push((own.frequency() / rhythm.frequency).ln());
        }
        let product = |after: usize| {
            values.iter().zip(&values[after..]).map(|(a, b)| a * b).sum::<f64>() / values.len() as f64
        };
        (product(0).sqrt(), product(5) / product(0))
    }

    #[test]
    fn the_frequency_wanders_as_far_and_as_slowly_as_it_shall() {
        let (spread, kept) = wander(0.3, 100.0);
        assert!((spread - 0.3).abs() < 0.015 && (kept - (-1.0_f64).exp()).abs() < 0.06, "{spread} {kept}");
        // Broken twins: half as far, and twice as fast.
        assert!((wander(0.15, 100.0).0 - 0.3).abs() > 0.1);
        assert!((wander(0.3, 50.0).1 - (-1.0_f64).exp()).abs() > 0.15);
    }

    #[test]
    fn the_target_is_a_sinusoid_of_the_frequency() {
        let rhythm = Rhythm { frequency_spread: 0.0, ..RHYTHM };
        let joints = [joint(0, 1, Freedom::Hinge([1.0, 0.0, 0.0]))];
        let rng = &mut stream(1, 1, "motion", 0);
        let mut own = Oscillators::new(&joints, &rhythm, Targets::Each, (500, 0.01), rng);
        let Axes { amplitudes: [amplitude, ..], lags: [lag, ..] } = own.axes[0];
        for step in 1..=100_000 {
            if step % 500 == 0 {
                own.begin_epoch(rng);
            }
            own.advance();
            let right = amplitude * (TAU * 0.2 * f64::from(step) * 0.01 - lag).sin();
            assert!((own.target(0)[0] - right).abs() < 1e-9, "{step}");
        }
    }
}
