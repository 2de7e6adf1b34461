//! Learn the motions of given parts, in the way in which the [parts](super::parts) are searched: by completion, with samples weighed, and
//! with the rank of the shortest description.

use std::cmp::Reverse;
use std::collections::BTreeMap;

use rayon::prelude::*;

use super::cluster::Cluster;
use super::faces::faces;
use super::factorisation::MAX_RANK;
use super::parts::MIN_FELT;
use super::prepared::{Prepared, series_of};
use super::roots::{Roots, size};
use super::stratified::stratified;
use super::subspace::{MotionSubspace, ROTATION_RANK};
use crate::stages::sense::Tactile;

/// Sensors of a part that are used, spread over all, but for small faces: more than its motion is learned from.
const MAX_SENSORS: usize = 64;
/// Samples that faces are told by.
const MAX_SAMPLES: usize = 2000;

/// The motion of each part at all T samples, by its label; of rank 0 if it feels nothing.
///
/// In: M × T pressures, of any sign, and NaN where one is missing; whether negative ones are signal (`signed`); for each of the M
/// sensors the label of its part, or `None` for a sensor to be left out; and the rank of all motions, 1 to 6, or one less than a part has
/// sensors. Without it, the data choose the rank of each, and small faces of rank one or two get motions of their own, which are
/// appended.
pub(crate) fn motions_of_parts(
    tactile: &Tactile,
    signed: bool,
    labels: &[Option<usize>],
    rank: Option<usize>,
) -> BTreeMap<usize, MotionSubspace> {
    let series: Vec<&[f32]> = tactile.series().collect();
    let parts: BTreeMap<usize, Faces> = members(&series, signed, labels)
        .into_par_iter()
        .map(|(label, own)| {
            (label, if rank.is_some() { Faces::together(own) } else { Faces::apart(&series, own, signed) })
        })
        .collect();
    let sensors: Vec<usize> = parts.values().flat_map(|own| own.large.iter().copied()).collect();
    let nothing = MotionSubspace { rank: 0, basis: Vec::new() };
    if sensors.is_empty() {
        return parts.into_keys().map(|label| (label, nothing.clone())).collect();
    }
    let prepared = Prepared::new(tactile, signed, &sensors);
    let mut search = prepared.search(&sensors);
    let place: BTreeMap<usize, usize> = sensors.iter().copied().zip(0..).collect();
    let places = |own: &Faces| own.large.iter().map(|sensor| place[sensor]).collect::<Vec<usize>>();
    // With fewer sensors, any motion explains a part.
    let (tell, others): (Vec<_>, Vec<_>) =
        parts.values().map(places).partition(|own| own.len() >= 2 * MAX_RANK);
    search.calibrate(if tell.is_empty() { &others } else { &tell });
    let motion = |own: &Faces| {
        if own.large.is_empty() {
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
        own.small.iter().fold(prepared.motion(&cluster, &sensors), |whole, small| whole.with(small))
    };
    parts.par_iter().map(|(label, own)| (*label, motion(own))).collect()
}

/// The sensors of each part that feel enough; if none does, those that feel anything.
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
    }
    parts
}

/// The faces of a part.
struct Faces {
    /// Sensors of the largest face and of those of rank three and more, at most [`MAX_SENSORS`], spread over all.
    large: Vec<usize>,
    /// The motions of the other faces. Few such sensors would hardly count among the rest.
    small: Vec<MotionSubspace>,
}

impl Faces {
    /// All sensors of a part as one.
    fn together(mut sensors: Vec<usize>) -> Self {
        sensors.sort_unstable();
        let large = stratified(sensors.len(), MAX_SENSORS).map(|at| sensors[at]).collect();
        Self { large, small: Vec::new() }
    }

    /// The small faces of a part by themselves, the largest first, as long as they may complete the motion that a face of rank three
    /// feels.
    fn apart(series: &[&[f32]], sensors: Vec<usize>, signed: bool) -> Self {
        let samples = series.first().map_or(0, |series| series.len());
        let some: Vec<usize> = stratified(samples, MAX_SAMPLES).collect();
        let every: Vec<usize> = (0..sensors.len()).collect();
        let mut faces = faces(&Roots::at(&series_of(series, &sensors), &some, signed), &every);
        faces.sort_by_key(|face| Reverse(face.len()));
        let (mut large, mut small, mut lacks) = (Vec::new(), Vec::new(), MAX_RANK - ROTATION_RANK);
        for (at, face) in faces.iter().enumerate() {
            let own: Vec<usize> = face.iter().map(|&at| sensors[at]).collect();
            let motion =
                (at > 0 && lacks > 0).then(|| MotionSubspace::of_cluster(&series_of(series, &own), signed));
            match motion.filter(|motion| motion.rank < ROTATION_RANK && motion.rank <= lacks) {
                Some(motion) => {
                    lacks -= motion.rank;
                    small.push(motion);
                }
                None => large.extend(own),
            }
        }
        Self { small, ..Self::together(large) }
    }
}

#[cfg(test)]
mod tests;
