use super::super::statistics::{rate, wilson};
use super::*;
use crate::numerics::rng::stream;

#[test]
fn simulations_that_differ_widen_the_interval_and_equal_ones_do_not_narrow_it() {
    let resamples = Resamples::new(5, 10_000, &mut stream(1, 1, "bootstrap", 0));
    let alike = [(9.0, 10); 5];
    let pooled = rate(45, 50);
    let same = resamples.clustered(pooled, &alike);
    assert_eq!((same.interval, same.spread, same.simulations), (pooled.interval, Some((0.9, 0.9)), 5));
    let unlike = resamples.clustered(pooled, &[(10.0, 10), (10.0, 10), (10.0, 10), (10.0, 10), (5.0, 10)]);
    let (low, high) = unlike.interval.unwrap();
    assert!(low < 0.7 && high == 1.0, "{low} {high}");
    assert_eq!(unlike.spread, Some((0.5, 1.0)));
    // Four simulations without an eligible observation leave one, whose observations are all there is.
    let alone = resamples.clustered(rate(9, 10), &[(9.0, 10), (0.0, 0), (0.0, 0), (0.0, 0), (0.0, 0)]);
    assert_eq!((alone.interval, alone.spread, alone.simulations), (rate(9, 10).interval, None, 1));
    let single = resamples.clustered(rate(3, 5), &[(1.0, 1), (0.0, 1), (1.0, 1), (1.0, 1), (0.0, 1)]);
    assert_eq!((single.interval, single.spread, single.simulations), (rate(3, 5).interval, None, 5));
}

#[test]
fn a_difference_is_paired_and_never_narrower_than_its_samples_allow() {
    let resamples = Resamples::new(5, 10_000, &mut stream(1, 1, "bootstrap", 0));
    let groups = |rates: [f64; 5]| rates.map(|rate| (10.0 * rate, 10));
    let of = |groups: &[(f64, usize)]| rate(groups.iter().map(|group| group.0).sum::<f64>() as usize, 50);
    let between = |first: [f64; 5], second: [f64; 5]| {
        let (first, second) = (groups(first), groups(second));
        let found = resamples.difference((of(&first), &first), (of(&second), &second));
        (found.value.unwrap(), found.interval.unwrap())
    };
    // Bodies that differ much from each other, and all by the same between the two.
    let (paired, (low, high)) = between([0.0, 0.2, 0.5, 0.7, 0.9], [0.1, 0.3, 0.6, 0.8, 1.0]);
    let (_, (unpaired_low, _)) = between([0.0, 0.2, 0.5, 0.7, 0.9], [1.0, 0.8, 0.6, 0.3, 0.1]);
    assert!((paired - 0.1).abs() < 1e-12 && low < 0.1 && high > 0.1);
    assert!(unpaired_low < low - 0.3, "{unpaired_low} {low}");
    // Nothing differs in any simulation, and yet fifty observations of each know no more than this.
    let (none, (low, high)) = between([0.0; 5], [0.0; 5]);
    assert_eq!(none, 0.0);
    assert!((low + high).abs() < 1e-12 && (high - wilson(0.0, 50.0).1).abs() < 1e-12);
    let lacking = resamples.difference((rate(0, 0), &[(0.0, 0); 5]), (rate(1, 5), &[(1.0, 1); 5]));
    assert_eq!(lacking, Estimate::default());
}

#[test]
fn the_interval_over_simulations_covers_the_truth_where_the_pooled_one_does_not() {
    // Bodies whose rate is uniform over [0, 1]; five of them, with 40 chains each.
    let mut rng = stream(1, 1, "coverage", 0);
    let resamples = Resamples::new(5, 10_000, &mut rng);
    let (mut clustered, mut pooled, runs) = (0, 0, 400);
    for _ in 0..runs {
        let groups: Vec<(f64, usize)> = (0..5).map(|_| (40.0 * rng.random::<f64>(), 40)).collect();
        let plain = rate(groups.iter().map(|group| group.0).sum::<f64>().round() as usize, 200);
        let covers = |estimate: Estimate| {
            let (low, high) = estimate.interval.unwrap();
            usize::from((low..=high).contains(&0.5))
        };
        pooled += covers(plain);
        clustered += covers(resamples.clustered(plain, &groups));
    }
    assert!(clustered >= runs * 90 / 100, "{clustered} of {runs}");
    assert!(pooled <= runs * 60 / 100, "the twin that pools: {pooled} of {runs}");
}
