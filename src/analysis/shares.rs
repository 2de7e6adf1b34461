//! Say in what share of a multiverse claims hold, and how often it would look so if the published rate were true.

use rand::{Rng, RngExt};
use rand_distr::{Beta, Binomial, Distribution};

use super::statistics::{Estimate, quantile};

/// Whether something holds in a specification.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Held {
    /// The movement, with its bodies, that the specification shares with others.
    pub movement: usize,
    /// Whether it holds.
    pub holds: bool,
}

/// The share in which it holds, with a 95 % percentile interval over resamples of the movements: with each go its bodies and
/// its specifications.
pub fn share(held: &[Held], rng: &mut impl Rng) -> Estimate {
    const RESAMPLES: usize = 10_000;
    let mut movements: Vec<(usize, f64, f64)> = Vec::new();
    for one in held {
        let holds = f64::from(u8::from(one.holds));
        match movements.iter_mut().find(|(movement, ..)| *movement == one.movement) {
            Some((_, sum, n)) => (*sum, *n) = (*sum + holds, *n + 1.0),
            None => movements.push((one.movement, holds, 1.0)),
        }
    }
    let n = held.len();
    if n == 0 {
        return Estimate::bare(None, 0);
    }
    let value = held.iter().filter(|one| one.holds).count() as f64 / n as f64;
    let mut resampled: Vec<f64> = (0..RESAMPLES)
        .map(|_| {
            let drawn = (0..movements.len()).map(|_| &movements[rng.random_range(0..movements.len())]);
            let (sum, n) = drawn.fold((0.0, 0.0), |(sum, n), (_, holds, of)| (sum + holds, n + of));
            sum / n
        })
        .collect();
    resampled.sort_by(f64::total_cmp);
    let interval = (movements.len() > 1).then(|| (quantile(&resampled, 0.025), quantile(&resampled, 0.975)));
    Estimate { value: Some(value), n, interval, simulations: movements.len(), spread: None }
}

/// The rate of a specification, over some eligible draws of some bodies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rate {
    /// The movement, with its bodies.
    pub movement: usize,
    /// Successes over draws.
    pub rate: f64,
    /// Number of draws.
    pub draws: usize,
    /// Number of bodies that they are from.
    pub bodies: usize,
    /// Lowest and highest rate of a single body, where there are several.
    pub spread: Option<(f64, f64)>,
}

/// What a multiverse of rates looks like beside those that would be if one rate were true in all of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointInference {
    /// Share of the specifications whose rate is in the range.
    pub share: f64,
    /// The same in simulated multiverses: the median, and the ends of the middle 95 %.
    pub expected: (f64, f64, f64),
    /// Share of simulated multiverses with a share as low as this one's, or lower.
    pub as_low: f64,
    /// How strongly bodies differ in the simulated ones: the variance of their rates over that of single outcomes.
    pub correlation: f64,
}

/// If `true_rate` were that of every specification, in what share of simulated multiverses would as few rates, or fewer, be
/// within `range`? After the joint test of Simonsohn, Simmons and Nelson (2020), with simulation in place of permutation.
///
/// Bodies differ: their rates are drawn from a beta distribution, whose variance is that seen between the bodies of one
/// specification beyond what their numbers of draws explain. All specifications of a movement have the same bodies. `None`
/// without a rate.
pub fn joint_inference(
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
    let share = share_of(rates.iter().filter(|one| inside(one.rate)).count());
    let correlation = correlation(rates, true_rate);
    let spread = true_rate * (1.0 - true_rate);
    let bodies_of = |rng: &mut _, count: usize| -> Vec<f64> {
        // Var = spread × correlation, so that a + b = 1 / correlation − 1.
        let both = 1.0 / correlation - 1.0;
        match Beta::new(true_rate * both, (1.0 - true_rate) * both) {
            Ok(beta) if correlation > 0.0 && spread > 0.0 => (0..count).map(|_| beta.sample(rng)).collect(),
            _ => vec![true_rate; count],
        }
    };
    let most = rates.iter().map(|one| one.bodies).max().unwrap_or(1).max(1);
    let mut shares: Vec<f64> = (0..MULTIVERSES)
        .map(|_| {
            let mut movement: Option<(usize, Vec<f64>)> = None;
            let mut count = 0;
            for one in rates {
                if movement.as_ref().is_none_or(|(last, _)| *last != one.movement) {
                    movement = Some((one.movement, bodies_of(rng, most)));
                }
                let bodies = &movement.as_ref().expect("it was drawn").1;
                let right: u64 = (0..one.bodies.max(1))
                    .map(|body| {
                        let draws = shared_out(one.draws, one.bodies.max(1), body) as u64;
                        Binomial::new(draws, bodies[body]).expect("a rate").sample(rng)
                    })
                    .sum();
                count += usize::from(inside(right as f64 / one.draws.max(1) as f64));
            }
            share_of(count)
        })
        .collect();
    shares.sort_by(f64::total_cmp);
    let as_low = shares.partition_point(|one| *one <= share) as f64 / shares.len() as f64;
    let expected = (quantile(&shares, 0.5), quantile(&shares, 0.025), quantile(&shares, 0.975));
    Some(JointInference { share, expected, as_low, correlation })
}

