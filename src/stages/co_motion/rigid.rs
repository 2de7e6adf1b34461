//! Find the parts: sensors are on one part if one motion explains all that they simulate_and_sense, because a part is rigid.
//!
//! In: pressures, and the distances between sensors. Out: the [part](RigidParts) of each sensor. The number of parts is found,
//! too. Neighbours in the distances make small pieces, which nearly always are pieces of one part. Then, in turns, two sets of
//! sensors become one where that [costs](Set::cost) least, and each sensor goes to the set whose motion leaves least of it. What
//! comes of this hangs on the pieces, so there are several starts, and the sets that cost least are kept. A part that one
//! motion does not explain at the times that tell most of it is looked at anew, by itself. At last, faces that share nothing with
//! the rest of their set, such as the ends of cylinders, are made [loose sets](RigidParts::loose).

use std::collections::BTreeMap;

use kodama::Method;
use rayon::prelude::*;

use self::set::{MAX_SENSORS, Set, set, union};
use super::censored::Roots;
use super::motion::{LEAST_COMPONENTS, is_signed, spread};
use crate::numerics::linkage;
use crate::numerics::partition::named_by_appearance;
use crate::stages::distance::Distances;
use crate::stages::sense::Tactile;

/// Sensors of a piece, on the mean: of each start.
const PIECES: [usize; 3] = [6, 9, 12];
/// Fewest sensors of which several parts can be found: two pieces.
pub const MIN_SENSORS: usize = 2 * PIECES[0];
/// Most pieces.
const MAX_PIECES: usize = 100;
/// Times that are read: for the many pieces, and for the few parts.
const TIMES: [usize; 2] = [250, 2000];
/// Times, for each that is read, that it is chosen from, spread over all.
const CHOICE: usize = 4;
/// The share of squares that a motion must leave, of roots beyond its components, so that a part may be several.
const UNEXPLAINED: f64 = 0.05;
/// What a sensor, or a set, may leave of its squares over what the one in the middle leaves.
const TIMES_THE_MIDDLE: f64 = 3.0;
/// Turns in which the motion of a set is found: of the many pieces, and of the few parts.
const ROUNDS: [usize; 2] = [4, 16];
/// Turns in which the motion of the body as a whole is found.
const FEW_ROUNDS: usize = 3;
/// Sets that a set is tried with, the nearest: of the many pieces, and of the few parts.
const NEAR: [usize; 2] = [4, 3];
/// What one set of two must cost less than both, for each time: it must be seen that they share a component.
const MARGIN: f64 = 1.0;
/// Roots beyond its components that a part must have at a time, on the mean. With fewer, any sensors fit.
const SUPPORT: f64 = 1.0;
/// Most times that sensors go to the set that leaves least of them.
const EXCHANGES: usize = 10;
/// Most times that sets become one and sensors move.
const CYCLES: usize = 4;

/// Parts, and how well they explain what their sensors feel.
#[derive(Debug, Clone, PartialEq)]
pub struct RigidParts {
    /// The part of each sensor, 0, 1, … in order of appearance.
    pub labels: Vec<usize>,
    /// The share of each sensor's squares that the motion of its part leaves.
    pub left: Vec<f64>,
    /// Of each sensor, the other parts, and the share that their motions leave, the least first.
    pub others: Vec<Vec<(usize, f64)>>,
    /// The labels of sets that feel too little to be a part: they are on one of the others, but their own motion does not say
    /// on which.
    pub loose: Vec<usize>,
}

/// Finds the parts.
///
/// In: M × T pressures, of any sign, of at least [`MIN_SENSORS`] sensors, which all change; and the distances between `sensors`, which are spread over all
/// of them. The others go to the part whose motion leaves least of them.
pub fn rigid_parts(tactile: &Tactile, sensors: &[usize], distances: &Distances) -> RigidParts {
    let signed = is_signed(tactile);
    let all: Vec<&[f32]> = tactile.series().collect();
    let some: Vec<&[f32]> = sensors.iter().map(|&sensor| all[sensor]).collect();
    let body = Body { series: some, signed, distances };
    let every: Vec<usize> = (0..sensors.len()).collect();
    let times = body.telling_times(&every);
    let found = body.parts_of(&every, &times, &PIECES);
    let labels = body.taken_apart(found.clone());
    let fine = Search { roots: body.roots(&every, &times[1]), distances, rounds: ROUNDS[1] };
    let sets = fine.sets(members(&labels), Vec::new());
    let sets = if labels == found { sets } else { fine.exchanged(sets, true) };
    let (parts, loose) = fine.separated(sets);
    assigned(&parts, &loose, &Roots::at(&all, &times[1], signed).normalised())
}

