//! Make a body map from distances by classical multidimensional scaling (Torgerson; section 4.1).
//!
//! The paper says "MDS" and cites Kruskal; which variant it ran is open, and the classical one is our
//! default; [majorisation](crate::stages::body_map::smacof()) starts from it. All dimensions come from one
//! eigen-decomposition: a map of d dimensions is the first d columns of any larger one.

use faer::MatRef;
use rayon::prelude::*;

use super::coordinates::BodyMap;
use crate::numerics::eigen::{Eigen, NoConvergence, largest};
use crate::stages::distance::Distances;

/// The largest eigenvalues of the doubly centred matrix B = −½ J D² J, whose entries are the inner products of
/// the points if the distances are Euclidean.
#[derive(Debug, Clone)]
pub struct ClassicalScaling {
    /// The largest eigenvalues, descending; all of them if there are no more than were asked for.
    pub eigenvalues: Vec<f64>,
    /// Their unit eigenvectors, one after the other; the entry of largest magnitude is positive.
    vectors: Vec<f64>,
    /// n.
    sensors: usize,
    /// Sum of the squares of all eigenvalues: of all entries of B.
    squares: f64,
}

/// A body map that cannot be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MapError {
    /// All distances are 0.
    #[error("the {0} sensors are all at distance 0 from each other; there is nothing to map")]
    NoDifference(usize),
    /// More dimensions than the distances span.
    #[error(
        "{dims} dimensions were asked for, but the distances between {sensors} sensors span only {positive} \
         (positive eigenvalues); ask for at most {positive}"
    )]
    TooManyDimensions {
        /// Asked for.
        dims: usize,
        /// Number of sensors.
        sensors: usize,
        /// Number of positive eigenvalues.
        positive: usize,
    },
    /// Distances whose squares overflow or underflow.
    #[error(
        "the largest distance is {0:e}, which is too large or too small for floating-point arithmetic; rescale the distances"
    )]
    Scale(f64),
    /// The eigen-decomposition failed.
    #[error("the eigen-decomposition of the {0} x {0} distances did not converge")]
    NoConvergence(usize),
}

impl ClassicalScaling {
    /// Decomposes a matrix of distances, which must be finite and symmetric, for maps of up to `dims`
    /// dimensions.
    ///
    /// # Errors
    /// If the largest distance is outside 1e-50 to 1e50, or the eigen-decomposition does not converge.
    pub fn new(distances: &Distances, dims: usize) -> Result<Self, MapError> {
        let n = distances.sensors;
        let longest = distances.values.iter().copied().fold(0.0, f64::max);
        if longest > 0.0 && !(1e-50..=1e50).contains(&longest) {
            return Err(MapError::Scale(longest));
        }
        let centred = inner_products(distances);
        let squared = |row: &[f64]| row.iter().map(|product| product.powi(2)).sum::<f64>();
        let squares = centred.chunks_exact(n).map(squared).sum();
        let Eigen { values, vectors } = largest(MatRef::from_row_major_slice(&centred, n, n), dims)
            .map_err(|NoConvergence| MapError::NoConvergence(n))?;
        let vectors = vectors.col_iter().flat_map(|vector| {
            let largest =
                vector.iter().fold(0.0, |kept: f64, x| if x.abs() > kept.abs() { *x } else { kept });
            vector.iter().map(move |x| x * largest.signum())
        });
        Ok(Self { vectors: vectors.collect(), eigenvalues: values, sensors: n, squares })
    }

    /// How many of the computed eigenvalues are above rounding error. This is the number of all positive ones if it
    /// is below the number of dimensions asked for. 0 if no sensor differs from another.
    pub fn positive(&self) -> usize {
        let rounding = self.squares.sqrt() * f64::EPSILON * self.sensors as f64;
        self.eigenvalues.iter().filter(|value| **value > rounding).count()
    }

    /// How well a map of d dimensions agrees with the distances: the sum of the squares of its eigenvalues, as a
    /// share of that of all, negative ones too (α₂ of Mardia, Kent & Bibby, Multivariate Analysis, 1979, section 14.4).
    /// 1 if the points of the map have these distances, 0 if all distances are 0.
    pub fn agreement(&self, dims: usize) -> f64 {
        let kept: f64 = self.eigenvalues.iter().take(dims).map(|value| value.powi(2)).sum();
        if self.squares > 0.0 { kept / self.squares } else { 0.0 }
    }

    /// The body map in d dimensions, columns by descending eigenvalue; its mean is the origin.
    ///
    /// # Errors
    /// [`MapError::TooManyDimensions`] if fewer than `dims` eigenvalues are positive.
    ///
    /// # Panics
    /// If `dims` is more than the decomposition was made for.
    pub fn coordinates(&self, dims: usize) -> Result<BodyMap, MapError> {
        let n = self.sensors;
        let positive = self.positive();
        if positive == 0 {
            return Err(MapError::NoDifference(n));
        }
        if dims > positive {
            assert!(positive < self.eigenvalues.len(), "decomposed for {positive} dimensions only");
            return Err(MapError::TooManyDimensions { dims, sensors: n, positive });
        }
        let coordinates = (0..n)
            .flat_map(|i| (0..dims).map(move |k| self.vectors[k * n + i] * self.eigenvalues[k].sqrt()))
            .collect();
        Ok(BodyMap { dims, coordinates })
    }
}

/// B = −½ J D² J, n × n, exactly symmetric.
fn inner_products(distances: &Distances) -> Vec<f64> {
    let n = distances.sensors;
    let squares = |i: usize| distances.values[i * n..][..n].iter().map(|distance| distance.powi(2));
    let means: Vec<f64> = (0..n).into_par_iter().map(|i| squares(i).sum::<f64>() / n as f64).collect();
    let mean = means.iter().sum::<f64>() / n as f64;
    let mut centred = vec![0.0; n * n];
    centred.par_chunks_exact_mut(n).enumerate().for_each(|(i, row)| {
        for ((entry, square), other) in row.iter_mut().zip(squares(i)).zip(&means) {
            *entry = -0.5 * (square - (means[i] + other) + mean);
        }
    });
    centred
}

#[cfg(test)]
mod tests;
