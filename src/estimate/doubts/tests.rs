use std::collections::BTreeMap;

use super::*;

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
        tree: tree.map(|pair| Edge { child: pair.other, parent: pair.part }).collect(),
        pairs,
    }
}

/// Parts with so many sensors each, whose residuals are as given, or 0 beyond, and that of the next best part 0.1.
fn parts(sizes: &[usize], residuals: &[f64]) -> RigidParts {
    let labels: Vec<usize> = sizes.iter().enumerate().flat_map(|(part, size)| vec![part; *size]).collect();
    RigidParts {
        residuals: (0..labels.len()).map(|at| residuals.get(at).copied().unwrap_or(0.0)).collect(),
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
    let found = said(&parts(&[16, 15, 4], &[0.021, 0.5]), &joints);
    assert_eq!(
        found,
        [
            "part 1, the first of 2 such parts, has 15 sensors; 16 and more are needed to rely on a part",
            "2 sensors that their next best part explains nearly as well: their part is uncertain",
        ]
    );
}

#[test]
fn an_uncertain_joint_is_named_with_what_other_times_join_instead() {
    // 0 – 1 – 2 – 3, where 2 – 3 may be 1 – 3, and never 0 – 3. That 0 and 2 are joined sometimes says nothing of it.
    let joints = joined(
        4,
        &[
            (0, 1, 0.99, 1.0, true),
            (0, 2, 0.9, 0.45, false),
            (0, 3, 0.9, 0.0, false),
            (1, 2, 0.99, 1.0, true),
            (1, 3, 0.9, 0.4, false),
            (2, 3, 0.99, 0.6, true),
        ],
    );
    let found = doubts(&parts(&[16; 4], &[]), &joints, &Parameters::default());
    let joint = Edge { child: 3, parent: 2 };
    assert_eq!(found, [Doubt::Joint { joint, support: 0.6, instead: Some((1, 3, 0.4)) }]);
    assert_eq!(
        found[0].to_string(),
        "joint 3–2 is uncertain (support 60 %): it may be 1–3 instead (40 %); record longer, with these parts moving against each other"
    );
}

#[test]
fn parts_that_feel_one_joint_are_named_together() {
    // 1, 2, 3 and 4 at one place, of which the tree joins 1 with each; and 5, 6 and 7 at another.
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
    ];
    let places = at_one_place(&joined(8, &pairs), 1e-3);
    assert_eq!(places, [vec![1, 2, 3, 4], vec![5, 6, 7]]);
    let text = Doubt::OnePlace(places[1].clone()).to_string();
    assert!(text.starts_with("parts 5, 6, 7 feel one joint: "), "{text}");
}
