//! Verdicts on both sides of a range, ties, and conditions without a sample.

use super::*;
use crate::analysis::conditions::{BaselineEstimate, Conditions};
use crate::analysis::published::figures;
use crate::analysis::statistics::mean;
use crate::pipeline::Record;
use crate::stages::baselines::ClusteringMethod;
use crate::stages::schema::{Model, Sampler};

fn record(model: Model, dimension: usize, parts: usize, ari: f64, tree_correct: bool) -> Record {
    Record {
        simulation: 1,
        coordination: 0.9,
        dimension,
        model,
        chain: 0,
        sweep: 1,
        parts,
        log_posterior: Some(0.0),
        ari,
        eligible: ari == 1.0,
        tree_correct,
    }
}

/// Posterior samples of experiment 2, of which all are eligible.
fn moved(coordination: f64, simulation: usize, correct: bool) -> Record {
    Record { coordination, simulation, ..record(Model::DpgmmLj, 14, 5, 1.0, correct) }
}

fn judge_with(id: &str, records: &[Record], baselines: Vec<BaselineEstimate>) -> Judged {
    let claim = claims().into_iter().find(|claim| claim.id == id).unwrap();
    let experiment = claim.experiments[0];
    let simulations = records.iter().map(|record| record.simulation).max().unwrap_or(1);
    let conditions = Conditions::new(records.to_vec(), simulations, 1);
    let evidence = Evidence { conditions, baselines, reading: Sampler::Equations };
    judge(experiment, &evidence).into_iter().find(|judged| judged.claim.id == id).unwrap()
}

fn judge_by_id(id: &str, records: &[Record]) -> Judged {
    judge_with(id, records, Vec::new())
}

#[test]
fn the_published_claims_load_with_the_accuracy_first() {
    let claims = claims();
    let Claim { id, published, wording, .. } = &claims[0];
    assert_eq!((id.as_str(), *published, wording.as_str()), ("tree-accuracy", Some(0.846), "84.6 %"));
    for Claim { id, published, accept, measure, .. } in &claims {
        let computable = !matches!(measure, Measure::Nothing { .. });
        assert_eq!(accept.is_some(), computable, "{id} has a range if and only if it can be computed");
        assert_eq!(measure.unit().is_some(), computable, "{id} has a unit if and only if it can be computed");
        assert!(accept.is_none_or(|(low, high)| low <= high), "{id}");
        let inside = |published| accept.is_some_and(|(low, high)| (low..=high).contains(&published));
        assert!(published.is_none_or(inside), "{id}: the paper's number is outside the accepted range");
    }
    assert!(figures().iter().all(|figure| figure.name.starts_with("fig") && !figure.says.is_empty()));
}

#[test]
fn a_rate_is_judged_on_both_sides_of_its_range() {
    for (correct, verdict) in
        [(20, Verdict::NotReproduced), (17, Verdict::Reproduced), (14, Verdict::NotReproduced)]
    {
        let records: Vec<_> = (0..20).map(|i| record(Model::DpgmmLj, 14, 5, 1.0, i < correct)).collect();
        let judged = judge_by_id("tree-accuracy", &records);
        assert_eq!((judged.verdict, judged.reproduced.n), (verdict, 20), "{correct}");
    }
}

#[test]
fn without_an_eligible_draw_there_is_no_rate() {
    let judged = judge_by_id("tree-accuracy", &[record(Model::DpgmmLj, 14, 6, 0.9, false)]);
    assert_eq!((judged.verdict, judged.reproduced.value), (Verdict::NotTestable, None));
}

#[test]
fn the_worst_dimension_decides() {
    let records = [record(Model::DpgmmLj, 2, 5, 0.5, false), record(Model::DpgmmLj, 3, 7, 0.9, false)];
    let parts = judge_by_id("number-of-parts", &records);
    assert_eq!((parts.verdict, parts.reproduced.value), (Verdict::NotReproduced, Some(7.0)));
    assert!(parts.place.starts_with("worst: d = 3; no value: d = 4"), "{}", parts.place);
    assert_eq!(judge_by_id("ari-unknown-number", &records).reproduced.value, Some(0.5));
}

#[test]
fn a_tie_for_the_best_dimension_counts_and_a_better_one_does_not() {
    let at = |d, correct| record(Model::DpgmmLj, d, 5, 1.0, correct);
    let tie = judge_by_id("best-dimension", &[at(12, true), at(14, true)]);
    assert_eq!(tie.verdict, Verdict::Reproduced);
    let better = judge_by_id("best-dimension", &[at(12, true), at(14, false)]);
    assert_eq!((better.verdict, better.reproduced.value), (Verdict::NotReproduced, Some(12.0)));
}

