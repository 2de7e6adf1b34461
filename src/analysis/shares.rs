//! Say in what share of a multiverse claims hold, and how often it would look so if the published rate were true.

use rand::Rng;
use rand_distr::{Beta, Binomial, Distribution};
use serde::Serialize;

use super::bootstrap;
use super::statistics::{Estimate, quantile, wilson};

/// Whether something holds in a specification.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Held {
    /// The movement, with its bodies, that the specification shares with others.
    pub movement: usize,
    /// Whether it holds.
    pub holds: bool,
}

/// The share in which it holds, with a 95 % percentile interval over resamples of the movements, with which go their bodies,
/// and of the specifications of each. The interval is never narrower than Wilson's for as many throws as there are movements.
pub(crate) fn share(held: &[Held], rng: &mut impl Rng) -> Estimate {
    const RESAMPLES: usize = 2_000;
    let mut movements: Vec<(usize, Vec<f64>)> = Vec::new();
    for one in held {
        let holds = f64::from(u8::from(one.holds));
        match movements.iter_mut().find(|(movement, _)| *movement == one.movement) {
            Some((_, all)) => all.push(holds),
            None => movements.push((one.movement, vec![holds])),
        }
    }
    let n = held.len();
    if n == 0 {
        return Estimate::bare(None, 0);
    }
    let value = held.iter().filter(|one| one.holds).count() as f64 / n as f64;
    let sizes: Vec<usize> = movements.iter().map(|(_, all)| all.len()).collect();
    let resampled = bootstrap::of_clusters(&sizes, RESAMPLES, rng, |drawn| {
        drawn.iter().map(|&(movement, at)| movements[movement].1[at]).sum::<f64>() / drawn.len() as f64
    });
    let (low, high) = wilson(value * movements.len() as f64, movements.len() as f64);
    let interval = (quantile(&resampled, 0.025).min(low), quantile(&resampled, 0.975).max(high));
    Estimate { value: Some(value), n, interval: Some(interval), simulations: movements.len(), spread: None }
}

/// The posterior samples of a specification.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Rate {
    /// The movement, with its bodies.
    pub movement: usize,
    /// Successes and posterior samples of each body.
    pub bodies: Vec<(usize, usize)>,
}

impl Rate {
    /// Number of posterior samples.
    pub(crate) fn samples(&self) -> usize {
        self.bodies.iter().map(|(_, samples)| samples).sum()
    }

    fn rate(&self) -> f64 {
        self.bodies.iter().map(|(right, _)| right).sum::<usize>() as f64 / self.samples() as f64
    }
}

/// What a multiverse of rates looks like beside those that would be if one rate were true in all of it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(crate) struct JointInference {
    /// Number of specifications.
    pub n: usize,
    /// Share of them whose rate is in the range.
    pub share: f64,
    /// The same in simulated multiverses: the median.
    pub expected: f64,
    /// Lower end of the middle 95 % of simulated multiverses.
    pub expected_low: f64,
    /// Upper end of them.
    pub expected_high: f64,
    /// Share of simulated multiverses with a share as low as this one's, or lower; this one counts as one of them.
    pub as_low: f64,
    /// How strongly bodies differ in the simulated ones: the variance of their rates over that of single outcomes.
    pub correlation: f64,
}

/// If `true_rate` were that of every specification, in what share of simulated multiverses would as few rates, or fewer, be
/// within `range`? After the joint test of Simonsohn, Simmons and Nelson (2020), with simulation in place of permutation.
///
/// Bodies differ: their rates are drawn from a beta distribution with the correlation that is seen between the samples of one
/// body. All specifications of a movement have the same bodies; those of one must stand together. `None` without a rate.
pub(crate) fn joint_inference(
    rates: &[Rate],
    true_rate: f64,
    range: (f64, f64),
    rng: &mut impl Rng,
) -> Option<JointInference> {
    const MULTIVERSES: usize = 10_000;
    let inside = |rate: f64| range.0 <= rate && rate <= range.1;
    if rates.is_empty() {
        return None;
    }
    let share_of = |count: usize| count as f64 / rates.len() as f64;
    let share = share_of(rates.iter().filter(|one| inside(one.rate())).count());
    let correlation = correlation(rates);
    // Var = p (1 − p) × correlation, so that a + b = 1 / correlation − 1.
    let both = 1.0 / correlation - 1.0;
    let beta = Beta::new(true_rate * both, (1.0 - true_rate) * both).ok().filter(|_| correlation > 0.0);
    let most = rates.iter().map(|one| one.bodies.len()).max().unwrap_or_default();
    let mut shares: Vec<f64> = (0..MULTIVERSES)
        .map(|_| {
            let mut count = 0;
            for together in rates.chunk_by(|one, other| one.movement == other.movement) {
                let bodies: Vec<f64> =
                    (0..most).map(|_| beta.map_or(true_rate, |beta| beta.sample(rng))).collect();
                for one in together {
                    let right: u64 = one
                        .bodies
                        .iter()
                        .zip(&bodies)
                        .map(|((_, samples), rate)| {
                            Binomial::new(*samples as u64, *rate).expect("a rate").sample(rng)
                        })
                        .sum();
                    count += usize::from(inside(right as f64 / one.samples() as f64));
                }
            }
            share_of(count)
        })
        .collect();
    shares.sort_by(f64::total_cmp);
    let as_low = shares.partition_point(|one| *one <= share);
    Some(JointInference {
        n: rates.len(),
        share,
        expected: quantile(&shares, 0.5),
        expected_low: quantile(&shares, 0.025),
        expected_high: quantile(&shares, 0.975),
        as_low: (as_low + 1) as f64 / (shares.len() + 1) as f64,
        correlation,
    })
}

/// The correlation of two samples of one body, from all specifications with several bodies: the estimator of the analysis of
/// variance (Ridout, Demetrio and Firth 1999), its parts summed over specifications; not below 0.
fn correlation(rates: &[Rate]) -> f64 {
    let (mut above, mut below) = (0.0, 0.0);
    for one in rates {
        let bodies: Vec<(f64, f64)> = one
            .bodies
            .iter()
            .filter(|(_, samples)| *samples > 0)
            .map(|&(right, samples)| (right as f64 / samples as f64, samples as f64))
            .collect();
        let (count, samples) = (bodies.len() as f64, one.samples() as f64);
        if count < 2.0 || samples <= count {
            continue;
        }
        let rate = one.rate();
        let between = bodies.iter().map(|(own, n)| n * (own - rate).powi(2)).sum::<f64>() / (count - 1.0);
        let within = bodies.iter().map(|(own, n)| n * own * (1.0 - own)).sum::<f64>() / (samples - count);
        let size = (samples - bodies.iter().map(|(_, n)| n * n).sum::<f64>() / samples) / (count - 1.0);
        above += between - within;
        below += between + (size - 1.0) * within;
    }
    if below > 0.0 { (above / below).clamp(0.0, 0.99) } else { 0.0 }
}

#[cfg(test)]
mod tests;
