//! Test paired differences by hand.

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
