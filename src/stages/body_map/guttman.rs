//! Move all points of a body map by the Guttman transform, the step of metric majorisation (Borg & Groenen 2005, chapter 8).
//!
//! Each pair of points is computed once, for both: the pairs of two blocks of points make a [tile]. What the pairs of a tile do to
//! the points of its first block is summed up with coordinates side by side, and to those of its second with points side by side,
//! so that no tile has to be transposed; the points are kept in both orders.

mod tile;

use std::array::from_fn;

use rayon::prelude::*;

use self::tile::{BLOCK, COORDINATES, Lanes, Tile, compare, pull_first, pull_second};
use super::coordinates::BodyMap;
use crate::numerics::interrupt;
use crate::numerics::simd::vectorised;
use crate::stages::distance::Distances;

/// Share of the largest squared norm up to which squared distances are small.
const CLOSE: f64 = 1e-4;
/// Shares of a step, each with sums of its own: threads may take one each. Eight took longer on two cores, and several random starts
/// are on their way at the same time.
const SHARES: usize = 4;

/// Fewest blocks that a thread moves.
const MIN_BLOCKS: usize = 32;

/// A map on its way to less stress.
#[derive(Debug)]
pub(super) struct Guttman {
    /// The distances of each block with itself and with all that follow, 0 where the last block has no point.
    tiles: Vec<Tile>,
    points: Points,
    /// What each share of a step sums up.
    shares: Vec<Sums>,
}

impl Guttman {
    /// Begins at a map of as many points as the distances have, which must be finite and symmetric.
    pub(super) fn new(distances: &Distances, map: &BodyMap) -> Self {
        let points = Points::new(map);
        let shares = (0..SHARES).map(|_| Sums::zeros(&points)).collect();
        Self { tiles: tiles(distances), points, shares }
    }

    /// Moves every point by the Guttman transform; returns raw stress, the sum over pairs of (distance − distance within
    /// the map)², as it was before.
    pub(super) fn step(&mut self) -> f64 {
        interrupt::check();
        let (tiles, points) = (&self.tiles, &self.points);
        let blocks = points.blocks();
        self.shares.par_iter_mut().enumerate().for_each(|(share, sums)| {
            sums.clear();
            for (turn, own) in sums.by_chunks.chunks_exact_mut(points.chunks).enumerate() {
                let block = block(share, turn);
                if block < blocks {
                    let tiles = &tiles[first_tile(block, blocks)..first_tile(block + 1, blocks)];
                    let (by_rows, stress) = (&mut sums.by_rows, &mut sums.stress);
                    vectorised(
                        #[inline(always)]
                        || add_tiles(own, by_rows, stress, tiles, points, block),
                    );
                }
            }
        });
        self.points.move_by(&self.shares);
        self.shares.iter().flat_map(|sums| &sums.stress).sum()
    }

    /// Σ ‖x_i‖.
    pub(super) fn norms(&self) -> f64 {
        self.points.squared_norms().map(|square| square.sqrt()).sum()
    }

    /// The map, in the unit of the distances.
    pub(super) fn map(&self) -> BodyMap {
        let dims = self.points.dims;
        let places = (0..self.points.count).flat_map(|i| (0..dims).map(move |k| (i, k)));
        BodyMap { dims, coordinates: places.map(|(i, k)| self.points.get(i, k)).collect() }
    }
}

/// The points of a map. All numbers are 0 where the last block has no point.
#[derive(Debug)]
struct Points {
    dims: usize,
    count: usize,
    /// Chunks of a block's points: of d coordinates, and 1.
    chunks: usize,
    /// Rows of a block: the same d coordinates and 1, then the squared norms, and 0 up to a multiple of COORDINATES.
    rows: usize,
    /// Squared distance up to which two points are close: see [`compare`].
    close: f64,
    /// Blocks × chunks.
    by_chunks: Vec<Tile>,
    /// Blocks × rows.
    by_rows: Vec<Lanes>,
}

impl Points {
    fn new(map: &BodyMap) -> Self {
        let (dims, count) = (map.dims, map.coordinates.len() / map.dims);
        let (chunks, rows) = ((dims + 1).div_ceil(BLOCK), (dims + 2).next_multiple_of(COORDINATES));
        let blocks = count.div_ceil(BLOCK);
        let by_chunks = vec![[[0.0; BLOCK]; BLOCK]; blocks * chunks];
        let mut points = Self {
            dims,
            count,
            chunks,
            rows,
            close: 0.0,
            by_chunks,
            by_rows: vec![[0.0; BLOCK]; blocks * rows],
        };
        points.change(|block, rows| {
            let points = map.coordinates[block * BLOCK * dims..].chunks_exact(dims).take(BLOCK);
            for (i, coordinates) in points.enumerate() {
                coordinates.iter().chain(&[1.0]).zip(&mut *rows).for_each(|(x, row)| row[i] = *x);
            }
        });
        points
    }

    fn blocks(&self) -> usize {
        self.count.div_ceil(BLOCK)
    }

    fn chunks_of(&self, block: usize) -> &[Tile] {
        &self.by_chunks[block * self.chunks..][..self.chunks]
    }

