//! Estimate the parts of a body: which sensors move rigidly together, and how many parts there are.
//!
//! Censored roots are [completed](super::completion), and clusters of one motion each are [searched](super::search) for. At last, a
//! sensor that the search left out goes to the part that explains it much better than any other. Those that no part explains, such
//! as the ends of cylinders, stay [unassigned](RigidParts::unassigned).

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::cluster::{Cluster, Felt, ITERATIONS, MIN_FREEDOM};
use super::completion::Completion;
use super::faces::similar;
use super::factorisation::MAX_RANK;
use super::floor::{floors, telling_samples, typical_floor};
use super::medians::typical_size;
use super::roots::Roots;
use super::search::{MIN_SENSORS, Search};
use super::separation::explaining;
use super::subspace::{Loadings, MotionSubspace, ROTATION_RANK};
use crate::numerics::partition::named_by_appearance;
use crate::stages::sense::Tactile;

/// Samples at which a sensor must feel something to be searched for: four for each of the six numbers of its c.
const MIN_FELT: usize = 4 * MAX_RANK;
/// Samples that parts are searched on, spread over all at which anything is felt.
const MAX_SAMPLES: usize = 1500;

/// The part of each of M sensors, and how well its motion explains what the sensor feels.
///
/// A residual is the share of the mean square of a sensor's roots that the motion of a part leaves unexplained: 0 if it explains
/// everything, 1 if nothing. Samples at which all sensors have a large error weigh less.
#[derive(Debug, Clone, PartialEq)]
pub struct RigidParts {
    /// The part of each sensor, 0, 1, … in order of appearance.
    pub labels: Vec<usize>,
    /// The residual of each sensor by the motion of its part; 0 for one that is or was unassigned.
    pub residuals: Vec<f64>,
    /// For each sensor, the other parts and its residual by their motions, the smallest first.
    pub alternatives: Vec<Vec<(usize, f64)>>,
    /// Labels of clusters that feel too little to be parts: they are on other parts, but their motion does not say on which. The
    /// joints do, and [`estimate`](crate::estimate::estimate) leaves none.
    pub unassigned: Vec<usize>,
    /// The motion of each part at all T samples, by its label.
    pub(crate) motions: BTreeMap<usize, MotionSubspace>,
}