/// What some sensors of a body feel.
struct Body<'a> {
    series: Vec<&'a [f32]>,
    signed: bool,
    distances: &'a Distances,
}

impl Body<'_> {
    fn roots(&self, sensors: &[usize], times: &[usize]) -> Roots {
        let series: Vec<&[f32]> = sensors.iter().map(|&sensor| self.series[sensor]).collect();
        Roots::at(&series, times, self.signed).normalised()
    }

    /// [`TIMES`] at which the sensors move least as one, of [`CHOICE`] times as many. Where joints are locked, parts are one for
    /// a while, and such times say nothing of them.
    fn telling_times(&self, sensors: &[usize]) -> [Vec<usize>; 2] {
        let some: Vec<usize> = spread(sensors.len(), MAX_SENSORS).map(|at| sensors[at]).collect();
        TIMES.map(|count| {
            let times: Vec<usize> = spread(self.series[0].len(), CHOICE * count).collect();
            let roots = self.roots(&some, &times);
            let start = roots.start();
            let fit = roots.fit(&start, start.components(), FEW_ROUNDS);
            let mut order: Vec<(f64, usize)> = roots.left_at_times(&fit).into_iter().zip(times).collect();
            order.sort_by(|a, b| b.0.total_cmp(&a.0));
            let mut chosen: Vec<usize> = order.into_iter().take(count).map(|(_, t)| t).collect();
            chosen.sort_unstable();
            chosen
        })
    }

    /// The parts of some sensors, from pieces of these sizes: of all starts, those that cost least.
    fn parts_of(&self, sensors: &[usize], times: &[Vec<usize>; 2], pieces: &[usize]) -> Vec<usize> {
        let n = sensors.len();
        let values = sensors.iter().flat_map(|&i| sensors.iter().map(move |&j| self.distances.get(i, j)));
        let distances = &Distances { sensors: n, values: values.collect() };
        let [coarse, fine] = [0, 1].map(|at| {
            let roots = self.roots(sensors, &times[at]);
            Search { roots, distances, rounds: ROUNDS[at] }
        });
        let found = |size: &usize| {
            let count = (n / size).clamp(1, MAX_PIECES);
            let labels = linkage::clusters(n, |i, j| distances.get(i, j), Method::Average, count);
            let sets = coarse.sets(members(&labels), Vec::new());
            let sets = coarse.exchanged(coarse.merged(sets, NEAR[0], 0.0, 0), false);
            let labels = labels_of(&coarse.settled(sets, usize::MAX));
            let sets = fine.settled(fine.sets(members(&labels), Vec::new()), NEAR[1]);
            (sets.iter().map(|set| set.cost).sum::<f64>(), labels_of(&sets))
        };
        let starts: Vec<(f64, Vec<usize>)> = pieces.par_iter().map(found).collect();
        // The first of the best. The cost, not the number of parts, tells: with one motion for two parts much is left.
        let best = starts.into_iter().reduce(|best, other| if other.0 < best.0 { other } else { best });
        best.expect("there are starts").1
    }

    /// Takes parts apart, and what comes of them, where one motion does not explain what is felt at the times that tell most of
    /// this part.
    fn taken_apart(&self, mut labels: Vec<usize>) -> Vec<usize> {
        let mut left = members(&labels);
        let mut next = left.len();
        while let Some(part) = left.pop() {
            let Some(parts) = self.apart(&part) else { continue };
            let parts: Vec<Vec<usize>> =
                members(&parts).into_iter().map(|own| own.into_iter().map(|at| part[at]).collect()).collect();
            for own in parts {
                own.iter().for_each(|&sensor| labels[sensor] = next);
                next += 1;
                left.push(own);
            }
        }
        named_by_appearance(&labels)
    }

    /// The parts of what was taken for one, if it is several.
    fn apart(&self, part: &[usize]) -> Option<Vec<usize>> {
        if part.len() < MIN_SENSORS {
            return None;
        }
        let times = self.telling_times(part);
        let roots = self.roots(part, &times[1]);
        let every: Vec<usize> = (0..part.len()).collect();
        let whole = set(&roots, every, 1, ROUNDS[1]);
        if whole.fit.residual <= UNEXPLAINED * whole.fit.spare {
            return None;
        }
        // One start: from more, sensors that are on the end of a part become one of their own.
        let labels = self.parts_of(part, &times, &PIECES[..1]);
        let parts = members(&labels);
        let count = parts.len();
        let sum: f64 = parts.into_iter().map(|own| set(&roots, own, 1, ROUNDS[1]).cost).sum();
        (count > 1 && whole.cost - sum > MARGIN).then_some(labels)
    }
}

