//! Compute with the small matrices of the sampler: sums of outer products, Cholesky factors and triangular systems over
//! rows (x, 1).
//!
//! The 1 is a border: with it, one matrix holds the count, the sum and the outer products of points, and
//! another the precision of a Gaussian and its pull. Rows are padded to whole chunks of [`LANES`], so that
//! the innermost loops become vector instructions: that halves the time of all updates but the labels',
//! against a library of general matrices.

#[cfg(test)]
use nalgebra::{DMatrix, DVector};

use crate::numerics::simd::vectorised;

/// Numbers that are computed side by side.
pub(super) const LANES: usize = 8;

/// A piece of a row.
pub(super) type Chunk = [f64; LANES];

/// A matrix over (x, 1), x in d dimensions: symmetric or upper triangular, of which the upper triangle is
/// kept, or the rows (P, −P μ) of a Gaussian.
#[derive(Debug, Clone, PartialEq)]
pub struct Augmented {
    /// d.
    pub dims: usize,
    /// As many rows as a row has numbers: d, the border, and padding.
    rows: Vec<Chunk>,
}

/// Chunks of a row.
pub(super) fn chunks(dims: usize) -> usize {
    (dims + 1).div_ceil(LANES)
}

impl Augmented {
    /// Zero.
    pub fn zeros(dims: usize) -> Self {
        Self { dims, rows: vec![[0.0; LANES]; chunks(dims).pow(2) * LANES] }
    }

    /// Row i: d numbers, the border, and padding.
    #[inline(always)]
    pub fn row(&self, i: usize) -> &[f64] {
        let width = chunks(self.dims);
        self.rows[i * width..][..width].as_flattened()
    }

    /// The same, to change.
    #[inline(always)]
    pub fn row_mut(&mut self, i: usize) -> &mut [f64] {
        let width = chunks(self.dims);
        self.rows[i * width..][..width].as_flattened_mut()
    }

    /// The border's own entry.
    pub fn corner(&self) -> f64 {
        self.row(self.dims)[self.dims]
    }

    /// The border's entry of each row.
    pub fn border(&self) -> impl Iterator<Item = f64> {
        (0..self.dims).map(|i| self.row(i)[self.dims])
    }

    /// The first d rows.
    pub fn body(&self) -> impl Iterator<Item = &[Chunk]> + Clone {
        self.rows.chunks_exact(chunks(self.dims)).take(self.dims)
    }

    /// Adds another.
    pub fn add(&mut self, other: &Self) {
        self.rows.as_flattened_mut().iter_mut().zip(other.rows.as_flattened()).for_each(|(x, y)| *x += y);
    }

    /// Subtracts another.
    pub fn subtract(&mut self, other: &Self) {
        self.rows.as_flattened_mut().iter_mut().zip(other.rows.as_flattened()).for_each(|(x, y)| *x -= y);
    }

