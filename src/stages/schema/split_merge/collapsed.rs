//! Sample labels one by one, with the Gaussians of all clusters integrated out.
//!
//! A point that has the wrong label widens the Gaussian of its cluster, and stays. Without its own share in it, it leaves.

use rand::{Rng, RngExt};

use crate::numerics::log_sum::log_sum;
use crate::stages::mixture::{NormalInverseWishart, Points, Predictive, Rounding, SufficientStatistics};

/// The share of points that are drawn in a scan, and how many they are at most, on average: of many points, each says less.
const SHARE: f64 = 0.25;
const MOST: f64 = 210.0;

/// Draws z_i ∝ n_k t(x_i; points and joints of k) for some points, one after the other, and updates `data`, the statistics of
/// each cluster's points and joints. Points that are alone in their cluster stay.
///
/// # Errors
/// [`Rounding`].
pub(super) fn collapsed_labels(
    points: &Points,
    prior: &NormalInverseWishart,
    data: &mut [SufficientStatistics],
    labels: &mut [usize],
    rng: &mut impl Rng,
) -> Result<(), Rounding> {
    if data.len() < 2 {
        return Ok(());
    }
    let share = SHARE.min(MOST / labels.len() as f64);
    let predictive = |data: &SufficientStatistics| Ok(prior.posterior(data)?.predictive());
    let mut predictives: Vec<Predictive> = data.iter().map(predictive).collect::<Result<_, Rounding>>()?;
    let mut counts: Vec<f64> = vec![0.0; data.len()];
    labels.iter().for_each(|&label| counts[label] += 1.0);
    for (i, label) in labels.iter_mut().enumerate() {
        let from = *label;
        if rng.random::<f64>() >= share || counts[from] < 2.0 {
            continue;
        }
        let x = points.row(i);
        let mut without = data[from].clone();
        without.remove(x);
        let own = predictive(&without)?;
        let log_weights: Vec<f64> = (0..data.len())
            .map(|k| {
                let (count, predictive) =
                    if k == from { (counts[k] - 1.0, &own) } else { (counts[k], &predictives[k]) };
                count.ln() + predictive.log_density(x)
            })
            .collect();
        let log_total = log_sum(log_weights.iter().copied());
        let mut threshold = rng.random::<f64>();
        let to = log_weights.iter().position(|weight| {
            threshold -= (weight - log_total).exp();
            threshold < 0.0
        });
        let to = to.unwrap_or(from);
        if to != from {
            data[from] = without;
            predictives[from] = own;
            data[to].add(x);
            predictives[to] = predictive(&data[to])?;
            counts[from] -= 1.0;
            counts[to] += 1.0;
            *label = to;
        }
    }
    Ok(())
}
