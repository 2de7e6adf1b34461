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
    /// Pressures of these sensors at these samples. Those of a noisy sensor are smoothed, and 0 where they are within its noise. NaN where a
    /// value is missing.
    pub tactile: Tactile,
    /// The sensors that are kept: their numbers in the uncleaned recording, from 0, rising.
    pub sensors: Vec<usize>,
    /// The sensors that were left out, rising, and why.
    pub dropped: Vec<(usize, Fault)>,
    /// The samples that are kept: their numbers in the uncleaned recording, from 0, rising.
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

/// What a user says of a recording, in place of what the data tell.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Cleaning {
    /// Keep values at the end of a sensor's range, instead of taking them for saturated, and so for missing.
    pub keep_saturated: bool,
    /// Whether negative pressures are signal; if not, they count as 0.
    pub signed: Option<bool>,
}

impl Recording {
    /// Cleans a recording of M sensors as the data tell. It is [`Recording::cleaned`] with the default [`Cleaning`].
    pub fn new(tactile: Tactile) -> Self {
        Self::cleaned(tactile, Cleaning::default())
    }

    /// Cleans a recording of M sensors: drops samples at which most sensors have no value, then sensors that are dead, constant or
    /// mostly missing, and smooths the noisy ones of the others. It may drop all sensors. Infinite and saturated values count as missing.
    pub fn cleaned(mut tactile: Tactile, Cleaning { keep_saturated, signed }: Cleaning) -> Self {
        if signed == Some(false) {
            // A comparison with NaN is false, so that missing values stay missing.
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
mod tests;
