//! Stage 5. Distances → body map: classical multidimensional scaling (Torgerson; section 4.1).
//!
//! The paper says "MDS" and cites Kruskal; which variant it ran is open, and the classical one is our
//! default. All dimensions come from one eigen-decomposition: a map of d dimensions is the first d columns
//! of any larger one.

use faer::{Mat, Side};

use crate::distance::Distances;

/// Coordinates of n points (sensors) in d dimensions.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyMap {
    /// d.
    pub dims: usize,
    /// n × d, by rows.
    pub coordinates: Vec<f64>,
}

impl BodyMap {
    /// n.
    pub fn points(&self) -> usize {
        self.coordinates.len() / self.dims
    }

    /// The first d of its dimensions.
    ///
    /// # Panics
    /// If it has fewer.
    pub fn first(&self, dims: usize) -> Self {
        let rows = self.coordinates.chunks_exact(self.dims);
        Self { dims, coordinates: rows.flat_map(|row| &row[..dims]).copied().collect() }
    }
}

/// The eigen-decomposition of the doubly centred matrix B = −½ J D² J, whose entries are the inner
/// products of the points if the distances are Euclidean.
#[derive(Debug, Clone)]
pub struct ClassicalScaling {
    /// Eigenvalues, descending; negative ones measure how far the distances are from Euclidean.
    pub eigenvalues: Vec<f64>,
    /// Their unit eigenvectors, one after the other; the entry of largest magnitude is positive.
    vectors: Vec<f64>,
}

/// A body map that cannot be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MapError {
    /// All sensors show the same.
    #[error("the {0} sensors are all at distance 0 from each other, so that there is nothing to map")]
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
    /// The eigen-decomposition failed.
    #[error("the eigen-decomposition of the {0} x {0} distances did not converge")]
    NoConvergence(usize),
}

impl ClassicalScaling {
    /// Decomposes a matrix of distances, which must be finite and symmetric.
    ///
    /// # Errors
    /// If the eigen-decomposition does not converge.
    pub fn new(distances: &Distances) -> Result<Self, MapError> {
        let n = distances.sensors;
        let squared = |i: usize, j: usize| distances.get(i, j).powi(2);
        let means: Vec<f64> = (0..n).map(|i| (0..n).map(|j| squared(i, j)).sum::<f64>() / n as f64).collect();
        let mean = means.iter().sum::<f64>() / n as f64;
        let centred = Mat::from_fn(n, n, |i, j| -0.5 * (squared(i, j) - means[i] - means[j] + mean));
        // faer's results depend on its number of threads; one is as fast at this size.
        faer::set_global_parallelism(faer::Par::Seq);
        let decomposition =
            centred.self_adjoint_eigen(Side::Lower).map_err(|_| MapError::NoConvergence(n))?;

        let ascending = decomposition.S().column_vector();
        let mut vectors = Vec::with_capacity(n * n);
        for column in (0..n).rev() {
            let vector = decomposition.U().col(column);
            let largest =
                (0..n).fold(0.0, |kept: f64, i| if vector[i].abs() > kept.abs() { vector[i] } else { kept });
            vectors.extend((0..n).map(|i| vector[i] * largest.signum()));
        }
        Ok(Self { eigenvalues: (0..n).rev().map(|i| ascending[i]).collect(), vectors })
    }

    /// Number of eigenvalues above the rounding of the largest.
    pub fn positive(&self) -> usize {
        let magnitude = self.eigenvalues.iter().fold(0.0, |kept: f64, value| kept.max(value.abs()));
        let rounding = magnitude * f64::EPSILON * self.eigenvalues.len() as f64;
        self.eigenvalues.iter().filter(|value| **value > rounding).count()
    }

    /// Share of the negative eigenvalues in the sum of all magnitudes, 0 for Euclidean distances.
    pub fn negative_share(&self) -> f64 {
        let total: f64 = self.eigenvalues.iter().map(|value| value.abs()).sum();
        // A fold from 0, since the sum of nothing is −0.
        let negative = self.eigenvalues.iter().fold(0.0, |sum, value| sum - value.min(0.0));
        if total > 0.0 { negative / total } else { 0.0 }
    }

    /// The body map in d dimensions, columns by descending eigenvalue; its mean is the origin.
    ///
    /// # Errors
    /// [`MapError::TooManyDimensions`] if fewer than `dims` eigenvalues are positive.
    pub fn coordinates(&self, dims: usize) -> Result<BodyMap, MapError> {
        let n = self.eigenvalues.len();
        let positive = self.positive();
        if positive == 0 {
            return Err(MapError::NoDifference(n));
        }
        if dims > positive {
            return Err(MapError::TooManyDimensions { dims, sensors: n, positive });
        }
        let coordinates = (0..n)
            .flat_map(|i| (0..dims).map(move |k| self.vectors[k * n + i] * self.eigenvalues[k].sqrt()))
            .collect();
        Ok(BodyMap { dims, coordinates })
    }
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use crate::streams::stream;

    fn distances(n: usize, between: impl Fn(usize, usize) -> f64) -> Distances {
        let values = (0..n * n).map(|at| between(at / n, at % n)).collect();
        Distances { sensors: n, values }
    }

    fn euclidean(map: &BodyMap, i: usize, j: usize) -> f64 {
        let row = |i: usize| &map.coordinates[i * map.dims..][..map.dims];
        row(i).iter().zip(row(j)).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
    }

    #[test]
    fn a_planted_configuration_is_recovered_up_to_rigid_motion() {
        let mut rng = stream(1, 1, "planted", 0);
        let planted =
            BodyMap { dims: 3, coordinates: (0..60).map(|_| rng.random_range(-1.0..1.0)).collect() };
        let scaling = ClassicalScaling::new(&distances(20, |i, j| euclidean(&planted, i, j))).unwrap();
        assert_eq!(scaling.positive(), 3);
        assert!(scaling.negative_share() < 1e-12);
        let found = scaling.coordinates(3).unwrap();
        for (i, j) in (0..20).flat_map(|i| (0..20).map(move |j| (i, j))) {
            assert!((euclidean(&found, i, j) - euclidean(&planted, i, j)).abs() < 1e-10);
        }
        assert_eq!(
            scaling.coordinates(4).unwrap_err(),
            MapError::TooManyDimensions { dims: 4, sensors: 20, positive: 3 }
        );
    }

    #[test]
    fn fewer_dimensions_are_the_first_columns() {
        let scaling =
            ClassicalScaling::new(&distances(6, |i, j| (i as f64 - j as f64).abs().sqrt())).unwrap();
        let (two, four) = (scaling.coordinates(2).unwrap(), scaling.coordinates(4).unwrap());
        for i in 0..6 {
            assert_eq!(two.coordinates[2 * i..][..2], four.coordinates[4 * i..][..2]);
        }
        assert!(scaling.eigenvalues.windows(2).all(|pair| pair[0] >= pair[1]));
    }

    #[test]
    fn distances_that_are_not_euclidean_show_negative_eigenvalues() {
        // Four points, three of them pairwise at 2, all at 1 from the fourth: no such points exist.
        let star = distances(4, |i, j| {
            if i == j {
                0.0
            } else if i * j == 0 {
                1.0
            } else {
                2.0
            }
        });
        assert!(ClassicalScaling::new(&star).unwrap().negative_share() > 0.05);
    }

    #[test]
    fn equal_sensors_span_nothing() {
        let scaling = ClassicalScaling::new(&distances(3, |_, _| 0.0)).unwrap();
        assert_eq!((scaling.positive(), scaling.negative_share()), (0, 0.0));
        assert!(scaling.coordinates(1).is_err());
    }
}
