use rand::RngExt;

use super::*;
use crate::numerics::rng::stream;

fn fitted(values: &[f64], isotonic: fn(&mut [Pool]) -> &[Pool]) -> Vec<f64> {
    let mut pools: Vec<Pool> = values.iter().map(|value| Pool::of(*value)).collect();
    isotonic(&mut pools).iter().flat_map(|pool| repeat_n(pool.mean, pool.count)).collect()
}

fn one_pass(pools: &mut [Pool]) -> &[Pool] {
    let count = pooled(pools);
    &pools[..count]
}

#[test]
fn isotonic_regression_pools_what_falls() {
    assert_eq!(fitted(&[1.0, 3.0, 2.0, 4.0], isotonic), [1.0, 2.5, 2.5, 4.0]);
    assert_eq!(fitted(&[3.0, 2.0, 1.0, 6.0, 5.0], isotonic), [2.0, 2.0, 2.0, 5.5, 5.5]);
    assert_eq!(fitted(&[1.0, 5.0, 4.0, 0.0], isotonic), [1.0, 3.0, 3.0, 3.0]);
    assert!(fitted(&[], isotonic).is_empty());
}

#[test]
fn stretches_give_what_one_pass_gives() {
    let mut rng = stream(1, 1, "values", 0);
    // Pools are longer than a stretch, and shorter.
    for slope in [0.0, 1e-5, 1e-2] {
        let values: Vec<f64> =
            (0..50_000).map(|at| slope * f64::from(at) + rng.random_range(0.0..1.0)).collect();
        let (found, expected) = (fitted(&values, isotonic), fitted(&values, one_pass));
        assert_eq!(found.len(), values.len());
        assert!(found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-12), "slope {slope}");
    }
}
