//! Say how far a claim's value is from that of another configuration on the same simulations.

use super::bootstrap::{Resamples, percentile_interval};
use super::claims::outside;
use super::measure::{Evidence, measure};
use super::published::Claim;
use crate::numerics::rng::stream;

/// Number of resamples. Each measures the claim anew, which takes a millisecond.
const RESAMPLES: usize = 1000;
/// Number of simulations from which on a change has an interval.
const ENOUGH: usize = 5;

/// The claim's value by `second` minus that by `first`, with a 95 % interval where there is one; `None` if either has no
/// value. Both must be of the same conditions and simulations.
///
/// Of a claim over several conditions, the one counts at which the first's value lies farthest towards the outside of the
/// range, among those at which both have a value. Simulations are drawn in pairs, since they share what the two have in
/// common. The interval is the expanded percentile interval (Hesterberg 2015), over the resamples in which both have a value;
/// there is none if those are fewer than half, or for fewer than five simulations. The random numbers derive from `seed`.
pub(crate) fn change(
    claim: &Claim,
    first: &Evidence,
    second: &Evidence,
    seed: u64,
) -> Option<(f64, Option<(f64, f64)>)> {
    let values = |evidence: &Evidence| -> Vec<Option<f64>> {
        measure(&claim.measure, evidence).into_iter().map(|(_, estimate)| estimate.value).collect()
    };
    let pairs: Vec<_> = values(first).into_iter().zip(values(second)).collect();
    let both = pairs.iter().enumerate().filter_map(|(at, (first, second))| Some((at, (*first)?, (*second)?)));
    let (at, of_first, of_second) =
        both.max_by(|(_, a, _), (_, b, _)| outside(claim, *a).total_cmp(&outside(claim, *b)))?;
    let simulations = first.conditions.simulations();
    if simulations < ENOUGH {
        return Some((of_second - of_first, None));
    }
    let resamples = Resamples::new(simulations, RESAMPLES, &mut stream(seed, 0, "paired bootstrap", 0));
    let differences = resamples.values(|drawn| {
        let numbers: Vec<usize> = drawn.iter().map(|simulation| simulation + 1).collect();
        let redrawn = |evidence: &Evidence| values(&evidence.redrawn(&numbers)).get(at).copied()?;
        Some(redrawn(second)? - redrawn(first)?)
    });
    let enough = 2 * differences.len() >= RESAMPLES;
    Some((of_second - of_first, enough.then(|| percentile_interval(&differences, simulations))))
}

#[cfg(test)]
mod tests {
    use super::super::conditions::Conditions;
    use super::super::published::claims;
    use super::*;
    use crate::pipeline::Record;
    use crate::stages::schema::{Model, Sampler};

    /// Ten samples of each of eight simulations at d = 14, all eligible; `right` says how many trees of a simulation are
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
        assert!((change.0 - 0.2).abs() < 1e-12);
        let (low, high) = change.1.unwrap();
        assert!((low - 0.2).abs() < 1e-12 && (high - 0.2).abs() < 1e-12, "{low} to {high}");
    }

    #[test]
    fn what_bodies_do_not_share_widens_it() {
        let opposite = evidence(|simulation| 9 - simulation);
        let change = change(&headline(), &evidence(|simulation| simulation), &opposite, 1).unwrap();
        assert!(change.0.abs() < 1e-12);
        let (low, high) = change.1.unwrap();
        // Each simulation's change is one of ±0.7, ±0.5, ±0.3, ±0.1: the standard error of their mean is 0.16.
        assert!((-0.5..-0.25).contains(&low) && (0.25..0.5).contains(&high), "{low} to {high}");
    }
}
