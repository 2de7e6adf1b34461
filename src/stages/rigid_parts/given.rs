//! Learn the motions of given parts, in the way in which the [parts](super::parts) are searched: by completion, with samples weighed, and
//! with the rank of the shortest description.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::cluster::Cluster;
use super::factorisation::MAX_RANK;
use super::parts::MIN_FELT;
use super::prepared::Prepared;
use super::roots::size;
use super::stratified::stratified;
use super::subspace::MotionSubspace;
use crate::stages::parameters::Parameters;
use crate::stages::sense::Tactile;

/// Sensors of a part that are used, spread over all: more than its motion is learned from.
const MAX_SENSORS: usize = 64;

/// The motion of each part at all T samples, by its label; of rank 0 if it feels nothing.
///
/// In: M × T pressures, of any sign, and NaN where one is missing; whether negative ones are signal (`signed`); for each of the M
/// sensors the label of its part, or `None` for a sensor to be left out; and the rank of all motions, 1 to 6, or one less than a part has
/// sensors. Without it, the data choose the rank of each. Also the `parameters`.
pub(crate) fn motions_of_parts(
    tactile: &Tactile,
    signed: bool,
    labels: &[Option<usize>],
    rank: Option<usize>,
    parameters: &Parameters,
) -> BTreeMap<usize, MotionSubspace> {
    let series: Vec<&[f32]> = tactile.series().collect();
    let parts = members(&series, signed, labels);
    let sensors: Vec<usize> = parts.values().flatten().copied().collect();
    let nothing = MotionSubspace { rank: 0, basis: Vec::new() };
    if sensors.is_empty() {
        return parts.into_keys().map(|label| (label, nothing.clone())).collect();
    }
    let prepared = Prepared::new(tactile, signed, &sensors, parameters);
    let mut search = prepared.search(&sensors);
    let place: BTreeMap<usize, usize> = sensors.iter().copied().zip(0..).collect();
    let places = |own: &Vec<usize>| own.iter().map(|sensor| place[sensor]).collect::<Vec<usize>>();
    // With fewer sensors, any motion explains a part.
    let (tell, others): (Vec<_>, Vec<_>) =
        parts.values().map(places).partition(|own| own.len() >= 2 * MAX_RANK);
    search.calibrate(if tell.is_empty() { &others } else { &tell });
    let motion = |own: &Vec<usize>| {
        if own.is_empty() {
            return nothing.clone();
        }
        let cluster = if let Some(rank) = rank {
            let mut cluster = Cluster::of_rank(&search.felt, places(own), rank);
            cluster.learn_longer(&search.felt);
            cluster
        } else {
            let mut cluster = Cluster::new(&search.felt, places(own));
            cluster.learn_with_least_rank(&search.felt);
            cluster
        };
        prepared.motion(&cluster, &sensors)
    };
    parts.par_iter().map(|(label, own)| (*label, motion(own))).collect()
}

/// The sensors of each part that feel enough; if none does, those that feel anything. Of more than [`MAX_SENSORS`], so many are spread over
/// all.
fn members(series: &[&[f32]], signed: bool, labels: &[Option<usize>]) -> BTreeMap<usize, Vec<usize>> {
    let felt: Vec<usize> = series
        .par_iter()
        .map(|own| own.iter().filter(|pressure| size(**pressure, signed) > 0.0).count())
        .collect();
    let mut parts: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (sensor, label) in labels.iter().enumerate() {
        if let Some(label) = label {
            parts.entry(*label).or_default().push(sensor);
        }
    }
    for own in parts.values_mut() {
        let least = if own.iter().any(|&sensor| felt[sensor] >= MIN_FELT) { MIN_FELT } else { 1 };
        own.retain(|&sensor| felt[sensor] >= least);
        *own = stratified(own.len(), MAX_SENSORS).map(|at| own[at]).collect();
    }
    parts
}

#[cfg(test)]
mod tests;
