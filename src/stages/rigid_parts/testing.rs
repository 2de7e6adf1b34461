//! What sensors feel, for tests.

use faer::Mat;

use super::cluster::{Felt, ITERATIONS, LEAST_TOLERANCE};
use super::completion::Completion;
use super::roots::Roots;

/// What sensors with these velocities along their normals, samples × sensors, feel: what is positive. Also their affinities.
pub(super) fn felt_of(velocities: &Mat<f64>) -> (Felt, Mat<f64>) {
    let samples = velocities.nrows();
    let values = Mat::from_fn(samples, velocities.ncols(), |t, sensor| velocities[(t, sensor)].max(0.0));
    let sizes = vec![1.0; samples];
    let roots = Roots { values, thresholds: sizes.clone(), signed: false };
    let scales = roots.scales();
    let roots = roots.scaled(&scales).equalised(&sizes, 0.0);
    let completion = Completion::new(&roots);
    let (completed, iterations) = (completion.velocities, ITERATIONS);
    (Felt { roots, completed, sizes, tolerance: LEAST_TOLERANCE, iterations }, completion.affinities)
}
