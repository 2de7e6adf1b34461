//! Test what counts as noise, and what is left of touch.

use rand::Rng;
use rand_distr::{Distribution, StandardNormal};

use super::*;
use crate::numerics::rng::stream;

/// What a sensor feels that is pushed for a short time now and then.
fn touch() -> Vec<f32> {
    (0..10_000).map(|t| 50.0 * (0.02 * f64::from(t)).sin().max(0.0).powi(12) as f32).collect()
}

fn noisy(series: &[f32], deviation: f32, rng: &mut impl Rng) -> Vec<f32> {
    let mut error = || -> f32 { StandardNormal.sample(rng) };
    series.iter().map(|pressure| pressure + deviation * error()).collect()
}

#[test]
fn noise_is_found_whatever_its_size_and_whether_or_not_negative_values_are_cut() {
    let rng = &mut stream(1, 1, "noise", 0);
    // Smaller noise is found, too, but is taken for larger: second differences of touch come near it.
    for deviation in [0.1, 0.3, 1.0] {
        let signed = noisy(&touch(), deviation, rng);
        let positive: Vec<f32> = signed.iter().map(|pressure| pressure.max(0.0)).collect();
        for series in [signed, positive] {
            let found = size(&series).unwrap() / deviation;
            assert!((1.0..2.0).contains(&found), "{deviation}: {found}");
        }
    }
}

#[test]
fn touch_without_noise_stays_as_it_is() {
    assert_eq!(size(&touch()), None);
    let on_and_off: Vec<f32> = touch().iter().map(|pressure| f32::from(*pressure > 10.0)).collect();
    assert_eq!(size(&on_and_off), None);
    // A joint that rings at a limit from step to step, now and then: differences of one size.
    let ringing: Vec<f32> =
        (0..3000).map(|t: u16| f32::from(t % 1000 < 400) * (10.0 + f32::from(t % 2))).collect();
    assert_eq!(size(&ringing), None);
    // Always: even then each difference is known from the last.
    let ringing: Vec<f32> = (0..3000).map(|t: u16| 10.0 + f32::from(t % 2)).collect();
    assert_eq!(size(&ringing), None);
    for few in [vec![], vec![1.0], vec![1.0, 2.0], vec![1.0, 2.0, 4.0], vec![3.0; 100]] {
        let tactile = Tactile { samples: few.len().max(1), pressures: few };
        assert_eq!(above_noise(tactile.clone()), (tactile, 0));
    }
}

#[test]
fn what_sensors_share_is_movement() {
    let rng = &mut stream(3, 1, "noise", 0);
    // Two sensors of one part that jitters: the same errors, of other sizes.
    let (one, other) = (noisy(&touch(), 0.5, rng), noisy(&touch(), 0.5, rng));
    let shared: Vec<f32> = one.iter().zip(touch()).map(|(one, touch)| 2.0 * one - touch).collect();
    let noise = |series: &[&[f32]]| above_noise(Tactile { samples: one.len(), pressures: series.concat() }).1;
    assert_eq!(noise(&[&one, &other]), 2);
    assert_eq!(noise(&[&one, &shared]), 0);
    assert_eq!(noise(&[&one, &shared, &other]), 1);
}

#[test]
fn what_is_left_is_touch() {
    let (touch, rng) = (touch(), &mut stream(2, 1, "noise", 0));
    let pressures = [noisy(&touch, 0.5, rng), touch.clone()].concat();
    let (left, count) = above_noise(Tactile { samples: touch.len(), pressures });
    assert_eq!(count, 1);
    let false_touch =
        left.pressures.iter().zip(&touch).filter(|(left, true_touch)| **left != 0.0 && **true_touch < 0.01);
    assert!(false_touch.count() < 10);
    assert_eq!(left.pressures[touch.len()..], touch);
}
