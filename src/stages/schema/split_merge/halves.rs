//! Propose how to split a set of points in two, with the probability of each split.
//!
//! The proposal depends on the set and on the two points that the move was drawn for, and on nothing else: not on how the
//! points are split now. So the same function proposes a split, and gives the probability of the split that a merge undoes
//! (Jain and Neal 2004: a launch state). From the two points it goes on by Lloyd's algorithm and by rounds of full
//! covariances, without chance; then each point falls to a side at random, by its densities.
//!
//! A merge is accepted only if the split that it undoes is likely to be proposed, and a chain may have split a part in many
//! ways. So some proposals take a root of the odds, and some pay no heed to the points: they draw a share of the first
//! side, evenly, and let each point fall by it. Such splits are hardly ever accepted, but the merges that undo them are
//! ("smart" merges with "dumb" splits: Wang and Russell 2015).

use rand::{Rng, RngExt};

use crate::stages::mixture::{Gaussian, NormalInverseWishart, Points, Rounding, SufficientStatistics};

/// Rounds of Lloyd's algorithm, and rounds of Gaussians, at most.
const ROUNDS: usize = 10;

/// What a split goes by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Care {
    /// By the odds of each point to this power.
    Odds(f64),
    /// By a share that is drawn evenly.
    Blind,
}

/// How to split some points between the sides of two of them.
#[derive(Debug)]
pub struct Halves {
    /// The points, rising, without the two.
    others: Vec<usize>,
    /// Of each of them, log odds of the first side; none if the split is blind.
    log_odds: Option<Vec<f64>>,
    /// The points that have the sides.
    ends: [usize; 2],
}

impl Halves {
    /// Of the points `members`, rising, of which both `ends` are two.
    ///
    /// # Errors
    /// [`Rounding`].
    pub fn new(
        points: &Points,
        prior: &NormalInverseWishart,
        members: &[usize],
        ends: [usize; 2],
        care: Care,
    ) -> Result<Self, Rounding> {
        let others = members.iter().copied().filter(|point| !ends.contains(point)).collect();
        let mut halves = Self { others, log_odds: None, ends };
        if let Care::Odds(power) = care {
            let odds = halves.odds(points, prior)?;
            halves.log_odds = Some(odds.into_iter().map(|odds| odds * power).collect());
        }
        Ok(halves)
    }

    /// Log odds of the first side, of each point.
    fn odds(&self, points: &Points, prior: &NormalInverseWishart) -> Result<Vec<f64>, Rounding> {
        let Self { others, ends, .. } = self;
        let mut centres = ends.map(|end| points.row(end).to_vec());
        let mut first: Vec<bool> = Vec::new();
        for _ in 0..ROUNDS {
            let nearer: Vec<bool> = others
                .iter()
                .map(|&i| square(points.row(i), &centres[0]) <= square(points.row(i), &centres[1]))
                .collect();
            if nearer == first {
                break;
            }
            first = nearer;
            centres = [true, false].map(|side| {
                let end = ends[usize::from(!side)];
                let own = others.iter().zip(&first).filter(|(_, is)| **is == side).map(|(i, _)| *i);
                mean(points, own.chain([end]))
            });
        }
        let mut log_odds = Vec::new();
        for _ in 0..ROUNDS {
            let gaussians = self.gaussians(points, prior, &first)?;
            let odds = |&i: &usize| {
                let [a, b] = &gaussians;
                let row = points.row(i);
                (a.1 + a.0.log_density(row)) - (b.1 + b.0.log_density(row))
            };
            log_odds = others.iter().map(odds).collect();
            let likelier: Vec<bool> = log_odds.iter().map(|odds: &f64| *odds >= 0.0).collect();
            if likelier == first {
                break;
            }
            first = likelier;
        }
        Ok(log_odds)
    }

    /// The predictive Gaussian of each side, with the logarithm of its count.
    fn gaussians(
        &self,
        points: &Points,
        prior: &NormalInverseWishart,
        first: &[bool],
    ) -> Result<[(Gaussian, f64); 2], Rounding> {
        let of = |side: bool| {
            let members = self.side(first, side);
            let posterior = prior.posterior(&SufficientStatistics::of(points, &members))?;
            Ok((posterior.predictive().gaussian, (members.len() as f64).ln()))
        };
        Ok([of(true)?, of(false)?])
    }

    /// The points of a side, rising.
    fn side(&self, first: &[bool], side: bool) -> Vec<usize> {
        let own = self.others.iter().zip(first).filter(|(_, is)| **is == side).map(|(i, _)| *i);
        let mut members: Vec<usize> = own.chain([self.ends[usize::from(!side)]]).collect();
        members.sort_unstable();
        members
    }

    /// Draws a split: the points of both sides, rising, and the logarithm of its probability.
    pub fn draw(&self, rng: &mut impl Rng) -> ([Vec<usize>; 2], f64) {
        let first: Vec<bool> = if let Some(odds) = &self.log_odds {
            odds.iter().map(|odds| rng.random::<f64>() < 1.0 / (1.0 + (-odds).exp())).collect()
        } else {
            let share: f64 = rng.random();
            self.others.iter().map(|_| rng.random::<f64>() < share).collect()
        };
        let log_probability = self.log_probability_of(first.iter().copied());
        ([self.side(&first, true), self.side(&first, false)], log_probability)
    }

    /// Logarithm of the probability that [`Self::draw`] gives the split in which `is_first` says which points fall to the
    /// first side.
    pub fn log_probability(&self, is_first: impl Fn(usize) -> bool) -> f64 {
        self.log_probability_of(self.others.iter().map(|&i| is_first(i)))
    }

    fn log_probability_of(&self, first: impl Iterator<Item = bool>) -> f64 {
        let Some(log_odds) = &self.log_odds else {
            // The integral of f^a (1 − f)^b over the share f: a! b! / (a + b + 1)!.
            let (all, a) = (self.others.len() as f64, first.filter(|is| *is).count() as f64);
            return libm::lgamma(a + 1.0) + libm::lgamma(all - a + 1.0) - libm::lgamma(all + 2.0);
        };
        // log (1 / (1 + e^−x)), of a side's own log odds x.
        let log_share = |odds: f64| -(-odds.abs()).exp().ln_1p() + odds.min(0.0);
        first.zip(log_odds).map(|(is, odds)| log_share(if is { *odds } else { -odds })).sum()
    }
}

fn mean(points: &Points, members: impl Iterator<Item = usize>) -> Vec<f64> {
    let (mut sum, mut count) = (vec![0.0; points.dims], 0.0);
    for i in members {
        sum.iter_mut().zip(points.row(i)).for_each(|(sum, x)| *sum += x);
        count += 1.0;
    }
    sum.iter_mut().for_each(|sum| *sum /= count);
    sum
}

fn square(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| (x - y).powi(2)).sum()
}
