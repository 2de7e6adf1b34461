//! Compute the information metric between all pairs of sensors (equations 23 to 26).
//!
//! D(X, Y) = H(X|Y) + H(Y|X) in bits. It is 0 where each sensor's symbol tells the other's, so that two
//! sensors that differ by names of symbols only are at distance 0: a metric up to relabelling.

use rayon::prelude::*;

use super::bit_planes::{self, BitPlanes, TILE};
use super::runs::{self, Counter, Runs};
use super::stretches::Stretches;
use crate::numerics::interrupt;
use crate::stages::quantise::Symbols;

/// A symmetric matrix of distances with a zero diagonal.
#[derive(Debug, Clone, PartialEq)]
pub struct Distances {
    /// M, number of sensors.
    pub sensors: usize,
    /// M × M, by rows.
    pub values: Vec<f64>,
}

impl Distances {
    /// Distance between sensors `i` and `j`.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        self.values[i * self.sensors + j]
    }
}

/// Maximum number of sensors: their distances take 3.2 GB.
pub const MAX_SENSORS: usize = 20_000;

/// Sensors that are counted with the same running counts: their joint counts take 1 MB at most.
const COLUMNS: usize = 1024;

/// What finds the joint counts of two sensors. All give the same counts.
enum Counting<'a> {
    /// (N − 1)² passes over T bits.
    Planes(BitPlanes),
    /// A step for each change of one sensor's symbol.
    Runs(Runs<'a>),
    /// One pass over T bits, and a step for each time at which either symbol changes.
    Stretches(Stretches<'a>),
}

impl<'a> Counting<'a> {
    /// Rows and columns of distances that are found together.
    fn tile(&self) -> (usize, usize) {
        match self {
            Self::Runs(_) => (1, COLUMNS),
            _ => (TILE, TILE),
        }
    }

    /// That which takes the least time, by what was measured on processors of both kinds (`benches/README.md`).
    fn fastest(symbols: &'a Symbols) -> Self {
        // In times that a word of bit planes takes.
        let step = if bit_planes::counts_by_eight() { 20 } else { 4 };
        let (changes, levels) = (mean_changes(symbols), symbols.levels);
        let planes = (levels - 1).pow(2) * symbols.samples / 64;
        let runs = changes * step * if levels <= 8 { 3 } else { 6 } / 4;
        let stretches = (symbols.samples / 13 + (2 * changes).min(symbols.samples) * 2 / 3) * step;
        if planes <= runs.min(stretches) {
            Self::Planes(BitPlanes::new(symbols))
        } else if runs <= stretches && levels <= runs::MAX_LEVELS {
            Self::Runs(Runs::new(symbols))
        } else {
            Self::Stretches(Stretches::new(symbols))
        }
    }
}

/// The information metric between all pairs of sensors (equations 23 to 26).
///
/// In: the symbols of M sensors at T times. Out: M × M distances in bits, 0 to 2 log₂ N, symmetric, 0 on the diagonal.
pub fn information_metric(symbols: &Symbols) -> Distances {
    by(&Counting::fastest(symbols), symbols)
}

fn by(counting: &Counting, symbols: &Symbols) -> Distances {
    let (sensors, levels) = (symbols.sensors(), symbols.levels);
    let marginals: Vec<Vec<u32>> = match counting {
        Counting::Planes(planes) => planes.marginals(symbols),
        _ => symbols.series().map(|series| histogram(series, levels)).collect(),
    };
    let logarithms: Vec<f64> = (0..=symbols.samples).map(|count| libm::log2(count.max(1) as f64)).collect();
    let logarithm = |count: &u32| logarithms[*count as usize];
    let of_marginals: Vec<Vec<f64>> =
        marginals.iter().map(|counts| counts.iter().map(logarithm).collect()).collect();

    let (height, width) = counting.tile();
    let tiles: Vec<(usize, usize)> = (0..sensors)
        .step_by(height)
        .flat_map(|row| (row..sensors).step_by(width).map(move |column| (row, column)))
        .collect();
    let columns = |i: usize, column: usize| column.max(i + 1)..(column + width).min(sensors);
    let pairs = |&(row, column): &(usize, usize)| {
        let rows = row..(row + height).min(sensors);
        rows.flat_map(move |i| columns(i, column).map(move |j| (i, j)))
    };
    let metric = |i: usize, j: usize, joint: &[u32]| {
        metric_of_counts(joint, &of_marginals[i], &of_marginals[j], &logarithms)
    };
    let of_tile = |(joint, counter): &mut (Vec<u32>, Counter), tile: &(usize, usize)| -> Vec<f64> {
        interrupt::check();
        let mut by_pairs = |count: &dyn Fn(usize, usize, &mut [u32])| {
            let of_pair = |(i, j)| {
                count(i, j, joint);
                metric(i, j, joint)
            };
            pairs(tile).map(of_pair).collect()
        };
        match counting {
            Counting::Planes(planes) => {
                let counted = planes.count(tile.0, tile.1);
                by_pairs(&|i, j, joint| counted.joint(i, j, &marginals, joint))
            }
            Counting::Runs(runs) => {
                let (i, others) = (tile.0, columns(tile.0, tile.1));
                let counts = runs.count(i, others.clone(), counter);
                others.zip(counts).map(|(j, joint)| metric(i, j, joint)).collect()
            }
            Counting::Stretches(stretches) => by_pairs(&|i, j, joint| stretches.joint(i, j, joint)),
        }
    };
    let scratch = || (vec![0; levels * levels], Counter::default());
    let tiled: Vec<Vec<f64>> =
        tiles.par_iter().map_init(scratch, |scratch, tile| of_tile(scratch, tile)).collect();

    let mut values = vec![0.0; sensors * sensors];
    for ((i, j), distance) in tiles.iter().flat_map(pairs).zip(tiled.into_iter().flatten()) {
        values[i * sensors + j] = distance;
        values[j * sensors + i] = distance;
    }
    Distances { sensors, values }
}

/// H(X|Y) + H(Y|X) from joint counts: Σ c_xy [(log₂ c_x − log₂ c_xy) + (log₂ c_y − log₂ c_xy)] / T.
///
/// Every term is at least 0 and exactly 0 where a symbol tells the other, so that neither rounding nor
/// cancellation can make a distance negative. `first` and `second` have the logarithms of the marginal counts; `logarithms`
/// has log₂ c for all c from 1 to T, and 0 for c = 0: T of them are found, not one for every cell of every pair.
fn metric_of_counts(joint: &[u32], first: &[f64], second: &[f64], logarithms: &[f64]) -> f64 {
    let mut sum = 0.0;
    for (row, x) in joint.chunks_exact(second.len()).zip(first) {
        // Of many levels, most pairs never meet and add 0. They are left out without a branch, which no processor could foresee.
        let (mut met, mut count) = ([0_u8; 256], 0);
        for (symbol, &both) in row.iter().enumerate() {
            // At most 256 are counted; the mask says so to the compiler.
            met[count & 255] = symbol as u8;
            count += usize::from(both > 0);
        }
        for &symbol in &met[..count] {
            let (both, y) = (row[usize::from(symbol)], second[usize::from(symbol)]);
            let log = logarithms[both as usize];
            sum += f64::from(both) * ((x - log) + (y - log));
        }
    }
    sum / (logarithms.len() - 1) as f64
}

/// How often a sensor changes its symbol on average.
fn mean_changes(symbols: &Symbols) -> usize {
    let of_sensor = |series: &[u8]| series.windows(2).filter(|pair| pair[0] != pair[1]).count();
    let all: usize = symbols.values.par_chunks_exact(symbols.samples).map(of_sensor).sum();
    all / symbols.sensors().max(1)
}

/// How often each symbol occurs in the series of one sensor.
fn histogram(series: &[u8], levels: usize) -> Vec<u32> {
    let mut counts = vec![0; levels];
    series.iter().for_each(|&symbol| counts[usize::from(symbol)] += 1);
    counts
}

#[cfg(test)]
mod tests;
