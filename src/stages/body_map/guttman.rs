//! Move all points of a body map by the Guttman transform, the step of metric majorisation (Borg & Groenen 2005, chapter 8).
//!
//! Each pair of points is computed once, for both: the pairs of two blocks of points make a tile.

use std::array::from_fn;

use rayon::prelude::*;

use super::coordinates::BodyMap;
use crate::numerics::simd::vectorised;
use crate::stages::distance::Distances;

/// Points of a block.
const BLOCK: usize = 8;
/// What stands for a distance of 0 between two points of the map, in the unit of the distances.
const COINCIDENT: f64 = 1e-5;
/// Coordinates whose sums the registers hold.
const COORDINATES: usize = 4;
/// Shares of a step, each with sums of its own: threads may take one each.
const SHARES: usize = 8;

/// A number for each point of a block.
type Lanes = [f64; BLOCK];
/// A number for each pair of two blocks: by rows, one for each point of the first.
type Tile = [Lanes; BLOCK];

/// A map on its way to less stress.
#[derive(Debug)]
pub struct Guttman<'a> {
    distances: &'a Distances,
    /// The distances of each block with itself and with all that follow, 0 where the last block has no point.
    tiles: Vec<Tile>,
    dims: usize,
    /// Rows of a block: d coordinates, rows of 0 up to a multiple of COORDINATES, and a last one of 1 for each point.
    rows: usize,
    /// ⌈n / BLOCK⌉ × rows. All numbers are 0 where the last block has no point.
    points: Vec<Lanes>,
    /// What each share of a step sums up.
    shares: Vec<Sums>,
}

impl<'a> Guttman<'a> {
    /// Begins at a map of as many points as the distances have, which must be finite and symmetric.
    pub fn new(distances: &'a Distances, map: &BodyMap) -> Self {
        let (dims, rows) = (map.dims, (map.dims + 1).next_multiple_of(COORDINATES));
        let mut points = vec![[0.0; BLOCK]; distances.sensors.div_ceil(BLOCK) * rows];
        for (i, coordinates) in map.coordinates.chunks_exact(dims).enumerate() {
            let block = &mut points[i / BLOCK * rows..][..rows];
            coordinates.iter().zip(&mut *block).for_each(|(x, row)| row[i % BLOCK] = *x);
            block[rows - 1][i % BLOCK] = 1.0;
        }
        let shares = (0..SHARES).map(|_| Sums::zeros(points.len())).collect();
        Self { distances, tiles: tiles(distances), dims, rows, points, shares }
    }

    /// Moves every point by the Guttman transform; returns raw stress, the sum over pairs of (distance − distance within
    /// the map)², as it was before.
    pub fn step(&mut self) -> f64 {
        let (tiles, points, rows) = (&self.tiles, &self.points, self.rows);
        let (blocks, dims) = (points.len() / rows, self.dims);
        self.shares.par_iter_mut().enumerate().for_each(|(share, sums)| {
            sums.clear();
            // Later blocks have fewer tiles: every other turn is in the opposite order.
            for turn in 0..blocks.div_ceil(SHARES) {
                let block = turn * SHARES + if turn % 2 == 0 { share } else { SHARES - 1 - share };
                if block < blocks {
                    let tiles = &tiles[first_tile(block, blocks)..first_tile(block + 1, blocks)];
                    vectorised(
                        #[inline(always)]
                        || sums.add_tiles(tiles, points, rows, dims, block),
                    );
                }
            }
        });
        // In the order of the shares, so that the number of threads does not change a bit.
        let (sums, shares) = self.shares.split_first_mut().expect("there is more than one");
        shares.iter().for_each(|share| sums.add(share));
        let n = self.distances.sensors as f64;
        for (points, pulls) in self.points.chunks_exact_mut(rows).zip(sums.pulls.chunks_exact(rows)) {
            let ratios = pulls[rows - 1];
            for (x, pull) in points.iter_mut().zip(pulls).take(self.dims) {
                for lane in 0..BLOCK {
                    x[lane] = (ratios[lane] * x[lane] - pull[lane]) / n;
                }
            }
        }
        sums.stress
    }

    fn coordinate(&self, i: usize, k: usize) -> f64 {
        self.points[i / BLOCK * self.rows + k][i % BLOCK]
    }

    /// Σ ‖x_i‖.
    pub fn norms(&self) -> f64 {
        let square = |i: usize| (0..self.dims).map(|k| self.coordinate(i, k).powi(2)).sum::<f64>();
        (0..self.distances.sensors).map(|i| square(i).sqrt()).sum()
    }

    /// The map, in the unit of the distances.
    pub fn map(&self) -> BodyMap {
        let points = 0..self.distances.sensors;
        let coordinates = points.flat_map(|i| (0..self.dims).map(move |k| self.coordinate(i, k))).collect();
        BodyMap { dims: self.dims, coordinates }
    }
}

/// Sums of the transform over some tiles.
#[derive(Debug)]
struct Sums {
    /// Σ_j (D_ij / d_ij) x_jk of each point i, laid out as the points are; where they have 1, Σ_j D_ij / d_ij.
    pulls: Vec<Lanes>,
    /// Σ (D_ij − d_ij)² over pairs.
    stress: f64,
}

