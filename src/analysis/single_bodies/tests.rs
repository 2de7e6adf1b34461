//! Test what single simulations show of a published value.

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
    let found = headline(&[body(3, 5, 5), body(5, 5, 5), body(60, 100, 5), body(85, 100, 5), body(4, 4, 5)]);
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
