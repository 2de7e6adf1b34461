//! Body map → the points x_i of the mixture, laid out for the sampler's two inner loops.

use nalgebra::{DMatrix, DVector};
use pulp::{Arch, Simd, WithSimd};

use super::gaussian::Gaussian;
use crate::body_map::BodyMap;

/// Points evaluated side by side, so that the loop over them becomes vector instructions.
const LANES: usize = 32;

/// n points in d dimensions, centred on their mean.
#[derive(Debug, Clone)]
pub struct Points {
    /// n.
    pub count: usize,
    /// d.
    pub dims: usize,
    /// n × d, by rows.
    rows: Vec<f64>,
    /// ⌈n / LANES⌉ blocks of d × LANES: the same, a block of points at a time; the last one is padded.
    blocks: Vec<f64>,
}

impl Points {
    /// Centres a body map. Clusters, joints and trees do not depend on where the origin is.
    pub fn new(map: &BodyMap) -> Self {
        let (count, dims) = (map.points(), map.dims);
        let mean = |k: usize| map.coordinates.iter().skip(k).step_by(dims).sum::<f64>() / count as f64;
        let means: Vec<f64> = (0..dims).map(mean).collect();
        let centred = |row: &[f64]| row.iter().zip(&means).map(|(x, m)| x - m).collect::<Vec<_>>();
        Self::from_rows(dims, map.coordinates.chunks_exact(dims).flat_map(centred).collect())
    }

    /// Takes points as they are, by rows.
    pub(crate) fn from_rows(dims: usize, rows: Vec<f64>) -> Self {
        let count = rows.len() / dims;
        let mut blocks = vec![0.0; count.div_ceil(LANES) * dims * LANES];
        for (i, row) in rows.chunks_exact(dims).enumerate() {
            for (k, x) in row.iter().enumerate() {
                blocks[(i / LANES * dims + k) * LANES + i % LANES] = *x;
            }
        }
        Self { count, dims, rows, blocks }
    }

    /// Point i.
    pub fn row(&self, i: usize) -> &[f64] {
        &self.rows[i * self.dims..][..self.dims]
    }

    /// Covariance of all points (d × d), with divisor n − 1.
    pub fn covariance(&self) -> DMatrix<f64> {
        let mut total = Statistics::new(self.dims);
        (0..self.count).for_each(|i| total.add(self.row(i)));
        total.scatter() / (self.count.max(2) - 1) as f64
    }

    /// Writes log N(x_i; μ, Σ) for all i to `densities`, whose length is a whole number of blocks
    /// ([`Points::padded`]); entries from n on are meaningless.
    pub fn log_densities(&self, gaussian: &Gaussian, densities: &mut [f64]) {
        Arch::new().dispatch(LogDensities { points: self, gaussian, densities });
    }

    /// n rounded up to whole blocks.
    pub fn padded(&self) -> usize {
        self.count.next_multiple_of(LANES)
    }
}

/// [`Points::log_densities`], compiled once for each set of vector instructions and chosen at run time.
///
/// Lanes never mix and `mul_add` rounds once on any machine, so all of them give the same bits.
struct LogDensities<'a> {
    points: &'a Points,
    gaussian: &'a Gaussian,
    densities: &'a mut [f64],
}

impl WithSimd for LogDensities<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let dims = self.points.dims;
        let mut offsets = vec![[0.0; LANES]; dims];
        for (block, densities) in
            self.points.blocks.chunks_exact(dims * LANES).zip(self.densities.chunks_exact_mut(LANES))
        {
            for ((offset, x), mean) in
                offsets.iter_mut().zip(block.chunks_exact(LANES)).zip(self.gaussian.mean.iter())
            {
                for lane in 0..LANES {
                    offset[lane] = x[lane] - mean;
                }
            }
            // |P (x − μ)|² row by row of the lower triangular P.
            let mut squares = [0.0; LANES];
            for i in 0..dims {
                let mut whitened = [0.0; LANES];
                for (root, offset) in self.gaussian.root_row(i).iter().zip(&offsets) {
                    for lane in 0..LANES {
                        whitened[lane] = root.mul_add(offset[lane], whitened[lane]);
                    }
                }
                for lane in 0..LANES {
                    squares[lane] = whitened[lane].mul_add(whitened[lane], squares[lane]);
                }
            }
            for lane in 0..LANES {
                densities[lane] = self.gaussian.log_peak - 0.5 * squares[lane];
            }
        }
    }
}

