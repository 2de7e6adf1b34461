//! Provide statistical tests for the unit tests: fixed seeds, one significance level, no retries.

use statrs::distribution::{ChiSquared, ContinuousCDF};

/// The level of every statistical test.
pub const ALPHA: f64 = 1e-3;

/// p value of the Kolmogorov–Smirnov test of draws against a distribution function.
pub fn ks_one_sample(draws: &[f64], distribution: impl Fn(f64) -> f64) -> f64 {
    let sorted = sorted(draws);
    let n = sorted.len() as f64;
    let distance = sorted.iter().enumerate().fold(0.0, |largest: f64, (i, x)| {
        let expected = distribution(*x);
        largest.max(expected - i as f64 / n).max((i + 1) as f64 / n - expected)
    });
    kolmogorov(distance, n)
}

/// p value of the two-sample Kolmogorov–Smirnov test. That of statrs 0.19 never ends where both samples are equal.
pub fn ks_two_sample(first: &[f64], second: &[f64]) -> f64 {
    let (first, second) = (sorted(first), sorted(second));
    let share = |sample: &[f64], x: f64| sample.partition_point(|y| *y <= x) as f64 / sample.len() as f64;
    let distance = first
        .iter()
        .chain(&second)
        .fold(0.0, |largest: f64, x| largest.max((share(&first, *x) - share(&second, *x)).abs()));
    let (n, m) = (first.len() as f64, second.len() as f64);
    kolmogorov(distance, n * m / (n + m))
}

fn sorted(draws: &[f64]) -> Vec<f64> {
    let mut sorted = draws.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted
}

/// Stephens' (1970) approximation of the Kolmogorov distribution.
fn kolmogorov(distance: f64, n: f64) -> f64 {
    let lambda = (n.sqrt() + 0.12 + 0.11 / n.sqrt()) * distance;
    let term =
        |k: i32| 2.0 * f64::from(1 - 2 * ((k - 1) % 2)) * (-2.0 * f64::from(k * k) * lambda * lambda).exp();
    if lambda < 0.2 { 1.0 } else { (1..=100).map(term).sum::<f64>().clamp(0.0, 1.0) }
}

/// p value of Pearson's chi-squared test of counts against probabilities. Cells of fewer than five
/// expected counts are put together.
pub fn chi_squared(counts: &[f64], probabilities: &[f64]) -> f64 {
    let total: f64 = counts.iter().sum();
    let (mut statistic, mut cells, mut rare) = (0.0, 0, (0.0, 0.0));
    let mut add = |count: f64, expected: f64| {
        statistic += (count - expected).powi(2) / expected;
        cells += 1;
    };
    for (count, probability) in counts.iter().zip(probabilities) {
        let expected = total * probability;
        if expected < 5.0 {
            rare = (rare.0 + count, rare.1 + expected);
        } else {
            add(*count, expected);
        }
    }
    if rare.1 > 0.5 {
        add(rare.0, rare.1);
    } else if rare.0 > 10.0 {
        return 0.0;
    }
    let degrees_of_freedom = f64::from(cells - 1);
    ChiSquared::new(degrees_of_freedom).expect("at least two cells").sf(statistic)
}

#[test]
fn the_tests_accept_what_is_so_and_reject_what_is_not() {
    let even: Vec<f64> = (0..500).map(|i| (f64::from(i) + 0.5) / 500.0).collect();
    assert!(ks_one_sample(&even, |x| x) > 0.99);
    assert!(ks_one_sample(&even, |x| x * x) < ALPHA);
    let shifted: Vec<f64> = even.iter().map(|x| x + 0.2).collect();
    assert!(ks_two_sample(&even, &even) > 0.99 && ks_two_sample(&even, &shifted) < ALPHA);
    assert!(chi_squared(&[251.0, 249.0, 500.0], &[0.25, 0.25, 0.5]) > 0.5);
    assert!(chi_squared(&[300.0, 200.0, 500.0], &[0.25, 0.25, 0.5]) < ALPHA);
    // scipy.stats.chisquare([30, 45, 25], [33, 40, 27])
    assert!((chi_squared(&[30.0, 45.0, 25.0], &[0.33, 0.40, 0.27]) - 0.592_78).abs() < 1e-5);
}
