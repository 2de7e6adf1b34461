//! Stage 3, `quantise`: turn pressures into symbols (section 4.1).
//!
//! In: [`Tactile`] pressures, M × T, in Pa. Out: [`Symbols`], M × T. The paper has "integer values between 1 and N";
//! here they are 0 to N − 1.
//!
//! The paper leaves the levels open. Pressures are heavy-tailed, so that levels of equal width put nearly
//! every sample into one; the default has a level for no pressure and shares the positive pressures
//! equally among the others. A level is a function of the value alone: equal values never split.

use rayon::prelude::*;

use serde::{Deserialize, Serialize};

use crate::numerics::range::{Checked, check};
use crate::stages::sense::Tactile;

/// How pressures become levels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Scheme {
    /// Level 0 is no pressure; the others hold equally many of that sensor's positive pressures.
    PerSensor,
    /// As [`Self::PerSensor`], but with one set of thresholds for all sensors.
    Pooled,
    /// Levels of equal width between the smallest and the largest pressure of all sensors.
    EqualWidth,
}

/// Quantisation (section 4.1).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Quantise {
    /// How levels are placed.
    pub scheme: Scheme,
    /// N, number of levels, 2 to 256.
    pub levels: usize,
}

impl Quantise {
    /// Checks the range of each setting.
    ///
    /// # Errors
    /// The first setting that is outside its range.
    pub fn check(&self) -> Checked {
        check("quantise.levels", self.levels, (2..=256).contains(&self.levels), "2 to 256")
    }
}

/// Quantised tactile information a_{i,t} of M sensors at T times.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Symbols {
    /// T, at least 1.
    pub samples: usize,
    /// N, number of levels; each symbol is below it.
    pub levels: usize,
    /// M × T: the whole series of one sensor after that of another.
    pub values: Vec<u8>,
}

impl Symbols {
    /// M.
    pub fn sensors(&self) -> usize {
        self.values.len() / self.samples
    }

    /// The series of each sensor.
    pub fn series(&self) -> std::slice::ChunksExact<'_, u8> {
        self.values.chunks_exact(self.samples)
    }

    /// The series of one sensor.
    pub fn of(&self, sensor: usize) -> &[u8] {
        &self.values[sensor * self.samples..][..self.samples]
    }

    /// Sensors that show one symbol throughout, and so tell nothing.
    pub fn constant_sensors(&self) -> Vec<usize> {
        let constant = |series: &[u8]| series.iter().all(|symbol| *symbol == series[0]);
        self.series().enumerate().filter(|(_, series)| constant(series)).map(|(sensor, _)| sensor).collect()
    }
}

/// Turns pressures into symbols (section 4.1).
///
/// In: M × T pressures in Pa. Out: M × T symbols from 0 to N − 1, where N is `settings.levels`. With levels of equal frequency, level 0 is
/// no pressure. A sensor with fewer distinct positive values than levels leaves some levels empty.
///
/// # Panics
/// If there are not 2 to 256 levels, or T is 0.
pub fn quantise(tactile: &Tactile, settings: &Quantise) -> Symbols {
    let levels = settings.levels;
    assert!((2..=256).contains(&levels), "2 to 256 levels, not {levels}");
    let common = match settings.scheme {
        Scheme::PerSensor => None,
        Scheme::Pooled => Some(equal_frequency(&tactile.pressures, levels)),
        Scheme::EqualWidth => Some(equal_width(&tactile.pressures, levels)),
    };
    let mut values = vec![0; tactile.pressures.len()];
    values
        .par_chunks_exact_mut(tactile.samples)
        .zip(tactile.pressures.par_chunks_exact(tactile.samples))
        .for_each(|(symbols, pressures)| {
            let own;
            let thresholds = match &common {
                Some(thresholds) => thresholds,
                None => {
                    own = equal_frequency(pressures, levels);
                    &own
                }
            };
            for (symbol, pressure) in symbols.iter_mut().zip(pressures) {
                *symbol = thresholds.iter().filter(|threshold| pressure > *threshold).count() as u8;
            }
        });
    Symbols { samples: tactile.samples, levels, values }
}

/// Upper bounds of all levels but the last: 0 for no pressure, then the quantiles of the positive values.
fn equal_frequency(pressures: &[f32], levels: usize) -> Vec<f32> {
    let mut positive: Vec<f32> = pressures.iter().copied().filter(|pressure| *pressure > 0.0).collect();
    // The last of the lowest `level` of `levels - 1` shares.
    let rank = |level: usize| (positive.len() * level).div_ceil(levels - 1).checked_sub(1);
    let ranks: Vec<usize> = (1..levels - 1).filter_map(rank).collect();
    select(&mut positive, &ranks, 0);
    std::iter::once(0.0).chain(ranks.into_iter().map(|rank| positive[rank])).collect()
}

/// Puts at each rank the value that sorting would put there. It selects the median rank, and then those on both sides, which is faster
/// than to sort. `ranks` rise, and count from `first`.
fn select(values: &mut [f32], ranks: &[usize], first: usize) {
    let Some(&middle) = ranks.get(ranks.len() / 2) else { return };
    let (below, _, above) = values.select_nth_unstable_by(middle - first, f32::total_cmp);
    select(below, &ranks[..ranks.partition_point(|rank| *rank < middle)], first);
    select(above, &ranks[ranks.partition_point(|rank| *rank <= middle)..], middle + 1);
}

/// Upper bounds of all levels but the last, evenly spaced over the range of the values.
fn equal_width(pressures: &[f32], levels: usize) -> Vec<f32> {
    let low = pressures.iter().copied().fold(f32::INFINITY, f32::min);
    let high = pressures.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    (1..levels).map(|level| low + (high - low) * (level as f32 / levels as f32)).collect()
}

#[cfg(test)]
mod tests;