/// Sufficient statistics of a set of points for a Gaussian: count, sum, and sum of outer products.
#[derive(Debug, Clone, PartialEq)]
pub struct Statistics {
    /// Number of points.
    pub count: f64,
    /// Σ x.
    pub sum: DVector<f64>,
    /// Σ x xᵀ; only the lower triangle is kept.
    pub outer: DMatrix<f64>,
}

impl Statistics {
    /// Of no points in d dimensions.
    pub fn new(dims: usize) -> Self {
        Self { count: 0.0, sum: DVector::zeros(dims), outer: DMatrix::zeros(dims, dims) }
    }

    /// Forgets all points.
    pub fn clear(&mut self) {
        self.count = 0.0;
        self.sum.fill(0.0);
        self.outer.fill(0.0);
    }

    /// Adds a point.
    pub fn add(&mut self, x: &[f64]) {
        self.count += 1.0;
        let dims = x.len();
        for (sum, x) in self.sum.iter_mut().zip(x) {
            *sum += x;
        }
        for (j, column) in self.outer.as_mut_slice().chunks_exact_mut(dims).enumerate() {
            for (entry, xi) in column[j..].iter_mut().zip(&x[j..]) {
                *entry += xi * x[j];
            }
        }
    }

    /// Σ (x − x̄)(x − x̄)ᵀ, both triangles; zero for no points.
    fn scatter(&self) -> DMatrix<f64> {
        let correction = &self.sum * self.sum.transpose() / self.count.max(1.0);
        let mut scatter = &self.outer - correction;
        scatter.fill_upper_triangle_with_lower_triangle();
        scatter
    }
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use crate::streams::stream;

    #[test]
    fn densities_agree_with_the_textbook_in_all_dimensions_and_on_any_processor() {
        let mut rng = stream(1, 1, "densities", 0);
        for dims in 1..=15 {
            let rows: Vec<f64> = (0..37 * dims).map(|_| rng.random_range(-2.0..2.0)).collect();
            let points = Points::from_rows(dims, rows);
            let mean = DVector::from_fn(dims, |_, _| rng.random_range(-1.0..1.0));
            let root = DMatrix::from_fn(dims, dims, |i, j| match i.cmp(&j) {
                std::cmp::Ordering::Less => 0.0,
                std::cmp::Ordering::Equal => rng.random_range(0.5..2.0),
                std::cmp::Ordering::Greater => rng.random_range(-0.5..0.5),
            });
            let gaussian = Gaussian::new(mean.clone(), root.clone());
            let mut found = vec![0.0; points.padded()];
            points.log_densities(&gaussian, &mut found);

            let covariance = (root.transpose() * &root).try_inverse().unwrap();
            let determinant = covariance.determinant();
            let inverse = covariance.try_inverse().unwrap();
            for (i, found) in found.iter().enumerate().take(points.count) {
                let offset = DVector::from_row_slice(points.row(i)) - &mean;
                let square = (offset.transpose() * &inverse * &offset)[0];
                let textbook =
                    -0.5 * (square + determinant.ln() + dims as f64 * (2.0 * std::f64::consts::PI).ln());
                assert!((found - textbook).abs() < 1e-9, "d = {dims}: {found} {textbook}");
            }

            let mut portable = vec![0.0; points.padded()];
            LogDensities { points: &points, gaussian: &gaussian, densities: &mut portable }
                .with_simd(pulp::Scalar::new());
            assert_eq!(found, portable, "the same bits without vector instructions");
        }
    }
}
