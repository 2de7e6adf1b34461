//! Find the parts: sensors are on one part if one motion explains all that they feel, because a part is rigid.
//!
//! In: pressures, and the distances between sensors. Out: the [part](RigidParts) of each sensor. The number of parts is found,
//! too. Neighbours in the distances make small pieces, which nearly always are pieces of one part. Then, in turns, two sets of
//! sensors become one where that [costs](cost) least, and each sensor goes to the set whose motion leaves least of it. A part
//! that one motion does not explain at the times that tell most of it is looked at anew, by itself.
//!
//! The cost of a set is what it takes to tell what its sensors feel up to a tolerance: for each component of its motion half
//! the logarithm of its variance, and for each root beyond these half that of what is left of it, both over the tolerance
//! (the likelihood of probabilistic principal components, Tipping and Bishop 1999; here over roots that tell something), and
//! half a logarithm of the number of times for each c. Two sets of one part share components, so that one of both costs less.

use std::collections::BTreeMap;

use kodama::Method;
use nalgebra::SMatrix;
use rayon::prelude::*;

use super::censored::{Column, Fit, MAX_COMPONENTS, Roots};
use super::motion::{is_signed, spread};
use crate::numerics::linkage;
use crate::numerics::partition::named_by_appearance;
use crate::stages::distance::Distances;
use crate::stages::sense::Tactile;

/// Sensors of a piece, on the mean.
const PIECE: usize = 6;
/// Fewest sensors of which several parts can be found: two pieces.
pub const MIN_SENSORS: usize = 2 * PIECE;
/// Most pieces.
const MAX_PIECES: usize = 100;
/// Times that are read: for the many pieces, and for the few parts.
const TIMES: [usize; 2] = [500, 2000];
/// Times, for each that is read, that it is chosen from, spread over all.
const CHOICE: usize = 4;
/// The share of squares that a motion must leave, of roots beyond its components, so that a part may be several.
const UNEXPLAINED: f64 = 0.05;
/// Turns in which the motion of the body as a whole is found.
const FEW_ROUNDS: usize = 3;
/// Turns in which a motion is found.
const ROUNDS: usize = 6;
/// Sensors of a set that its motion is found from, spread over all.
const MAX_SENSORS: usize = 64;
/// Sets that a set is tried with, the nearest: of the many pieces, and of the few parts.
const NEAR: [usize; 2] = [6, 3];
/// The share of a sensor's squares that is left unexplained without cost.
const TOLERANCE: f64 = 0.01;
/// What one set of two must cost less than both, for each time: it must be seen that they share a component.
const MARGIN: f64 = 1.0;
/// Roots beyond its components that a part must have at a time, on the mean. With fewer, any sensors fit.
const SUPPORT: f64 = 1.0;
/// Components that the motion of a small part must have: of one with less than half of the sensors that a part has in the
/// middle. What feels fewer is no skin of a part, but a few sensors, such as those on the ends of cylinders, that feel alike
/// on several parts.
const LEAST_COMPONENTS: usize = 3;
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
    /// The part whose motion leaves least of the others, and that share; `None` if there is no other part.
    pub next: Vec<Option<(usize, f64)>>,
}

/// Finds the parts.
///
/// In: M × T pressures, of any sign, of sensors that all change; and the distances between `sensors`, which are spread over all
/// of them. The others go to the part whose motion leaves least of them.
pub fn rigid_parts(tactile: &Tactile, sensors: &[usize], distances: &Distances) -> RigidParts {
    let signed = is_signed(tactile);
    let all: Vec<&[f32]> = tactile.series().collect();
    let some: Vec<&[f32]> = sensors.iter().map(|&sensor| all[sensor]).collect();
    let body = Body { series: some, signed, distances };
    let every: Vec<usize> = (0..sensors.len()).collect();
    let times = body.telling_times(&every);
    let found = body.parts_of(&every, &times);
    let labels = body.taken_apart(found.clone());
    let fine = Search { roots: body.roots(&every, &times[1]), distances };
    let labels = if labels == found { labels } else { fine.exchanged(labels, true) };
    assigned(&fine.roots, &labels, &Roots::at(&all, &times[1], signed).normalised())
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
            let fit = roots.fit(&roots.start(), MAX_COMPONENTS.min(some.len()), FEW_ROUNDS);
            let mut order: Vec<(f64, usize)> = roots.left_at_times(&fit).into_iter().zip(times).collect();
            order.sort_by(|a, b| b.0.total_cmp(&a.0));
            let mut chosen: Vec<usize> = order.into_iter().take(count).map(|(_, t)| t).collect();
            chosen.sort_unstable();
            chosen
        })
    }

    /// The parts of some sensors, from pieces.
    fn parts_of(&self, sensors: &[usize], times: &[Vec<usize>; 2]) -> Vec<usize> {
        let n = sensors.len();
        let values = sensors.iter().flat_map(|&i| sensors.iter().map(move |&j| self.distances.get(i, j)));
        let distances = &Distances { sensors: n, values: values.collect() };
        let pieces = (n / PIECE).clamp(1, MAX_PIECES);
        let labels = linkage::clusters(n, |i, j| distances.get(i, j), Method::Average, pieces);
        let search = Search { roots: self.roots(sensors, &times[0]), distances };
        let labels = search.exchanged(search.merged(labels, NEAR[0], 0.0), false);
        let labels = search.settled(labels, usize::MAX);
        Search { roots: self.roots(sensors, &times[1]), distances }.settled(labels, NEAR[1])
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
        let (whole, fit) = best_fit(&roots, &every, 1, MAX_COMPONENTS);
        if fit.residual <= UNEXPLAINED * fit.spare {
            return None;
        }
        let labels = self.parts_of(part, &times);
        let parts = members(&labels);
        let sum: f64 = parts.iter().map(|own| best_fit(&roots, own, 1, MAX_COMPONENTS).0).sum();
        (parts.len() > 1 && whole - sum > MARGIN).then_some(labels)
    }
}

