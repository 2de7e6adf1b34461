//! Count how often two sensors show each pair of symbols at one time, by one bit for each time and level (equations 25
//! and 26).

use pulp::{Arch, NullaryFnOnce};
use rayon::prelude::*;

use crate::stages::quantise::Symbols;

/// Sensors whose pairs with as many others are counted together, so that their planes stay in the cache:
/// a tile has 2 × 8 × 3 × T / 8 bytes at N = 4.
pub(super) const TILE: usize = 8;

/// 512 samples.
type Lanes = [u64; 8];

/// For each sensor and each level but 0, one bit for each sample.
pub(super) struct BitPlanes {
    /// Planes of one sensor, N − 1.
    each: usize,
    /// Length of one plane.
    length: usize,
    /// Plane after plane; empty ones fill the last tile.
    bits: Vec<Lanes>,
}

/// Planes that are counted together with as many others: each loaded word is used 4 times, and 16 sums fit
/// the registers.
const BLOCK: usize = 4;

impl BitPlanes {
    /// Of all sensors.
    pub(super) fn new(symbols: &Symbols) -> Self {
        let (each, length) = (symbols.levels - 1, symbols.samples.div_ceil(512));
        let mut bits = vec![[0; 8]; symbols.sensors().next_multiple_of(TILE) * each * length];
        bits.par_chunks_exact_mut(each * length)
            .zip(symbols.values.par_chunks_exact(symbols.samples))
            .for_each(|(planes, series)| {
                for (word, chunk) in series.chunks(64).enumerate() {
                    let mut padded = [0; 64];
                    padded[..chunk.len()].copy_from_slice(chunk);
                    let digits = binary_digits(&padded, each);
                    for (level, plane) in (1..).zip(planes.chunks_exact_mut(length)) {
                        let digit =
                            |(k, ones): (usize, &u64)| if level >> k & 1 == 1 { *ones } else { !ones };
                        plane.as_flattened_mut()[word] =
                            digits.iter().enumerate().map(digit).fold(u64::MAX, |all, one| all & one);
                    }
                }
            });
        Self { each, length, bits }
    }

    /// How often each symbol of each sensor occurs.
    pub(super) fn marginals(&self, symbols: &Symbols) -> Vec<Vec<u32>> {
        let planes = self.bits.par_chunks_exact(self.each * self.length).take(symbols.sensors());
        let marginal = |planes: &[Lanes]| {
            let ones =
                |plane: &[Lanes]| plane.as_flattened().iter().map(|word| word.count_ones()).sum::<u32>();
            let mut counts = vec![symbols.samples as u32];
            counts.extend(planes.chunks_exact(self.length).map(ones));
            counts[0] -= counts[1..].iter().sum::<u32>();
            counts
        };
        planes.map(marginal).collect()
    }

    /// Counts together all planes of the tiles of sensors that start at `row` and `column`.
    pub(super) fn count(&self, row: usize, column: usize) -> Counted {
        let size = TILE * self.each;
        let block = |tile: usize, start: usize| {
            std::array::from_fn(|k| &self.bits[(tile * self.each + start + k) * self.length..][..self.length])
        };
        let mut ones = vec![0; size * size];
        for x in (0..size).step_by(BLOCK) {
            for y in (0..size).step_by(BLOCK) {
                let counts = Block { first: block(row, x), second: block(column, y) }.count();
                for (k, counts) in counts.iter().enumerate() {
                    ones[(x + k) * size + y..][..BLOCK].copy_from_slice(counts);
                }
            }
        }
        Counted { row, column, each: self.each, ones }
    }
}

/// Numbers of bits set in both planes of every pair from two tiles.
pub(super) struct Counted {
    row: usize,
    column: usize,
    each: usize,
    /// By rows: the planes of the second tile for each of the first.
    ones: Vec<u32>,
}

impl Counted {
    /// Joint counts of two sensors; those with level 0 follow from the marginal counts.
    pub(super) fn joint(&self, i: usize, j: usize, marginals: &[Vec<u32>], joint: &mut [u32]) {
        let (levels, size) = (self.each + 1, TILE * self.each);
        joint[..levels].copy_from_slice(&marginals[j]);
        for x in 1..levels {
            let at = ((i - self.row) * self.each + x - 1) * size + (j - self.column) * self.each;
            joint[x * levels] = marginals[i][x];
            for (y, &both) in (1..).zip(&self.ones[at..][..self.each]) {
                joint[x * levels + y] = both;
                joint[x * levels] -= both;
                joint[y] -= both;
            }
            joint[0] -= joint[x * levels];
        }
    }
}

/// Planes of two tiles whose words are each loaded once to be counted with [`BLOCK`] others.
#[derive(Clone, Copy)]
struct Block<'a> {
    first: [&'a [Lanes]; BLOCK],
    second: [&'a [Lanes]; BLOCK],
}

#[cfg(target_arch = "x86_64")]
pulp::simd_type! {
    /// Processors that count the bits of eight words at once.
    struct CountsBits {
        avx512f: "avx512f",
        avx512vpopcntdq: "avx512vpopcntdq",
    }
}

/// Whether this processor counts the bits of eight words at once.
pub(super) fn counts_by_eight() -> bool {
    #[cfg(target_arch = "x86_64")]
    return CountsBits::try_new().is_some();
    #[cfg(not(target_arch = "x86_64"))]
    false
}

impl Block<'_> {
    /// Numbers of bits set in both planes, by the widest instructions of this processor.
    fn count(self) -> [[u32; BLOCK]; BLOCK] {
        #[cfg(target_arch = "x86_64")]
        if let Some(processor) = CountsBits::try_new() {
            return processor.vectorize(self);
        }
        Arch::new().dispatch(self)
    }
}

impl NullaryFnOnce for Block<'_> {
    type Output = [[u32; BLOCK]; BLOCK];

    #[inline(always)]
    fn call(self) -> Self::Output {
        let length = self.first[0].len();
        let first = self.first.map(|plane| &plane[..length]);
        let second = self.second.map(|plane| &plane[..length]);
        let mut sums = [[[0_u64; 8]; BLOCK]; BLOCK];
        for at in 0..length {
            for x in 0..BLOCK {
                for y in 0..BLOCK {
                    for lane in 0..8 {
                        let both = first[x][at][lane] & second[y][at][lane];
                        sums[x][y][lane] += u64::from(both.count_ones());
                    }
                }
            }
        }
        sums.map(|row| row.map(|lanes| lanes.iter().sum::<u64>() as u32))
    }
}

/// Binary digits of 64 symbols up to `largest`, the lowest first: bit t of each is that of symbol t.
fn binary_digits(symbols: &[u8; 64], largest: usize) -> Vec<u64> {
    let digits = (largest + 1).next_power_of_two().ilog2();
    let mut ones = vec![0; digits as usize];
    for (at, eight) in symbols.as_chunks::<8>().0.iter().enumerate() {
        let eight = u64::from_le_bytes(*eight);
        for (k, ones) in ones.iter_mut().enumerate() {
            // The product moves the lowest bits of all bytes into the highest byte.
            let bits = (eight >> k & 0x0101_0101_0101_0101).wrapping_mul(0x0102_0408_1020_4080) >> 56;
            *ones |= bits << (8 * at);
        }
    }
    ones
}

#[cfg(test)]
mod tests;
