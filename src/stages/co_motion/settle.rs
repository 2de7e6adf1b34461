//! Find the tree over parts that were found, and by it the part of loose sets of sensors. Small parts that the joints show to be pieces
//! of others become loose sets, too.

use std::cmp::Reverse;
use std::collections::BTreeMap;

use rand::Rng;
use rayon::prelude::*;

use super::censored::Roots;
use super::faces::{alike, opposites};
use super::motion::{Motion, is_signed, motion, spread};
use super::owners::{gain, owners};
use super::rigid::{RigidParts, limit, middle_of_sensors};
use super::tree::{CoMotion, joined};
use crate::numerics::partition::{named_by_appearance, sizes};
use crate::stages::sense::Tactile;

/// Times that likeness is read at, spread over all.
const TIMES: usize = 2000;
/// The share of a sensor's squares that its part may leave so that the tree is learned from it, if it leaves no more of others.
const TRUSTED: f64 = 0.02;
/// What the tree must explain more by a small part's going to another, in nats, so that it is no part.
const WEAK: f64 = 1.0;
/// Components of a part that is whole: what a cylinder feels of its motion but its spin.
const WHOLE: usize = 5;
/// Loose sets whose part the joints are asked for, the largest: what is remembered of them grows with the square of their number.
const MAX_SETS: usize = 40;

/// The tree over the parts, once loose sets are on the part that they are on: the one that the joints tell, or else the one whose
/// motion leaves least of them.
///
/// In: M × T pressures, of any sign, and the parts and loose sets of their sensors. Out: parts without loose sets, and their tree.
pub fn settle(tactile: &Tactile, mut parts: RigidParts, rng: &mut impl Rng) -> (RigidParts, CoMotion) {
    let mut body = Body::new(tactile);
    let (mut settled, names, motions) = loop {
        let mut settled = parts.clone();
        let (names, motions) = body.settled(&mut settled);
        let Some(weak) = body.weakest(&parts, &names, &motions) else { break (settled, names, motions) };
        body.come_apart(&mut parts, weak);
    };
    // Loose sets leave gaps in the labels.
    let labels = named_by_appearance(&settled.labels);
    let new: BTreeMap<usize, usize> = settled.labels.iter().copied().zip(labels.iter().copied()).collect();
    let named = |(name, own): (usize, Motion)| Some((*new.get(&name)?, own));
    let nodes: BTreeMap<usize, Motion> = names.into_iter().zip(motions).filter_map(named).collect();
    for others in &mut settled.others {
        *others = others.iter().filter_map(|(part, left)| Some((*new.get(part)?, *left))).collect();
    }
    (settled.labels, settled.loose) = (labels, Vec::new());
    let (names, motions): (Vec<usize>, Vec<Motion>) = nodes.into_iter().unzip();
    let tree = joined(&names, &motions, tactile.samples, rng);
    (settled, tree)
}

/// The largest sets, and the sensors of the others.
fn largest(sets: BTreeMap<usize, Vec<usize>>) -> (BTreeMap<usize, Vec<usize>>, Vec<Vec<usize>>) {
    let mut order: Vec<(usize, Vec<usize>)> = sets.into_iter().collect();
    order.sort_by_key(|(_, sensors)| Reverse(sensors.len()));
    let rest = order.split_off(order.len().min(MAX_SETS));
    (order.into_iter().collect(), rest.into_iter().map(|(_, sensors)| sensors).collect())
}

/// Makes each sensor the part's whose motion leaves least of it, or this part's if there is no other.
fn leave(parts: &mut RigidParts, sensors: &[usize], part: usize) {
    for &sensor in sensors {
        let left = parts.left[sensor];
        let others = &mut parts.others[sensor];
        let best = if others.is_empty() { (part, left) } else { others.remove(0) };
        (parts.labels[sensor], parts.left[sensor]) = best;
    }
}

/// Makes sensors a part's.
fn give(parts: &mut RigidParts, sensors: &[usize], part: usize) {
    for &sensor in sensors {
        parts.labels[sensor] = part;
        parts.others[sensor].retain(|(other, _)| *other != part);
    }
}

/// What all sensors feel.
struct Body<'a> {
    series: Vec<&'a [f32]>,
    signed: bool,
    roots: Roots,
    /// The motions that were found, by their sensors: from turn to turn most stay the same.
    known: BTreeMap<Vec<usize>, Motion>,
}

impl<'a> Body<'a> {
    fn new(tactile: &'a Tactile) -> Self {
        let series: Vec<&[f32]> = tactile.series().collect();
        let times: Vec<usize> = spread(tactile.samples, TIMES).collect();
        let signed = is_signed(tactile);
        Self { roots: Roots::at(&series, &times, signed), signed, series, known: BTreeMap::new() }
    }

    /// T.
    fn samples(&self) -> usize {
        self.series.first().map_or(0, |series| series.len())
    }

