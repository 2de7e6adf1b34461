//! Hold what the sensors of a body felt, and choose the informative samples: those at which it moves least like one rigid body.

use super::cluster::MAX_SENSORS;
use super::roots::Roots;
use super::stratified::stratified;
use crate::stages::distance::Distances;

/// Informative samples: for the many seed clusters, and for the few parts.
pub(super) const SAMPLES: [usize; 2] = [250, 2000];
/// Samples, for each informative one, that it is chosen from, spread over all.
const CANDIDATES: usize = 4;
/// Iterations in which the motion of the body as a whole is learned.
const ITERATIONS: usize = 3;

/// What some sensors of a body felt.
pub(super) struct Observations<'a> {
    /// The series of each sensor.
    pub series: Vec<&'a [f32]>,
    /// Whether negative pressures are signal.
    pub signed: bool,
    /// Distances between the sensors.
    pub distances: &'a Distances,
}

impl Observations<'_> {
    /// The normalised roots of some sensors at some samples.
    pub(super) fn roots(&self, sensors: &[usize], samples: &[usize]) -> Roots {
        let series: Vec<&[f32]> = sensors.iter().map(|&sensor| self.series[sensor]).collect();
        Roots::at(&series, samples, self.signed).normalised()
    }

    /// [`SAMPLES`] at which one motion leaves the largest residuals, of [`CANDIDATES`] times as many, rising. While joints are
    /// locked, several parts move as one, and samples do not separate them.
    pub(super) fn informative_samples(&self, sensors: &[usize]) -> [Vec<usize>; 2] {
        let some: Vec<usize> = stratified(sensors.len(), MAX_SENSORS).map(|at| sensors[at]).collect();
        SAMPLES.map(|count| {
            let samples: Vec<usize> = stratified(self.series[0].len(), CANDIDATES * count).collect();
            let roots = self.roots(&some, &samples);
            let start = roots.start();
            let fit = roots.fit(&start, start.max_rank(), ITERATIONS);
            let mut order: Vec<(f64, usize)> =
                roots.residuals_of_samples(&fit).into_iter().zip(samples).collect();
            order.sort_by(|a, b| b.0.total_cmp(&a.0));
            let mut chosen: Vec<usize> = order.into_iter().take(count).map(|(_, t)| t).collect();
            chosen.sort_unstable();
            chosen
        })
    }

    /// The distances between some sensors.
    pub(super) fn distances_between(&self, sensors: &[usize]) -> Distances {
        let values = sensors.iter().flat_map(|&i| sensors.iter().map(move |&j| self.distances.get(i, j)));
        Distances { sensors: sensors.len(), values: values.collect() }
    }
}
