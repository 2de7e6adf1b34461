//! Prepare pressures for a search: their roots at telling samples, in the units of each sensor and of each sample, and what completes
//! them.

use super::cluster::{Cluster, Felt, ITERATIONS};
use super::completion::Completion;
use super::floor::{floors, telling_samples, typical_floor};
use super::memory::Memory;
use super::roots::Roots;
use super::search::Search;
use super::subspace::{Loadings, MotionSubspace};
use crate::stages::parameters::Parameters;
use crate::stages::sense::Tactile;

/// What M sensors felt, and which of it is searched.
pub(super) struct Prepared<'a> {
    /// T pressures of each sensor.
    pub series: Vec<&'a [f32]>,
    /// Whether negative pressures are signal.
    signed: bool,
    /// Those that are searched.
    pub samples: Vec<usize>,
    /// The least root that is felt, in units of the root mean square of a sensor.
    floor: f64,
    /// The root mean square of each sensor's roots at these samples, √Pa, which they were divided by.
    pub scales: Vec<f64>,
    /// The size that the roots at each sample were divided by.
    pub sizes: Vec<f64>,
    /// At these samples, of all sensors; scaled by sensor and by sample.
    pub roots: Roots,
    /// The parameters of the search.
    parameters: Parameters,
}

impl<'a> Prepared<'a> {
    /// Of M × T pressures, of which those of `sensors` are searched.
    pub(super) fn new(
        tactile: &'a Tactile,
        signed: bool,
        sensors: &[usize],
        parameters: &Parameters,
    ) -> Self {
        let series: Vec<&[f32]> = tactile.series().collect();
        let floors = floors(&series, signed);
        let searched: Vec<f64> = sensors.iter().map(|&sensor| floors[sensor]).collect();
        let samples = telling_samples(&series_of(&series, sensors), signed, &searched, parameters.samples);
        let roots = Roots::at(&series, &samples, signed);
        let scales = roots.scales();
        let floor = typical_floor(&floors, &scales);
        let roots = roots.scaled(&scales);
        let sizes = roots.select(sensors).sizes();
        Self {
            roots: roots.equalised(&sizes, floor),
            series,
            signed,
            samples,
            floor,
            scales,
            sizes,
            parameters: *parameters,
        }
    }

    /// A search among these sensors.
    pub(super) fn search(&self, sensors: &[usize]) -> Search {
        let roots = self.roots.select_as_they_are(sensors);
        let Completion { velocities, affinities } = Completion::new(&roots, self.parameters.completion_ridge);
        let felt = Felt {
            roots,
            completed: velocities,
            sizes: self.sizes.clone(),
            tolerance: 0.0,
            iterations: ITERATIONS,
            parameters: self.parameters,
            memory: Memory::default(),
        };
        Search::new(felt, affinities)
    }

    /// The motion at all T samples of a cluster that was found among these sensors.
    pub(super) fn motion(&self, cluster: &Cluster, sensors: &[usize]) -> MotionSubspace {
        let own: Vec<usize> = cluster.representatives.iter().map(|&sensor| sensors[sensor]).collect();
        let series = series_of(&self.series, &own);
        let given = Loadings {
            values: cluster.whitened_loadings(),
            scales: Roots::at(&series, &self.samples, self.signed).scales(),
            deviation: cluster.variance().sqrt(),
            floor: self.floor,
        };
        MotionSubspace::of_loadings(&series, &given, self.signed)
    }
}

/// The series of these sensors.
pub(super) fn series_of<'a>(series: &[&'a [f32]], sensors: &[usize]) -> Vec<&'a [f32]> {
    sensors.iter().map(|&sensor| series[sensor]).collect()
}
