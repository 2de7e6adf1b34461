//! Counts and samples → rates, means, their intervals, and tests.

/// A value with its 95 % interval, and how many samples it rests on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The value; none where there is no sample ("0 of 0, no rate").
    pub value: Option<f64>,
    /// Number of samples.
    pub n: usize,
    /// Lower and upper end of the 95 % interval, where there is one.
    pub interval: Option<(f64, f64)>,
}

/// The 97.5 % quantile of the standard normal distribution.
const Z: f64 = 1.959_963_984_540_054;

/// `successes` of `n`, with Wilson's (1927) score interval.
pub fn rate(successes: usize, n: usize) -> Estimate {
    Estimate {
        value: (n > 0).then(|| successes as f64 / n as f64),
        n,
        interval: (n > 0).then(|| wilson(successes, n)),
    }
}

fn wilson(successes: usize, n: usize) -> (f64, f64) {
    let (k, n) = (successes as f64, n as f64);
    let p = k / n;
    let centre = (p + Z * Z / (2.0 * n)) / (1.0 + Z * Z / n);
    let half = Z / (1.0 + Z * Z / n) * (p * (1.0 - p) / n + Z * Z / (4.0 * n * n)).sqrt();
    // At the ends the interval touches 0 or 1 exactly; rounding must not push it past or short.
    let low = if successes == 0 { 0.0 } else { centre - half };
    let high = if k == n { 1.0 } else { centre + half };
    (low, high)
}

/// 95 % interval of the difference first − second of two independent rates, each (successes, n) with
/// n > 0: Newcombe's (1998) hybrid score interval, his method 10.
pub fn rate_difference(first: (usize, usize), second: (usize, usize)) -> (f64, f64) {
    let p = |(k, n): (usize, usize)| k as f64 / n as f64;
    let (low_1, high_1) = wilson(first.0, first.1);
    let (low_2, high_2) = wilson(second.0, second.1);
    let (p_1, p_2) = (p(first), p(second));
    (p_1 - p_2 - (p_1 - low_1).hypot(high_2 - p_2), p_1 - p_2 + (high_1 - p_1).hypot(p_2 - low_2))
}

/// The mean, with its normal 95 % interval (from two values on).
pub fn mean(values: &[f64]) -> Estimate {
    let n = values.len();
    let mean = values.iter().sum::<f64>() / n.max(1) as f64;
    let variance = values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n.saturating_sub(1).max(1) as f64;
    let half = Z * (variance / n.max(1) as f64).sqrt();
    Estimate { value: (n > 0).then_some(mean), n, interval: (n > 1).then_some((mean - half, mean + half)) }
}

/// Two-sided p value of the Mann–Whitney U test, by the normal approximation with corrections for ties
/// and continuity, as SciPy's `mannwhitneyu(method="asymptotic")`; 1 where nothing differs.
pub fn mann_whitney(first: &[f64], second: &[f64]) -> f64 {
    let mut all: Vec<(f64, bool)> =
        first.iter().map(|&x| (x, true)).chain(second.iter().map(|&x| (x, false))).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (n_1, n_2, n) = (first.len() as f64, second.len() as f64, all.len() as f64);
    let (mut rank_sum, mut ties, mut before) = (0.0, 0.0, 0.0);
    for tied in all.chunk_by(|a, b| a.0 == b.0) {
        let size = tied.len() as f64;
        let rank = before + (size + 1.0) / 2.0;
        rank_sum += rank * tied.iter().filter(|(_, in_first)| *in_first).count() as f64;
        ties += size.powi(3) - size;
        before += size;
    }
    let u = rank_sum - n_1 * (n_1 + 1.0) / 2.0;
    let variance = n_1 * n_2 / 12.0 * (n + 1.0 - ties / (n * (n - 1.0)));
    if variance.is_nan() || variance <= 0.0 {
        return 1.0;
    }
    let distance = ((u - n_1 * n_2 / 2.0).abs() - 0.5).max(0.0);
    libm::erfc(distance / variance.sqrt() / std::f64::consts::SQRT_2)
}

/// The smallest of several p values after Holm's (1979) correction, which is Bonferroni's for it.
pub fn smallest_adjusted(p_values: &[f64]) -> Option<f64> {
    let smallest = p_values.iter().copied().reduce(f64::min)?;
    Some((smallest * p_values.len() as f64).min(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(found: f64, expected: f64) {
        assert!((found - expected).abs() < 5e-5, "{found} is not {expected}");
    }

    #[test]
    fn no_sample_has_no_rate() {
        assert_eq!(rate(0, 0), Estimate { value: None, n: 0, interval: None });
    }

    #[test]
    fn mann_whitney_knows_equal_shifted_and_tied_samples() {
        let low: Vec<f64> = (0..20).map(f64::from).collect();
        let high: Vec<f64> = low.iter().map(|x| x + 30.0).collect();
        assert_eq!(mann_whitney(&low, &low), 1.0);
        assert!(mann_whitney(&low, &high) < 1e-6);
        assert_eq!(mann_whitney(&[1.0; 5], &[1.0; 7]), 1.0);
        assert_eq!(mann_whitney(&[], &[1.0]), 1.0);
    }

    #[test]
    fn means_and_corrections() {
        let estimate = mean(&[1.0, 2.0, 3.0, 4.0]);
        assert_eq!((estimate.value, estimate.n), (Some(2.5), 4));
        close(estimate.interval.unwrap().1, 2.5 + 1.959964 * (5.0_f64 / 3.0 / 4.0).sqrt());
        assert_eq!(mean(&[]).value, None);
        assert_eq!(smallest_adjusted(&[0.5, 0.01, 0.2]), Some(0.03));
        assert_eq!(smallest_adjusted(&[0.6, 0.9]), Some(1.0));
        assert_eq!(smallest_adjusted(&[]), None);
    }
}
