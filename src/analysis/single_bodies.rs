//! Judge the claims in single bodies: the paper seems to show one, and bodies differ far more than chains do.
//!
//! So beside the estimate over all bodies stands a predictive check: in what share of single bodies would the published
//! value have been seen, alone and together with all other claims of the experiment?

use super::claims::{Judged, Verdict, judge};
use super::measure::Evidence;
use super::one_body::SingleBodies;
use super::published::{Claim, Experiment};
use super::statistics::rate;

/// Minimum number of eligible posterior samples of a body at which its rate is compared with a published one.
const ELIGIBLE: usize = 5;

/// Adds to judged claims how often single bodies show them; `bodies` has the evidence of each body.
pub(crate) fn add_single_bodies(experiment: Experiment, judged: &mut [Judged], bodies: &[Evidence]) {
    // Whether each body shows each claim; `None` where it has no value.
    let seen: Vec<Vec<Option<bool>>> =
        bodies.iter().map(|body| judge(experiment, body).iter().map(is_seen).collect()).collect();
    for (at, judged) in judged.iter_mut().enumerate() {
        let with_value: Vec<&Vec<Option<bool>>> = seen.iter().filter(|seen| seen[at].is_some()).collect();
        let share = |holds: &dyn Fn(&[Option<bool>]) -> bool| {
            rate(with_value.iter().filter(|seen| holds(seen)).count(), with_value.len())
        };
        judged.single_bodies = Some(SingleBodies {
            alone: share(&|seen| seen[at] == Some(true)),
            together: share(&|seen| seen.iter().all(|seen| *seen != Some(false))),
        });
    }
}

/// Whether the published value would have been seen in a body, judged on its samples alone; `None` without a value.
fn is_seen(judged: &Judged) -> Option<bool> {
    let value = judged.reproduced.value?;
    match interval_of_counts(&judged.claim, judged.reproduced.n) {
        None => Some(judged.verdict == Verdict::Reproduced),
        Some((low, high)) => (judged.reproduced.n >= ELIGIBLE).then_some((low..=high).contains(&value)),
    }
}

/// The Wilson interval of the published rate, for that of its possible counts which is nearest to n; `None` if the paper
/// gives no rate.
fn interval_of_counts(claim: &Claim, n: usize) -> Option<(f64, f64)> {
    let nearest = claim.possible_counts.iter().min_by_key(|(_, trials)| trials.abs_diff(n))?;
    rate(nearest.0, nearest.1).interval
}

#[cfg(test)]
mod tests;