/// The draws of one of several bodies that share them as evenly as can be.
fn shared_out(draws: usize, bodies: usize, body: usize) -> usize {
    draws / bodies + usize::from(body < draws % bodies)
}

/// The variance of the rates of bodies over that of single outcomes, from specifications of two bodies with draws.
fn correlation(rates: &[Rate], true_rate: f64) -> f64 {
    let pairs = rates.iter().filter(|one| one.bodies == 2 && one.draws > 1);
    let excess: Vec<f64> = pairs
        .filter_map(|one| {
            let (low, high) = one.spread?;
            let by_chance = one.rate * (1.0 - one.rate) * 2.0 / one.draws as f64;
            Some((high - low).powi(2) / 2.0 - by_chance)
        })
        .collect();
    let mean = excess.iter().sum::<f64>() / excess.len().max(1) as f64;
    (mean / (true_rate * (1.0 - true_rate))).clamp(0.0, 0.99)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::rng::stream;

    #[test]
    fn a_share_has_the_interval_of_its_movements_not_of_its_specifications() {
        // Ten movements of a hundred specifications that all agree: as much as ten coin throws say.
        let held: Vec<Held> =
            (0..1000).map(|at| Held { movement: at / 100, holds: at / 100 % 2 == 0 }).collect();
        let share = share(&held, &mut stream(1, 0, "shares", 0));
        assert_eq!((share.value, share.simulations), (Some(0.5), 10));
        let (low, high) = share.interval.unwrap();
        assert!((0.1..=0.3).contains(&low) && (0.7..=0.9).contains(&high), "{low} to {high}");
    }

    fn rates(rate: impl Fn(usize) -> f64, spread: Option<(f64, f64)>) -> Vec<Rate> {
        (0..200).map(|at| Rate { movement: at / 4, rate: rate(at), draws: 20, bodies: 2, spread }).collect()
    }

    fn inference(rates: &[Rate]) -> JointInference {
        joint_inference(rates, 0.85, (0.75, 0.95), &mut stream(1, 0, "joint", 0)).unwrap()
    }

    #[test]
    fn a_multiverse_drawn_from_the_rate_looks_like_it_and_another_does_not() {
        // Of 20 draws at 0.85 between 15 and 19 are right with probability 0.894 (binomial distribution).
        let mut rng = stream(2, 0, "joint", 0);
        let binomial = Binomial::new(20, 0.85).unwrap();
        let drawn: Vec<f64> = (0..200).map(|_| binomial.sample(&mut rng) as f64 / 20.0).collect();
        let found = inference(&rates(|at| drawn[at], Some((0.85, 0.85))));
        assert!((found.expected.0 - 0.894).abs() < 0.02, "{found:?}");
        assert!((0.02..0.98).contains(&found.as_low) && found.correlation == 0.0, "{found:?}");
        let other = inference(&rates(|at| if at % 2 == 0 { 1.0 } else { 0.85 }, Some((0.85, 0.85))));
        assert!(other.as_low < 0.001 && other.share == 0.5, "{other:?}");
    }

    #[test]
    fn bodies_that_differ_make_fewer_rates_likely_to_be_in_the_range() {
        let alike = inference(&rates(|_| 0.85, Some((0.85, 0.85))));
        let apart = inference(&rates(|_| 0.85, Some((0.5, 1.0))));
        assert!(apart.correlation > 0.5, "{apart:?}");
        assert!(apart.expected.0 < alike.expected.0 && apart.expected.1 < alike.expected.1, "{apart:?}");
        assert!(joint_inference(&[], 0.85, (0.75, 0.95), &mut stream(1, 0, "joint", 0)).is_none());
    }
}
