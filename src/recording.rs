//! One's own recording: what sensors felt, cleaned, and what became of each sensor and each sample.
//!
//! In: [`Tactile`] pressures of all sensors, of any sign, NaN where there is no value
//! ([`read_touch`](crate::files::touch::read_touch) reads them). Out: a [`Recording`], which
//! [`estimate`](crate::estimate::estimate) takes; [`joints`](crate::stages::joints::joints) takes its pressures and known parts.

use crate::stages::noise::above_noise;
use crate::stages::rigid_parts::is_signed;
use crate::stages::sense::Tactile;
use crate::stages::tree::Truth;
use crate::stages::usable::{Fault, Missing, Usable, usable_with};

/// A recording of sensors that tell something, at samples at which they do.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    /// Pressures of these sensors at these samples; smoothed where a sensor has noise, with 0 where a pressure is within it. NaN where
    /// a value is missing.
    pub tactile: Tactile,
    /// The sensors, as they were counted before, rising.
    pub sensors: Vec<usize>,
    /// The sensors that were left out, rising, and why.
    pub dropped: Vec<(usize, Fault)>,
    /// The samples, as they were counted before, rising.
    pub samples: Vec<usize>,
    /// How many samples were left out, because most sensors have no value there.
    pub lost_samples: usize,
    /// Values that are missing, which are not interpolated.
    pub missing: Missing,
    /// How many sensors have noise.
    pub noisy: usize,
    /// Whether negative pressures are signal, not noise about 0. All stages go by it.
    pub signed: bool,
}

/// What a user may say of a recording, so that the data do not tell it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Cleaning {
    /// Whether values at the end of a sensor's range are no sign of saturation, and count.
    pub keep_saturated: bool,
    /// Whether negative pressures are signal; if not, they count as 0.
    pub signed: Option<bool>,
}

impl Recording {
    /// Cleans a recording of M sensors as the data tell. It is [`Recording::cleaned`] with nothing said.
    pub fn new(tactile: Tactile) -> Self {
        Self::cleaned(tactile, Cleaning::default())
    }

    /// Cleans a recording of M sensors: drops samples at which most sensors have no value, then sensors that are dead, constant or
    /// mostly missing, and smooths the noisy ones of the others. It may drop all. Infinite and saturated values count as missing.
    pub fn cleaned(mut tactile: Tactile, Cleaning { keep_saturated, signed }: Cleaning) -> Self {
        if signed == Some(false) {
            // NaN stays.
            let negative = tactile.pressures.iter_mut().filter(|pressure| **pressure < 0.0);
            negative.for_each(|pressure| *pressure = 0.0);
        }
        let Usable { tactile, sensors, dropped, lost_samples, samples, missing } =
            usable_with(tactile, keep_saturated);
        let (tactile, noisy) = above_noise(tactile);
        let signed = signed.unwrap_or_else(|| is_signed(&tactile));
        Self { tactile, sensors, dropped, samples, lost_samples, missing, noisy, signed }
    }

    /// How many sensors there were.
    pub fn all_sensors(&self) -> usize {
        self.sensors.len() + self.dropped.len()
    }

    /// What is known of each sensor that is left, of what is known of all.
    pub fn of_sensors<T: Clone>(&self, of_all: &[T]) -> Vec<T> {
        self.sensors.iter().map(|&sensor| of_all[sensor].clone()).collect()
    }

    /// The true parts of the sensors that are left, and the true tree.
    pub fn truth(&self, of_all: &Truth) -> Truth {
        Truth { labels: self.of_sensors(&of_all.labels), ..of_all.clone() }
    }
}

#[cfg(test)]
mod tests {
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
        assert_eq!(recording.dropped, [(1, Fault::Dead), (2, Fault::NotFinite)]);
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
}
