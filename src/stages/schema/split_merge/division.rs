//! Propose how to divide a set of points among a few of them, its ends, with the probability of each division.
//!
//! The proposal depends on the set and on its ends, and on nothing else: not on how the points are divided now. So the same
//! function proposes a division, and gives the probability of the division that the opposite move undoes (Jain and Neal
//! 2004: a launch state). From the ends it goes on by Lloyd's algorithm and by rounds of full covariances, without chance;
//! then each point falls to a side at random, by its densities.
//!
//! A merge is accepted only if the split that it undoes is likely to be proposed, and a chain may have split a part in many
//! ways. So some proposals take a root of the odds, and some pay no heed to the points: they draw a share of each side,
//! evenly, and let each point fall by it. Such splits are hardly ever accepted, but the merges that undo them are
//! ("smart" merges with "dumb" splits: Wang and Russell 2015).

use rand::{Rng, RngExt};
use rand_distr::Exp1;

use crate::numerics::log_sum::log_sum;
use crate::stages::mixture::{Gaussian, NormalInverseWishart, Points, Rounding, SufficientStatistics};

/// Rounds of Lloyd's algorithm, and rounds of Gaussians, at most.
const ROUNDS: usize = 10;

/// How a split is proposed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum SplitProposal {
    /// By the odds of each point, tempered to this power.
    Tempered(f64),
    /// By random shares, whatever the points ("dumb" splits).
    Uninformed,
}

/// How to divide some points among their ends, a side for each.
#[derive(Debug)]
pub(super) struct Division {
    /// The points, rising, without the ends.
    others: Vec<usize>,
    /// The points that have the sides.
    ends: Vec<usize>,
    /// Of each of the others, the logarithms of the probabilities of all sides; none if the proposal is uninformed, or has one side.
    log_shares: Option<Vec<f64>>,
}

impl Division {
    /// Of the points `members`, rising, of which the `ends` are one or more.
    ///
    /// # Errors
    /// [`Rounding`].
    pub(super) fn new(
        points: &Points,
        prior: &NormalInverseWishart,
        members: &[usize],
        ends: &[usize],
        care: SplitProposal,
    ) -> Result<Self, Rounding> {
        let others = members.iter().copied().filter(|point| !ends.contains(point)).collect();
        let mut division = Self { others, ends: ends.to_vec(), log_shares: None };
        if let SplitProposal::Tempered(power) = care
            && ends.len() > 1
        {
            division.log_shares = Some(division.weigh(points, prior, power)?);
        }
        Ok(division)
    }

    /// The logarithms of the probabilities of all sides, of each point.
    fn weigh(&self, points: &Points, prior: &NormalInverseWishart, power: f64) -> Result<Vec<f64>, Rounding> {
        let size = self.ends.len();
        let mut centres: Vec<Vec<f64>> = self.ends.iter().map(|&end| points.row(end).to_vec()).collect();
        let mut sides: Vec<usize> = Vec::new();
        for _ in 0..ROUNDS {
            let nearness = |&i: &usize| {
                let row = points.row(i);
                largest(centres.iter().map(|centre| -square(row, centre)))
            };
            let nearest: Vec<usize> = self.others.iter().map(nearness).collect();
            if nearest == sides {
                break;
            }
            sides = nearest;
            centres = self.members(&sides).iter().map(|members| mean(points, members)).collect();
        }
        let mut logs: Vec<f64> = Vec::new();
        for _ in 0..ROUNDS {
            let gaussians = self
                .members(&sides)
                .iter()
                .map(|members| predictive(points, prior, members))
                .collect::<Result<Vec<_>, Rounding>>()?;
            let weights = |&i: &usize| {
                let row = points.row(i);
                gaussians.iter().map(move |(gaussian, log_count)| log_count + gaussian.log_density(row))
            };
            logs = self.others.iter().flat_map(weights).collect();
            let likeliest: Vec<usize> =
                logs.chunks_exact(size).map(|logs| largest(logs.iter().copied())).collect();
            if likeliest == sides {
                break;
            }
            sides = likeliest;
        }
        for logs in logs.chunks_exact_mut(size) {
            logs.iter_mut().for_each(|log| *log *= power);
            let total = log_sum(logs.iter().copied());
            logs.iter_mut().for_each(|log| *log -= total);
        }
        Ok(logs)
    }

