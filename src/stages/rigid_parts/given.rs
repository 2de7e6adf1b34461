//! Learn the motions of given parts, in the way in which the [parts](super::parts) are searched: by completion, with samples weighed, and
//! with the rank of the shortest description.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::cluster::Cluster;
use super::faces::faces;
use super::prepared::{Prepared, of};
use super::roots::Roots;
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
/// sensors the label of its part, or `None` for a sensor to be left out; and the rank of all motions, 1 to 6, without which the
/// data choose one for each. Then small faces of rank one or two get
/// motions of their own, which are appended.
pub(crate) fn motions_of_parts(
    tactile: &Tactile,
    signed: bool,
    labels: &[Option<usize>],
    rank: Option<usize>,
) -> BTreeMap<usize, MotionSubspace> {
    let series: Vec<&[f32]> = tactile.series().collect();
    let feels = |sensor: usize| series[sensor].iter().any(|pressure| pressure.abs() > 0.0);
    let mut parts: BTreeMap<usize, Vec<usize>> =
        labels.iter().flatten().map(|label| (*label, Vec::new())).collect();
    for (sensor, label) in labels.iter().enumerate().filter(|(sensor, _)| feels(*sensor)) {
        label.iter().for_each(|label| parts.get_mut(label).expect("a label").push(sensor));
    }
    let parts: BTreeMap<usize, Faces> =
        parts.into_par_iter().map(|(label, own)| (label, Faces::new(&series, own, signed))).collect();
    let sensors: Vec<usize> = parts.values().flat_map(|own| own.large.iter().copied()).collect();
    let nothing = MotionSubspace { rank: 0, basis: Vec::new() };
    if sensors.is_empty() {
        return parts.into_keys().map(|label| (label, nothing.clone())).collect();
    }
    let prepared = Prepared::new(tactile, signed, &sensors);
    let mut search = prepared.search(&sensors);
    let place: BTreeMap<usize, usize> = sensors.iter().copied().zip(0..).collect();
    let places = |own: &Faces| own.large.iter().map(|sensor| place[sensor]).collect::<Vec<usize>>();
    search.calibrate(&parts.values().map(places).filter(|own| !own.is_empty()).collect::<Vec<_>>());
    let motion = |own: &Faces| {
        if own.large.is_empty() {
            return nothing.clone();
        }
        let cluster = match rank {
            Some(rank) => {
                let mut cluster = Cluster::of_rank(&search.felt, places(own), rank);
                cluster.learn_more(&search.felt);
                cluster
            }
            None => {
                let mut cluster = Cluster::new(&search.felt, places(own));
                cluster.learn_well(&search.felt);
                cluster
            }
        };
        let large = prepared.motion(&cluster, &sensors);
        if rank.is_some() { large } else { own.small.iter().fold(large, |whole, small| whole.with(small)) }
    };
    parts.par_iter().map(|(label, own)| (*label, motion(own))).collect()
}

/// The faces of a part.
struct Faces {
    /// Sensors of the largest face, and of those of rank three and more: at most [`MAX_SENSORS`], spread over all.
    large: Vec<usize>,
    /// The motions of the other faces. Few such sensors would hardly count among the rest.
    small: Vec<MotionSubspace>,
}

