//! What sensors feel, for tests.

use faer::Mat;
use rand::RngExt;

use super::cluster::{Felt, ITERATIONS};
use super::completion::Completion;
use super::memory::Memory;
use super::roots::{Roots, product};
use super::search::Search;
use crate::numerics::rng::stream;
use crate::stages::parameters::Parameters;

/// Sensors of each pair of opposite faces.
const SENSORS: usize = 10;
/// Pairs of opposite faces of a box.
const PAIRS: usize = 3;

/// What sensors with these velocities along their normals, samples × sensors, feel: what is positive. Also their affinities.
pub(super) fn felt_of(velocities: &Mat<f64>) -> (Felt, Mat<f64>) {
    let samples = velocities.nrows();
    let values = Mat::from_fn(samples, velocities.ncols(), |t, sensor| velocities[(t, sensor)].max(0.0));
    let sizes = vec![1.0; samples];
    let roots = Roots { values, thresholds: sizes.clone(), signed: false };
    let scales = roots.scales();
    let roots = roots.scaled(&scales).equalised(&sizes, 0.0);
    let parameters = Parameters::default();
    let completion = Completion::new(&roots, parameters.completion_ridge);
    let (completed, iterations) = (completion.velocities, ITERATIONS);
    let memory = Memory::default();
    let felt =
        Felt { roots, completed, sizes, tolerance: parameters.min_tolerance, iterations, parameters, memory };
    (felt, completion.affinities)
}

/// The sensors of the faces of a box whose normals lie along an axis. The hinge lies along axis 0.
pub(super) fn pair(part: usize, axis: usize) -> Vec<usize> {
    let first = (part * PAIRS + axis) * SENSORS;
    (first..first + SENSORS).collect()
}

/// The sensors of some pairs of faces.
pub(super) fn pairs(of: &[(usize, usize)]) -> Vec<usize> {
    of.iter().flat_map(|&(part, axis)| pair(part, axis)).collect()
}

/// What two boxes feel that a hinge joins. They move independently, but for the velocity along the hinge. Places are measured from it. Each
/// moves with so many degrees of freedom: with five, it does not turn about its axis 2.
pub(super) fn hinged_boxes(degrees: usize) -> Search {
    let mut rng = stream(5, 1, "regrouping", 0);
    let mut uniform = |rows, columns| Mat::from_fn(rows, columns, |_, _| rng.random_range(-1.0_f64..1.0));
    let (first, mut second) = (uniform(600, 6), uniform(600, 6));
    second.col_mut(0).copy_from(first.col(0));
    let velocities: Vec<Mat<f64>> = [first, second]
        .iter()
        .map(|motion| {
            let places = uniform(3, PAIRS * SENSORS);
            // Velocity along the normal n at the place r: n · v + (r × n) · ω.
            let own = Mat::from_fn(6, PAIRS * SENSORS, |at, sensor| {
                let axis = sensor / SENSORS;
                let [next, last] = [(axis + 1) % 3, (axis + 2) % 3];
                let side = if sensor % 2 == 0 { 1.0 } else { -1.0 };
                let value = match at {
                    at if at >= degrees => 0.0,
                    at if at == axis => 1.0,
                    at if at == 3 + next => places[(last, sensor)],
                    at if at == 3 + last => -places[(next, sensor)],
                    _ => 0.0,
                };
                side * value
            });
            product(motion.as_ref(), own.as_ref())
        })
        .collect();
    let count = PAIRS * SENSORS;
    let (felt, affinities) =
        felt_of(&Mat::from_fn(600, 2 * count, |t, sensor| velocities[sensor / count][(t, sensor % count)]));
    Search::new(felt, affinities)
}
