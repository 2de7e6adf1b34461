//! Say how far a claim's value is from that of another configuration on the same simulations.

use rand::RngExt;
use rayon::prelude::*;

use super::claims::judge_claim;
use super::measure::Evidence;
use super::published::Claim;
use super::statistics::{Estimate, percentile_interval};
use crate::numerics::rng::stream;

/// Draws of simulations with replacement. Each measures the claim anew, which takes milliseconds.
const RESAMPLES: usize = 400;

/// The claim's value by `second` minus that by `first`; `None` if either has none.
///
/// Simulations are drawn in pairs, since they share what the two have in common; the claim is measured anew in each
/// resample, and so is which of its conditions is the worst. The interval is the expanded percentile interval (Hesterberg
/// 2015), over the resamples in which both have a value; without one if those are fewer than half, or if there is one
/// simulation. The random numbers derive from `seed`.
pub fn change(claim: &Claim, first: &Evidence, second: &Evidence, seed: u64) -> Option<Estimate> {
    let difference = |first: &Evidence, second: &Evidence| {
        let [first, second] = [first, second].map(|evidence| judge_claim(claim, evidence).0);
        Some((second.value? - first.value?, second.n))
    };
    let (value, n) = difference(first, second)?;
    let simulations = first.conditions.simulations();
    let mut rng = stream(seed, 0, "paired bootstrap", 0);
    let drawn: Vec<Vec<usize>> = (0..RESAMPLES)
        .map(|_| (0..simulations).map(|_| rng.random_range(1..=simulations)).collect())
        .collect();
    let mut differences: Vec<f64> = drawn
        .par_iter()
        .filter_map(|drawn| {
            let [first, second] = [first, second].map(|evidence| evidence.redrawn(drawn));
            difference(&first, &second).map(|(difference, _)| difference)
        })
        .collect();
    differences.sort_by(f64::total_cmp);
    let enough = simulations > 1 && 2 * differences.len() >= RESAMPLES;
    let interval = enough.then(|| percentile_interval(&differences, simulations));
    Some(Estimate { value: Some(value), n, interval, simulations, spread: None })
}

#[cfg(test)]
mod tests {
    use super::super::conditions::Conditions;
    use super::super::published::claims;
    use super::*;
    use crate::pipeline::Record;
    use crate::stages::schema::{Model, Sampler};

    /// Ten draws of each of eight simulations at d = 14, all eligible; `right` says how many trees of a simulation are
    /// right.
    fn evidence(right: impl Fn(usize) -> usize) -> Evidence {
        let record = |simulation: usize, chain: usize| Record {
            simulation,
            chain,
            dimension: 14,
            coordination: 0.9,
            model: Model::DpgmmLj,
            eligible: true,
            tree_correct: chain < right(simulation),
            ari: 1.0,
            parts: 5,
            sweep: 1,
            log_posterior: None,
        };
        let records = (1..=8).flat_map(|simulation| (0..10).map(move |chain| record(simulation, chain)));
        let conditions = Conditions::new(records.collect(), 8, 1);
        Evidence { conditions, baselines: Vec::new(), reading: Sampler::Equations }
    }

    fn headline() -> Claim {
        claims().into_iter().find(|claim| claim.id == "tree-accuracy").unwrap()
    }

    #[test]
    fn what_bodies_share_does_not_widen_the_interval_of_a_change() {
        let first = evidence(|simulation| simulation);
        let change = change(&headline(), &first, &evidence(|simulation| simulation + 2), 1).unwrap();
        assert!((change.value.unwrap() - 0.2).abs() < 1e-12);
        let (low, high) = change.interval.unwrap();
        assert!((low - 0.2).abs() < 1e-12 && (high - 0.2).abs() < 1e-12, "{low} to {high}");
    }

    #[test]
    fn what_bodies_do_not_share_widens_it() {
        let opposite = evidence(|simulation| 9 - simulation);
        let change = change(&headline(), &evidence(|simulation| simulation), &opposite, 1).unwrap();
        assert!(change.value.unwrap().abs() < 1e-12);
        let (low, high) = change.interval.unwrap();
        // Each simulation's change is one of ±0.7, ±0.5, ±0.3, ±0.1: the standard error of their mean is 0.16.
        assert!((-0.5..-0.25).contains(&low) && (0.25..0.5).contains(&high), "{low} to {high}");
    }
}
