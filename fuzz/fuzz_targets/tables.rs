//! Fuzz the reader of the truth: the number of sensors, the table of labels and that of the tree, between zero bytes;
//! what is accepted must be a tree.

#![no_main]

use bodyschema::stages::evaluate::{parts, score};
use bodyschema::files::tables::read_truth;
use bodyschema::stages::schema::Sample;
use bodyschema::stages::tree::Edge;
use bodyschema_fuzz::{accepted, file};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let Some((&sensors, rest)) = data.split_first() else { return };
    let sensors = usize::from(sensors % 16) + 1;
    let mut tables = rest.splitn(2, |byte| *byte == 0);
    let labels = file("labels.csv", tables.next().unwrap_or_default());
    let tree = file("tree.csv", tables.next().unwrap_or_default());
    let Some(truth) = accepted(read_truth(&labels, &tree, sensors)) else { return };

    assert_eq!((truth.labels.len(), truth.tree.len() + 1), (sensors, truth.parts()));
    let edge = |&(child, parent): &(usize, usize)| Edge { child, parent };
    let tree: Vec<Edge> = truth.tree.iter().map(edge).collect();
    // No estimate has a part of one sensor, so that its edges match none.
    if parts(&truth.labels) == truth.parts() {
        let score = score(&truth.labels, &tree, &truth, 1.0);
        assert!(score.eligible && score.tree_correct, "the truth is right: {score:?}");
    }
});
