//! Drop samples at which most sensors are missing, and sensors that are missing, dead or constant.
//!
//! In: [`Tactile`] pressures as a robot has them. Out: [`Usable`] pressures, and why each other sensor was left out.

use std::fmt::{self, Display, Formatter};

use rayon::prelude::*;

use crate::stages::sense::Tactile;

/// Why a sensor is dropped.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fault {
    /// A value is no finite number.
    NotFinite,
    /// It is 0 throughout.
    Dead,
    /// It has one value throughout, which is not 0.
    Constant,
}

impl Display for Fault {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::NotFinite => "not a number",
            Self::Dead => "dead",
            Self::Constant => "constant",
        })
    }
}

/// A recording without missing values, and what was dropped.
#[derive(Debug, Clone, PartialEq)]
pub struct Usable {
    /// Their pressures.
    pub tactile: Tactile,
    /// The sensors that they are of, rising.
    pub sensors: Vec<usize>,
    /// The other sensors, rising.
    pub dropped: Vec<(usize, Fault)>,
    /// Samples that were left out, because more than half of the sensors have no number there.
    pub lost_samples: usize,
    /// The other samples, rising.
    pub samples: Vec<usize>,
}

/// Drops samples at which most sensors are missing, and then sensors that are missing, dead or constant.
pub fn usable(tactile: Tactile) -> Usable {
    let all = tactile.samples;
    let (tactile, samples) = without_lost_samples(tactile);
    let lost_samples = all - samples.len();
    let fault = |series: &[f32]| {
        if series.iter().any(|pressure| !pressure.is_finite()) {
            Some(Fault::NotFinite)
        } else if series.iter().all(|pressure| *pressure == 0.0) {
            Some(Fault::Dead)
        } else {
            series.iter().all(|pressure| *pressure == series[0]).then_some(Fault::Constant)
        }
    };
    let faults: Vec<Option<Fault>> = tactile.pressures.par_chunks_exact(tactile.samples).map(fault).collect();
    let dropped = faults.iter().enumerate().filter_map(|(sensor, fault)| Some((sensor, (*fault)?))).collect();
    let sensors: Vec<usize> = (0..faults.len()).filter(|sensor| faults[*sensor].is_none()).collect();
    Usable { tactile: only(tactile, &sensors), sensors, dropped, lost_samples, samples }
}

/// The pressures without samples at which more than half of the sensors are missing, such as a lost frame, and the samples that are
/// kept. Sensors that are missing in at least half of the samples are ignored in this count if that keeps more complete values: broken
/// sensors should not cost samples, and a slow skin, which is missing in most frames of a log, should not cost sensors. If no sample
/// would be kept, none is dropped.
fn without_lost_samples(mut tactile: Tactile) -> (Tactile, Vec<usize>) {
    let (samples, sensors) = (tactile.samples, tactile.sensors());
    let gaps = |series: &[f32]| series.iter().filter(|pressure| !pressure.is_finite()).count();
    let gaps: Vec<usize> = tactile.pressures.par_chunks_exact(samples).map(gaps).collect();
    let mut kept = samples_with_quorum(&tactile, &gaps, samples);
    let half = samples.div_ceil(2) - 1;
    if gaps.iter().any(|gaps| *gaps > half) {
        let other = samples_with_quorum(&tactile, &gaps, half);
        if complete_values(&tactile, &other) > complete_values(&tactile, &kept) {
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
            .for_each(|(missing, pressure)| *missing += usize::from(!pressure.is_finite()));
    }
    let sensors = gaps.iter().filter(|gaps| **gaps <= most).count();
    (0..tactile.samples).filter(|t| 2 * missing[*t] <= sensors).collect()
}

/// Number of values of the sensors that have one at all of these samples.
fn complete_values(tactile: &Tactile, samples: &[usize]) -> usize {
    let is_whole = |series: &&[f32]| samples.iter().all(|t| series[*t].is_finite());
    samples.len() * tactile.series().filter(is_whole).count()
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
mod tests {
    use super::*;

    #[test]
    fn sensors_that_tell_nothing_are_left_out_with_their_reason() {
        let pressures =
            vec![1.0, 2.0, f32::NAN, 3.0, 0.0, 0.0, 7.0, 7.0, 0.0, -1.0, f32::INFINITY, f32::INFINITY];
        let found = usable(Tactile { samples: 2, pressures });
        assert_eq!(found.sensors, [0, 4]);
        assert_eq!(found.tactile.pressures, [1.0, 2.0, 0.0, -1.0]);
        let dropped = [(1, Fault::NotFinite), (2, Fault::Dead), (3, Fault::Constant), (5, Fault::NotFinite)];
        assert_eq!(found.dropped, dropped);
    }

    #[test]
    fn a_lost_frame_costs_a_sample_and_no_sensor() {
        let nan = f32::NAN;
        let pressures = vec![1.0, nan, 2.0, 3.0, 4.0, nan, 5.0, 6.0, nan, 1.0, 2.0, 3.0];
        let found = usable(Tactile { samples: 4, pressures });
        assert_eq!((found.lost_samples, found.tactile.samples, found.samples), (1, 3, vec![0, 2, 3]));
        assert_eq!(found.sensors, [0, 1]);
        assert_eq!(found.tactile.pressures, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        assert_eq!(found.dropped, [(2, Fault::NotFinite)]);
    }

    #[test]
    fn broken_sensors_cost_no_sample() {
        let nan = f32::NAN;
        // Two that work but for one frame each, and three that soon break.
        let mut pressures = vec![1.0, 2.0, nan, 4.0, 5.0, 6.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        (0..3).for_each(|_| pressures.extend([1.0, nan, nan, nan, nan, nan]));
        let found = usable(Tactile { samples: 6, pressures });
        assert_eq!((found.lost_samples, found.sensors), (0, vec![1]));
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
}