#[test]
fn the_worst_of_a_one_sided_range_is_the_one_nearest_to_its_bound() {
    let at = |d, ari| record(Model::DpgmmLj, d, 5, ari, false);
    let judged = judge_by_id("ari-unknown-number", &[at(3, 1.0), at(4, 0.85), at(5, 0.95)]);
    assert_eq!((judged.verdict, judged.reproduced.value), (Verdict::Reproduced, Some(0.85)));
}

#[test]
fn the_best_dimension_is_not_testable_where_the_published_one_was_not_run() {
    let judged = judge_by_id("best-dimension", &[record(Model::DpgmmLj, 4, 5, 1.0, true)]);
    assert_eq!(judged.verdict, Verdict::NotTestable);
}

#[test]
fn a_clear_difference_in_ari_is_seen() {
    let records: Vec<_> = (0..30)
        .flat_map(|i| {
            [
                record(Model::Dpgmm, 5, 5, 0.9 + 0.001 * i as f64, false),
                record(Model::DpgmmLj, 5, 5, 0.5, false),
            ]
        })
        .collect();
    assert_eq!(judge_by_id("ari-no-difference", &records).verdict, Verdict::NotReproduced);
    assert_eq!(judge_by_id("ari-no-difference", &records[..1]).verdict, Verdict::NotTestable);
}

#[test]
fn the_extension_counts_the_likeliest_draw_of_each_simulation() {
    let sample = |simulation, log_posterior, correct| Record {
        log_posterior: Some(log_posterior),
        ..moved(0.9, simulation, correct)
    };
    // Simulation 1: two of three wrong, but the likeliest is right; simulation 2 the other way round.
    let records = [
        sample(1, -5.0, false),
        sample(1, -1.0, true),
        sample(1, -3.0, false),
        sample(2, -2.0, true),
        sample(2, -1.0, false),
        sample(2, -9.0, true),
    ];
    let judged = judge_by_id("tree-accuracy", &records);
    assert_eq!((judged.reproduced.value, judged.reproduced.n), (Some(0.5), 6));
    let (best, _) = judged.best.as_ref().unwrap();
    assert_eq!((best.value, best.n), (Some(0.5), 2));
}

#[test]
fn the_likeliest_draw_counts_even_where_its_parts_are_wrong() {
    let judged = judge_by_id("tree-accuracy", &[record(Model::DpgmmLj, 14, 6, 0.9, false)]);
    let (best, _) = judged.best.unwrap();
    assert_eq!((judged.reproduced.n, best.value, best.n), (0, Some(0.0), 1));
}

#[test]
fn dependence_on_p_takes_several_simulations_and_their_differences() {
    let rates = |of: &dyn Fn(f64, usize) -> bool| -> Vec<Record> {
        [0.0, 0.4, 0.9]
            .into_iter()
            .flat_map(|p| {
                (1..=5).flat_map(move |simulation| (0..10).map(move |chain| (p, simulation, chain)))
            })
            .map(|(p, simulation, chain)| moved(p, simulation, of(p, chain)))
            .collect()
    };
    let dependent = judge_by_id("tree-depends-on-coordination", &rates(&|p, chain| p > 0.5 || chain < 2));
    assert_eq!((dependent.verdict, dependent.reproduced.n), (Verdict::Reproduced, 15));
    let independent = judge_by_id("tree-depends-on-coordination", &rates(&|_, chain| chain < 5));
    assert_eq!(independent.verdict, Verdict::NotReproduced);
    let one: Vec<Record> =
        rates(&|p, _| p > 0.5).into_iter().filter(|record| record.simulation == 1).collect();
    assert_eq!(judge_by_id("tree-depends-on-coordination", &one).verdict, Verdict::NotTestable);
}

#[test]
fn places_of_experiment_2_are_p() {
    let records = [moved(0.0, 1, true), moved(0.4, 1, false), moved(0.9, 1, true), moved(1.0, 1, false)];
    let best = judge_by_id("best-coordination", &records);
    assert_eq!((best.verdict, best.reproduced.value), (Verdict::Reproduced, Some(0.9)));
    let narrow = judge_by_id("tree-random-movement", &records);
    assert_eq!((narrow.verdict, narrow.reproduced.value), (Verdict::NotReproduced, Some(1.0)));
    assert!(narrow.place.starts_with("worst: p = 0; no value: p = 0.2"), "{}", narrow.place);
    assert_eq!(judge_by_id("ari-without-movement", &records).verdict, Verdict::NotReproduced);
}