/// Sensors whose sets are looked for.
struct Search<'a> {
    roots: Roots,
    distances: &'a Distances,
    /// Turns in which the motion of a set is found.
    rounds: usize,
}

impl Search<'_> {
    /// A set of these sensors.
    fn set(&self, sensors: Vec<usize>) -> Set {
        set(&self.roots, sensors, 1, self.rounds)
    }

    /// Sets of these members; some are known.
    fn sets(&self, members: Vec<Vec<usize>>, known: Vec<Set>) -> Vec<Set> {
        let mut known: BTreeMap<Vec<usize>, Set> =
            known.into_iter().map(|set| (set.sensors.clone(), set)).collect();
        let found: Vec<_> = members.into_iter().map(|own| (known.remove(&own), own)).collect();
        found.into_par_iter().map(|(known, own)| known.unwrap_or_else(|| self.set(own))).collect()
    }

    /// Makes one of two sets, of each and its `near` nearest, and moves sensors, until nothing changes.
    fn settled(&self, mut sets: Vec<Set>, near: usize) -> Vec<Set> {
        for _ in 0..CYCLES {
            let before = labels_of(&sets);
            sets = self.exchanged(self.merged(sets, near, MARGIN, 0), true);
            if labels_of(&sets) == before {
                break;
            }
        }
        sets
    }

    /// Makes one of two sets, of each and its `near` nearest, where that saves most, as long as it saves more than `margin`.
    /// The first `fixed` sets stay apart from each other.
    fn merged(&self, sets: Vec<Set>, near: usize, margin: f64, fixed: usize) -> Vec<Set> {
        let mut name = sets.len();
        let mut sets: BTreeMap<usize, Set> = sets.into_iter().enumerate().collect();
        let mut tried: BTreeMap<(usize, usize), Set> = BTreeMap::new();
        while sets.len() > 1 {
            let new: Vec<(usize, usize)> = self
                .pairs(&sets, near)
                .into_iter()
                .filter(|pair| pair.1 >= fixed && !tried.contains_key(pair))
                .collect();
            let made = new
                .into_par_iter()
                .map(|(a, b)| ((a, b), union(&self.roots, &sets[&a], &sets[&b], self.rounds)));
            tried.extend(made.collect::<Vec<_>>());
            let saved = |(&(a, b), both): (&(usize, usize), &Set)| sets[&a].cost + sets[&b].cost - both.cost;
            let Some((most, pair)) = tried
                .iter()
                .map(|entry| (saved(entry), *entry.0))
                .reduce(|best, other| if other.0 > best.0 { other } else { best })
            else {
                break;
            };
            if most <= margin {
                break;
            }
            let both = tried.remove(&pair).expect("it is the best of those tried");
            tried.retain(|(a, b), _| ![pair.0, pair.1].iter().any(|gone| a == gone || b == gone));
            sets.retain(|name, _| *name != pair.0 && *name != pair.1);
            if pair.0 < fixed {
                sets.insert(pair.0, both);
            } else {
                sets.insert(name, both);
                name += 1;
            }
        }
        sets.into_values().collect()
    }

    /// Each set with its nearest ones.
    fn pairs(&self, sets: &BTreeMap<usize, Set>, near: usize) -> Vec<(usize, usize)> {
        let apart = |a: &Set, b: &Set| {
            let sum: f64 = a
                .sensors
                .iter()
                .flat_map(|&i| b.sensors.iter().map(move |&j| self.distances.get(i, j)))
                .sum();
            sum / (a.sensors.len() * b.sensors.len()) as f64
        };
        let nearest = |(&name, set): (&usize, &Set)| {
            let mut others: Vec<(f64, usize)> = sets
                .iter()
                .filter(|(other, _)| **other != name)
                .map(|(other, own)| (if near < sets.len() { apart(set, own) } else { 0.0 }, *other))
                .collect();
            others.sort_by(|a, b| a.0.total_cmp(&b.0));
            others
                .into_iter()
                .take(near)
                .map(|(_, other)| (name.min(other), name.max(other)))
                .collect::<Vec<_>>()
        };
        let mut pairs: Vec<(usize, usize)> =
            sets.iter().collect::<Vec<_>>().into_par_iter().flat_map_iter(nearest).collect();
        pairs.sort_unstable();
        pairs.dedup();
        pairs
    }

    /// Moves each sensor to the set whose motion leaves least of it, until none moves. Where only parts are admitted, sets that
    /// cannot be one go.
    fn exchanged(&self, mut sets: Vec<Set>, only_parts: bool) -> Vec<Set> {
        for _ in 0..EXCHANGES {
            let mut sizes: Vec<usize> = sets.iter().map(|set| set.sample.len()).collect();
            sizes.sort_unstable();
            let small = sizes[sizes.len() / 2].div_ceil(2);
            let can_be = |set: &&Set| {
                let is_skin = set.fit.components() >= LEAST_COMPONENTS || set.sample.len() >= small;
                set.fit.spare >= SUPPORT && is_skin
            };
            let parts: Vec<&Set> = sets.iter().filter(can_be).collect();
            let kept = if only_parts && !parts.is_empty() { parts } else { sets.iter().collect() };
            let left: Vec<Vec<f64>> = kept.par_iter().map(|set| self.roots.left(&set.fit)).collect();
            let best =
                |sensor: usize| least(left.iter().map(|left| left[sensor])).map_or(0, |(part, _)| part);
            let labels: Vec<usize> = (0..self.roots.sensors()).map(best).collect();
            let moved = named_by_appearance(&labels);
            if moved == labels_of(&sets) {
                break;
            }
            sets = self.sets(members(&moved), sets);
        }
        sets
    }
}

