//! Test which columns are clocks, and what they tell.

use super::*;

fn even(first: f64, step: f64) -> Vec<f64> {
    (0..200).map(|t| first + step * f64::from(t)).collect()
}

fn interval(name: Option<&str>, values: &[f64]) -> Option<f64> {
    Clock::of(name, values, false).and_then(|clock| clock.interval)
}

#[test]
fn times_are_told_by_their_names() {
    let rough: Vec<f64> = (0..20).map(|t| f64::from(t * t)).collect();
    for name in
        ["time", "%time", "Time [ms]", "field.header.stamp", "time_s", "t (s)", "__time", "Zeit", "nanosec"]
    {
        assert_eq!(Clock::of(Some(name), &rough, false).map(|clock| clock.mark), Some(Mark::Name), "{name}");
    }
    for name in ["s", "left_0", "sensor", "timer_pad", "t", "", "pressure [Pa]", "ms", "seq"] {
        assert_eq!(Clock::of(Some(name), &rough, false), None, "{name}");
    }
    assert!((interval(Some("time [ms]"), &even(5.0, 20.0)).unwrap() - 0.02).abs() < 1e-12);
    assert!((interval(Some("%time"), &even(1.7e18, 1e8)).unwrap() - 0.1).abs() < 1e-6);
    // Text, or nothing.
    assert_eq!(
        Clock::of(Some("date"), &[f64::NAN; 3], false),
        Some(Clock { mark: Mark::Name, interval: None })
    );
}

#[test]
fn even_steps_tell_a_clock_without_a_name() {
    assert_eq!(interval(None, &even(1.7e9, 0.125)), Some(0.125));
    assert_eq!(Clock::of(None, &even(3.0, 1.0), false), Some(Clock { mark: Mark::Counts, interval: None }));
    // A clock that jitters, lost some frames, and begins again.
    let mut values: Vec<f64> =
        even(0.0, 0.1).iter().enumerate().map(|(t, value)| value + 0.002 * (t as f64).sin()).collect();
    values[50..].iter_mut().for_each(|value| *value += 0.3);
    values[120..].iter_mut().for_each(|value| *value -= 12.0);
    assert!((interval(None, &values).unwrap() - 0.1).abs() < 0.003);
}

#[test]
fn an_interval_has_the_digits_that_the_times_support() {
    for (first, step, expected) in [
        (0.0, 0.1, 0.1),
        (-3.7, 0.01, 0.01),
        (0.0, 0.016_667, 0.016_667),
        // Since 1970 a time has fewer digits after the point.
        (1.7e9, 0.1, 0.1),
        (1.7e9, 1.0 / 60.0, 0.016_667),
        (1.7e18, 16_666_667.0, 0.016_667),
        (1.7e12, 33.0, 0.033),
        // Exact ones stay.
        (0.0, 64.0 + 1.0 / 64.0, 64.015_625),
    ] {
        assert_eq!(interval(Some("time"), &even(first, step)), Some(expected));
    }
    let single: Vec<f64> = even(0.0, 0.1).into_iter().map(|time| f64::from(time as f32)).collect();
    assert_eq!(Clock::of(None, &single, true).unwrap().interval, Some(0.1));
    assert_ne!(Clock::of(None, &single, false).unwrap().interval, Some(0.1));
}

#[test]
fn what_may_be_a_sensor_is_no_clock() {
    let speeds: Vec<f64> = (0..200).map(|t| (0.03 * f64::from(t)).sin().max(0.0).powi(2)).collect();
    let rising: Vec<f64> = (0..200).map(|t| (0.01 * f64::from(t)).exp()).collect();
    let few = even(0.0, 0.1)[..MIN_VALUES - 1].to_vec();
    for values in [speeds, rising, few, vec![2.0; 100], vec![f64::NAN; 100], Vec::new(), vec![1.0]] {
        assert_eq!(Clock::of(None, &values, false), None, "{values:?}");
    }
    assert!(may_rise(&even(0.0, 1.0)) && !may_rise(&[0.0; 60]) && may_rise(&[1.0]));
}
