//! Estimate the parts of a body: which sensors move rigidly together, and how many parts there are.
//!
//! Neighbouring sensors form seed clusters, which are merged into clusters of one motion each, from [several
//! starts](super::starts). Clusters that one motion does not explain are [split](super::split). At last, clusters that share
//! nothing with the rest of a part, such as the ends of cylinders, stay [unassigned](RigidParts::unassigned).

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::cluster::Cluster;
use super::observations::Observations;
use super::roots::{Roots, is_signed};
use super::search::{ITERATIONS, Search, members, smallest};
use super::starts::SEED_SIZES;
use crate::numerics::partition::named_by_appearance;
use crate::stages::distance::Distances;
use crate::stages::sense::Tactile;

/// The part of each of M sensors, and how well its motion explains what the sensor feels.
///
/// A residual is the share of the mean square of a sensor's roots that the motion of a part leaves unexplained: 0 if it explains
/// everything, 1 if nothing.
#[derive(Debug, Clone, PartialEq)]
pub struct RigidParts {
    /// The part of each sensor, 0, 1, … in order of appearance.
    pub labels: Vec<usize>,
    /// The residual of each sensor, by the motion of the cluster that it came to its part with.
    pub residuals: Vec<f64>,
    /// For each sensor, the other parts and its residual by their motions, the smallest first.
    pub alternatives: Vec<Vec<(usize, f64)>>,
    /// Labels of clusters that feel too little to be parts: they are on other parts, but their motion does not say on which. The
    /// joints do, and [`estimate`](crate::estimate::estimate) leaves none.
    pub unassigned: Vec<usize>,
}

/// Estimates the parts.
///
/// In: M × T pressures, finite and of any sign, of sensors that all change; and the distances between `sensors`, at least
/// [`MIN_SENSORS`](super::MIN_SENSORS) of them, rising and spread over all. The motions of parts are learned from these; the other
/// sensors are assigned to the part with the smallest residual. Out: the part of all M sensors. No random numbers are drawn, and
/// the number of threads changes no bit.
///
/// # Panics
/// If `sensors` is empty or names a sensor beyond M, `distances` is of fewer sensors, or T is 0.
pub fn rigid_parts(tactile: &Tactile, sensors: &[usize], distances: &Distances) -> RigidParts {
    let signed = is_signed(tactile);
    let all: Vec<&[f32]> = tactile.series().collect();
    let some: Vec<&[f32]> = sensors.iter().map(|&sensor| all[sensor]).collect();
    let observations = Observations { series: some, signed, distances };
    let every: Vec<usize> = (0..sensors.len()).collect();
    let samples = observations.informative_samples(&every);
    let found = observations.clustered(&every, &samples, &SEED_SIZES);
    let labels = observations.split(found.clone());
    let fine =
        Search { roots: observations.roots(&every, &samples[1]), distances, iterations: ITERATIONS[1] };
    let clusters = fine.clusters(members(&labels), Vec::new());
    let clusters = if labels == found { clusters } else { fine.assigned(clusters, true) };
    let (parts, unassigned) = fine.parts_and_unassigned(clusters);
    of_all(&parts, &unassigned, &Roots::at(&all, &samples[1], signed).normalised())
}

/// Assigns all sensors to the cluster with the smallest residual.
fn of_all(parts: &[Cluster], unassigned: &[Cluster], all: &Roots) -> RigidParts {
    let clusters: Vec<&Cluster> = parts.iter().chain(unassigned).collect();
    let residuals: Vec<Vec<f64>> = clusters.par_iter().map(|cluster| all.residuals(&cluster.fit)).collect();
    let best = |sensor: usize| {
        smallest(residuals.iter().map(|residuals| residuals[sensor])).expect("there are clusters")
    };
    let own: Vec<(usize, f64)> = (0..all.sensors()).map(best).collect();
    let found: Vec<usize> = own.iter().map(|(cluster, _)| *cluster).collect();
    let labels = named_by_appearance(&found);
    let names: BTreeMap<usize, usize> = found.iter().copied().zip(labels.iter().copied()).collect();
    let alternatives = |sensor: usize| {
        let named = (0..parts.len()).filter(|part| *part != found[sensor] && names.contains_key(part));
        let mut others: Vec<(usize, f64)> =
            named.map(|part| (names[&part], residuals[part][sensor])).collect();
        others.sort_by(|a, b| a.1.total_cmp(&b.1));
        others
    };
    RigidParts {
        residuals: own.into_iter().map(|(_, residual)| residual).collect(),
        alternatives: (0..all.sensors()).map(alternatives).collect(),
        unassigned: (parts.len()..clusters.len()).filter_map(|at| names.get(&at).copied()).collect(),
        labels,
    }
}

#[cfg(test)]
mod tests;
