use super::*;

#[test]
fn sensors_that_tell_nothing_are_left_out_with_their_reason() {
    let pressures =
        vec![1.0, 2.0, f32::NAN, 3.0, 0.0, 0.0, 7.0, 7.0, 0.0, -1.0, f32::INFINITY, f32::INFINITY];
    let found = usable(Tactile { samples: 2, pressures });
    assert_eq!(found.missing, Missing { infinite: 2, ..Missing::default() });
    assert_eq!(found.sensors, [0, 4]);
    assert_eq!(found.tactile.pressures, [1.0, 2.0, 0.0, -1.0]);
    let dropped =
        [(1, Fault::MostlyMissing), (2, Fault::Dead), (3, Fault::Constant), (5, Fault::MostlyMissing)];
    assert_eq!(found.dropped, dropped);
}

#[test]
fn a_lost_frame_costs_a_sample_and_no_sensor() {
    let nan = f32::NAN;
    let pressures = vec![1.0, nan, 2.0, 3.0, 4.0, nan, 5.0, 6.0, nan, 1.0, 2.0, 3.0];
    let found = usable(Tactile { samples: 4, pressures });
    assert_eq!((found.lost_samples, found.tactile.samples, found.samples), (1, 3, vec![0, 2, 3]));
    assert_eq!((found.sensors, found.missing.values), (vec![0, 1, 2], 1));
    assert_eq!(found.tactile.pressures[..6], [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    assert!(found.tactile.pressures[6].is_nan() && found.dropped.is_empty());
}

#[test]
fn broken_sensors_cost_no_sample() {
    let nan = f32::NAN;
    // Two that work but for one frame each, and three that soon break.
    let mut pressures = vec![1.0, 2.0, nan, 4.0, 5.0, 6.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
    (0..3).for_each(|_| pressures.extend([1.0, nan, nan, nan, nan, nan]));
    let found = usable(Tactile { samples: 6, pressures });
    assert_eq!((found.lost_samples, found.sensors), (0, vec![0, 1]));
    assert_eq!(found.dropped, [2, 3, 4].map(|sensor| (sensor, Fault::MostlyMissing)));
}

#[test]
fn a_sensor_may_lack_two_of_five_values() {
    let nan = f32::NAN;
    let pressures = vec![1.0, nan, 2.0, nan, 4.0, nan, nan, 1.0, nan, 2.0, 1.0, 2.0, 3.0, 4.0, 5.0];
    let found = usable(Tactile { samples: 5, pressures });
    assert_eq!((found.sensors, found.missing.values), (vec![0, 2], 2));
    assert_eq!((found.dropped, found.lost_samples), (vec![(1, Fault::MostlyMissing)], 0));
}

#[test]
fn saturated_values_are_counted_unless_they_are_kept() {
    let touch = |t: u16| (3.0 * (0.05 * f32::from(t)).sin()).clamp(0.0, 2.0);
    let pressures = (0..400).map(touch).chain((0..400_u16).map(f32::from)).collect();
    let tactile = Tactile { samples: 400, pressures };
    let found = usable(tactile.clone());
    assert!(found.missing.saturated > 100 && found.missing.saturated == found.missing.values);
    assert_eq!(found.missing.saturated_sensors, 1);
    let kept = usable_with(tactile.clone(), true);
    assert_eq!((kept.tactile, kept.missing), (tactile, Missing::default()));
}

#[test]
fn a_slow_skin_in_a_fast_log_costs_no_sensor() {
    let nan = f32::NAN;
    let slow = [1.0, nan, 2.0, nan, 3.0, nan];
    // A counter has a number in each frame.
    for (counters, sensors) in [(0, vec![0, 1, 2]), (1, vec![0, 1, 2, 3])] {
        let mut pressures = [slow; 3].concat();
        (0..counters).for_each(|_| pressures.extend([1.0, 2.0, 3.0, 4.0, 5.0, 6.0]));
        let found = usable(Tactile { samples: 6, pressures });
        assert_eq!((found.samples, found.sensors), (vec![0, 2, 4], sensors));
    }
}