/// The sensors of each set.
fn members(labels: &[usize]) -> Vec<Vec<usize>> {
    let mut members = vec![Vec::new(); labels.iter().max().map_or(0, |last| last + 1)];
    labels.iter().enumerate().for_each(|(sensor, &label)| members[label].push(sensor));
    members
}

/// The set of each sensor, by appearance.
fn labels_of(sets: &[Set]) -> Vec<usize> {
    let mut labels = vec![0; sets.iter().map(|set| set.sensors.len()).sum()];
    for (at, set) in sets.iter().enumerate() {
        set.sensors.iter().for_each(|&sensor| labels[sensor] = at);
    }
    named_by_appearance(&labels)
}

/// The largest share that is like the others: so many times the one in the middle, or `least`, whichever is more.
pub fn limit(mut shares: Vec<f64>, least: f64) -> f64 {
    shares.sort_by(f64::total_cmp);
    shares.get(shares.len() / 2).map_or(least, |middle| f64::max(least, TIMES_THE_MIDDLE * middle))
}

/// Of the sizes of sets, that of the set which the sensor in the middle is in.
pub fn middle_of_sensors(mut sizes: Vec<usize>) -> usize {
    sizes.sort_unstable();
    let half = sizes.iter().sum::<usize>().div_ceil(2);
    let mut below = 0;
    let reaches = |size: &usize| {
        below += size;
        below >= half
    };
    sizes.into_iter().find(reaches).unwrap_or(0)
}

/// The first of the smallest numbers.
fn least(values: impl Iterator<Item = f64>) -> Option<(usize, f64)> {
    values.enumerate().reduce(|best, other| if other.1 < best.1 { other } else { best })
}

/// The part, or loose set, of all sensors, from those of some, by the motions of these.
fn assigned(parts: &[Set], loose: &[Set], all: &Roots) -> RigidParts {
    let sets: Vec<&Set> = parts.iter().chain(loose).collect();
    let left: Vec<Vec<f64>> = sets.par_iter().map(|set| all.left(&set.fit)).collect();
    let best = |sensor: usize| least(left.iter().map(|left| left[sensor])).expect("there are sets");
    let own: Vec<(usize, f64)> = (0..all.sensors()).map(best).collect();
    let found: Vec<usize> = own.iter().map(|(set, _)| *set).collect();
    let labels = named_by_appearance(&found);
    let names: BTreeMap<usize, usize> = found.iter().copied().zip(labels.iter().copied()).collect();
    let others = |sensor: usize| {
        let named = (0..parts.len()).filter(|set| *set != found[sensor] && names.contains_key(set));
        let mut others: Vec<(usize, f64)> = named.map(|set| (names[&set], left[set][sensor])).collect();
        others.sort_by(|a, b| a.1.total_cmp(&b.1));
        others
    };
    RigidParts {
        left: own.into_iter().map(|(_, left)| left).collect(),
        others: (0..all.sensors()).map(others).collect(),
        loose: (parts.len()..sets.len()).filter_map(|set| names.get(&set).copied()).collect(),
        labels,
    }
}

mod separate;
mod set;

#[cfg(test)]
mod tests;
