//! Find the part of loose sets of sensors, from the joints.
//!
//! The ends of a cylinder alone feel its motion along its axis, and its side alone the rest. Nothing in these two motions says
//! that they are of one part. But the joints do: both parts of a joint know its speed, and each needs all of its own motion for
//! it. So a loose set of sensors belongs to the part that, with the motion of the set, agrees better with its neighbours.
//!
//! In: motions of parts, and of loose sets, at the same times. Out: the part of each set, where the joints tell it.

use std::ops::Range;

use nalgebra::DMatrix;
use rayon::prelude::*;

use super::joint_speed::{Forms, agreement, monomials, scales};
use super::motion::{Motion, spread};
use super::tree::spanning;

/// Times that are read, spread over all.
const TIMES: usize = 4000;
/// What the tree must explain more by a set's going to a part, in nats.
const GAIN: f64 = 0.05;
/// The same of a set that goes from one part to another.
const BETTER: f64 = 0.01;
/// The share of a joint's speed that counts as nothing, where an edge leaves less.
const NEGLIGIBLE: f64 = 1e-3;
/// Times that each set is tried with all parts again.
const REVISITS: usize = 3;

/// The part of each loose set, by its place among `parts`; `None` where no joint gains by it.
///
/// `pairs` are sets that may be the two ends of one part, which gain most together. In turns, a set, or a pair, goes to the part
/// by which the tree explains most more, as long as that is more than [`GAIN`]. Then each is tried with the other parts again.
pub fn owners(
    parts: &[Motion],
    loose: &[Motion],
    pairs: &[(usize, usize)],
    samples: usize,
) -> Vec<Option<usize>> {
    let mut owners = vec![None; loose.len()];
    if parts.len() < 2 || loose.is_empty() {
        return owners;
    }
    let moments = Monomials::new(parts, loose, samples);
    let mut body = Body::new(&moments);
    let ends = (0..loose.len()).map(|set| vec![set]).chain(pairs.iter().map(|&(a, b)| vec![a, b]));
    let tries = ends.flat_map(|sets| (0..parts.len()).map(move |part| (sets.clone(), part)));
    let tries: Vec<(Vec<usize>, usize)> = tries.collect();
    let mut tries: Vec<Try> = tries.into_par_iter().map(|(sets, part)| body.tried(sets, part)).collect();
    loop {
        let found: Vec<f64> = tries.par_iter().map(|one| body.with(one)).collect();
        let Some((at, explained)) = most(found.into_iter()) else { break };
        if explained <= body.explained + GAIN {
            break;
        }
        let taken = tries.swap_remove(at);
        let part = taken.part;
        taken.sets.iter().for_each(|&set| owners[set] = Some(part));
        tries.retain(|one| !one.sets.iter().any(|set| taken.sets.contains(set)));
        body.take(taken);
        tries.par_iter_mut().for_each(|one| {
            if one.part == part {
                *one = body.tried(std::mem::take(&mut one.sets), part);
            } else {
                one.row[part] = moments.agreement(&one.side, &body.sides[part]);
            }
        });
    }
    for _ in 0..REVISITS {
        let before = owners.clone();
        for (set, owner) in owners.iter_mut().enumerate() {
            if let Some(part) = owner {
                *part = body.revisit(set, *part);
            }
        }
        if owners == before {
            break;
        }
    }
    owners
}

/// What the tree over the other parts explains more, in nats, if one of all goes to the part that gains most by it.
pub fn gain(parts: &[Motion], at: usize, samples: usize) -> f64 {
    let others: Vec<Motion> =
        parts.iter().enumerate().filter(|(place, _)| *place != at).map(|(_, own)| own.clone()).collect();
    let moments = Monomials::new(&others, &parts[at..=at], samples);
    let body = Body::new(&moments);
    let with = |part: usize| body.with(&body.tried(vec![0], part)) - body.explained;
    (0..others.len()).into_par_iter().map(with).reduce(|| f64::NEG_INFINITY, f64::max)
}

/// The first of the largest numbers.
fn most(values: impl Iterator<Item = f64>) -> Option<(usize, f64)> {
    values.enumerate().reduce(|best, other| if other.1 > best.1 { other } else { best })
}

/// What the tree of greatest agreement explains of the speeds of joints, in nats: for two Gaussians of correlation ρ, twice what
/// one says of the other is −ln(1 − ρ²).
fn explained(agreement: &DMatrix<f64>) -> f64 {
    let of = |agreement: f64| -(1.0 - agreement * agreement + NEGLIGIBLE).ln();
    spanning(agreement).iter().map(|edge| of(agreement[(edge.child, edge.parent)])).sum()
}

