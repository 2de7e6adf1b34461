//! Trees of bodies drawn from the model itself: found where that is easy, by chance where it is impossible.
//! The whole picture, over separation and dimensions, is `reproduce/evidence.sh`'s.

use bodyschema::numerics::rng::stream;
use bodyschema::settings::Settings;
use bodyschema::stages::evaluate::{parts, score};
use bodyschema::stages::schema::{EdgeWeight, Schema};
use bodyschema::stages::schema::{Model, infer};
use bodyschema::stages::tree::Truth;

use crate::support::synthetic;

/// The sampler of the paper's equations.
fn equations() -> Schema {
    let text = include_str!("../reproduce/equations.toml");
    Settings::paper().with(text, "reproduce/equations.toml").expect("the repository's settings").schema
}

/// (draws that find the parts and the tree, draws that find the parts, all draws) over the identifiable of
/// 12 bodies; `judge` may replace the truth by which a body is judged.
fn recovered(dims: usize, separation: f64, judge: impl Fn(Truth, usize) -> Truth) -> (usize, usize, usize) {
    let mut schema = equations();
    (schema.chains, schema.sweeps) = (6, 150);
    // The joints of equation 22; what the other weights do is tested below.
    schema.edge_weight = EdgeWeight::Pairwise;
    let mut counts = (0, 0, 0);
    for at in 0..12 {
        let body = synthetic::body(dims, separation, &mut stream(1, 1, "synthetic", at));
        if !body.identifiable && separation > 0.0 {
            continue;
        }
        let truth = judge(body.truth, at);
        for draw in infer(&body.map, Model::DpgmmLj, &schema, 1, at, &|| ()).unwrap() {
            let score = score(&draw.labels, &draw.tree, &truth, synthetic::ELIGIBLE_ARI);
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
fn every_edge_weight_gives_a_tree_over_the_parts_and_the_collapsed_one_finds_it_too() {
    let identifiable =
        |at: &usize| synthetic::body(14, 3.0, &mut stream(1, 1, "synthetic", *at)).identifiable;
    let at = (0..12).find(identifiable).expect("some body is identifiable");
    let body = synthetic::body(14, 3.0, &mut stream(1, 1, "synthetic", at));
    for edge_weight in [EdgeWeight::Literal, EdgeWeight::Pairwise, EdgeWeight::Collapsed] {
        let schema = Schema { chains: 6, sweeps: 150, edge_weight, ..equations() };
        let draws = infer(&body.map, Model::DpgmmLj, &schema, 1, 1, &|| ()).unwrap();
        let mut right = 0;
        for draw in &draws {
            assert_eq!(draw.tree.len() + 1, parts(&draw.labels), "{edge_weight:?}: a tree over all parts");
            let mut reached = vec![draw.tree[0].parent];
            for edge in &draw.tree {
                assert!(reached.contains(&edge.parent) && !reached.contains(&edge.child), "{edge_weight:?}");
                reached.push(edge.child);
            }
            let score = score(&draw.labels, &draw.tree, &body.truth, synthetic::ELIGIBLE_ARI);
            right += usize::from(score.eligible && score.tree_correct);
        }
        // The literal weight is sticky: a child keeps its joint where its first parent was.
        assert!(edge_weight == EdgeWeight::Literal || right >= 4, "{edge_weight:?}: {right} of 6");
    }
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
