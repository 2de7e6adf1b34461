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
mod tests {
    use super::*;
    use crate::analysis::conditions::Conditions;
    use crate::analysis::one_body::OneBody;
    use crate::pipeline::Record;
    use crate::stages::schema::{Model, Sampler};

    /// A body with some eligible posterior samples at d = 14 and p = 0.9, of which some have the right tree.
    fn body(right: usize, eligible: usize, parts: usize) -> Evidence {
        let sample = |chain: usize| Record {
            simulation: 1,
            coordination: 0.9,
            dimension: 14,
            model: Model::DpgmmLj,
            chain,
            sweep: 1,
            parts,
            log_posterior: Some(0.0),
            ari: 1.0,
            eligible: true,
            tree_correct: chain < right,
        };
        let conditions = Conditions::new((0..eligible).map(sample).collect(), 1, 1);
        Evidence { conditions, baselines: Vec::new(), reading: Sampler::Equations }
    }

    fn headline(bodies: &[Evidence]) -> SingleBodies {
        let mut judged = judge(Experiment::Exp2, &bodies[0]);
        add_single_bodies(Experiment::Exp2, &mut judged, bodies);
        judged[0].single_bodies.unwrap()
    }

    #[test]
    fn a_body_shows_the_headline_if_its_rate_lies_in_the_interval_of_the_counts_nearest_to_its_own() {
        // 11 of 13 has the interval 0.58 to 0.96, 77 of 91 has 0.76 to 0.91.
        let found =
            headline(&[body(3, 5, 5), body(5, 5, 5), body(60, 100, 5), body(85, 100, 5), body(4, 4, 5)]);
        assert_eq!((found.alone.n, found.alone.value), (4, Some(0.5)), "four samples are too few");
        assert_eq!(found.verdict(), Some(OneBody::Usual));
        assert_eq!(headline(&[body(0, 20, 5)]).verdict(), Some(OneBody::Never));
        assert_eq!(headline(&[body(1, 2, 5)]).verdict(), None);
    }

    #[test]
    fn together_never_is_more_than_alone() {
        let bodies = [body(11, 13, 5), body(11, 13, 9), body(0, 13, 5)];
        let mut judged = judge(Experiment::Exp1, &bodies[0]);
        add_single_bodies(Experiment::Exp1, &mut judged, &bodies);
        for Judged { single_bodies, .. } in &judged {
            let SingleBodies { alone, together } = single_bodies.unwrap();
            assert!(together.value <= alone.value);
        }
    }
}