/// A part with some loose sets.
struct Side {
    sets: Vec<usize>,
    /// Where its monomials are.
    places: Vec<usize>,
    forms: Option<Forms>,
}

/// Loose sets that may go to a part.
struct Try {
    sets: Vec<usize>,
    part: usize,
    /// The part with them, and with those that it has.
    side: Side,
    /// Its agreement with each other part.
    row: Vec<f64>,
}

/// All parts with the loose sets that they have.
struct Body<'a> {
    moments: &'a Monomials,
    sides: Vec<Side>,
    agreement: DMatrix<f64>,
    /// What the tree explains.
    explained: f64,
}

impl<'a> Body<'a> {
    fn new(moments: &'a Monomials) -> Self {
        let count = moments.of_part.len();
        let sides: Vec<Side> = (0..count).map(|part| moments.side(part, Vec::new())).collect();
        let mut agreement = DMatrix::identity(count, count);
        for (a, b) in (0..count).flat_map(|a| (a + 1..count).map(move |b| (a, b))) {
            agreement[(a, b)] = moments.agreement(&sides[a], &sides[b]);
            agreement[(b, a)] = agreement[(a, b)];
        }
        Self { moments, sides, explained: explained(&agreement), agreement }
    }

    fn tried(&self, sets: Vec<usize>, part: usize) -> Try {
        let side = self.moments.side(part, [self.sides[part].sets.as_slice(), &sets].concat());
        Try { row: self.row(part, &side, None), sets, part, side }
    }

    /// The agreements of a part, as it would be, with all others, of which one may be as it would be, too.
    fn row(&self, part: usize, side: &Side, changed: Option<(usize, &Side)>) -> Vec<f64> {
        let with = |other: usize| {
            let theirs = changed.filter(|(at, _)| *at == other).map_or(&self.sides[other], |(_, side)| side);
            if other == part { 1.0 } else { self.moments.agreement(side, theirs) }
        };
        (0..self.sides.len()).map(with).collect()
    }

    /// What the tree explains with a try.
    fn with(&self, one: &Try) -> f64 {
        explained(&replaced(&self.agreement, one.part, &one.row))
    }

    fn take(&mut self, one: Try) {
        self.agreement = replaced(&self.agreement, one.part, &one.row);
        self.explained = explained(&self.agreement);
        self.sides[one.part] = one.side;
    }

    /// The part of a set that one part has, after all have been tried again.
    fn revisit(&mut self, set: usize, from: usize) -> usize {
        let rest = self.sides[from].sets.iter().copied().filter(|other| *other != set).collect();
        let without = self.moments.side(from, rest);
        let base = replaced(&self.agreement, from, &self.row(from, &without, None));
        let moved = |part: usize| {
            let side = self.moments.side(part, [self.sides[part].sets.as_slice(), &[set]].concat());
            let row = self.row(part, &side, Some((from, &without)));
            (part, side, replaced(&base, part, &row))
        };
        let others: Vec<usize> = (0..self.sides.len()).filter(|part| *part != from).collect();
        let mut found: Vec<(usize, Side, DMatrix<f64>)> = others.into_par_iter().map(moved).collect();
        let best = most(found.iter().map(|(.., agreement)| explained(agreement)));
        let Some((at, explained)) = best.filter(|(_, sum)| *sum > self.explained + BETTER) else {
            return from;
        };
        let (part, side, agreement) = found.swap_remove(at);
        (self.sides[from], self.sides[part]) = (without, side);
        (self.agreement, self.explained) = (agreement, explained);
        part
    }
}

/// The agreements, with other ones of a part.
fn replaced(agreement: &DMatrix<f64>, part: usize, row: &[f64]) -> DMatrix<f64> {
    let mut changed = agreement.clone();
    for (other, &value) in row.iter().enumerate() {
        (changed[(part, other)], changed[(other, part)]) = (value, value);
    }
    changed
}

/// Sums over times of the products of monomials: of each part's motion, of each loose set's, and of one of each.
struct Monomials {
    sums: DMatrix<f64>,
    /// Where the monomials of a part, of two loose sets, and of a part and a loose set are.
    of_part: Vec<Range<usize>>,
    of_sets: Vec<Vec<Range<usize>>>,
    of_both: Vec<Vec<Range<usize>>>,
    /// Components of each part, and of each set.
    parts: Vec<usize>,
    sets: Vec<usize>,
}

