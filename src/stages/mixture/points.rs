//! Hold the points x_i of a mixture, laid out in memory for the two inner loops of the sampler.

use nalgebra::{DMatrix, DVector};

use super::augmented::{Augmented, Chunk, LANES, chunks};
use crate::stages::body_map::BodyMap;

/// Points of a block, evaluated side by side, so that the loop over them becomes vector instructions.
pub(super) const BLOCK: usize = 32;

/// n points in d dimensions, centred on their mean.
#[derive(Debug, Clone)]
pub struct Points {
    /// n.
    pub count: usize,
    /// d.
    pub dims: usize,
    /// Mean of the body map, which is the origin here.
    centre: Vec<f64>,
    /// n rows (x_i, 1), padded to whole chunks.
    rows: Vec<Chunk>,
    /// ⌈n / BLOCK⌉ × d: coordinate k of a block of points; the last one is padded.
    blocks: Vec<[f64; BLOCK]>,
}

impl Points {
    /// Centres a body map. Clusters, joints and trees do not depend on where the origin is.
    pub fn new(map: &BodyMap) -> Self {
        let (count, dims) = (map.points(), map.dims);
        let mean = |k: usize| map.coordinates.iter().skip(k).step_by(dims).sum::<f64>() / count as f64;
        let centre: Vec<f64> = (0..dims).map(mean).collect();
        let centred = |row: &[f64]| row.iter().zip(&centre).map(|(x, m)| x - m).collect::<Vec<_>>();
        let rows = map.coordinates.chunks_exact(dims).flat_map(centred).collect();
        Self { centre: centre.clone(), ..Self::from_rows(dims, rows) }
    }

    /// Coordinates on the body map of a position among the centred points.
    pub fn uncentred(&self, position: &DVector<f64>) -> Vec<f64> {
        position.iter().zip(&self.centre).map(|(x, mean)| x + mean).collect()
    }

    /// Where the origin of the body map is among the centred points.
    pub fn origin(&self) -> DVector<f64> {
        -DVector::from_column_slice(&self.centre)
    }

    /// Takes points as they are, by rows.
    pub(crate) fn from_rows(dims: usize, rows: Vec<f64>) -> Self {
        let count = rows.len() / dims;
        let mut blocks = vec![[0.0; BLOCK]; count.div_ceil(BLOCK) * dims];
        for (i, row) in rows.chunks_exact(dims).enumerate() {
            for (k, x) in row.iter().enumerate() {
                blocks[i / BLOCK * dims + k][i % BLOCK] = *x;
            }
        }
        let rows = rows.chunks_exact(dims).flat_map(bordered).collect();
        Self { count, dims, centre: vec![0.0; dims], rows, blocks }
    }

    /// Point i.
    pub fn row(&self, i: usize) -> &[f64] {
        &self.bordered_row(i).as_flattened()[..self.dims]
    }

    /// (x_i, 1), padded.
    fn bordered_row(&self, i: usize) -> &[Chunk] {
        let width = chunks(self.dims);
        &self.rows[i * width..][..width]
    }

    /// The points, a block at a time, by coordinates.
    #[inline(always)]
    pub fn blocks(&self) -> impl Iterator<Item = &[[f64; BLOCK]]> {
        self.blocks.chunks_exact(self.dims)
    }

    /// Covariance of all points (d × d), with divisor n − 1.
    pub fn covariance(&self) -> DMatrix<f64> {
        let all: Vec<usize> = (0..self.count).collect();
        SufficientStatistics::of(self, &all).scatter() / (self.count.max(2) - 1) as f64
    }
}

/// Sufficient statistics of a set of points for a Gaussian: count, sum, and sum of outer products.
#[derive(Debug, Clone, PartialEq)]
pub struct SufficientStatistics {
    /// Σ (x, 1)(x, 1)ᵀ.
    pub moments: Augmented,
}

impl SufficientStatistics {
    /// Of no points in d dimensions.
    pub fn new(dims: usize) -> Self {
        Self { moments: Augmented::zeros(dims) }
    }

    /// Of the points of these numbers.
    pub fn of(points: &Points, members: &[usize]) -> Self {
        let mut statistics = Self::new(points.dims);
        statistics.moments.add_outer(members.iter().map(|&i| points.bordered_row(i)));
        statistics
    }

    /// Number of points.
    pub fn count(&self) -> f64 {
        self.moments.corner()
    }

    /// Adds a point.
    pub fn add(&mut self, x: &[f64]) {
        self.moments.add_outer(std::iter::once(bordered(x).as_slice()));
    }

    /// Takes a point away that was added.
    pub fn remove(&mut self, x: &[f64]) {
        let mut own = Self::new(self.moments.dims);
        own.add(x);
        self.moments.subtract(&own.moments);
    }

    /// x̄; 0 if there are no points.
    pub fn mean(&self) -> DVector<f64> {
        let count = self.count().max(1.0);
        DVector::from_iterator(self.moments.dims, self.moments.border().map(|sum| sum / count))
    }

    /// Σ (x − x̄)(x − x̄)ᵀ of at least one point.
    pub fn scatter(&self) -> DMatrix<f64> {
        let mut scatter = self.moments.clone();
        scatter.eliminate_border();
        DMatrix::from_fn(scatter.dims, scatter.dims, |i, j| scatter.row(i.min(j))[i.max(j)])
    }
}

/// (x, 1), padded.
fn bordered(x: &[f64]) -> Vec<Chunk> {
    let mut row = vec![[0.0; LANES]; chunks(x.len())];
    let flat = row.as_flattened_mut();
    flat[..x.len()].copy_from_slice(x);
    flat[x.len()] = 1.0;
    row
}
