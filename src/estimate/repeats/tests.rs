use faer::Mat;

use super::*;
use crate::estimate::estimate;
use crate::numerics::rng::stream;
use crate::settings::{Base, Settings};

/// What 20 sensors on each of three parts feel. The last two move as one, but for the samples from 300 to 400 of 1,000.
fn moved_once() -> Recording {
    let mut rng = stream(1, 1, "moved once", 0);
    let mut uniform = |rows, columns| Mat::from_fn(rows, columns, |_, _| rng.random_range(-1.0_f64..1.0));
    let (motions, loadings) = ([0; 3].map(|_| uniform(1000, 5)), uniform(60, 5));
    let motion = |part: usize, t: usize| &motions[if (300..400).contains(&t) { part } else { part.min(1) }];
    let velocity = |sensor: usize, t: usize| {
        (0..5).map(|k| motion(sensor / 20, t)[(t, k)] * loadings[(sensor, k)]).sum::<f64>()
    };
    let places = (0..60).flat_map(|sensor| (0..1000).map(move |t| (sensor, t)));
    let pressures = places.map(|(sensor, t)| velocity(sensor, t).max(0.0).powi(2) as f32).collect();
    Recording::new(Tactile { samples: 1000, pressures })
}

#[test]
fn parts_that_moved_only_once_are_not_found_again_each_time() {
    let recording = moved_once();
    let levels = Settings::load_over(Some(Base::ESTIMATE), None).unwrap().quantise;
    let rng = &mut stream(1, 1, "moved once", 1);
    let found = estimate(&recording, &levels, &Parameters::default(), rng, &|| ()).unwrap();
    assert_eq!(found.joints.ranks.len(), 3);
    let again = repeats(&recording, &found, 8, &Parameters::default(), rng, &|| ());
    // The block in which they moved apart is drawn in two of three repeats.
    assert_eq!(again.parts[&0], 1.0);
    assert!((1..3).any(|part| (0.2..0.95).contains(&again.parts[&part])), "{again:?}");
    assert!(again.sensors[..20].iter().all(|share| *share == 1.0), "{again:?}");
    let mean = again.sensors[20..].iter().sum::<f64>() / 40.0;
    assert!((0.2..0.95).contains(&mean), "{mean}");
}

#[test]
fn parts_have_counterparts_by_their_sensors_whatever_they_are_called() {
    let other = [4, 4, 4, 0, 0, 0, 7, 0].map(Some).into_iter().chain([None; 5]).collect::<Vec<_>>();
    // Sensors that have no part there do not count.
    let same = Matching::new(&[0, 0, 0, 1, 1, 1, 2, 2, 0, 0, 0, 0, 3], &other);
    assert_eq!(same.to, [(0, 4), (1, 0), (2, 7)].into());
    // Part 2 has one of the two sensors of both in common: just half.
    assert_eq!(same.alike, [0, 1]);
    let joined = |child, parent| same.has_joint(&Edge { child: 0, parent: 1 }, &[Edge { child, parent }]);
    assert!(joined(4, 0) && joined(0, 4) && !joined(7, 0));
    assert!(!same.has_joint(&Edge { child: 2, parent: 1 }, &[Edge { child: 7, parent: 0 }]));
}

#[test]
fn times_at_which_nothing_is_felt_have_no_parts() {
    let silent = Tactile { samples: 200, pressures: vec![0.0; 20 * 200] };
    assert_eq!(found_again(silent, false, &Parameters::default()), (vec![None; 20], vec![]));
}

#[test]
fn times_are_drawn_in_blocks_for_all_sensors_alike() {
    let pressures = (0..2).flat_map(|sensor| (0..1000).map(move |t| (1000 * sensor + t) as f32)).collect();
    let tactile = Tactile { samples: 1000, pressures };
    let drawn = resampled(&tactile, &mut stream(1, 1, "repeats", 0));
    assert_eq!(drawn.samples, 1000);
    let series: Vec<&[f32]> = drawn.series().collect();
    assert!(series[0].iter().zip(series[1]).all(|(first, second)| second - first == 1000.0));
    let jumps = series[0].windows(2).filter(|pair| pair[1] - pair[0] != 1.0).count();
    assert!((1..10).contains(&jumps), "{jumps}");
    let mut times: Vec<f32> = series[0].to_vec();
    times.sort_by(f32::total_cmp);
    times.dedup();
    assert!(times.len() < 1000 && times.len().is_multiple_of(100), "{}", times.len());
}
