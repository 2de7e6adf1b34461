//! A search for tests: of sensors that feel these velocities.

use faer::Mat;

use super::cluster::{Felt, ITERATIONS, LEAST_TOLERANCE};
use super::completion::Completion;
use super::roots::Roots;
use super::search::Search;

impl Search {
    /// Of sensors with these velocities along their normals, samples × sensors, of which they feel what is positive.
    pub(super) fn of_velocities(velocities: &Mat<f64>) -> Self {
        let samples = velocities.nrows();
        let values = Mat::from_fn(samples, velocities.ncols(), |t, sensor| velocities[(t, sensor)].max(0.0));
        let sizes = vec![1.0; samples];
        let roots = Roots { values, thresholds: sizes.clone(), signed: false };
        let scales = roots.scales();
        let roots = roots.scaled(&scales).equalised(&sizes, 0.0);
        let completion = Completion::new(&roots);
        let (completed, iterations) = (completion.velocities, ITERATIONS);
        let felt = Felt { roots, completed, sizes, tolerance: LEAST_TOLERANCE, iterations };
        Self::new(felt, completion.affinities)
    }
}
