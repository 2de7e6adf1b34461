//! Test the verdict, and what sensors that rest a little below 0 give.

use std::collections::BTreeMap;

use rand::RngExt;

use super::*;
use crate::numerics::rng::stream;
use crate::settings::{Base, Settings};

fn levels() -> Quantise {
    Settings::load_over(Some(Base::ESTIMATE), None).unwrap().quantise
}

/// Two parts of 16 sensors, which do not explain the last ones, so many.
fn two_halves(unexplained: usize) -> RigidParts {
    RigidParts {
        labels: (0..32).map(|sensor| sensor / 16).collect(),
        residuals: (0..32).map(|at| if at + unexplained < 32 { 0.0 } else { 0.06 }).collect(),
        alternatives: vec![Vec::new(); 32],
        unassigned: Vec::new(),
        motions: BTreeMap::new(),
    }
}

/// What these sensors feel at so many samples, beyond what they read at rest.
fn felt(rest: f32, samples: usize) -> Recording {
    let pressures = (0..32 * samples).map(|at| rest + (at % 7) as f32).collect();
    Recording::new(Tactile { samples, pressures })
}

/// The verdict on a recording of these sensors, if all are explained.
fn judged(recording: &Recording, novelty: f64) -> Fit {
    Fit::new(1.0, &[], recording, novelty, novelty < SIMILAR)
}

#[test]
fn whatever_is_explained_a_short_recording_is_doubtful_and_one_that_repeats_or_has_an_offset_does_not_fit() {
    let with_rest = |rest: f32, samples: usize, novelty: f64| judged(&felt(rest, samples), novelty);
    let fit = |samples: usize, novelty: f64| with_rest(0.0, samples, novelty);
    assert_eq!(fit(SHORT, 0.1).verdict, Verdict::Good);
    assert_eq!((fit(SHORT, 1e-4).verdict, fit(SHORT, 1e-4).cause), (Verdict::DoesNotFit, Some(REPETITION)));
    let similar = fit(SHORT, 0.01);
    assert_eq!((similar.verdict, similar.cause), (Verdict::Doubtful, Some(SIMILARITY)));
    // A loop of many motions, as a walk that was recorded once and repeated.
    let looped = Fit::new(1.0, &[], &felt(0.0, SHORT), 1e-4, false);
    assert_eq!((looped.verdict, looped.cause), (Verdict::Doubtful, Some(LOOPED)));
    let short = fit(SHORT - 1, 0.1);
    assert_eq!((short.verdict, short.explained), (Verdict::Doubtful, 1.0));
    assert!(short.cause.is_some());
    // Readings at rest are above 0, however little.
    for novelty in [0.1, 1e-4] {
        let offset = with_rest(0.01, SHORT, novelty);
        assert_eq!((offset.verdict, offset.cause), (Verdict::DoesNotFit, Some(OFFSET)));
    }
}

#[test]
fn the_fewer_sensors_are_explained_the_worse_is_the_verdict() {
    let recording = felt(0.0, SHORT);
    let verdict = |unexplained: usize| {
        let share = explained(&two_halves(unexplained), &recording);
        Fit::new(share, &[], &recording, 0.5, false).verdict
    };
    // 91 %, 88 % and 78 % of 32 sensors.
    let found = [3, 4, 7].map(verdict);
    assert_eq!(found, [Verdict::Good, Verdict::Doubtful, Verdict::DoesNotFit]);
}

#[test]
fn one_part_and_a_part_of_few_sensors_are_doubtful() {
    let fit = |doubt: &Doubt, samples: usize| {
        let fit = Fit::new(1.0, std::slice::from_ref(doubt), &felt(0.0, samples), 0.5, false);
        (fit.verdict, fit.cause)
    };
    let small = Doubt::SmallParts { part: 0, sensors: 15, count: 1 };
    assert_eq!(fit(&Doubt::OnePart(0.0), SHORT), (Verdict::Doubtful, Some(ONE_PART)));
    assert_eq!(fit(&small, SHORT), (Verdict::Doubtful, Some(SMALL_PART)));
    // Other doubts are of joints and sensors, and say nothing of the fit.
    assert_eq!(fit(&Doubt::OnlyByJoints(3), SHORT), (Verdict::Good, None));
    // That a recording is short may be why there is a small part.
    let short = fit(&small, SHORT - 1);
    assert!(short.0 == Verdict::Doubtful && short.1 != Some(SMALL_PART), "{short:?}");
    // Where it does not fit, nothing else counts.
    let offset = Fit::new(1.0, &[Doubt::OnePart(0.0)], &felt(0.01, SHORT), 0.5, false);
    assert_eq!((offset.verdict, offset.cause), (Verdict::DoesNotFit, Some(OFFSET)));
}

