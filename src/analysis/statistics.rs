//! Estimate rates and means with their intervals, and test for differences.

use statrs::distribution::{ChiSquared, ContinuousCDF, StudentsT};
use statrs::stats_tests::Alternative;
use statrs::stats_tests::mannwhitneyu::{MannWhitneyUMethod, mannwhitneyu};

/// A value with its 95 % interval, and how many observations it rests on.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Estimate {
    /// The value; `None` without an observation (0 of 0 is no rate).
    pub value: Option<f64>,
    /// Number of observations.
    pub n: usize,
    /// Lower and upper end of the 95 % interval, where there is one.
    pub interval: Option<(f64, f64)>,
    /// Number of simulations that the observations are from.
    pub simulations: usize,
    /// Lowest and highest value of a single simulation, where there are several.
    pub spread: Option<(f64, f64)>,
}

impl Estimate {
    /// A value without an interval.
    pub fn bare(value: Option<f64>, n: usize) -> Self {
        Self { value, n, ..Self::default() }
    }
}

/// The 97.5 % quantile of the standard normal distribution.
const Z: f64 = 1.959_963_984_540_054;

/// `successes` of `n` independent trials, with Wilson's (1927) score interval.
pub fn rate(successes: usize, n: usize) -> Estimate {
    Estimate {
        value: (n > 0).then(|| successes as f64 / n as f64),
        n,
        interval: (n > 0).then(|| wilson(successes as f64, n as f64)),
        ..Estimate::default()
    }
}

/// Wilson's (1927) score interval of `k` successes of `n` > 0, which need not be whole numbers.
pub fn wilson(k: f64, n: f64) -> (f64, f64) {
    let p = k / n;
    let centre = (p + Z * Z / (2.0 * n)) / (1.0 + Z * Z / n);
    let half = Z / (1.0 + Z * Z / n) * (p * (1.0 - p) / n + Z * Z / (4.0 * n * n)).sqrt();
    // At the ends the interval touches 0 or 1 exactly; rounding must not push it past or short.
    let low = if k == 0.0 { 0.0 } else { centre - half };
    let high = if k == n { 1.0 } else { centre + half };
    (low, high)
}

/// 95 % interval of the difference of two independent rates: of a reproduced one, `value` with its
/// `interval`, minus a published one of (successes, n), n > 0. Newcombe's (1998) hybrid score interval, his
/// method 10, which takes the interval of each rate as it is.
pub fn rate_difference(value: f64, interval: (f64, f64), published: (usize, usize)) -> (f64, f64) {
    let (low, high) = wilson(published.0 as f64, published.1 as f64);
    let other = published.0 as f64 / published.1 as f64;
    (
        value - other - (value - interval.0).hypot(high - other),
        value - other + (interval.1 - value).hypot(other - low),
    )
}

/// The mean of independent values, with Student's 95 % interval (from two values on).
pub fn mean(values: &[f64]) -> Estimate {
    let n = values.len();
    let mean = values.iter().sum::<f64>() / n.max(1) as f64;
    let variance = values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n.saturating_sub(1).max(1) as f64;
    let half = (variance / n.max(1) as f64).sqrt();
    let interval = (n > 1).then(|| student(n) * half).map(|half| (mean - half, mean + half));
    Estimate { value: (n > 0).then_some(mean), n, interval, ..Estimate::default() }
}

/// The 97.5 % quantile of Student's t with n − 1 degrees of freedom, n > 1.
pub fn student(n: usize) -> f64 {
    StudentsT::new(0.0, 1.0, (n - 1) as f64).expect("n > 1").inverse_cdf(0.975)
}

/// The lowest and the highest of several values.
pub fn spread(values: &[f64]) -> Option<(f64, f64)> {
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    (values.len() > 1).then_some((least, most))
}

/// The quantile of `sorted` values, not empty, with linear interpolation (NumPy's default).
pub fn quantile(sorted: &[f64], share: f64) -> f64 {
    let at = share * (sorted.len() - 1) as f64;
    let (below, above) = (sorted[at.floor() as usize], sorted[at.ceil() as usize]);
    below + (above - below) * at.fract()
}

/// Two-sided p value of the Mann–Whitney U test, by the normal approximation with corrections for ties
/// and continuity, as SciPy's `mannwhitneyu(method="asymptotic")`; 1 where nothing differs or a group is empty.
pub fn mann_whitney(first: &[f64], second: &[f64]) -> f64 {
    const METHOD: MannWhitneyUMethod = MannWhitneyUMethod::AsymptoticInclContinuityCorrection;
    mannwhitneyu(first, second, METHOD, Alternative::TwoSided).map_or(1.0, |(_, p_value)| p_value)
}

/// p value of the Kruskal–Wallis test that all groups have one distribution, with the correction for ties,
/// as SciPy's `kruskal`; `None` with fewer than two groups or with an empty one, and 1 where nothing
/// differs.
pub fn kruskal_wallis(groups: &[Vec<f64>]) -> Option<f64> {
    if groups.len() < 2 || groups.iter().any(Vec::is_empty) {
        return None;
    }
    let all: Vec<(f64, usize)> = groups
        .iter()
        .enumerate()
        .flat_map(|(group, values)| values.iter().map(move |&value| (value, group)))
        .collect();
    let (ranks, ties) = rank_sums(all, groups.len());
    let n = groups.iter().map(Vec::len).sum::<usize>() as f64;
    let between: f64 = ranks.iter().zip(groups).map(|(sum, values)| sum * sum / values.len() as f64).sum();
    let untied = 1.0 - ties / (n * n * n - n);
    if untied.is_nan() || untied <= 0.0 {
        return Some(1.0);
    }
    let statistic = (12.0 / (n * (n + 1.0)) * between - 3.0 * (n + 1.0)) / untied;
    let freedom = (groups.len() - 1) as f64;
    Some(ChiSquared::new(freedom).expect("at least two groups").sf(statistic))
}

/// The sum of ranks of each group, and Σ (t³ − t) over ties of t values.
fn rank_sums(mut all: Vec<(f64, usize)>, groups: usize) -> (Vec<f64>, f64) {
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut sums, mut ties, mut before) = (vec![0.0; groups], 0.0, 0.0);
    for tied in all.chunk_by(|a, b| a.0 == b.0) {
        let size = tied.len() as f64;
        tied.iter().for_each(|(_, group)| sums[*group] += before + (size + 1.0) / 2.0);
        ties += size.powi(3) - size;
        before += size;
    }
    (sums, ties)
}

/// The smallest of several p values after Holm's (1979) correction, which is Bonferroni's for it.
pub fn smallest_adjusted(p_values: &[f64]) -> Option<f64> {
    let smallest = p_values.iter().copied().reduce(f64::min)?;
    Some((smallest * p_values.len() as f64).min(1.0))
}

#[cfg(test)]
mod tests;
