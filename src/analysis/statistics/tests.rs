//! Test rates, means and tests by hand.

use super::*;

fn close(found: f64, expected: f64) {
    assert!((found - expected).abs() < 5e-5, "{found} is not {expected}");
}

#[test]
fn no_observation_has_no_rate() {
    assert_eq!(rate(0, 0), Estimate::default());
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
    // 3.182446 is the 97.5 % quantile of t with three degrees of freedom.
    close(estimate.interval.unwrap().1, 2.5 + 3.182446 * (5.0_f64 / 3.0 / 4.0).sqrt());
    assert_eq!(mean(&[]).value, None);
    assert_eq!(smallest_adjusted(&[0.5, 0.01, 0.2]), Some(0.03));
    assert_eq!(smallest_adjusted(&[0.6, 0.9]), Some(1.0));
    assert_eq!(smallest_adjusted(&[]), None);
}

#[test]
fn kruskal_wallis_sees_a_shift_and_needs_two_groups() {
    let low: Vec<f64> = (0..10).map(f64::from).collect();
    let high: Vec<f64> = low.iter().map(|x| x + 20.0).collect();
    assert!(kruskal_wallis(&[low.clone(), high, low.clone()]).unwrap() < 1e-3);
    assert!(kruskal_wallis(&[low.clone(), low.clone()]).unwrap() > 0.9);
    assert_eq!(kruskal_wallis(&[vec![1.0; 3], vec![1.0; 4]]), Some(1.0));
    assert_eq!((kruskal_wallis(std::slice::from_ref(&low)), kruskal_wallis(&[low, vec![]])), (None, None));
}
