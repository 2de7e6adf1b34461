//! Test that the motions of given parts are recovered, those of the ends of a cylinder included.

use rand::RngExt;

use super::super::fixtures::{self, sensor_series};
use super::*;
use crate::numerics::rng::stream;

const SAMPLES: usize = 300;

/// Parts whose motions have these ranks, by 30 sensors each: their motions, and what is felt. A part of rank 0 feels nothing.
fn felt(ranks: &[usize]) -> (Vec<Vec<f64>>, Tactile, Vec<Option<usize>>) {
    let mut rng = stream(1, 1, "given", 0);
    let mut uniform =
        |count: usize| -> Vec<f64> { (0..count).map(|_| rng.random_range(-1.0..1.0)).collect() };
    let mut pressures = Vec::new();
    let motions: Vec<Vec<f64>> = ranks.iter().map(|k| uniform(SAMPLES * k)).collect();
    for (w, k) in motions.iter().zip(ranks) {
        for _ in 0..30 {
            if *k == 0 {
                pressures.extend([0.0; SAMPLES])
            } else {
                pressures.extend(sensor_series(w, &uniform(*k)))
            }
        }
    }
    let labels = (0..30 * ranks.len()).map(|sensor| Some(7 + sensor / 30)).collect();
    (motions, Tactile { samples: SAMPLES, pressures }, labels)
}

fn unexplained(w: &[f64], found: &MotionSubspace) -> f64 {
    fixtures::unexplained(w, (&found.basis, found.rank))
}

#[test]
fn motions_are_recovered_from_few_samples() {
    let ranks = [3, 5, 6];
    let (motions, tactile, labels) = felt(&ranks);
    let found = motions_of_parts(&tactile, false, &labels, None, &Parameters::default());
    assert_eq!(found.keys().copied().collect::<Vec<_>>(), [7, 8, 9]);
    for ((w, k), found) in motions.iter().zip(ranks).zip(found.values()) {
        let error = unexplained(w, found);
        // What completes so few samples may add a component, and a sensor that is like no other a face.
        assert!((k..=k + 3).contains(&found.rank) && error < 1e-3, "rank {} for {k}: {error}", found.rank);
    }
}

#[test]
fn a_lower_rank_is_not_the_whole_motion() {
    let (motions, tactile, labels) = felt(&[5, 5]);
    for (w, found) in motions
        .iter()
        .zip(motions_of_parts(&tactile, false, &labels, Some(3), &Parameters::default()).values())
    {
        assert!(found.rank == 3 && unexplained(w, found) > 0.1);
    }
}

#[test]
fn what_feels_nothing_has_no_motion() {
    let (motions, tactile, labels) = felt(&[4, 0, 3]);
    let found = motions_of_parts(&tactile, false, &labels, None, &Parameters::default());
    assert_eq!(found.values().map(|own| own.rank > 0).collect::<Vec<_>>(), [true, false, true]);
    assert!(unexplained(&motions[2], &found[&9]) < 1e-3);
    let still = Tactile { samples: 9, pressures: vec![0.0; 18] };
    assert!(
        motions_of_parts(&still, false, &[Some(0), Some(1)], None, &Parameters::default())
            .values()
            .all(|own| own.rank == 0)
    );
    // A single sensor that feels something at a single sample, and one that is left out.
    let mut once = still.clone();
    once.pressures[3] = 1.0;
    for rank in [None, Some(6)] {
        let found = motions_of_parts(&once, false, &[Some(0), None], rank, &Parameters::default());
        assert!(found.len() == 1 && found[&0].basis.iter().all(|value| value.is_finite()));
    }
}

/// Two cylinders: sides that feel four components, and ends that feel one more, from few sensors.
fn cylinders(unit: f32) -> (Vec<Vec<f64>>, Tactile, Vec<Option<usize>>) {
    let mut rng = stream(1, 1, "given", 1);
    let mut uniform =
        |count: usize| -> Vec<f64> { (0..count).map(|_| rng.random_range(-1.0..1.0)).collect() };
    let motions: Vec<Vec<f64>> = (0..2).map(|_| uniform(5 * SAMPLES)).collect();
    let mut pressures: Vec<f32> = Vec::new();
    for w in &motions {
        for at in 0..40 {
            let side = [uniform(4), vec![0.0]].concat();
            let c = if at < 36 { side } else { vec![0.0, 0.0, 0.0, 0.0, [1.0, -1.0][at % 2]] };
            pressures.extend(sensor_series(w, &c).map(|pressure| unit * pressure));
        }
    }
    (motions, Tactile { samples: SAMPLES, pressures }, (0..80).map(|sensor| Some(sensor / 40)).collect())
}

#[test]
fn the_ends_of_a_cylinder_complete_its_motion() {
    let (motions, tactile, labels) = cylinders(1.0);
    for rank in [None, Some(5)] {
        for (w, found) in motions
            .iter()
            .zip(motions_of_parts(&tactile, false, &labels, rank, &Parameters::default()).values())
        {
            assert!(unexplained(w, found) < 1e-3 && found.rank >= 5, "{}", unexplained(w, found));
        }
    }
}

#[test]
fn the_unit_of_pressure_changes_nothing() {
    let sizes = |unit: f32| {
        let (_, tactile, labels) = cylinders(unit);
        let found = motions_of_parts(&tactile, false, &labels, None, &Parameters::default());
        let size = |own: &MotionSubspace, at: usize| {
            own.basis.iter().skip(at).step_by(own.rank).map(|w| w * w).sum::<f64>() / SAMPLES as f64
        };
        found
            .values()
            .flat_map(|own| (0..own.rank).map(|at| size(own, at)).collect::<Vec<_>>())
            .collect::<Vec<f64>>()
    };
    let (one, other) = (sizes(1.0), sizes(1e6));
    assert_eq!(one.len(), other.len());
    assert!(one.iter().zip(&other).all(|(one, other)| (one / other - 1.0).abs() < 1e-3), "{one:?} {other:?}");
    assert!(one.iter().all(|size| (0.3..3.0).contains(size)), "{one:?}");
}
