//! Test what becomes of sensors and samples.

use super::*;

#[test]
fn a_recording_knows_what_became_of_each_sensor_and_sample() {
    // Sensor 1 is dead, sensor 2 has a value at one sample only, and no sensor has one at sample 3.
    let nan = f32::NAN;
    let pressures = [
        [1.0, 0.0, 2.0, nan, 3.0],
        [0.0, 0.0, 0.0, nan, 0.0],
        [nan, nan, 2.0, nan, nan],
        [0.0, 5.0, 1.0, nan, 0.0],
    ];
    let recording = Recording::new(Tactile { samples: 5, pressures: pressures.concat() });
    assert_eq!((&recording.sensors[..], &recording.samples[..]), (&[0, 3][..], &[0, 1, 2, 4][..]));
    assert_eq!(recording.dropped, [(1, Fault::Dead), (2, Fault::MostlyMissing)]);
    assert_eq!((recording.lost_samples, recording.noisy, recording.signed), (1, 0, false));
    assert_eq!(recording.all_sensors(), 4);
    let truth = Truth::new(vec![7, 8, 8, 9], vec![(8, 7), (9, 8)]);
    assert_eq!(recording.truth(&truth), Truth { labels: vec![7, 9], ..truth });
}

#[test]
fn whether_negative_pressures_count_is_said_or_told_by_the_data() {
    // Of all, 0.4 % and 40 % are below 0.
    for (below, told) in [(-0.01, false), (-1.6, true)] {
        let pressures: Vec<f32> = (0..8).map(|t| if t % 2 == 0 { 2.4 } else { below }).collect();
        let tactile = Tactile { samples: 4, pressures };
        let of = |signed| Recording::cleaned(tactile.clone(), Cleaning { signed, ..Cleaning::default() });
        assert_eq!([None, Some(true), Some(false)].map(|signed| of(signed).signed), [told, true, false]);
        assert_eq!(of(Some(true)).tactile, tactile);
        assert!(of(Some(false)).tactile.pressures.iter().all(|pressure| *pressure >= 0.0));
    }
}