impl Sums {
    fn zeros(length: usize) -> Self {
        Self { pulls: vec![[0.0; BLOCK]; length], stress: 0.0 }
    }

    fn clear(&mut self) {
        self.pulls.fill([0.0; BLOCK]);
        self.stress = 0.0;
    }

    fn add(&mut self, other: &Self) {
        for (sum, term) in self.pulls.iter_mut().zip(&other.pulls) {
            sum.iter_mut().zip(term).for_each(|(sum, term)| *sum += term);
        }
        self.stress += other.stress;
    }

    /// Adds the pairs of one block with itself and with all that follow, whose distances `tiles` holds.
    #[inline(always)]
    fn add_tiles(&mut self, tiles: &[Tile], points: &[Lanes], rows: usize, dims: usize, block: usize) {
        let first = &points[block * rows..][..rows];
        for (offset, tile) in tiles.iter().enumerate() {
            let second = &points[(block + offset) * rows..][..rows];
            let (ratios, stress) = compare(tile, dims, first, second);
            let mut transposed = [[0.0; BLOCK]; BLOCK];
            for i in 0..BLOCK {
                for j in 0..BLOCK {
                    transposed[j][i] = ratios[i][j];
                }
            }
            pull(&mut self.pulls[block * rows..][..rows], &transposed, second);
            if offset == 0 {
                // The tile has each pair twice.
                self.stress += 0.5 * stress;
            } else {
                pull(&mut self.pulls[(block + offset) * rows..][..rows], &ratios, first);
                self.stress += stress;
            }
        }
    }
}

/// The tiles of each block with itself and with all that follow.
fn tiles(distances: &Distances) -> Vec<Tile> {
    let n = distances.sensors;
    let get = |i: usize, j: usize| if i < n && j < n { distances.get(i, j) } else { 0.0 };
    let tile = |i: usize, j: usize| from_fn(|a| from_fn(|b| get(i + a, j + b)));
    let starts = || (0..n).step_by(BLOCK);
    starts().flat_map(|i| starts().filter(move |j| *j >= i).map(move |j| tile(i, j))).collect()
}

/// Where the tiles of a block begin.
fn first_tile(block: usize, blocks: usize) -> usize {
    block * (2 * blocks + 1 - block) / 2
}

/// D / d of all pairs of two blocks, and the sum of their (D − d)².
#[inline(always)]
fn compare(tile: &Tile, dims: usize, first: &[Lanes], second: &[Lanes]) -> (Tile, f64) {
    /// Points of the first block whose sums the registers hold.
    const POINTS: usize = 4;
    let (real, others) = (first[first.len() - 1], second[second.len() - 1]);
    let mut ratios = [[0.0; BLOCK]; BLOCK];
    let mut squares = [0.0; BLOCK];
    for top in (0..BLOCK).step_by(POINTS) {
        let mut squared = [[0.0; BLOCK]; POINTS];
        for (own, x) in first[..dims].iter().zip(&second[..dims]) {
            // A copy, which the compiler knows not to overlap with anything.
            let x = *x;
            for (squared, own) in squared.iter_mut().zip(&own[top..top + POINTS]) {
                for (squared, x) in squared.iter_mut().zip(&x) {
                    *squared = (own - x).mul_add(own - x, *squared);
                }
            }
        }
        for (i, squared) in squared.iter().enumerate() {
            for j in 0..BLOCK {
                let (distance, within) = (tile[top + i][j], squared[j].sqrt());
                let off = real[top + i] * others[j] * (distance - within);
                squares[j] = off.mul_add(off, squares[j]);
                ratios[top + i][j] = distance / if within > 0.0 { within } else { COINCIDENT };
            }
        }
    }
    (ratios, squares.iter().sum())
}

/// Adds Σ_i ratios[i][j] x_i to the sums of each point j, for all coordinates.
#[inline(always)]
fn pull(sums: &mut [Lanes], ratios: &Tile, points: &[Lanes]) {
    let sums = sums.as_chunks_mut::<COORDINATES>().0;
    for (sums, points) in sums.iter_mut().zip(points.as_chunks::<COORDINATES>().0) {
        // On a copy, which the compiler knows not to overlap with anything.
        let mut own = *sums;
        for (i, ratios) in ratios.iter().enumerate() {
            for k in 0..COORDINATES {
                for j in 0..BLOCK {
                    own[k][j] = ratios[j].mul_add(points[k][i], own[k][j]);
                }
            }
        }
        *sums = own;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_that_coincide_on_the_map_do_not_move_each_other_to_infinity() {
        let values = (0..81).map(|at| f64::from(at / 9 - at % 9).abs()).collect();
        let distances = Distances { sensors: 9, values };
        let mut state = Guttman::new(&distances, &BodyMap { dims: 2, coordinates: vec![0.5; 18] });
        for _ in 0..3 {
            state.step();
        }
        assert!(state.map().coordinates.iter().all(|x| x.is_finite()));
    }
}
