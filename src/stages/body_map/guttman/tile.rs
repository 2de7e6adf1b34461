//! What the pairs of two blocks of points do to the points in a step of metric majorisation.

use std::array::from_fn;
use std::hint::black_box;

/// Points of a block, and coordinates of a chunk.
pub(super) const BLOCK: usize = 8;
/// What stands for a distance of 0 between two points of the map, in the unit of the distances.
const COINCIDENT: f64 = 1e-5;
/// Coordinates whose sums the registers hold.
pub(super) const COORDINATES: usize = 4;

/// A number for each point of a block, or for each coordinate of a chunk.
pub(super) type Lanes = [f64; BLOCK];
/// A number for each pair of two blocks, or of a block and a chunk: by rows, one for each point of the first.
pub(super) type Tile = [Lanes; BLOCK];

/// D / d of all pairs of two blocks, and shares of the sum of their (D − d)².
///
/// In: D; and of each block d rows of coordinates, one of 1, and one of squared norms. If one of the squares of d is no more than `close`, all are summed
/// up from differences: twice the product of two points would leave too few digits of their squared norms.
#[inline(always)]
pub(super) fn compare(
    tile: &Tile,
    dims: usize,
    close: f64,
    first: &[Lanes],
    second: &[Lanes],
) -> (Tile, Lanes) {
    let mut squared = [[0.0; BLOCK]; BLOCK];
    for (x, y) in first[..dims].iter().zip(&second[..dims]) {
        // Copies, which the compiler knows not to overlap with anything.
        let (x, y) = (*x, *y);
        for i in 0..BLOCK {
            squared[i] = from_fn(|j| x[i].mul_add(y[j], squared[i][j]));
        }
    }
    let (norms, other_norms) = (first[dims + 1], second[dims + 1]);
    let mut least = [f64::INFINITY; BLOCK];
    for i in 0..BLOCK {
        let both: Lanes = from_fn(|j| norms[i] + other_norms[j]);
        squared[i] = from_fn(|j| (-2.0f64).mul_add(squared[i][j], both[j]));
        least = from_fn(|j| if squared[i][j] < least[j] { squared[i][j] } else { least[j] });
    }
    let (real, other_real) = (&first[dims], &second[dims]);
    if least.iter().fold(false, |any, least| any | (*least <= close)) {
        squared = [[0.0; BLOCK]; BLOCK];
        for (x, y) in first[..dims].iter().zip(&second[..dims]) {
            for i in 0..BLOCK {
                squared[i] = from_fn(|j| (x[i] - y[j]).mul_add(x[i] - y[j], squared[i][j]));
            }
        }
        ratios_and_stress::<true>(tile, &squared, real, other_real)
    } else {
        ratios_and_stress::<false>(tile, &squared, real, other_real)
    }
}

/// The same from the squares of d, of which some may be 0 where points are close.
#[inline(always)]
fn ratios_and_stress<const CLOSE: bool>(
    distances: &Tile,
    squared: &Tile,
    real: &Lanes,
    other_real: &Lanes,
) -> (Tile, Lanes) {
    let mut ratios = [[0.0; BLOCK]; BLOCK];
    let mut stress = [0.0; BLOCK];
    for i in 0..BLOCK {
        let (distances, squared) = (distances[i], squared[i]);
        let mut inverse = inverse_roots(&squared);
        let off: Lanes = from_fn(|j| (-squared[j]).mul_add(inverse[j], distances[j]));
        if CLOSE {
            stress = from_fn(|j| (real[i] * off[j]).mul_add(off[j], stress[j]));
            inverse = from_fn(|j| if squared[j] > 0.0 { inverse[j] } else { 1.0 / COINCIDENT });
        } else {
            stress = from_fn(|j| off[j].mul_add(off[j], stress[j]));
        }
        ratios[i] = from_fn(|j| distances[j] * inverse[j]);
    }
    (ratios, from_fn(|j| other_real[j] * stress[j]))
}

/// 1 / √x, within a few units in the last place; something finite for x = 0.
///
/// From the exponent of x and the first of its digits, within 4 %, in two steps that take the error to the fourth power
/// (Householder's method). That is faster than a root and a division, and rounds in the same way on any machine.
#[inline(always)]
fn inverse_roots(x: &Lanes) -> Lanes {
    /// Makes the start of half the bits of x: a known constant, whose relative error is least.
    const START: u64 = 0x5fe6_eb50_c7b5_37a9;
    let mut y: Lanes = from_fn(|j| f64::from_bits(START.wrapping_sub(x[j].to_bits() >> 1)));
    for _ in 0..2 {
        let scaled: Lanes = from_fn(|j| -x[j] * y[j]);
        let off: Lanes = from_fn(|j| scaled[j].mul_add(y[j], 1.0));
        let series: Lanes = from_fn(|j| off[j].mul_add(5.0 / 16.0, 3.0 / 8.0));
        let series: Lanes = from_fn(|j| series[j].mul_add(off[j], 0.5));
        let turn: Lanes = from_fn(|j| off[j] * y[j]);
        y = from_fn(|j| turn[j].mul_add(series[j], y[j]));
    }
    y
}

/// Adds Σ_j ratios[i][j] x_j to the sums of each point i, for all coordinates.
#[inline(always)]
pub(super) fn pull_first(sums: &mut [Tile], ratios: &Tile, points: &[Tile]) {
    for (sums, points) in sums.iter_mut().zip(points) {
        // The compiler would spread out each of the 64 ratios before the loop, and has registers for 32.
        let ratios = black_box(ratios);
        let points = *points;
        for (sums, ratios) in sums.iter_mut().zip(ratios) {
            let mut own = *sums;
            for (ratio, x) in ratios.iter().zip(&points) {
                own = from_fn(|k| ratio.mul_add(x[k], own[k]));
            }
            *sums = own;
        }
    }
}

/// Adds Σ_i ratios[i][j] x_i to the sums of each point j, for all coordinates.
#[inline(always)]
pub(super) fn pull_second(sums: &mut [Lanes], ratios: &Tile, points: &[Lanes]) {
    let sums = sums.as_chunks_mut::<COORDINATES>().0;
    for (sums, points) in sums.iter_mut().zip(points.as_chunks::<COORDINATES>().0) {
        // On a copy, which the compiler knows not to overlap with anything.
        let mut own = *sums;
        for (i, ratios) in ratios.iter().enumerate() {
            for k in 0..COORDINATES {
                own[k] = from_fn(|j| ratios[j].mul_add(points[k][i], own[k][j]));
            }
        }
        *sums = own;
    }
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use crate::numerics::rng::stream;

    #[test]
    fn inverse_roots_are_right_at_any_size() {
        let mut rng = stream(1, 1, "roots", 0);
        for size in [-300, -20, -1, 0, 1, 20, 300] {
            let x: Lanes = from_fn(|_| rng.random_range(1.0..100.0) * 10f64.powi(size));
            for (found, x) in inverse_roots(&x).into_iter().zip(x) {
                assert!((found * x.sqrt() - 1.0).abs() < 4.0 * f64::EPSILON, "of {x:e}");
            }
        }
        assert!(inverse_roots(&[0.0; BLOCK]).iter().all(|y| y.is_finite()));
    }
}
