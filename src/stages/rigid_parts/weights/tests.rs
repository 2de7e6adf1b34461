//! Test that samples with an error weigh less, and how evenly a residual is spread.

use faer::Mat;
use rand::RngExt;

use super::super::medians::median;
use super::super::roots::product;
use super::super::testing::felt_of;
use super::*;
use crate::numerics::rng::stream;
use crate::stages::parameters::Parameters;

/// What 30 sensors of one part feel at 600 samples, of which every tenth has an error of this size.
fn felt(error: f64) -> Felt {
    let mut rng = stream(7, 1, "weights", 0);
    let mut uniform = |rows, columns| Mat::from_fn(rows, columns, |_, _| rng.random_range(-1.0_f64..1.0));
    let exact = product(uniform(600, 4).as_ref(), uniform(4, 30).as_ref());
    let errors = uniform(600, 30);
    let values = Mat::from_fn(600, 30, |t, sensor| {
        let own = if t % 10 == 0 { error * errors[(t, sensor)] } else { 0.0 };
        exact[(t, sensor)] + own
    });
    felt_of(&values).0
}

fn learned_longer(felt: &Felt) -> Cluster {
    Cluster::learned_longer(felt, (0..30).collect())
}

#[test]
fn samples_with_an_error_weigh_less() {
    let mut felt = felt(0.3);
    let before = learned_longer(&felt);
    weigh(&mut felt, std::slice::from_ref(&before));
    let typical =
        |wrong: bool| median((0..600).filter(|t| (t % 10 == 0) == wrong).map(|t| felt.sizes[t]).collect());
    assert!(typical(true) > 3.0 && typical(false) < 1.3, "{} and {}", typical(true), typical(false));
    let after = learned_longer(&felt);
    assert!(before.variance() > 3.0 * Parameters::default().min_tolerance, "{}", before.variance());
    assert!(after.variance() < 0.5 * Parameters::default().min_tolerance, "{}", after.variance());
    let root = felt.roots.values[(10, 0)] * felt.sizes[10];
    assert!((root - self::felt(0.3).roots.values[(10, 0)]).abs() < 1e-12, "the true size is kept");
}

#[test]
fn an_error_of_few_samples_is_spread_unevenly_and_that_of_all_is_not() {
    let share = |felt: &Felt| calm_share(felt, &learned_longer(felt));
    let few = share(&felt(0.3));
    // As large at every sample.
    let mut rng = stream(8, 1, "weights", 0);
    let mut uniform = |rows, columns| Mat::from_fn(rows, columns, |_, _| rng.random_range(-1.0_f64..1.0));
    let exact = product(uniform(600, 4).as_ref(), uniform(4, 30).as_ref());
    let all = share(&felt_of(&(exact + uniform(600, 30) * faer::Scale(0.1))).0);
    assert!(few < 0.05 && (0.3..1.0).contains(&all), "{few} and {all}");
}

#[test]
fn exact_samples_stay_as_they_are() {
    let mut felt = felt(0.0);
    let exact = learned_longer(&felt);
    weigh(&mut felt, &[exact]);
    assert!(felt.sizes.iter().all(|size| *size < 1.01), "{:?}", felt.sizes);
}
