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
mod tests;