impl Monomials {
    fn new(parts: &[Motion], loose: &[Motion], samples: usize) -> Self {
        let times: Vec<usize> = spread(samples, TIMES).collect();
        let scales = scales(parts, samples);
        let mut columns: Vec<Vec<f64>> = Vec::new();
        let mut add = |a: &Motion, b: &Motion, same: bool| {
            let first = columns.len();
            for i in 0..a.components {
                for j in if same { i } else { 0 }..b.components {
                    columns.push(times.iter().map(|&t| scales[t] * a.at(t)[i] * b.at(t)[j]).collect());
                }
            }
            first..columns.len()
        };
        let of_part = parts.iter().map(|part| add(part, part, true)).collect();
        let of_sets =
            (0..loose.len()).map(|a| (0..=a).map(|b| add(&loose[a], &loose[b], a == b)).collect()).collect();
        let of_both =
            parts.iter().map(|part| loose.iter().map(|set| add(part, set, false)).collect()).collect();
        let all = DMatrix::from_fn(times.len(), columns.len(), |row, column| columns[column][row]);
        let components = |motions: &[Motion]| motions.iter().map(|motion| motion.components).collect();
        let (parts, sets) = (components(parts), components(loose));
        Self { sums: all.transpose() * &all, of_part, of_sets, of_both, parts, sets }
    }

    /// The places of the monomials of a part with these sets, and which two numbers of their motion each is the product of.
    fn places(&self, part: usize, sets: &[usize]) -> (Vec<usize>, Vec<(usize, usize)>) {
        let k = self.parts[part];
        let mut places: Vec<usize> = self.of_part[part].clone().collect();
        let mut pairs = monomials(k);
        let mut firsts: Vec<usize> = Vec::new();
        let mut next = k;
        for (at, &set) in sets.iter().enumerate() {
            firsts.push(next);
            let own = next..next + self.sets[set];
            next = own.end;
            places.extend(self.of_both[part][set].clone());
            pairs.extend((0..k).flat_map(|i| own.clone().map(move |j| (i, j))));
            for (&other, &first) in sets[..=at].iter().zip(&firsts) {
                places.extend(self.of_sets[set.max(other)][set.min(other)].clone());
                let theirs = first..first + self.sets[other];
                // The set of the greater number gives the rows.
                let (rows, columns) = if set > other { (&own, &theirs) } else { (&theirs, &own) };
                if set == other {
                    pairs.extend(own.clone().flat_map(|i| (i..own.end).map(move |j| (i, j))));
                } else {
                    pairs.extend(
                        rows.clone().flat_map(|i| columns.clone().map(move |j| (i.min(j), i.max(j)))),
                    );
                }
            }
        }
        (places, pairs)
    }

    /// A part with loose sets.
    fn side(&self, part: usize, sets: Vec<usize>) -> Side {
        let (places, pairs) = self.places(part, &sets);
        let forms = Forms::new(pairs, self.select(&places, &places));
        Side { sets, places, forms }
    }

    fn select(&self, rows: &[usize], columns: &[usize]) -> DMatrix<f64> {
        DMatrix::from_fn(rows.len(), columns.len(), |row, column| self.sums[(rows[row], columns[column])])
    }

    /// The agreement of two parts.
    fn agreement(&self, first: &Side, second: &Side) -> f64 {
        agreement(&first.forms, &second.forms, &self.select(&first.places, &second.places))
    }
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::super::fixtures::row;
    use super::*;
    use crate::numerics::rng::stream;

    #[test]
    fn ends_are_on_the_part_whose_joints_need_them() {
        let (parts, ends) = row(3, 4000);
        assert_eq!(owners(&parts, &ends, &[], 4000), [Some(0), Some(1), Some(2)]);
        // In two halves, of which one rests while the other feels.
        let half = |end: &Motion, sign: f64| Motion {
            components: 1,
            values: end.values.iter().map(|value| (sign * value).max(0.0)).collect(),
        };
        let halves: Vec<Motion> = ends.iter().flat_map(|end| [half(end, 1.0), half(end, -1.0)]).collect();
        let pairs = [(0, 1), (2, 3), (4, 5)];
        let found: Vec<_> = [0, 0, 1, 1, 2, 2].map(Some).to_vec();
        assert_eq!(owners(&parts, &halves, &pairs, 4000), found);
    }

    #[test]
    fn what_no_joint_needs_is_on_no_part() {
        let (parts, ends) = row(3, 4000);
        let parts: Vec<Motion> = parts.iter().zip(&ends).map(|(part, end)| part.with(end)).collect();
        let mut rng = stream(1, 1, "owners", 1);
        let other =
            Motion { components: 1, values: (0..4000).map(|_| rng.random_range(-1.0..1.0)).collect() };
        assert_eq!(owners(&parts, std::slice::from_ref(&other), &[], 4000), [None]);
        assert_eq!(owners(&parts[..1], &[other], &[], 4000), [None]);
        assert_eq!(owners(&parts, &[], &[], 4000), []);
    }
}
