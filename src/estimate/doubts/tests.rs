use std::collections::BTreeMap;

use super::*;
use crate::stages::joints::Pair;

/// Joints over parts: pairs with their correlation and support, and whether the tree has them.
fn joined(parts: usize, pairs: &[(usize, usize, f64, f64, bool)]) -> Joints {
    let pair = |&(part, other, correlation, support, in_tree): &(usize, usize, f64, f64, bool)| Pair {
        part,
        other,
        correlation,
        information: 1.0,
        support,
        in_tree,
    };
    let pairs: Vec<Pair> = pairs.iter().map(pair).collect();
    let tree = pairs.iter().filter(|pair| pair.in_tree);
    Joints {
        ranks: (0..parts).map(|part| (part, 6)).collect(),
        tree: tree.clone().map(|pair| Edge { child: pair.other, parent: pair.part }).collect(),
        rivals: tree.map(|_| None).collect(),
        pairs,
    }
}

/// Parts with so many sensors each, whose residuals are as given, or small beyond, and that of the next best part 0.1.
fn parts(sizes: &[usize], residuals: &[f64]) -> RigidParts {
    let labels: Vec<usize> = sizes.iter().enumerate().flat_map(|(part, size)| vec![part; *size]).collect();
    RigidParts {
        residuals: (0..labels.len()).map(|at| residuals.get(at).copied().unwrap_or(1e-6)).collect(),
        alternatives: vec![vec![(9, 0.1)]; labels.len()],
        unassigned: Vec::new(),
        motions: BTreeMap::new(),
        labels,
    }
}

fn said(parts: &RigidParts, joints: &Joints) -> Vec<String> {
    doubts(parts, joints, &Parameters::default()).iter().map(ToString::to_string).collect()
}

#[test]
fn what_is_certain_is_not_doubted() {
    let joints =
        joined(3, &[(0, 1, 0.9999, 1.0, true), (1, 2, 0.9999, 0.95, true), (0, 2, 0.99, 0.05, false)]);
    assert_eq!(said(&parts(&[16, 16, 16], &[0.02]), &joints), Vec::<String>::new());
}

#[test]
fn one_part_has_no_joint() {
    let one = |residual: f64| said(&parts(&[20], &[residual; 20]), &joined(1, &[])).remove(0);
    assert!(one(0.01).ends_with("is 1.0 %; no joint seems to move, so record each joint moving by itself"));
    assert!(one(0.3).ends_with("rigid motion is 30.0 %"));
}

#[test]
fn small_parts_and_sensors_that_another_part_explains_are_counted() {
    let joints = joined(3, &[(0, 1, 0.99, 1.0, true), (1, 2, 0.99, 1.0, true)]);
    let found = said(&parts(&[16, 15, 4], &[0.021, 0.5, 0.0]), &joints);
    assert_eq!(
        found,
        [
            "part 1, the first of 2 such parts, has 15 sensors; 16 and more are needed to rely on a part",
            "sensors that may be on another part: 2; the next best one leaves at most 5 times as much",
            "sensors that are on a part only because of its joints (residual 0): 1",
        ]
    );
}

#[test]
fn an_uncertain_joint_is_named_with_what_may_be_in_its_place() {
    let mut joints = joined(3, &[(0, 1, 0.99, 1.0, true), (1, 2, 0.99, 0.9475, true)]);
    assert_eq!(
        said(&parts(&[16; 3], &[]), &joints),
        ["joint 2–1 is uncertain (support 94.8 %); record longer"]
    );
    joints.rivals[1] = Some(Rival { part: 0, other: 2, support: 0.05 });
    let text = "joint 2–1 is uncertain (support 94.8 %): it may be 0–2 instead (5.0 %); record longer, with these parts moving against each other";
    assert_eq!(said(&parts(&[16; 3], &[]), &joints), [text]);
}

#[test]
fn parts_that_feel_one_joint_are_named_together() {
    // 1, 2, 3 and 4 at one place, of which the tree joins 1 with each; 5, 6 and 7 at another; and 8 with two of four, which is none.
    let one = |part, other, in_tree| (part, other, 0.99999, 1.0, in_tree);
    let pairs = [
        (0, 1, 0.99999, 1.0, true),
        (0, 2, 0.99, 0.0, false),
        one(1, 2, true),
        one(1, 3, true),
        one(1, 4, true),
        one(2, 3, false),
        one(2, 4, false),
        one(3, 4, false),
        (1, 5, 0.999, 1.0, true),
        one(5, 6, true),
        one(5, 7, true),
        one(6, 7, false),
        one(7, 8, true),
    ];
    let places = at_one_place(&joined(9, &pairs), 1e-3);
    assert_eq!(places, [vec![1, 2, 3, 4], vec![5, 6, 7]]);
    let text = Doubt::OnePlace(places[1].clone()).to_string();
    assert!(text.starts_with("parts 5, 6, 7 feel one joint: "), "{text}");
}