/// Sensors whose sets are looked for.
struct Search<'a> {
    roots: Roots,
    distances: &'a Distances,
}

/// A set of sensors.
struct Set {
    sensors: Vec<usize>,
    cost: f64,
    components: usize,
}

impl Search<'_> {
    /// Makes one of two sets, of each and its `near` nearest, and moves sensors, until nothing changes.
    fn settled(&self, mut labels: Vec<usize>, near: usize) -> Vec<usize> {
        for _ in 0..CYCLES {
            let before = labels.clone();
            labels = self.exchanged(self.merged(labels, near, MARGIN), true);
            if labels == before {
                break;
            }
        }
        labels
    }

    /// Makes one of two sets, of each and its `near` nearest, where that saves most, as long as it saves more than `margin`.
    fn merged(&self, labels: Vec<usize>, near: usize, margin: f64) -> Vec<usize> {
        let first: Vec<Set> =
            members(&labels).into_par_iter().map(|own| self.set(own, 1, MAX_COMPONENTS)).collect();
        let mut sets: BTreeMap<usize, Set> = first.into_iter().enumerate().collect();
        let mut tried: BTreeMap<(usize, usize), Set> = BTreeMap::new();
        let mut name = sets.len();
        while sets.len() > 1 {
            let new: Vec<(usize, usize)> =
                self.pairs(&sets, near).into_iter().filter(|pair| !tried.contains_key(pair)).collect();
            let made = new.into_par_iter().map(|(a, b)| ((a, b), self.union(&sets[&a], &sets[&b])));
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
            sets.insert(name, both);
            name += 1;
        }
        let mut labels = labels;
        for (at, set) in sets.values().enumerate() {
            set.sensors.iter().for_each(|&sensor| labels[sensor] = at);
        }
        named_by_appearance(&labels)
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

    fn union(&self, a: &Set, b: &Set) -> Set {
        let sensors = [a.sensors.as_slice(), &b.sensors].concat();
        self.set(sensors, a.components.max(b.components), a.components + b.components)
    }

    /// A set, with the number of components, in a range, that makes it cost least.
    fn set(&self, sensors: Vec<usize>, least: usize, most: usize) -> Set {
        let (cost, fit) = best_fit(&self.roots, &sensors, least, most);
        Set { sensors, cost, components: fit.components }
    }

    /// Moves each sensor to the set whose motion leaves least of it, until none moves. Where only parts are admitted, sets that
    /// cannot be one go.
    fn exchanged(&self, mut labels: Vec<usize>, only_parts: bool) -> Vec<usize> {
        for _ in 0..EXCHANGES {
            let fits = fits(&self.roots, &labels);
            let mut sizes: Vec<usize> = fits.iter().map(|fit| fit.loadings.len()).collect();
            sizes.sort_unstable();
            let small = sizes[sizes.len() / 2].div_ceil(2);
            let can_be = |fit: &&Fit| {
                let is_skin = fit.components >= LEAST_COMPONENTS || fit.loadings.len() >= small;
                fit.spare >= SUPPORT && is_skin
            };
            let parts: Vec<&Fit> = fits.iter().filter(can_be).collect();
            let kept = if only_parts && !parts.is_empty() { parts } else { fits.iter().collect() };
            let best = |sensor: usize| {
                let left = kept.iter().map(|fit| self.roots.left(sensor, &fit.motions, fit.components));
                least(left).map_or(0, |(part, _)| part)
            };
            let moved = named_by_appearance(&(0..labels.len()).into_par_iter().map(best).collect::<Vec<_>>());
            if moved == labels {
                break;
            }
            labels = moved;
        }
        labels
    }
}