    fn motions(&mut self, sets: &[&Vec<usize>]) -> Vec<Motion> {
        let found = |sensors: &Vec<usize>| {
            let series: Vec<&[f32]> = sensors.iter().map(|&sensor| self.series[sensor]).collect();
            (sensors.clone(), motion(&series, None, self.signed))
        };
        let new = sets.par_iter().filter(|sensors| !self.known.contains_key(**sensors));
        let new: Vec<(Vec<usize>, Motion)> = new.map(|sensors| found(sensors)).collect();
        self.known.extend(new);
        sets.iter().map(|sensors| self.known[*sensors].clone()).collect()
    }

    /// The parts, with the loose sets that are on them, and their motions.
    fn settled(&mut self, parts: &mut RigidParts) -> (Vec<usize>, Vec<Motion>) {
        let (known, sets) = parts_and_sets(parts);
        let (sets, rest) = largest(sets);
        let mut motions = self.motions(&known.values().collect::<Vec<_>>());
        let mut names: Vec<usize> = known.into_keys().collect();
        let of_sets = self.motions(&sets.values().collect::<Vec<_>>());
        let members: Vec<&[usize]> = sets.values().map(Vec::as_slice).collect();
        let found = owners(&motions, &of_sets, &opposites(&self.roots, &members), self.samples());
        if names.is_empty() {
            names.extend(sets.keys());
            motions.extend(of_sets);
        } else {
            for (sensors, (owner, own)) in sets.values().zip(found.into_iter().zip(of_sets)) {
                let Some(owner) = owner else {
                    leave(parts, sensors, names[0]);
                    continue;
                };
                motions[owner] = motions[owner].with(&own);
                give(parts, sensors, names[owner]);
            }
        }
        rest.iter().for_each(|sensors| leave(parts, sensors, names[0]));
        (names, motions)
    }

    /// Of the small parts that are not whole, the one by which the tree explains most more if it goes to another, if that is much.
    fn weakest(&self, parts: &RigidParts, names: &[usize], motions: &[Motion]) -> Option<usize> {
        let sizes = sizes(&parts.labels);
        let own: Vec<usize> = names.iter().map(|name| sizes[name]).collect();
        let small = middle_of_sensors(own.clone()).div_ceil(2);
        let can_be = |at: &usize| {
            own[*at] < small && motions[*at].components < WHOLE && !parts.loose.contains(&names[*at])
        };
        let places = if names.len() > 2 { 0..names.len() } else { 0..0 };
        let gains = places.filter(can_be).map(|at| (gain(motions, at, self.samples()), at));
        let most = gains.reduce(|most, other| if other.0 > most.0 { other } else { most });
        most.filter(|(gain, _)| *gain > WEAK).map(|(_, at)| names[at])
    }

    /// Makes loose sets of a part: of what feels alike.
    fn come_apart(&self, parts: &mut RigidParts, part: usize) {
        let own: Vec<usize> = (0..parts.labels.len()).filter(|at| parts.labels[*at] == part).collect();
        for set in alike(&self.roots, &own) {
            let name = parts.labels.iter().chain(&parts.loose).max().map_or(0, |last| last + 1);
            give(parts, &set, name);
            parts.loose.push(name);
        }
        for others in &mut parts.others {
            others.retain(|(other, _)| *other != part);
        }
    }
}

/// The sensors of all parts that these explain, and the sensors of loose sets.
fn parts_and_sets(parts: &RigidParts) -> (BTreeMap<usize, Vec<usize>>, BTreeMap<usize, Vec<usize>>) {
    let (mut known, mut sets): (BTreeMap<usize, Vec<usize>>, BTreeMap<usize, Vec<usize>>) =
        Default::default();
    for (sensor, (label, is_trusted)) in parts.labels.iter().zip(trusted(parts)).enumerate() {
        if parts.loose.contains(label) {
            sets.entry(*label).or_default().push(sensor);
        } else if is_trusted {
            known.entry(*label).or_default().push(sensor);
        }
    }
    (known, sets)
}

