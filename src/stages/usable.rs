//! Count what is missing, and drop samples at which most sensors are missing, and sensors that are mostly missing, dead or constant.
//!
//! In: [`Tactile`] pressures as a robot has them. Out: [`Usable`] pressures, and why each other sensor was left out. A value that is
//! infinite or saturated is missing. What is missing of the other sensors stays missing: NaN. It is not interpolated.

mod saturation;

use std::fmt::{self, Display, Formatter};

use rayon::prelude::*;

use self::saturation::without_saturated;
use crate::stages::sense::Tactile;

/// Largest share of its values that a sensor may lack.
const MOST_MISSING: f64 = 0.4;

/// Why a sensor is dropped.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fault {
    /// Too many of its values are missing.
    MostlyMissing,
    /// It is 0 throughout.
    Dead,
    /// It has one value throughout, which is not 0.
    Constant,
}

impl Display for Fault {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::MostlyMissing => "missing",
            Self::Dead => "dead",
            Self::Constant => "constant",
        })
    }
}

/// Values that are missing.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Missing {
    /// Of the sensors and samples that are used.
    pub values: usize,
    /// Infinite values of the whole recording.
    pub infinite: usize,
    /// Saturated values of the whole recording.
    pub saturated: usize,
    /// Sensors that have any saturated value.
    pub saturated_sensors: usize,
}

/// A recording of sensors that tell something, and what was dropped.
#[derive(Debug, Clone, PartialEq)]
pub struct Usable {
    /// Pressures of the kept sensors at the kept samples, NaN where one is missing.
    pub tactile: Tactile,
    /// The kept sensors, rising.
    pub sensors: Vec<usize>,
    /// The dropped sensors, rising, and why.
    pub dropped: Vec<(usize, Fault)>,
    /// Samples that were left out, because more than half of the sensors have no number there.
    pub lost_samples: usize,
    /// The kept samples, rising.
    pub samples: Vec<usize>,
    /// What is missing.
    pub missing: Missing,
}

/// Drops samples at which most sensors are missing, and then sensors that are mostly missing, dead or constant.
pub fn usable(tactile: Tactile) -> Usable {
    usable_with(tactile, false)
}

/// The same, where values at the end of a sensor's range count if they are to be kept.
pub fn usable_with(mut tactile: Tactile, keeps_saturated: bool) -> Usable {
    let infinite = without_infinite(&mut tactile);
    let saturated = if keeps_saturated { Vec::new() } else { without_saturated(&mut tactile) };
    let all = tactile.samples;
    let (tactile, samples) = without_lost_samples(tactile);
    let lost_samples = all - samples.len();
    let of_sensors: Vec<(usize, Option<Fault>)> =
        tactile.pressures.par_chunks_exact(tactile.samples).map(gaps_and_fault).collect();
    let faults = || of_sensors.iter().map(|(_, fault)| *fault).enumerate();
    let dropped = faults().filter_map(|(sensor, fault)| Some((sensor, fault?))).collect();
    let sensors: Vec<usize> =
        faults().filter(|(_, fault)| fault.is_none()).map(|(sensor, _)| sensor).collect();
    let missing = Missing {
        values: sensors.iter().map(|&sensor| of_sensors[sensor].0).sum(),
        infinite,
        saturated: saturated.iter().sum(),
        saturated_sensors: saturated.iter().filter(|count| **count > 0).count(),
    };
    Usable { tactile: only(tactile, &sensors), sensors, dropped, lost_samples, samples, missing }
}

/// Replaces infinite values by NaN; how many they are.
fn without_infinite(tactile: &mut Tactile) -> usize {
    let samples = tactile.samples;
    let own = |series: &mut [f32]| {
        let infinite = series.iter_mut().filter(|pressure| pressure.is_infinite());
        infinite.map(|pressure| *pressure = f32::NAN).count()
    };
    tactile.pressures.par_chunks_exact_mut(samples).map(own).sum()
}

