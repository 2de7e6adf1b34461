//! Count how often two sensors show each pair of symbols at one time, by the times at which a symbol changes (equations 25
//! and 26).
//!
//! What a body feels changes slowly: of ten levels, one sample in 25 differs from the one before. A stretch of samples in
//! which both sensors keep their symbols ends at time t and begins at time s, and adds t − s to the count of that pair. So
//! each change adds its time to the count of the pair before it, and subtracts it from that of the pair after it.

use rayon::prelude::*;

use crate::stages::quantise::Symbols;

/// The times at which each sensor's symbol changes.
pub(super) struct Changes<'a> {
    symbols: &'a Symbols,
    /// For each sensor: every t > 0 at which its symbol is not that of t − 1, rising.
    times: Vec<Vec<u32>>,
}

impl<'a> Changes<'a> {
    /// Of all sensors; there must be a sample.
    pub(super) fn new(symbols: &'a Symbols) -> Self {
        let times = |series: &[u8]| {
            (1..).zip(series.windows(2)).filter(|(_, pair)| pair[0] != pair[1]).map(|(t, _)| t).collect()
        };
        Self { symbols, times: symbols.values.par_chunks_exact(symbols.samples).map(times).collect() }
    }

    /// How many changes a sensor has on average.
    pub(super) fn mean(symbols: &Symbols) -> usize {
        let count = |series: &[u8]| series.windows(2).filter(|pair| pair[0] != pair[1]).count();
        let all: usize = symbols.values.par_chunks_exact(symbols.samples).map(count).sum();
        all / symbols.sensors().max(1)
    }

    /// Joint counts of two sensors.
    pub(super) fn joint(&self, i: usize, j: usize, joint: &mut [u32]) {
        let (first, second, levels) = (self.symbols.of(i), self.symbols.of(j), self.symbols.levels);
        joint.fill(0);
        // Modulo 2³², in which the counts themselves are.
        let mut add = |x: u8, y: u8, time: u32| {
            let count = &mut joint[usize::from(x) * levels + usize::from(y)];
            *count = count.wrapping_add(time);
        };
        for &time in &self.times[i] {
            let t = time as usize;
            add(first[t - 1], second[t - 1], time);
            add(first[t], second[t], time.wrapping_neg());
        }
        for &time in &self.times[j] {
            let t = time as usize;
            // Where both change, the first sensor's change was counted.
            let time = if first[t - 1] == first[t] { time } else { 0 };
            add(first[t], second[t - 1], time);
            add(first[t], second[t], time.wrapping_neg());
        }
        let last = self.symbols.samples - 1;
        add(first[last], second[last], self.symbols.samples as u32);
    }
}