/// Whether the motion of its set explains each sensor. Others may be on another part, and would bring that one's motion.
fn trusted(parts: &RigidParts) -> Vec<bool> {
    let most = |part: usize| {
        let own = parts.labels.iter().zip(&parts.left).filter(|(label, _)| **label == part);
        limit(own.map(|(_, left)| *left).collect(), TRUSTED)
    };
    let count = parts.labels.iter().max().map_or(0, |last| last + 1);
    let most: Vec<f64> = (0..count).map(most).collect();
    parts.labels.iter().zip(&parts.left).map(|(part, left)| *left <= most[*part]).collect()
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::super::fixtures::{felt, row};
    use super::*;
    use crate::numerics::rng::stream;

    /// Two parts of sensors that feel four numbers of their own, and more single sensors than the joints are asked for.
    fn many_singles() -> (Tactile, RigidParts) {
        let (samples, singles) = (400, MAX_SETS + 5);
        let mut rng = stream(1, 1, "settle", 0);
        let mut uniform =
            |count: usize| -> Vec<f64> { (0..count).map(|_| rng.random_range(-1.0..1.0)).collect() };
        let mut pressures = Vec::new();
        for _ in 0..2 {
            let w = uniform(4 * samples);
            uniform(4 * 30).chunks(4).for_each(|c| pressures.extend(felt(&w, c)));
        }
        pressures.extend(uniform(singles * samples).into_iter().map(|value| value.max(0.0) as f32));
        let labels: Vec<usize> = (0..60).map(|at| at / 30).chain(2..2 + singles).collect();
        let others = |at: usize| if at.is_multiple_of(2) { vec![(1, 0.5)] } else { Vec::new() };
        let parts = RigidParts {
            left: vec![0.0; labels.len()],
            others: (0..labels.len()).map(others).collect(),
            loose: (2..2 + singles).collect(),
            labels,
        };
        (Tactile { samples, pressures }, parts)
    }

    #[test]
    fn every_sensor_is_on_a_part_of_the_tree() {
        let (tactile, parts) = many_singles();
        let (settled, tree) = settle(&tactile, parts.clone(), &mut stream(1, 1, "co-motion", 0));
        assert_eq!(tree.parts.iter().map(|part| part.0).collect::<Vec<_>>(), [0, 1]);
        assert!(settled.labels.iter().all(|label| *label < 2) && settled.loose.is_empty());
        assert_eq!(settled.labels[..60], parts.labels[..60]);
        assert!(settled.others.iter().flatten().all(|(part, left)| *part < 2 && left.is_finite()));
    }

    /// Three planar parts in a row of 20 sensors on their sides, and a fourth of six: `c` of what the last part, and the ends of the
    /// middle one, feel.
    fn small_part(c: impl Fn(usize) -> [f64; 3]) -> (Tactile, RigidParts) {
        let samples = 4000;
        let (sides, ends) = row(4, samples);
        let mut rng = stream(2, 1, "settle", 0);
        let mut pressures = Vec::new();
        for side in &sides[..3] {
            for _ in 0..20 {
                let c = [rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0)];
                pressures.extend(felt(&side.values, &c));
            }
        }
        let last = sides[3].with(&ends[1]);
        (0..6).for_each(|sensor| pressures.extend(felt(&last.values, &c(sensor))));
        let labels: Vec<usize> = (0..66).map(|sensor| sensor / 20).collect();
        let (left, others) = (vec![0.0; labels.len()], vec![vec![(0, 0.5)]; labels.len()]);
        (Tactile { samples, pressures }, RigidParts { labels, left, others, loose: Vec::new() })
    }

    #[test]
    fn a_small_set_is_a_part_unless_the_joints_need_it_elsewhere() {
        let settled = |(tactile, parts): (Tactile, RigidParts)| {
            settle(&tactile, parts, &mut stream(1, 1, "co-motion", 0)).0.labels
        };
        let sign = |sensor: usize| if sensor.is_multiple_of(2) { 1.0 } else { -1.0 };
        let foot = settled(small_part(|sensor| [sign(sensor), sensor as f64 / 6.0 - 0.4, 0.0]));
        assert_eq!(foot[60..], [3; 6]);
        let ends = settled(small_part(|sensor| [0.0, 0.0, sign(sensor)]));
        assert_eq!(ends[60..], [1; 6]);
    }

    #[test]
    fn a_sensor_that_was_next_to_a_piece_goes_to_the_next_part() {
        let sign = |sensor: usize| if sensor.is_multiple_of(2) { 1.0 } else { -1.0 };
        let (mut tactile, mut parts) = small_part(|sensor| [0.0, 0.0, sign(sensor)]);
        // A loose sensor that feels one time of all: no joint needs it.
        tactile.pressures.extend((0..tactile.samples).map(|t| f32::from(t == 7)));
        parts.labels.push(4);
        parts.left.push(0.0);
        parts.others.push(vec![(3, 0.1), (2, 0.12), (0, 0.9)]);
        parts.loose.push(4);
        let (settled, _) = settle(&tactile, parts, &mut stream(1, 1, "co-motion", 0));
        assert_eq!((settled.labels[60..].to_vec(), settled.left[66]), (vec![1, 1, 1, 1, 1, 1, 2], 0.12));
    }

    #[test]
    fn loose_sets_alone_are_parts() {
        let (tactile, mut parts) = many_singles();
        parts.loose = (0..=*parts.labels.iter().max().unwrap()).collect();
        let (settled, tree) = settle(&tactile, parts, &mut stream(1, 1, "co-motion", 0));
        assert_eq!(tree.tree.len() + 1, tree.parts.len());
        assert!(settled.labels.iter().all(|label| tree.parts.iter().any(|part| part.0 == *label)));
    }
}