    fn rows_of(&self, block: usize) -> &[Lanes] {
        &self.by_rows[block * self.rows..][..self.rows]
    }

    /// The squared norms of all points, and 0 where the last block has no point.
    fn squared_norms(&self) -> impl Iterator<Item = &f64> {
        self.by_rows.chunks_exact(self.rows).flat_map(|rows| &rows[self.dims + 1])
    }

    fn get(&self, i: usize, k: usize) -> f64 {
        self.by_rows[i / BLOCK * self.rows + k][i % BLOCK]
    }

    /// Changes the rows of each block, and lays out the rest by them.
    fn change(&mut self, change: impl Fn(usize, &mut [Lanes]) + Sync) {
        let dims = self.dims;
        let rows = self.by_rows.par_chunks_exact_mut(self.rows);
        let blocks = rows.zip(self.by_chunks.par_chunks_exact_mut(self.chunks)).enumerate();
        blocks.with_min_len(MIN_BLOCKS).for_each(|(block, (rows, chunks))| {
            change(block, rows);
            rows[dims + 1] =
                rows[..dims].iter().fold([0.0; BLOCK], |sum, row| from_fn(|i| row[i] * row[i] + sum[i]));
            for (chunk, rows) in chunks.iter_mut().zip(rows[..=dims].chunks(BLOCK)) {
                for (k, row) in rows.iter().enumerate() {
                    (0..BLOCK).for_each(|i| chunk[i][k] = row[i]);
                }
            }
        });
        self.close = CLOSE * self.squared_norms().copied().fold(0.0, f64::max);
    }

    /// Moves every point to where the sums over all pairs pull it.
    fn move_by(&mut self, shares: &[Sums]) {
        let &mut Self { dims, count, chunks, rows, .. } = self;
        self.change(|block, points| {
            let (share, turn) = share_and_turn(block);
            let by_chunks = &shares[share].by_chunks[turn * chunks..][..chunks];
            // In the order of the shares, so that the number of threads does not change a bit.
            let sum = |k: usize| {
                shares.iter().fold(from_fn(|i| by_chunks[k / BLOCK][i][k % BLOCK]), |sum: Lanes, share| {
                    let row = &share.by_rows[block * rows + k];
                    from_fn(|i| sum[i] + row[i])
                })
            };
            let ratios = sum(dims);
            for (k, x) in points[..dims].iter_mut().enumerate() {
                let pulls = sum(k);
                *x = from_fn(|i| (ratios[i] * x[i] - pulls[i]) / count as f64);
            }
        });
    }
}

/// The block that a share takes in a turn. Later blocks have fewer tiles: every other turn is in the opposite order.
fn block(share: usize, turn: usize) -> usize {
    turn * SHARES + if turn.is_multiple_of(2) { share } else { SHARES - 1 - share }
}

/// The share that takes a block, and its turn.
fn share_and_turn(block: usize) -> (usize, usize) {
    let (turn, place) = (block / SHARES, block % SHARES);
    (if turn.is_multiple_of(2) { place } else { SHARES - 1 - place }, turn)
}

/// What a share of the blocks sums up over their pairs with themselves and with all blocks that follow.
#[derive(Debug)]
struct Sums {
    /// Σ_j (D_ij / d_ij) x_jk of each point i of these blocks, laid out as the points are; where they have 1, Σ_j D_ij / d_ij.
    by_chunks: Vec<Tile>,
    /// The same of each point of all blocks, over the pairs with these blocks.
    by_rows: Vec<Lanes>,
    /// Σ (D_ij − d_ij)² over pairs, in shares.
    stress: Lanes,
}

impl Sums {
    fn zeros(points: &Points) -> Self {
        let by_chunks = vec![[[0.0; BLOCK]; BLOCK]; points.blocks().div_ceil(SHARES) * points.chunks];
        Self { by_chunks, by_rows: vec![[0.0; BLOCK]; points.by_rows.len()], stress: [0.0; BLOCK] }
    }

    fn clear(&mut self) {
        self.by_chunks.fill([[0.0; BLOCK]; BLOCK]);
        self.by_rows.fill([0.0; BLOCK]);
        self.stress = [0.0; BLOCK];
    }
}

/// Adds the pairs of one block with itself and with all that follow, whose distances `tiles` holds.
#[inline(always)]
fn add_tiles(
    by_chunks: &mut [Tile],
    by_rows: &mut [Lanes],
    stress: &mut Lanes,
    tiles: &[Tile],
    points: &Points,
    block: usize,
) {
    for (offset, tile) in tiles.iter().enumerate() {
        let other = block + offset;
        let (ratios, squares) =
            compare(tile, points.dims, points.close, points.rows_of(block), points.rows_of(other));
        pull_first(by_chunks, &ratios, points.chunks_of(other));
        // The tile of a block with itself has each pair twice.
        let share: f64 = if offset == 0 { 0.5 } else { 1.0 };
        *stress = from_fn(|j| share.mul_add(squares[j], stress[j]));
        if offset > 0 {
            pull_second(&mut by_rows[other * points.rows..][..points.rows], &ratios, points.rows_of(block));
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

#[cfg(test)]
mod tests;