impl Faces {
    /// Of a part with these sensors.
    fn new(series: &[&[f32]], sensors: Vec<usize>, signed: bool) -> Self {
        let samples = series.first().map_or(0, |series| series.len());
        let some: Vec<usize> = stratified(samples, MAX_SAMPLES).collect();
        let every: Vec<usize> = (0..sensors.len()).collect();
        let faces = faces(&Roots::at(&of(series, &sensors), &some, signed), &every);
        let largest = faces.iter().map(Vec::len).max().unwrap_or(0);
        let mut found = Self { large: Vec::new(), small: Vec::new() };
        for face in faces {
            let own: Vec<usize> = face.iter().map(|&at| sensors[at]).collect();
            let motion = (own.len() < largest).then(|| MotionSubspace::of_cluster(&of(series, &own), signed));
            match motion.filter(|motion| motion.rank < ROTATION_RANK) {
                Some(motion) => found.small.push(motion),
                None => found.large.extend(own),
            }
        }
        found.large.sort_unstable();
        found.large = stratified(found.large.len(), MAX_SENSORS).map(|at| found.large[at]).collect();
        found
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;
    use rand::RngExt;

    use super::super::fixtures::sensor_series;
    use super::*;
    use crate::numerics::rng::stream;

    const SAMPLES: usize = 300;

    /// Parts whose motions have these ranks, by 30 sensors each: their motions, and what is felt. A part of rank 0 feels nothing.
    fn felt(ranks: &[usize]) -> (Vec<Vec<f64>>, Tactile, Vec<Option<usize>>) {
        let mut rng = stream(1, 1, "given", 0);
        let mut uniform =
            |count: usize| -> Vec<f64> { (0..count).map(|_| rng.random_range(-1.0..1.0)).collect() };
        let mut pressures = Vec::new();
        let motions: Vec<Vec<f64>> = ranks.iter().map(|k| uniform(SAMPLES * k)).collect();
        for (w, k) in motions.iter().zip(ranks) {
            for _ in 0..30 {
                if *k == 0 {
                    pressures.extend([0.0; SAMPLES])
                } else {
                    pressures.extend(sensor_series(w, &uniform(*k)))
                }
            }
        }
        let labels = (0..30 * ranks.len()).map(|sensor| Some(7 + sensor / 30)).collect();
        (motions, Tactile { samples: SAMPLES, pressures }, labels)
    }

    /// The share of the true motion's squares that no linear map of the found one explains.
    fn unexplained(w: &[f64], found: &MotionSubspace) -> f64 {
        let w = DMatrix::from_row_slice(SAMPLES, w.len() / SAMPLES, w);
        let x = DMatrix::from_row_slice(SAMPLES, found.rank, &found.basis);
        let fitted = &x * x.clone().svd(true, true).solve(&w, 1e-12).unwrap();
        (&w - fitted).norm_squared() / w.norm_squared()
    }

    #[test]
    fn motions_are_recovered_from_few_samples() {
        let ranks = [3, 5, 6];
        let (motions, tactile, labels) = felt(&ranks);
        let found = motions_of_parts(&tactile, false, &labels, None);
        assert_eq!(found.keys().copied().collect::<Vec<_>>(), [7, 8, 9]);
        for ((w, k), found) in motions.iter().zip(ranks).zip(found.values()) {
            let error = unexplained(w, found);
            // What completes so few samples may add a component, and a sensor that is like no other a face.
            assert!(
                (k..=k + 1).contains(&found.rank) && error < 1e-3,
                "rank {} for {k}: {error}",
                found.rank
            );
        }
    }

    #[test]
    fn a_lower_rank_is_not_the_whole_motion() {
        let (motions, tactile, labels) = felt(&[5, 5]);
        for (w, found) in motions.iter().zip(motions_of_parts(&tactile, false, &labels, Some(3)).values()) {
            assert!(found.rank == 3 && unexplained(w, found) > 0.1);
        }
    }

    #[test]
    fn what_feels_nothing_has_no_motion() {
        let (motions, tactile, labels) = felt(&[4, 0, 3]);
        let found = motions_of_parts(&tactile, false, &labels, None);
        assert_eq!(found.values().map(|own| own.rank > 0).collect::<Vec<_>>(), [true, false, true]);
        assert!(unexplained(&motions[2], &found[&9]) < 1e-3);
        let still = Tactile { samples: 9, pressures: vec![0.0; 18] };
        assert!(motions_of_parts(&still, false, &[Some(0), Some(1)], None).values().all(|own| own.rank == 0));
        // A single sensor that feels something at a single sample, and one that is left out.
        let mut once = still.clone();
        once.pressures[3] = 1.0;
        let found = motions_of_parts(&once, false, &[Some(0), None], None);
        assert!(found.len() == 1 && found[&0].basis.iter().all(|value| value.is_finite()));
    }
}