/// Estimates the parts.
///
/// In: M × T pressures, of any sign and NaN where one is missing, of sensors that all change; whether negative ones are signal
/// (`signed`), not noise about 0; and `sensors`, at least
/// [`MIN_SENSORS`](super::MIN_SENSORS) of them, rising and spread over all. The motions of parts are learned from these; the other
/// sensors are assigned to the part with the smallest residual. Out: the part of all M sensors. No random numbers are drawn, and
/// the number of threads changes no bit.
///
/// # Panics
/// If `sensors` is empty or names a sensor beyond M, or T is 0.
pub fn rigid_parts(tactile: &Tactile, signed: bool, sensors: &[usize]) -> RigidParts {
    let all: Vec<&[f32]> = tactile.series().collect();
    let series_of = |sensors: &[usize]| sensors.iter().map(|&sensor| all[sensor]).collect::<Vec<&[f32]>>();
    let floors = floors(&all);
    let samples = telling_samples(
        &series_of(sensors),
        &sensors.iter().map(|&sensor| floors[sensor]).collect::<Vec<_>>(),
        MAX_SAMPLES,
    );
    let every = Roots::at(&all, &samples, signed);
    let scales = every.scales();
    let floor = typical_floor(&floors, &scales);
    let every = every.scaled(&scales);
    let sizes = every.select(sensors).sizes();
    let mut every = every.equalised(&sizes, floor);
    // Sensors that feel something at fewer samples tell next to nothing, and span motions of their own. They go to the part that explains
    // them best, unless nearly all are such.
    let tells: Vec<bool> = (0..all.len()).map(|sensor| every.felt_samples(sensor) >= MIN_FELT).collect();
    let telling: Vec<usize> = sensors.iter().copied().filter(|&sensor| tells[sensor]).collect();
    let are_enough = telling.len() >= MIN_SENSORS;
    let sensors = if are_enough { &telling } else { sensors };
    let some = series_of(sensors);
    let roots = every.select_as_they_are(sensors);
    let completion = Completion::new(&roots);
    let felt = Felt {
        roots,
        completed: completion.velocities,
        sizes: sizes.clone(),
        tolerance: 0.0,
        iterations: ITERATIONS,
    };
    let mut search = Search::new(felt, completion.affinities);
    let mut parts = parts_of(search.clusters());
    if parts.is_empty() {
        parts.push(search.whole());
    }
    // As the search has weighed the samples.
    every.divide(&search.felt.sizes.iter().zip(&sizes).map(|(now, before)| now / before).collect::<Vec<_>>());
    let mut labels: Vec<Option<usize>> = vec![None; all.len()];
    for (at, part) in parts.iter().enumerate() {
        part.sensors.iter().for_each(|&sensor| labels[sensors[sensor]] = Some(at));
    }
    let residuals: Vec<Vec<f64>> = parts.par_iter().map(|part| part.shares(&every)).collect();
    for (sensor, label) in labels.iter_mut().enumerate() {
        let most = if are_enough && !tells[sensor] { f64::INFINITY } else { search.most_residual() };
        *label = label.or_else(|| explaining(&residuals, sensor, most));
    }
    let rest: Vec<usize> = (0..all.len()).filter(|&sensor| labels[sensor].is_none()).collect();
    let groups = similar(&every, &rest);
    for (at, group) in groups.iter().enumerate() {
        group.iter().for_each(|&sensor| labels[sensor] = Some(parts.len() + at));
    }
    let labels: Vec<usize> = labels.into_iter().map(|label| label.expect("it is in a group")).collect();
    let named = named_by_appearance(&labels);
    let names: BTreeMap<usize, usize> = labels.iter().copied().zip(named.iter().copied()).collect();
    let alternatives = |sensor: usize| {
        let others = (0..parts.len()).filter(|part| *part != labels[sensor]);
        let mut others: Vec<(usize, f64)> =
            others.map(|part| (names[&part], residuals[part][sensor])).collect();
        others.sort_by(|a, b| a.1.total_cmp(&b.1));
        others
    };
    let residual = |sensor: usize| residuals.get(labels[sensor]).map_or(0.0, |own| own[sensor]);
    RigidParts {
        residuals: (0..all.len()).map(residual).collect(),
        alternatives: (0..all.len()).map(alternatives).collect(),
        unassigned: (parts.len()..parts.len() + groups.len()).map(|at| names[&at]).collect(),
        motions: parts
            .iter()
            .enumerate()
            .map(|(at, part)| (names[&at], motion(part, &some, &samples, floor, signed)))
            .collect(),
        labels: named,
    }
}

/// The clusters that are parts: those that feel how they rotate, and large ones.
fn parts_of(clusters: Vec<Cluster>) -> Vec<Cluster> {
    let small = typical_size(clusters.iter().map(|own| own.sensors.len()).collect()).div_ceil(2);
    let is_part = |own: &Cluster| {
        own.freedom >= MIN_FREEDOM && (own.rank() >= ROTATION_RANK || own.sensors.len() >= small)
    };
    clusters.into_iter().filter(is_part).collect()
}

/// The motion of a part at all samples, from what was learned at some.
fn motion(part: &Cluster, series: &[&[f32]], samples: &[usize], floor: f64, signed: bool) -> MotionSubspace {
    let series: Vec<&[f32]> = part.representatives.iter().map(|&sensor| series[sensor]).collect();
    let scales = Roots::at(&series, samples, signed).scales();
    let given =
        Loadings { values: part.whitened_loadings(), scales, deviation: part.variance().sqrt(), floor };
    MotionSubspace::of_loadings(&series, &given, signed)
}

#[cfg(test)]
mod tests;
