//! Say whether chains have mixed: rank-normalised split R̂ and bulk effective sample size (Vehtari, Gelman, Simpson,
//! Carpenter and Bürkner 2021, "Rank-normalization, folding, and localization").

use statrs::distribution::{ContinuousCDF, Normal};
use statrs::statistics::{Data, Median};

/// Up to this R̂, chains count as mixed (Vehtari et al., section 4).
pub(crate) const LARGEST_R_HAT: f64 = 1.01;

/// From this effective sample size on, R̂ can be trusted (section 4).
pub(crate) const LEAST_ESS: f64 = 400.0;

/// How well chains have mixed, by a number of each of their posterior samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mixing {
    /// R̂, the larger of that of the ranks and that of the ranks about the median; `None` where there are fewer than four
    /// posterior samples of a chain.
    pub r_hat: Option<f64>,
    /// Bulk effective sample size.
    pub ess: Option<f64>,
}

/// Of the posterior samples of each chain, as many of each.
pub(crate) fn mixing(chains: &[Vec<f64>]) -> Mixing {
    let length = chains.iter().map(Vec::len).min().unwrap_or(0);
    if length < 4 || chains.iter().flatten().any(|x| !x.is_finite()) {
        return Mixing { r_hat: None, ess: None };
    }
    let halves = halved(chains);
    // The samples of chains that all stay at one value have no ranks to compare. If that value is the same, they agree.
    let first = chains[0][0];
    if chains.iter().flatten().all(|x| *x == first) {
        return Mixing { r_hat: Some(1.0), ess: Some((chains.len() * length) as f64) };
    }
    let ranks = rank_normalised(&halves);
    let median = Data::new(halves.concat()).median();
    let folded: Vec<Vec<f64>> =
        halves.iter().map(|chain| chain.iter().map(|x| (x - median).abs()).collect()).collect();
    let r_hat = r_hat(&ranks).max(r_hat(&rank_normalised(&folded)));
    Mixing { r_hat: Some(r_hat), ess: Some(ess(&ranks)) }
}

/// The first and second half of each chain; of an odd number of posterior samples, the middle one is left out.
fn halved(chains: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let half = |chain: &Vec<f64>| {
        let size = chain.len() / 2;
        [chain[..size].to_vec(), chain[chain.len() - size..].to_vec()]
    };
    chains.iter().flat_map(half).collect()
}

/// Normal scores of the ranks of all samples; equal ones share the mean of their ranks (Blom's offsets).
fn rank_normalised(chains: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let mut order: Vec<(f64, usize, usize)> = Vec::new();
    for (chain, samples) in chains.iter().enumerate() {
        order.extend(samples.iter().enumerate().map(|(at, x)| (*x, chain, at)));
    }
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    let normal = Normal::standard();
    let total = order.len() as f64;
    let mut scores: Vec<Vec<f64>> = chains.iter().map(|samples| vec![0.0; samples.len()]).collect();
    let mut start = 0;
    while start < order.len() {
        let end = start + order[start..].iter().take_while(|(x, ..)| *x == order[start].0).count();
        let rank = (start + 1 + end) as f64 / 2.0;
        let score = normal.inverse_cdf((rank - 0.375) / (total + 0.25));
        order[start..end].iter().for_each(|(_, chain, at)| scores[*chain][*at] = score);
        start = end;
    }
    scores
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn variance(values: &[f64]) -> f64 {
    let centre = mean(values);
    values.iter().map(|x| (x - centre).powi(2)).sum::<f64>() / (values.len() as f64 - 1.0)
}

/// √(var⁺ / W), with W the mean variance within chains, and var⁺ that of all posterior samples.
fn r_hat(chains: &[Vec<f64>]) -> f64 {
    let (within, total) = variances(chains);
    // Chains that never move, at different values: they have nothing in common.
    if within == 0.0 { if total == 0.0 { 1.0 } else { f64::MAX } } else { (total / within).sqrt() }
}

/// W and var⁺.
fn variances(chains: &[Vec<f64>]) -> (f64, f64) {
    let length = chains[0].len() as f64;
    let means: Vec<f64> = chains.iter().map(|chain| mean(chain)).collect();
    let within = mean(&chains.iter().map(|chain| variance(chain)).collect::<Vec<_>>());
    let between = if means.len() > 1 { variance(&means) } else { 0.0 };
    (within, within * (length - 1.0) / length + between)
}

/// Effective sample size by Geyer's initial monotone sequence of autocorrelations.
fn ess(chains: &[Vec<f64>]) -> f64 {
    let length = chains[0].len();
    let samples = (chains.len() * length) as f64;
    let (within, total) = variances(chains);
    if total == 0.0 {
        return samples;
    }
    let centres: Vec<f64> = chains.iter().map(|chain| mean(chain)).collect();
    let autocovariance = |lag: usize| {
        let own = |(chain, centre): (&Vec<f64>, &f64)| {
            let pairs = chain.iter().zip(&chain[lag..]);
            pairs.map(|(x, y)| (x - centre) * (y - centre)).sum::<f64>() / length as f64
        };
        chains.iter().zip(&centres).map(own).sum::<f64>() / chains.len() as f64
    };
    let correlation = |lag: usize| 1.0 - (within - autocovariance(lag)) / total;
    // Pairs of neighbours, until one is not positive; of the last one, the first alone counts.
    let mut pairs = vec![[1.0, correlation(1)]];
    let mut lag = 1;
    while lag + 3 < length && pairs[pairs.len() - 1].iter().sum::<f64>() > 0.0 {
        pairs.push([correlation(lag + 1), correlation(lag + 2)]);
        lag += 2;
    }
    let last = pairs.pop().expect("there is a pair")[0].max(0.0);
    // Sums that never rise.
    let falling = pairs.iter().map(|pair| pair.iter().sum::<f64>()).scan(f64::INFINITY, |least, pair| {
        *least = pair.min(*least);
        Some(*least)
    });
    let time = (2.0 * falling.sum::<f64>() + last - 1.0).max(1.0 / samples.log10());
    samples / time
}

#[cfg(test)]
mod tests;