#[test]
fn where_few_sensors_feel_something_at_a_time_it_does_not_fit_unless_noise_tells_no_more() {
    // One sensor after the other, or every other one.
    let touched = |apart: usize, levels: usize| {
        let pressure = |at: usize| {
            let (sensor, t) = (at / SHORT, at % SHORT);
            if (t + sensor).is_multiple_of(apart) { 1.0 + (t % levels) as f32 } else { 0.0 }
        };
        Recording::new(Tactile { samples: SHORT, pressures: (0..32 * SHORT).map(pressure).collect() })
    };
    let verdict = |recording: &Recording| (judged(recording, 0.5).verdict, judged(recording, 0.5).cause);
    assert_eq!(verdict(&touched(2, 97)), (Verdict::Good, None));
    assert_eq!(verdict(&touched(12, 97)), (Verdict::DoesNotFit, Some(STROKES)));
    let pads = verdict(&touched(12, 1));
    assert!(
        pads.0 == Verdict::DoesNotFit && pads.1.unwrap().starts_with("most sensors have a few levels only"),
        "{pads:?}"
    );
    assert_eq!(verdict(&Recording { noisy: 32, ..touched(12, 97) }), (Verdict::Good, None));
}

/// What two parts of 20 sensors feel that move independently, with three numbers of motion each.
fn two_parts() -> Recording {
    let mut rng = stream(1, 1, "parameters", 0);
    let mut uniform = |count: usize| (0..count).map(|_| rng.random_range(-1.0..1.0)).collect::<Vec<f32>>();
    let (samples, motions, loadings) = (300, uniform(2 * 3 * 300), uniform(40 * 3));
    let pressure = |sensor: usize, t: usize| {
        let w = &motions[3 * (samples * (sensor / 20) + t)..][..3];
        let speed: f32 = w.iter().zip(&loadings[3 * sensor..]).map(|(w, c)| w * c).sum();
        speed.max(0.0).powi(2)
    };
    let pressures = (0..40).flat_map(|sensor| (0..samples).map(move |t| (sensor, t)));
    Recording::new(Tactile { samples, pressures: pressures.map(|(sensor, t)| pressure(sensor, t)).collect() })
}

#[test]
fn every_parameter_at_the_ends_of_its_range_gives_an_estimate() {
    let (recording, levels) = (two_parts(), levels());
    let found = |parameters: &Parameters| {
        let rng = &mut stream(1, 1, "co-motion", 0);
        estimate(&recording, &levels, parameters, rng, &|| ()).unwrap().parts.labels
    };
    let truth: Vec<usize> = (0..40).map(|sensor| sensor / 20).collect();
    assert_eq!(found(&Parameters::default()), truth);
    for (name, value) in Parameters::NAMES.iter().zip(Parameters::default().values()) {
        // A whole number is 1 at least, and tolerances must rise.
        let ends = [value / 100.0, f64::max(1.0, value / 100.0), value * 100.0];
        for parameters in ends.into_iter().filter_map(|end| Parameters::changed([(*name, end)]).ok()) {
            assert_eq!(found(&parameters).len(), 40, "{name}");
        }
    }
}

#[test]
fn sensors_that_rest_a_little_below_0_feel_nothing_there() {
    let samples = 400;
    let touch = |sensor: usize, t: usize| match t % 10 {
        0 => 2000.0 * (1.0 + ((7 * t + 13 * sensor) % 29) as f32 / 29.0),
        _ => -1.0 - t as f32 / samples as f32,
    };
    let pressures = (0..24).flat_map(|sensor| (0..samples).map(move |t| touch(sensor, t))).collect();
    let recording = Recording::new(Tactile { samples, pressures });
    assert!(!recording.signed);
    let rng = &mut stream(1, 1, "co-motion", 0);
    let found = estimate(&recording, &levels(), &Parameters::default(), rng, &|| ()).unwrap();
    assert!(found.parts.residuals.iter().all(|residual| residual.is_finite()));
}
