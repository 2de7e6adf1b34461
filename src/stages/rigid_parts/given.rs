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
    let parts: BTreeMap<usize, Faces> = members(&series, labels)
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
            cluster.learn_more(&search.felt);
            cluster
        } else {
            let mut cluster = Cluster::new(&search.felt, places(own));
            cluster.learn_well(&search.felt);
            cluster
        };
        own.small.iter().fold(prepared.motion(&cluster, &sensors), |whole, small| whole.with(small))
    };
    parts.par_iter().map(|(label, own)| (*label, motion(own))).collect()
}

/// The sensors of each part that feel enough; if none does, those that feel anything.
fn members(series: &[&[f32]], labels: &[Option<usize>]) -> BTreeMap<usize, Vec<usize>> {
    let felt: Vec<usize> =
        series.par_iter().map(|own| own.iter().filter(|pressure| pressure.abs() > 0.0).count()).collect();
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
mod tests {
    use rand::RngExt;

    use super::super::fixtures::{self, sensor_series};
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

    fn unexplained(w: &[f64], found: &MotionSubspace) -> f64 {
        fixtures::unexplained(w, (&found.basis, found.rank))
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
                (k..=k + 3).contains(&found.rank) && error < 1e-3,
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
        for rank in [None, Some(6)] {
            let found = motions_of_parts(&once, false, &[Some(0), None], rank);
            assert!(found.len() == 1 && found[&0].basis.iter().all(|value| value.is_finite()));
        }
    }

    /// Two cylinders: sides that feel four components, and ends that feel one more, from few sensors.
    fn cylinders(unit: f32) -> (Vec<Vec<f64>>, Tactile, Vec<Option<usize>>) {
        let mut rng = stream(1, 1, "given", 1);
        let mut uniform =
            |count: usize| -> Vec<f64> { (0..count).map(|_| rng.random_range(-1.0..1.0)).collect() };
        let motions: Vec<Vec<f64>> = (0..2).map(|_| uniform(5 * SAMPLES)).collect();
        let mut pressures: Vec<f32> = Vec::new();
        for w in &motions {
            for at in 0..40 {
                let side = [uniform(4), vec![0.0]].concat();
                let c = if at < 36 { side } else { vec![0.0, 0.0, 0.0, 0.0, [1.0, -1.0][at % 2]] };
                pressures.extend(sensor_series(w, &c).map(|pressure| unit * pressure));
            }
        }
        (motions, Tactile { samples: SAMPLES, pressures }, (0..80).map(|sensor| Some(sensor / 40)).collect())
    }

    #[test]
    fn the_ends_of_a_cylinder_complete_its_motion() {
        let (motions, tactile, labels) = cylinders(1.0);
        for rank in [None, Some(5)] {
            for (w, found) in motions.iter().zip(motions_of_parts(&tactile, false, &labels, rank).values()) {
                assert!(unexplained(w, found) < 1e-3 && found.rank >= 5, "{}", unexplained(w, found));
            }
        }
    }

    #[test]
    fn the_unit_of_pressure_changes_nothing() {
        let sizes = |unit: f32| {
            let (_, tactile, labels) = cylinders(unit);
            let found = motions_of_parts(&tactile, false, &labels, None);
            let size = |own: &MotionSubspace, at: usize| {
                own.basis.iter().skip(at).step_by(own.rank).map(|w| w * w).sum::<f64>() / SAMPLES as f64
            };
            found
                .values()
                .flat_map(|own| (0..own.rank).map(|at| size(own, at)).collect::<Vec<_>>())
                .collect::<Vec<f64>>()
        };
        let (one, other) = (sizes(1.0), sizes(1e6));
        assert_eq!(one.len(), other.len());
        assert!(
            one.iter().zip(&other).all(|(one, other)| (one / other - 1.0).abs() < 1e-3),
            "{one:?} {other:?}"
        );
        assert!(one.iter().all(|size| (0.3..3.0).contains(size)), "{one:?}");
    }
}
