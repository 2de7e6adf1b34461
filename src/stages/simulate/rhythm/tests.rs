use super::*;
use crate::numerics::rng::stream;

const RHYTHM: Rhythm = Rhythm {
    frequency: 0.2,
    frequency_spread: 0.3,
    frequency_time: 100.0,
    gait_time: 0.0,
    least_amplitude: 0.25,
    largest_amplitude: 0.75,
    phase_lag: 1.0,
    phase_spread: 0.5,
};

fn joint(parent: usize, child: usize, freedom: Freedom) -> Joint {
    Joint { parent, child, anchor: [0.0; 3], freedom }
}

fn drawn(joints: &[Joint], targets: Targets, rhythm: &Rhythm, seed: u64) -> Vec<Axes> {
    Oscillators::new(joints, rhythm, targets, (500, 0.01), &mut stream(seed, 1, "motion", 0)).gaits[0].clone()
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
        amplitudes.extend(axes.iter().flat_map(|own| own.amplitudes).filter(|amplitude| *amplitude > 0.0));
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
    let Axes { amplitudes: [amplitude, ..], lags: [lag, ..] } = own.gaits[0][0];
    for step in 1..=100_000 {
        if step % 500 == 0 {
            own.begin_epoch(rng);
        }
        own.advance();
        let right = amplitude * (TAU * 0.2 * f64::from(step) * 0.01 - lag).sin();
        assert!((own.target(0)[0] - right).abs() < 1e-9, "{step}");
    }
}

#[test]
fn amplitudes_and_lags_go_smoothly_from_gait_to_gait() {
    // Four epochs of 5 s lead from one gait to the next.
    let rhythm = Rhythm { gait_time: 20.0, ..RHYTHM };
    let joints = [joint(0, 1, Freedom::Hinge([1.0, 0.0, 0.0]))];
    let rng = &mut stream(1, 1, "motion", 0);
    let mut own = Oscillators::new(&joints, &rhythm, Targets::Each, (500, 0.01), rng);
    let of = |gait: &Gait| (gait[0].amplitudes[0], gait[0].lags[0]);
    let mut reached = vec![of(&own.gaits[0])];
    let mut last = own.target(0)[0];
    for step in 1..=20_000 {
        own.advance();
        let (phase, [from, to]) = (own.phase, own.gaits.clone().map(|gait| of(&gait)));
        let share = f64::from((step - 1) % 2000 + 1) / 2000.0;
        let (amplitude, lag) = (from.0 + share * (to.0 - from.0), from.1 + share * (to.1 - from.1));
        let target = own.target(0)[0];
        assert!((target - amplitude * (phase - lag).sin()).abs() < 1e-9, "{step}");
        // At most an amplitude of 0.75 at some 0.6 Hz, with lags that change by less than 2π in 20 s.
        assert!((target - last).abs() < 0.75 * (TAU * 0.6 + TAU / 20.0) * 0.01 + 0.001, "{step}");
        last = target;
        if step % 500 == 0 {
            own.begin_epoch(rng);
        }
        if step % 2000 == 0 {
            assert_eq!(of(&own.gaits[0]), to, "the gait that was reached");
            reached.push(to);
        }
    }
    let amplitudes: Vec<f64> = reached.iter().map(|gait| gait.0).collect();
    assert_eq!(reached.len(), 11);
    assert!(amplitudes.iter().all(|amplitude| (0.25..=0.75).contains(amplitude)));
    assert!(amplitudes.windows(2).all(|pair| (pair[0] - pair[1]).abs() > 1e-3), "{amplitudes:?}");
    // With 0 the gait never changes, and nothing more is drawn.
    let mut steady = Oscillators::new(&joints, &RHYTHM, Targets::Each, (500, 0.01), rng);
    let before = of(&steady.gaits[0]);
    (0..10).for_each(|_| steady.begin_epoch(rng));
    assert_eq!(steady.gaits.map(|gait| of(&gait)), [before; 2]);
}
