//! Measure whether a movement goes on to new states, or repeats itself.
//!
//! Where all joints keep step in one rhythm, each part's motion is a curve that is passed again and again, and the motions of all parts
//! span nearly the same functions of its phase. A model of rigid parts then fits well, and says nothing.

use faer::Mat;
use faer::linalg::matmul::matmul;
use faer::{Accum, Par};

use crate::stages::rigid_parts::{median, stratified};
use crate::stages::sense::Tactile;

/// Samples that are compared, spread over all.
const MAX_SAMPLES: usize = 1500;
/// Size below which a sample is left out, as a share of the median: at rest, all samples are alike.
const REST: f64 = 0.1;
/// Squared cosine from which on samples next to each other are of one state.
const SAME: f64 = 0.5;

/// The median, over samples, of the share of what is felt that the most similar sample leaves: 0 if every state comes again exactly, and 1
/// if none is like another. Samples just before and after, which are of the same state, do not count; speed does not count, either.
///
/// In: M × T pressures, and some of the sensors. 1 if nothing moves.
pub(super) fn novelty(tactile: &Tactile, sensors: &[usize]) -> f64 {
    let series: Vec<&[f32]> = tactile.series().collect();
    let root = |sensor: usize, t: usize| {
        let pressure = f64::from(series[sensor][t]);
        if pressure.is_nan() { 0.0 } else { pressure.signum() * pressure.abs().sqrt() }
    };
    let samples: Vec<usize> = stratified(tactile.samples, MAX_SAMPLES).collect();
    let size = |&t: &usize| sensors.iter().map(|&sensor| root(sensor, t).powi(2)).sum::<f64>().sqrt();
    let sizes: Vec<f64> = samples.iter().map(size).collect();
    let least = REST * median(sizes.clone());
    let moving: Vec<(usize, f64)> =
        samples.into_iter().zip(sizes).filter(|(_, size)| *size > least).collect();
    if moving.is_empty() {
        return 1.0;
    }
    let states = Mat::from_fn(sensors.len(), moving.len(), |at, sample| {
        let (t, size) = moving[sample];
        root(sensors[at], t) / size
    });
    let mut cosines = Mat::zeros(moving.len(), moving.len());
    matmul(cosines.as_mut(), Accum::Replace, states.transpose(), states.as_ref(), 1.0, Par::Seq);
    let left = |sample: usize| {
        let squares: Vec<f64> =
            (0..moving.len()).map(|other| cosines[(other, sample)] * cosines[(other, sample)]).collect();
        let before = squares[..sample].iter().rposition(|square| *square < SAME).map_or(0, |at| at + 1);
        let after =
            squares[sample..].iter().position(|square| *square < SAME).unwrap_or(squares.len() - sample);
        let others = squares[..before].iter().chain(&squares[sample + after..]);
        1.0 - others.fold(0.0, |most, square| f64::max(most, *square))
    };
    median((0..moving.len()).map(left).collect())
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use crate::numerics::rng::stream;

    /// What 30 sensors feel while their velocities are these functions of time, plus noise of this size.
    fn felt(noise: f64, velocity: impl Fn(usize, f64) -> f64) -> Tactile {
        let mut rng = stream(1, 1, "novelty", 0);
        let pressures = (0..30).flat_map(|sensor| {
            (0..2000)
                .map(|t| velocity(sensor, t as f64 / 10.0) + noise * rng.random_range(-1.0..1.0))
                .collect::<Vec<f64>>()
        });
        Tactile { samples: 2000, pressures: pressures.map(|v| v.max(0.0).powi(2) as f32).collect() }
    }

    fn of(tactile: &Tactile) -> f64 {
        novelty(tactile, &(0..30).collect::<Vec<usize>>())
    }

    #[test]
    fn a_rhythm_repeats_itself_at_any_speed() {
        let steady = felt(0.0, |sensor, t| (t - sensor as f64).sin());
        // Each period takes longer than the one before, and is slower.
        let slower = felt(0.0, |sensor, t| (20.0 * (1.0 + t).ln() - sensor as f64).sin() / (1.0 + t));
        assert!(of(&steady) < 1e-3 && of(&slower) < 1e-3, "{} {}", of(&steady), of(&slower));
    }

    #[test]
    fn movements_that_differ_are_new() {
        let several = felt(0.0, |sensor, t| {
            (0..6).map(|own| (t * (1.0 + own as f64).sqrt() + (own * sensor) as f64).sin()).sum()
        });
        let noisy = felt(0.2, |sensor, t| (t - sensor as f64).sin());
        assert!(of(&several) > 0.03 && of(&noisy) > 5e-3, "{} {}", of(&several), of(&noisy));
    }

    #[test]
    fn one_state_or_none_is_not_said_to_repeat() {
        assert_eq!(of(&felt(0.0, |sensor, _| sensor as f64)), 1.0);
        assert_eq!(of(&felt(0.0, |_, _| 0.0)), 1.0);
    }
}