#[test]
fn modes_medians_and_the_first_dimension() {
    let parts = |parts: &[usize]| -> Vec<Record> {
        parts.iter().map(|&parts| record(Model::DpgmmLj, 2, parts, 1.0, true)).collect()
    };
    assert_eq!(judge_by_id("number-of-parts-2d", &parts(&[6, 5, 5, 9])).verdict, Verdict::Reproduced);
    assert_eq!(judge_by_id("number-of-parts-2d", &parts(&[6, 6, 5])).verdict, Verdict::NotReproduced);

    let ari = |ari| record(Model::DpgmmLj, 3, 5, ari, false);
    let median = judge_by_id("ari-distribution", &[ari(0.1), ari(0.9), ari(0.95)]);
    assert_eq!((median.verdict, median.reproduced.value), (Verdict::Reproduced, Some(0.9)));

    let at = |d, correct| record(Model::DpgmmLj, d, 5, 1.0, correct);
    let first = judge_by_id("first-dimension", &[at(5, true), at(8, false), at(9, true), at(10, true)]);
    assert_eq!((first.verdict, first.reproduced.value), (Verdict::Reproduced, Some(9.0)));
    let never = judge_by_id("first-dimension", &[at(9, true), at(10, false)]);
    assert_eq!(never.verdict, Verdict::NotTestable);
}

#[test]
fn pooled_trees_lower_aris_and_shares_of_all_samples() {
    let at = |d, correct| record(Model::Dpgmm, d, 5, 1.0, correct);
    let unlike = Record { eligible: false, ..at(3, true) };
    let never = judge_by_id("baseline-tree", &[at(2, false), at(14, false), unlike]);
    assert_eq!((never.verdict, never.reproduced.value), (Verdict::Reproduced, Some(0.0)));
    let once = judge_by_id("baseline-tree", &[at(2, false), at(14, true)]);
    assert_eq!((once.verdict, once.reproduced.value), (Verdict::NotReproduced, Some(0.5)));

    let both = |d, dpgmm, joints| {
        [record(Model::Dpgmm, d, 5, dpgmm, false), record(Model::DpgmmLj, d, 5, joints, false)]
    };
    let worse = judge_by_id("ari-worse-with-joints", &[both(2, 0.9, 0.8), both(3, 0.8, 0.9)].concat());
    assert_eq!((worse.verdict, worse.reproduced.value), (Verdict::Reproduced, Some(0.5)));
    let better = judge_by_id("ari-worse-with-joints", &[both(2, 0.8, 0.9), both(3, 0.9, 0.9)].concat());
    assert_eq!((better.verdict, better.reproduced.value), (Verdict::NotReproduced, Some(0.0)));

    let still = |eligible, correct| Record { eligible, ..moved(1.0, 1, correct) };
    let none = judge_by_id("tree-without-movement", &[still(false, true), still(true, false)]);
    assert_eq!((none.verdict, none.reproduced.value), (Verdict::Reproduced, Some(0.0)));
    let some = judge_by_id("tree-without-movement", &[still(true, true), still(false, true)]);
    assert_eq!((some.verdict, some.reproduced.value), (Verdict::NotReproduced, Some(0.5)));
}

#[test]
fn clusterings_are_compared_over_numbers_of_clusters() {
    let baseline = |method, clusters, ari| BaselineEstimate {
        method,
        clusters,
        coordination: 0.9,
        dimension: 5,
        ari: mean(&[ari]),
    };
    let all = |at_ten: f64| {
        let of = |method| [baseline(method, 3, 0.6), baseline(method, 5, 0.9), baseline(method, 10, at_ten)];
        ClusteringMethod::ALL.into_iter().flat_map(of).collect::<Vec<_>>()
    };
    let verdict = |id, at_ten| judge_with(id, &[], all(at_ten)).verdict;
    assert_eq!(verdict("ari-known-number", 0.7), Verdict::Reproduced);
    assert_eq!(verdict("ari-too-few-clusters", 0.7), Verdict::Reproduced);
    assert_eq!(verdict("ari-too-many-clusters", 0.7), Verdict::Reproduced);
    assert_eq!(verdict("ari-too-many-clusters", 0.95), Verdict::NotReproduced);
    assert_eq!(judge_by_id("ari-known-number", &[]).verdict, Verdict::NotTestable);
}

#[test]
fn what_no_program_can_compute_is_not_testable_and_says_why() {
    let judged = judge_by_id("natural-movement", &[record(Model::DpgmmLj, 14, 5, 1.0, true)]);
    assert_eq!(judged.verdict, Verdict::NotTestable);
    assert!(judged.place.contains("by eye"), "{}", judged.place);
}
