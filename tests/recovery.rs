//! Trees of bodies drawn from the model itself: found where that is easy, by chance where it is impossible.
//! The whole picture, over separation and dimensions, is `reproduce/evidence.sh`'s.

#[path = "support/synthetic.rs"]
mod synthetic;

use bodyschema::evaluate::{Truth, score};
use bodyschema::schema::{Model, infer};
use bodyschema::settings::Settings;
use bodyschema::streams::stream;
use indicatif::ProgressBar;

/// (draws that find the parts and the tree, draws that find the parts, all draws) over the identifiable of
/// 12 bodies; `judge` may replace the truth by which a body is judged.
fn recovered(dims: usize, separation: f64, judge: impl Fn(Truth, usize) -> Truth) -> (usize, usize, usize) {
    let mut schema = Settings::paper().schema;
    (schema.chains, schema.sweeps) = (6, 150);
    let mut counts = (0, 0, 0);
    for at in 0..12 {
        let body = synthetic::body(dims, separation, &mut stream(1, 1, "synthetic", at));
        if !body.identifiable && separation > 0.0 {
            continue;
        }
        let truth = judge(body.truth, at);
        for sample in infer(&body.map, Model::DpgmmLj, &schema, 1, at, &ProgressBar::hidden()).unwrap() {
            let score = score(&sample, &truth, synthetic::ELIGIBLE_ARI);
            counts.0 += usize::from(score.eligible && score.tree_correct);
            counts.1 += usize::from(score.eligible);
            counts.2 += 1;
        }
    }
    counts
}

#[test]
fn easy_trees_are_found() {
    let (right, eligible, all) = recovered(14, 3.0, |truth, _| truth);
    assert!(all >= 30, "enough bodies are identifiable: {all}");
    assert!(2 * eligible > all && right as f64 > 0.95 * eligible as f64, "{right} of {eligible} of {all}");
}

#[test]
fn an_unrelated_tree_is_found_by_chance_only() {
    let unrelated = |truth: Truth, at| {
        let tree = synthetic::random_tree(&mut stream(2, 1, "unrelated", at));
        Truth { tree, ..truth }
    };
    let (right, eligible, all) = recovered(14, 3.0, unrelated);
    // Chance is 1 in 125 trees; by bad luck, one body of these.
    assert!(2 * eligible > all && right <= 6, "{right} of {eligible}");
}

#[test]
fn parts_that_coincide_are_not_told_apart() {
    let (_, eligible, all) = recovered(5, 0.0, |truth, _| truth);
    assert_eq!((eligible, all), (0, 72));
}