/// The motion of some sensors, with the number of components, in a range, that makes it cost least.
fn best_fit(roots: &Roots, sensors: &[usize], least: usize, most: usize) -> (f64, Fit) {
    let own: Vec<usize> = spread(sensors.len(), MAX_SENSORS).map(|at| sensors[at]).collect();
    let roots = roots.select(&own);
    let (start, most) = (roots.start(), most.min(MAX_COMPONENTS).min(own.len()));
    let try_with = |k: usize| {
        let fit = roots.fit(&start, k, ROUNDS);
        (cost(&fit, sensors.len()), fit)
    };
    // Costs fall with the number of components, and then rise; one step up may be a start that was not good.
    let mut best = try_with(least.min(most));
    let mut worse = 0;
    for k in best.1.components + 1..=most {
        let next = try_with(k);
        if next.0 < best.0 {
            (best, worse) = (next, 0);
        } else {
            worse += 1;
        }
        if worse == 2 {
            break;
        }
    }
    best
}

/// The motion of each set.
fn fits(roots: &Roots, labels: &[usize]) -> Vec<Fit> {
    members(labels).into_par_iter().map(|own| best_fit(roots, &own, 1, MAX_COMPONENTS).1).collect()
}

/// What it takes to tell what a set of sensors feels, for each time, in nats; see the head of this file.
fn cost(fit: &Fit, sensors: usize) -> f64 {
    let times = fit.motions.len() as f64;
    let k = fit.components as f64;
    // The fit may be of a share of the sensors only.
    let ratio = sensors as f64 / fit.loadings.len() as f64;
    let outer = |w: &Column| w * w.transpose();
    let mut scatter: SMatrix<f64, MAX_COMPONENTS, MAX_COMPONENTS> = fit.motions.iter().map(outer).sum();
    // Half of the sensors feel a motion, the others its opposite; with signs, all feel it, which adds a constant.
    scatter *= ratio / (2.0 * times * TOLERANCE);
    let components: f64 =
        scatter.symmetric_eigenvalues().iter().map(|variance| variance.max(0.0).ln_1p()).sum();
    let excess = if fit.spare > 0.0 { (fit.residual / fit.spare / TOLERANCE).max(1.0).ln() } else { 0.0 };
    0.5 * (components + ratio * fit.spare * excess + sensors as f64 * k * times.ln() / times)
}

/// The sensors of each set.
fn members(labels: &[usize]) -> Vec<Vec<usize>> {
    let mut members = vec![Vec::new(); labels.iter().max().map_or(0, |last| last + 1)];
    labels.iter().enumerate().for_each(|(sensor, &label)| members[label].push(sensor));
    members
}

/// The first of the smallest numbers.
fn least(values: impl Iterator<Item = f64>) -> Option<(usize, f64)> {
    values.enumerate().reduce(|best, other| if other.1 < best.1 { other } else { best })
}

/// The part of all sensors, from those of some, by the motions of their parts.
fn assigned(some: &Roots, labels: &[usize], all: &Roots) -> RigidParts {
    let fits = fits(some, labels);
    let ranked = |sensor: usize| {
        let left = |(part, fit): (usize, &Fit)| (all.left(sensor, &fit.motions, fit.components), part);
        let mut shares: Vec<(f64, usize)> = fits.iter().enumerate().map(left).collect();
        shares.sort_by(|a, b| a.0.total_cmp(&b.0));
        (shares[0], shares.get(1).copied())
    };
    let ranked: Vec<_> = (0..all.sensors()).into_par_iter().map(ranked).collect();
    let found: Vec<usize> = ranked.iter().map(|(own, _)| own.1).collect();
    let labels = named_by_appearance(&found);
    let names: BTreeMap<usize, usize> = found.iter().copied().zip(labels.iter().copied()).collect();
    let next = |other: Option<(f64, usize)>| other.and_then(|(left, part)| Some((*names.get(&part)?, left)));
    RigidParts {
        left: ranked.iter().map(|(own, _)| own.0).collect(),
        next: ranked.iter().map(|(_, other)| next(*other)).collect(),
        labels,
    }
}

#[cfg(test)]
mod tests;