    /// Adds the outer products of rows.
    pub fn add_outer<'a>(&mut self, rows: impl Iterator<Item = &'a [Chunk]> + Clone) {
        vectorised(
            #[inline(always)]
            || self.add_outer_in_lanes(rows.clone()),
        );
    }

    #[inline(always)]
    fn add_outer_in_lanes<'a>(&mut self, rows: impl Iterator<Item = &'a [Chunk]> + Clone) {
        let width = chunks(self.dims);
        // Tile by tile, so that a tile stays in registers for all rows.
        for down in 0..width {
            for across in down..width {
                let mut tile = [[0.0; LANES]; LANES];
                for row in rows.clone() {
                    for (sums, x) in tile.iter_mut().zip(&row[down]) {
                        multiply_add(sums, *x, &row[across]);
                    }
                }
                for (i, sums) in tile.iter().enumerate() {
                    let target = &mut self.rows[(down * LANES + i) * width + across];
                    target.iter_mut().zip(sums).for_each(|(target, sum)| *target += sum);
                }
            }
        }
    }

    /// A symmetric matrix with its border eliminated: A − b bᵀ / c, c the corner.
    pub fn eliminate_border(&mut self) {
        vectorised(
            #[inline(always)]
            || self.eliminate_border_in_lanes(),
        );
    }

    #[inline(always)]
    fn eliminate_border_in_lanes(&mut self) {
        let (width, corner) = (chunks(self.dims), self.corner());
        let mut scaled = vec![[0.0; LANES]; width];
        scaled.as_flattened_mut().iter_mut().zip(self.border()).for_each(|(scaled, b)| *scaled = b / corner);
        for row in self.rows.chunks_exact_mut(width).take(self.dims) {
            let b = row.as_flattened()[self.dims];
            row.iter_mut().zip(&scaled).for_each(|(target, scaled)| multiply_add(target, -b, scaled));
        }
    }

    /// Cholesky: a symmetric A turns into the upper triangular U with A = Uᵀ U; its border b turns into
    /// U⁻ᵀ b. `None` if A is not positive definite.
    pub fn factor(mut self) -> Option<Self> {
        vectorised(
            #[inline(always)]
            || self.factor_in_lanes(),
        )
        .then_some(self)
    }

    #[inline(always)]
    fn factor_in_lanes(&mut self) -> bool {
        let (dims, width) = (self.dims, chunks(self.dims));
        for k in 0..dims {
            let (above, below) = self.rows.split_at_mut((k + 1) * width);
            let row = &mut above[k * width..];
            let pivot = row.as_flattened()[k];
            if pivot <= 0.0 || !pivot.is_finite() {
                return false;
            }
            let inverse = 1.0 / pivot.sqrt();
            row[k / LANES..].as_flattened_mut().iter_mut().for_each(|x| *x *= inverse);
            for (j, target) in (k + 1..dims).zip(below.chunks_exact_mut(width)) {
                let factor = -row.as_flattened()[j];
                let from = j / LANES;
                for (target, x) in target[from..].iter_mut().zip(&row[from..]) {
                    multiply_add(target, factor, x);
                }
            }
        }
        true
    }

    /// U⁻¹ B for upper triangular U (this) and B, borders apart.
    pub fn solve(&self, columns: &mut Self) {
        vectorised(
            #[inline(always)]
            || self.solve_in_lanes(columns),
        );
    }

    #[inline(always)]
    fn solve_in_lanes(&self, columns: &mut Self) {
        let width = chunks(self.dims);
        for j in (0..self.dims).rev() {
            let (above, below) = columns.rows.split_at_mut(j * width);
            let from = j / LANES;
            let solved = &mut below[from..width];
            let inverse = 1.0 / self.row(j)[j];
            solved.as_flattened_mut().iter_mut().for_each(|x| *x *= inverse);
            for (i, target) in above.chunks_exact_mut(width).enumerate() {
                let factor = -self.row(i)[j];
                for (target, x) in target[from..].iter_mut().zip(&*solved) {
                    multiply_add(target, factor, x);
                }
            }
        }
    }

    /// x with U x = y for upper triangular U (this), borders apart; y turns into x.
    pub fn solve_vector(&self, y: &mut [f64]) {
        for j in (0..self.dims).rev() {
            let x = y[j] / self.row(j)[j];
            y[j] = x;
            for (i, y) in y[..j].iter_mut().enumerate() {
                *y -= self.row(i)[j] * x;
            }
        }
    }

    /// Sum of the logarithms of the diagonal.
    pub fn log_diagonal(&self) -> f64 {
        (0..self.dims).map(|i| self.row(i)[i].ln()).sum()
    }
}

/// sums += factor × chunk.
#[inline(always)]
fn multiply_add(sums: &mut Chunk, factor: f64, chunk: &Chunk) {
    for lane in 0..LANES {
        sums[lane] = factor.mul_add(chunk[lane], sums[lane]);
    }
}

#[cfg(test)]
impl Augmented {
    /// The upper triangle, without the border.
    pub fn upper(&self) -> DMatrix<f64> {
        DMatrix::from_fn(self.dims, self.dims, |i, j| if i <= j { self.row(i)[j] } else { 0.0 })
    }
}

#[cfg(test)]
mod tests;