    /// The points of each side, rising, given the sides of the others.
    fn members(&self, sides: &[usize]) -> Vec<Vec<usize>> {
        let mut members: Vec<Vec<usize>> = self.ends.iter().map(|&end| vec![end]).collect();
        self.others.iter().zip(sides).for_each(|(&i, &side)| members[side].push(i));
        members.iter_mut().for_each(|members| members.sort_unstable());
        members
    }

    /// Draws a division: the points of each side, rising, and the logarithm of its probability.
    pub(super) fn draw(&self, rng: &mut impl Rng) -> (Vec<Vec<usize>>, f64) {
        let size = self.ends.len();
        let sides: Vec<usize> = if let Some(log_shares) = &self.log_shares {
            log_shares.chunks_exact(size).map(|logs| side(logs.iter().map(|log| log.exp()), rng)).collect()
        } else {
            let shares: Vec<f64> = (0..size).map(|_| rng.sample::<f64, _>(Exp1)).collect();
            let total: f64 = shares.iter().sum();
            self.others.iter().map(|_| side(shares.iter().map(|share| share / total), rng)).collect()
        };
        (self.members(&sides), self.log_probability_of(sides.into_iter()))
    }

    /// Logarithm of the probability that [`Self::draw`] gives the division in which `side_of` says to which side each point
    /// falls.
    pub(super) fn log_probability(&self, side_of: impl Fn(usize) -> usize) -> f64 {
        self.log_probability_of(self.others.iter().map(|&i| side_of(i)))
    }

    fn log_probability_of(&self, sides: impl Iterator<Item = usize>) -> f64 {
        let size = self.ends.len();
        if let Some(log_shares) = &self.log_shares {
            return sides.zip(log_shares.chunks_exact(size)).map(|(side, logs)| logs[side]).sum();
        }
        // The integral of ∏ f_s^(n_s) over shares f that sum to 1: (S − 1)! ∏ n_s! / (n + S − 1)! for S sides.
        let mut counts = vec![0.0; size];
        sides.for_each(|side| counts[side] += 1.0);
        let sides: f64 = counts.iter().map(|count| libm::lgamma(count + 1.0)).sum();
        libm::lgamma(size as f64) + sides - libm::lgamma((self.others.len() + size) as f64)
    }
}

/// A side with these probabilities; the last, if rounding leaves none.
fn side(shares: impl ExactSizeIterator<Item = f64>, rng: &mut impl Rng) -> usize {
    let (mut threshold, last) = (rng.random::<f64>(), shares.len() - 1);
    shares.take(last).position(|share| (threshold -= share, threshold < 0.0).1).unwrap_or(last)
}

/// Where the largest of some numbers is; the first of equal ones.
fn largest(numbers: impl Iterator<Item = f64>) -> usize {
    numbers.enumerate().reduce(|kept, next| if next.1 > kept.1 { next } else { kept }).map_or(0, |(at, _)| at)
}

/// The predictive Gaussian of some points, with the logarithm of their count.
fn predictive(
    points: &Points,
    prior: &NormalInverseWishart,
    members: &[usize],
) -> Result<(Gaussian, f64), Rounding> {
    let posterior = prior.posterior(&SufficientStatistics::of(points, members))?;
    Ok((posterior.predictive().gaussian, (members.len() as f64).ln()))
}

fn mean(points: &Points, members: &[usize]) -> Vec<f64> {
    let mut sum = vec![0.0; points.dims];
    for &i in members {
        sum.iter_mut().zip(points.row(i)).for_each(|(sum, x)| *sum += x);
    }
    sum.iter_mut().for_each(|sum| *sum /= members.len() as f64);
    sum
}

fn square(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| (x - y).powi(2)).sum()
}
