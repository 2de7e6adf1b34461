//! Stage 4. Symbols → information metric between all pairs of sensors (equations 22 to 24).
//!
//! D(X, Y) = H(X|Y) + H(Y|X) in bits. It is 0 where each sensor's symbol tells the other's, so that two
//! sensors that differ by names of symbols only are at distance 0: a metric up to relabelling.

use pulp::{Arch, NullaryFnOnce};
use rayon::prelude::*;

use crate::quantise::Symbols;

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

/// Most sensors whose distances are computed: a matrix of 3.2 GB.
pub const MOST_SENSORS: usize = 20_000;

/// Most levels for which joint counts by bit planes, (N − 1)² passes over T bits, beat one pass over T
/// symbols.
const MOST_PLANES: usize = 10;

/// Sensors whose pairs with as many others are counted together, so that their planes stay in the cache:
/// a tile has 2 × 8 × 3 × T / 8 bytes at N = 4.
const TILE: usize = 8;

/// The information metric between all pairs of sensors, in bits.
pub fn information_metric(symbols: &Symbols) -> Distances {
    let (sensors, levels) = (symbols.sensors(), symbols.levels);
    let planes = (levels <= MOST_PLANES).then(|| BitPlanes::new(symbols));
    let marginals = match &planes {
        Some(planes) => planes.marginals(symbols),
        None => symbols.series().map(|series| histogram(series, levels)).collect(),
    };
    let logarithms: Vec<f64> = (0..=symbols.samples).map(|count| libm::log2(count.max(1) as f64)).collect();

    let tiles: Vec<(usize, usize)> = (0..sensors)
        .step_by(TILE)
        .flat_map(|row| (row..sensors).step_by(TILE).map(move |column| (row, column)))
        .collect();
    let pairs = |&(row, column): &(usize, usize)| {
        let rows = row..(row + TILE).min(sensors);
        rows.flat_map(move |i| (column.max(i + 1)..(column + TILE).min(sensors)).map(move |j| (i, j)))
    };
    let tiled: Vec<Vec<f64>> = tiles
        .par_iter()
        .map(|tile| {
            let counted = planes.as_ref().map(|planes| planes.count(tile.0, tile.1));
            let mut joint = vec![0; levels * levels];
            let metric = |(i, j)| {
                match &counted {
                    Some(counted) => counted.joint(i, j, &marginals, &mut joint),
                    None => count(symbols, i, j, &mut joint),
                }
                metric_of_counts(&joint, &marginals[i], &marginals[j], &logarithms)
            };
            pairs(tile).map(metric).collect()
        })
        .collect();

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
/// cancellation can make a distance negative. `logarithms` has log₂ c for all c from 1 to T, and 0 for c = 0: T
/// of them are found, not two for every cell of every pair.
fn metric_of_counts(joint: &[u32], first: &[u32], second: &[u32], logarithms: &[f64]) -> f64 {
    let log = |count: u32| logarithms[count as usize];
    let mut sum = 0.0;
    for (row, &x) in joint.chunks_exact(second.len()).zip(first) {
        for (&both, &y) in row.iter().zip(second) {
            sum += f64::from(both) * ((log(x) - log(both)) + (log(y) - log(both)));
        }
    }
    sum / (logarithms.len() - 1) as f64
}

/// How often each symbol occurs.
fn histogram(series: &[u8], levels: usize) -> Vec<u32> {
    let mut counts = vec![0; levels];
    series.iter().for_each(|&symbol| counts[usize::from(symbol)] += 1);
    counts
}

/// Joint counts of two sensors, one pass over their symbols: the plain definition (equation 24).
fn count(symbols: &Symbols, i: usize, j: usize, joint: &mut [u32]) {
    joint.fill(0);
    let series = |sensor: usize| &symbols.values[sensor * symbols.samples..][..symbols.samples];
    for (&x, &y) in series(i).iter().zip(series(j)) {
        joint[usize::from(x) * symbols.levels + usize::from(y)] += 1;
    }
}

/// 512 samples.
type Lanes = [u64; 8];

/// For each sensor and each level but 0, one bit for each sample.
struct BitPlanes {
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
    fn new(symbols: &Symbols) -> Self {
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
    fn marginals(&self, symbols: &Symbols) -> Vec<Vec<u32>> {
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
    fn count(&self, row: usize, column: usize) -> Counted {
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
struct Counted {
    row: usize,
    column: usize,
    each: usize,
    /// By rows: the planes of the second tile for each of the first.
    ones: Vec<u32>,
}

impl Counted {
    /// Joint counts of two sensors; those with level 0 follow from the marginal counts.
    fn joint(&self, i: usize, j: usize, marginals: &[Vec<u32>], joint: &mut [u32]) {
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
mod tests {
    use rand::RngExt;

    use super::*;
    use crate::streams::stream;

    fn random_symbols(sensors: usize, samples: usize, levels: usize) -> Symbols {
        let mut rng = stream(5, 1, "symbols", levels);
        let mut values: Vec<u8> = (0..sensors * samples).map(|_| rng.random_range(0..levels as u8)).collect();
        // Sensor 1 mostly copies sensor 0, and the last never changes.
        for t in 0..samples {
            if t % 7 != 0 {
                values[samples + t] = values[t];
            }
            values[(sensors - 1) * samples + t] = 1;
        }
        Symbols { samples, levels, values }
    }

    /// Equations 22 and 23 as they are written.
    fn by_definition(symbols: &Symbols, i: usize, j: usize) -> f64 {
        let (n, total) = (symbols.levels, symbols.samples as f64);
        let mut joint = vec![0; n * n];
        count(symbols, i, j, &mut joint);
        let p = |x: usize, y: usize| f64::from(joint[x * n + y]) / total;
        let mut sum = 0.0;
        for x in 0..n {
            for y in 0..n {
                if p(x, y) > 0.0 {
                    let px: f64 = (0..n).map(|y| p(x, y)).sum();
                    let py: f64 = (0..n).map(|x| p(x, y)).sum();
                    sum -= p(x, y) * (p(x, y) / px).log2() + p(x, y) * (p(x, y) / py).log2();
                }
            }
        }
        sum
    }

    #[test]
    fn agrees_with_the_definition_with_and_without_bit_planes() {
        for (levels, samples) in [(2, 63), (4, 64), (5, 1000), (10, 129), (11, 500), (40, 500)] {
            let symbols = random_symbols(19, samples, levels);
            let distances = information_metric(&symbols);
            for i in 0..19 {
                assert_eq!(distances.get(i, i), 0.0);
                for j in 0..19 {
                    let expected = by_definition(&symbols, i, j);
                    assert!((distances.get(i, j) - expected).abs() < 1e-12, "N = {levels}, {i}, {j}");
                    assert_eq!(distances.get(i, j), distances.get(j, i));
                }
            }
        }
    }

    #[test]
    fn bit_planes_count_as_the_definition_does_by_any_instructions() {
        for (levels, samples) in [(2, 1), (3, 63), (4, 511), (4, 512), (5, 513), (8, 1000), (10, 1537)] {
            let symbols = random_symbols(19, samples, levels);
            let planes = BitPlanes::new(&symbols);
            let marginals = planes.marginals(&symbols);
            let (mut joint, mut expected) = (vec![0; levels * levels], vec![0; levels * levels]);
            for (i, j) in (0..19).flat_map(|i| (i..19).map(move |j| (i, j))) {
                planes.count(i / TILE * TILE, j / TILE * TILE).joint(i, j, &marginals, &mut joint);
                count(&symbols, i, j, &mut expected);
                assert_eq!(joint, expected, "N = {levels}, T = {samples}, {i}, {j}");
            }
            let planes: Vec<&[Lanes]> = planes.bits.chunks_exact(planes.length).collect();
            let four = |from: usize| std::array::from_fn(|k| planes[from + k]);
            for from in (0..planes.len()).step_by(BLOCK) {
                let block = Block { first: four(0), second: four(from) };
                assert_eq!(block.count(), block.call(), "chosen and portable instructions");
                assert_eq!(block.count(), Arch::new().dispatch(block), "without VPOPCNTDQ");
            }
        }
    }

    #[test]
    fn known_joint_distributions() {
        // Two fair independent bits: H(X|Y) = H(Y|X) = 1 bit. A bit and its negation: 0. A bit and a
        // constant: 1 bit.
        let values = [[0, 0, 1, 1], [0, 1, 0, 1], [1, 1, 0, 0], [0, 0, 0, 0]].concat();
        let distances = information_metric(&Symbols { samples: 4, levels: 2, values });
        assert_eq!(distances.values[..4], [0.0, 2.0, 0.0, 1.0]);
    }

    #[test]
    fn the_triangle_inequality_holds() {
        let distances = information_metric(&random_symbols(12, 200, 4));
        for (x, y, z) in (0..12).flat_map(|x| (0..12).flat_map(move |y| (0..12).map(move |z| (x, y, z)))) {
            assert!(distances.get(x, z) <= distances.get(x, y) + distances.get(y, z) + 1e-12);
        }
    }
}
