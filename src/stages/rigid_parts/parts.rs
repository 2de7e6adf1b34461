//! Estimate the parts of a body: which sensors move rigidly together, and how many parts there are.
//!
//! Censored roots are [completed](super::completion), and clusters of one motion each are [searched](super::search) for. At last, a
//! sensor that the search left out goes to the part that explains it much better than any other. Those that no part explains, such
//! as the ends of cylinders, stay [unassigned](RigidParts::unassigned).

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::cluster::Cluster;
use super::cluster::evidence::Evidence;
use super::completion::MIN_PER_RANK;
use super::faces::similar;
use super::factorisation::MAX_RANK;
use super::medians::typical_size;
use super::prepared::Prepared;
use super::roots::Roots;
use super::search::MIN_SENSORS;
use super::separation::best_part;
use super::subspace::{MotionSubspace, ROTATION_RANK};
use crate::numerics::partition::named_by_appearance;
use crate::stages::parameters::Parameters;
use crate::stages::sense::Tactile;

/// Samples at which a sensor must feel something to be searched for, for all six numbers of its c.
pub(super) const MIN_FELT: usize = MIN_PER_RANK * MAX_RANK;
/// The part of each of M sensors, and how well its motion explains what the sensor feels.
///
/// A residual is the share of the mean square of a sensor's roots that the motion of a part leaves unexplained: 0 if it explains
/// everything, 1 if nothing. Samples at which all sensors have a large error weigh less.
#[derive(Debug, Clone, PartialEq)]
pub struct RigidParts {
    /// The part of each sensor, 0, 1, … in order of appearance.
    pub labels: Vec<usize>,
    /// The residual of each sensor by the motion of its part; 0 if it is unassigned, or was assigned by the joints.
    pub residuals: Vec<f64>,
    /// For each sensor, the other parts and its residual by their motions, the smallest first.
    pub alternatives: Vec<Vec<(usize, f64)>>,
    /// Labels of clusters that feel too little to be parts: they are on other parts, but their motion does not say on which. The
    /// joints do, and [`estimate`](crate::estimate::estimate) leaves none.
    pub unassigned: Vec<usize>,
    /// The motion of each part at all T samples, by its label; none once joints have assigned what was unassigned.
    pub(crate) motions: BTreeMap<usize, MotionSubspace>,
}

/// Estimates the parts.
///
/// In: M × T pressures, of any sign and NaN where one is missing, of sensors that all change; whether negative ones are signal
/// (`signed`), not noise about 0; and `sensors`, at least
/// [`MIN_SENSORS`](super::MIN_SENSORS) of them, rising and spread over all; and the `parameters`. The motions of parts are learned from these; the other
/// sensors are assigned to the part with the smallest residual, or, if they feel something at few samples, the largest evidence. Out: the part of all M sensors. No random numbers are drawn, and
/// the number of threads changes no bit.
///
/// # Panics
/// If `sensors` is empty or names a sensor beyond M, or T is 0.
pub fn rigid_parts(
    tactile: &Tactile,
    signed: bool,
    sensors: &[usize],
    parameters: &Parameters,
) -> RigidParts {
    let mut prepared = Prepared::new(tactile, signed, sensors, parameters);
    let count = prepared.series.len();
    // Sensors that feel something at fewer samples tell next to nothing, and span motions of their own. They go to the part that makes them
    // likely, unless nearly all are such.
    let tells: Vec<bool> = (0..count).map(|sensor| prepared.roots.felt_samples(sensor) >= MIN_FELT).collect();
    let telling: Vec<usize> = sensors.iter().copied().filter(|&sensor| tells[sensor]).collect();
    let are_enough = telling.len() >= MIN_SENSORS;
    let sensors = if are_enough { &telling } else { sensors };
    let mut search = prepared.search(sensors);
    let mut parts = parts_of(search.clusters(), parameters.min_freedom);
    if parts.is_empty() {
        parts.push(search.whole());
    }
    // As the search has weighed the samples.
    let weights = search.felt.sizes.iter().zip(&prepared.sizes).map(|(now, before)| now / before);
    prepared.roots.divide(&weights.collect::<Vec<_>>());
    let every = &prepared.roots;
    let mut labels: Vec<Option<usize>> = vec![None; count];
    for (at, part) in parts.iter().enumerate() {
        part.sensors.iter().for_each(|&sensor| labels[sensors[sensor]] = Some(at));
    }
    let residuals: Vec<Vec<f64>> = parts.par_iter().map(|part| part.shares(every)).collect();
    let scales: Vec<f64> = sensors.iter().map(|&sensor| prepared.scales[sensor]).collect();
    let evidence: Vec<_> =
        parts.iter().map(|part| part.evidence(&scales, parameters.min_tolerance)).collect();
    let likeliest = |sensor: usize| likeliest_part(&evidence, every, sensor, prepared.scales[sensor]);
    labels.par_iter_mut().enumerate().filter(|(_, label)| label.is_none()).for_each(|(sensor, label)| {
        let likely = if are_enough && !tells[sensor] { likeliest(sensor) } else { None };
        *label = likely
            .or_else(|| best_part(&residuals, sensor, search.most_residual(), parameters.max_residual_share));
    });
    let rest: Vec<usize> = (0..count).filter(|&sensor| labels[sensor].is_none()).collect();
    let groups = similar(every, &rest);
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
        residuals: (0..count).map(residual).collect(),
        alternatives: (0..count).map(alternatives).collect(),
        unassigned: (parts.len()..parts.len() + groups.len()).map(|at| names[&at]).collect(),
        motions: parts
            .iter()
            .enumerate()
            .map(|(at, part)| (names[&at], prepared.motion(part, sensors)))
            .collect(),
        labels: named,
    }
}

/// The part of the largest evidence for a sensor, whose roots were divided by this scale.
fn likeliest_part(parts: &[Option<Evidence>], roots: &Roots, sensor: usize, scale: f64) -> Option<usize> {
    let scaled = |values: &[f64]| values.iter().map(|value| scale * value).collect::<Vec<_>>();
    let (own, thresholds) = (scaled(roots.values.col_as_slice(sensor)), scaled(&roots.thresholds));
    let surprises = parts.iter().map(|part| part.as_ref()?.surprise(&own, &thresholds));
    let known = surprises.enumerate().filter_map(|(at, surprise)| Some((surprise?, at)));
    known.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, at)| at)
}

/// The clusters that are parts: those that feel how they rotate, and large ones.
fn parts_of(clusters: Vec<Cluster>, min_freedom: f64) -> Vec<Cluster> {
    let small = typical_size(clusters.iter().map(|own| own.sensors.len()).collect()).div_ceil(2);
    let is_part = |own: &Cluster| {
        own.freedom >= min_freedom && (own.rank() >= ROTATION_RANK || own.sensors.len() >= small)
    };
    clusters.into_iter().filter(is_part).collect()
}

#[cfg(test)]
mod tests;
