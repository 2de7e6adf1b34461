//! Count how often two sensors show each pair of symbols at one time, by the stretches in which neither changes (equations 25
//! and 26).
//!
//! Each stretch adds its length to the count of its pair. One bit for each sample says whether a sensor's symbol changes there,
//! so that the stretches of two sensors end at the bits of either.

use rayon::prelude::*;

use crate::stages::quantise::Symbols;

/// Samples of a word.
const WORD: usize = 64;

/// For each sensor, a bit for each sample at which its symbol is not that of the one before.
pub(super) struct Stretches<'a> {
    symbols: &'a Symbols,
    changes: Vec<Vec<u64>>,
}

impl<'a> Stretches<'a> {
    /// Of all sensors; there must be a sample.
    pub(super) fn new(symbols: &'a Symbols) -> Self {
        let changes = |series: &[u8]| {
            let mut bits = vec![0; series.len().div_ceil(WORD)];
            for (t, pair) in (1..).zip(series.windows(2)) {
                bits[t / WORD] |= u64::from(pair[0] != pair[1]) << (t % WORD);
            }
            bits
        };
        Self { symbols, changes: symbols.values.par_chunks_exact(symbols.samples).map(changes).collect() }
    }

    /// Joint counts of two sensors.
    pub(super) fn joint(&self, i: usize, j: usize, joint: &mut [u32]) {
        let (first, second, levels) = (self.symbols.of(i), self.symbols.of(j), self.symbols.levels);
        joint.fill(0);
        let mut begin = 0;
        let mut end_at = |end: usize| {
            let last = end - 1;
            joint[usize::from(first[last]) * levels + usize::from(second[last])] += (end - begin) as u32;
            begin = end;
        };
        for (word, (i, j)) in self.changes[i].iter().zip(&self.changes[j]).enumerate() {
            let mut changes = i | j;
            while changes != 0 {
                end_at(word * WORD + changes.trailing_zeros() as usize);
                changes &= changes - 1;
            }
        }
        end_at(first.len());
    }
}
