//! Leave out sensors that tell nothing: those that are not numbers, and those that never change.
//!
//! In: [`Tactile`] pressures as a robot has them. Out: [`Usable`] pressures, and why each other sensor was left out.

use std::fmt::{self, Display, Formatter};

use crate::stages::sense::Tactile;

/// Why a sensor tells nothing.
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

/// The pressures that tell something.
#[derive(Debug, Clone, PartialEq)]
pub struct Usable {
    /// Their pressures.
    pub tactile: Tactile,
    /// The sensors that they are of, rising.
    pub sensors: Vec<usize>,
    /// The other sensors, rising.
    pub dropped: Vec<(usize, Fault)>,
}

/// Leaves out sensors that tell nothing.
pub fn usable(tactile: Tactile) -> Usable {
    let fault = |series: &[f32]| {
        if series.iter().any(|pressure| !pressure.is_finite()) {
            Some(Fault::NotFinite)
        } else if series.iter().all(|pressure| *pressure == 0.0) {
            Some(Fault::Dead)
        } else {
            series.iter().all(|pressure| *pressure == series[0]).then_some(Fault::Constant)
        }
    };
    let faults: Vec<Option<Fault>> = tactile.series().map(fault).collect();
    let dropped = faults.iter().enumerate().filter_map(|(sensor, fault)| Some((sensor, (*fault)?))).collect();
    let sensors: Vec<usize> = (0..faults.len()).filter(|sensor| faults[*sensor].is_none()).collect();
    Usable { tactile: only(tactile, &sensors), sensors, dropped }
}

/// The pressures of some sensors, which rise.
pub fn only(tactile: Tactile, sensors: &[usize]) -> Tactile {
    if sensors.len() == tactile.sensors() {
        return tactile;
    }
    let series = |sensor: &usize| &tactile.pressures[sensor * tactile.samples..][..tactile.samples];
    Tactile { samples: tactile.samples, pressures: sensors.iter().flat_map(series).copied().collect() }
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
}