/// How many values of a sensor are missing, and what is the matter with it.
fn gaps_and_fault(series: &[f32]) -> (usize, Option<Fault>) {
    let gaps = gaps(series);
    let known = || series.iter().filter(|pressure| !pressure.is_nan());
    let fault = if is_missing(gaps, series.len()) {
        Some(Fault::MostlyMissing)
    } else if known().all(|pressure| *pressure == 0.0) {
        Some(Fault::Dead)
    } else {
        let first = known().next();
        known().all(|pressure| Some(pressure) == first).then_some(Fault::Constant)
    };
    (gaps, fault)
}

fn gaps(series: &[f32]) -> usize {
    series.iter().filter(|pressure| pressure.is_nan()).count()
}

/// Whether a sensor with so many gaps tells too little.
fn is_missing(gaps: usize, samples: usize) -> bool {
    gaps as f64 > MOST_MISSING * samples as f64
}

/// The pressures without samples at which more than half of the sensors are missing, such as a lost frame, and the samples that are
/// kept. Sensors that are missing in at least half of the samples are ignored in this count if that keeps more values: broken
/// sensors should not cost samples, and a slow skin, which is missing in most frames of a log, should not cost sensors. If no sample
/// would be kept, none is dropped.
fn without_lost_samples(mut tactile: Tactile) -> (Tactile, Vec<usize>) {
    let (samples, sensors) = (tactile.samples, tactile.sensors());
    let gaps: Vec<usize> = tactile.pressures.par_chunks_exact(samples).map(gaps).collect();
    let mut kept = samples_with_quorum(&tactile, &gaps, samples);
    let half = samples.div_ceil(2) - 1;
    if gaps.iter().any(|gaps| *gaps > half) {
        let other = samples_with_quorum(&tactile, &gaps, half);
        if usable_values(&tactile, &other) > usable_values(&tactile, &kept) {
            kept = other;
        }
    }
    if kept.is_empty() || kept.len() == samples {
        return (tactile, (0..samples).collect());
    }
    let mut to = 0;
    for sensor in 0..sensors {
        for t in &kept {
            tactile.pressures[to] = tactile.pressures[sensor * samples + t];
            to += 1;
        }
    }
    tactile.pressures.truncate(to);
    tactile.samples = kept.len();
    (tactile, kept)
}

/// The samples at which at least half of the sensors with no more than `most` gaps have a value; `gaps` says how many each has.
fn samples_with_quorum(tactile: &Tactile, gaps: &[usize], most: usize) -> Vec<usize> {
    let mut missing = vec![0; tactile.samples];
    for (series, _) in tactile.series().zip(gaps).filter(|(_, gaps)| (1..=most).contains(*gaps)) {
        missing
            .iter_mut()
            .zip(series)
            .for_each(|(missing, pressure)| *missing += usize::from(pressure.is_nan()));
    }
    let sensors = gaps.iter().filter(|gaps| **gaps <= most).count();
    (0..tactile.samples).filter(|t| 2 * missing[*t] <= sensors).collect()
}

/// Samples times the sensors that are not mostly missing at these.
fn usable_values(tactile: &Tactile, samples: &[usize]) -> usize {
    let gaps = |series: &[f32]| samples.iter().filter(|t| series[**t].is_nan()).count();
    samples.len() * tactile.series().filter(|series| !is_missing(gaps(series), samples.len())).count()
}

/// The pressures of some sensors, which rise. Nothing is copied to another place of the memory: it may be most of what there is.
pub fn only(mut tactile: Tactile, sensors: &[usize]) -> Tactile {
    let samples = tactile.samples;
    for (at, sensor) in sensors.iter().enumerate().filter(|(at, sensor)| at != *sensor) {
        tactile.pressures.copy_within(sensor * samples..(sensor + 1) * samples, at * samples);
    }
    tactile.pressures.truncate(sensors.len() * samples);
    tactile
}

#[cfg(test)]
mod tests;
