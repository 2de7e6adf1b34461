//! Count how often two sensors show each pair of symbols at one time, by the runs of one sensor and running counts of the other
//! (equations 25 and 26).
//!
//! What a body feels changes slowly: of ten levels, one sample in 25 differs from the one before. While sensor j keeps its
//! symbol y, from time s to time e, sensor i shows each symbol x so often as its running count grows: c_x(e) − c_x(s). The
//! running counts of all symbols are added at once, and no time is looked at but those at which sensor j changes.

use std::ops::Range;

use rayon::prelude::*;

use crate::stages::quantise::Symbols;

/// Maximum number of levels: their running counts fit two registers of any processor.
pub(super) const MAX_LEVELS: usize = 16;

/// Samples of a block. Its running counts take 128 kB, of more than 8 levels 256 kB, so that they stay in the cache of a core.
const BLOCK: usize = 8192;

/// The end of a run in its block, and its symbol.
type Run = (u16, u8);

/// The runs of equal symbols of each sensor.
pub(super) struct Runs<'a> {
    symbols: &'a Symbols,
    /// For each sensor and block.
    runs: Vec<Vec<Vec<Run>>>,
}

/// What one thread counts with.
#[derive(Default)]
pub(super) struct Counter {
    /// Of each symbol, before each sample of a block and after its last.
    running: Vec<u16>,
    /// N × N counts for each second sensor.
    joint: Vec<u32>,
}

impl<'a> Runs<'a> {
    /// Of all sensors; there must be a sample, and [`MAX_LEVELS`] at most.
    pub(super) fn new(symbols: &'a Symbols) -> Self {
        let in_block = |block: &[u8]| -> Vec<Run> {
            let mut end = 0;
            let run = |run: &[u8]| {
                end += run.len() as u16;
                (end, run[0])
            };
            block.chunk_by(|a, b| a == b).map(run).collect()
        };
        let of_sensor = |series: &[u8]| series.chunks(BLOCK).map(in_block).collect();
        Self { symbols, runs: symbols.values.par_chunks_exact(symbols.samples).map(of_sensor).collect() }
    }

    /// Joint counts of sensor `first` with each of `others`, N × N numbers each.
    pub(super) fn count<'c>(
        &self,
        first: usize,
        others: Range<usize>,
        counter: &'c mut Counter,
    ) -> impl Iterator<Item = &'c [u32]> {
        let cells = self.symbols.levels.pow(2);
        counter.joint.clear();
        counter.joint.resize(others.len() * cells, 0);
        if self.symbols.levels <= 8 {
            self.add::<8>(first, others, counter);
        } else {
            self.add::<MAX_LEVELS>(first, others, counter);
        }
        counter.joint.chunks_exact(cells)
    }

    /// As [`Self::count`], with running counts of so many symbols.
    fn add<const LANES: usize>(&self, first: usize, others: Range<usize>, counter: &mut Counter) {
        let levels = self.symbols.levels;
        let Counter { running, joint } = counter;
        for (block, series) in self.symbols.of(first).chunks(BLOCK).enumerate() {
            running_counts::<LANES>(series, running);
            for (j, joint) in others.clone().zip(joint.chunks_exact_mut(levels * levels)) {
                let sums = by_runs::<LANES>(&self.runs[j][block], running.as_chunks().0);
                for (x, row) in joint.chunks_exact_mut(levels).enumerate() {
                    row.iter_mut().zip(&sums).for_each(|(count, sum)| *count += u32::from(sum[x]));
                }
            }
        }
    }
}

/// How often each symbol occurs before each sample of `series`, and in all of it.
fn running_counts<const LANES: usize>(series: &[u8], running: &mut Vec<u16>) {
    let one =
        std::array::from_fn::<[u16; LANES], LANES, _>(|x| std::array::from_fn(|lane| u16::from(x == lane)));
    let mut counts = [0; LANES];
    running.clear();
    running.extend(counts);
    for &symbol in series {
        counts = plus(counts, one[usize::from(symbol) % LANES]);
        running.extend(counts);
    }
}

/// For each symbol of a sensor, by how much the counts grow in all its runs.
fn by_runs<const LANES: usize>(runs: &[Run], running: &[[u16; LANES]]) -> [[u16; LANES]; MAX_LEVELS] {
    let mut sums = [[0; LANES]; MAX_LEVELS];
    let mut before = [0; LANES];
    for &(end, symbol) in runs {
        let after = running[usize::from(end)];
        let sum = &mut sums[usize::from(symbol) % MAX_LEVELS];
        *sum = plus(*sum, std::array::from_fn(|x| after[x].wrapping_sub(before[x])));
        before = after;
    }
    sums
}

fn plus<const LANES: usize>(a: [u16; LANES], b: [u16; LANES]) -> [u16; LANES] {
    std::array::from_fn(|x| a[x].wrapping_add(b[x]))
}
