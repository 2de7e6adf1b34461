use super::*;

fn chain_of_three() -> Truth {
    Truth::new([[0; 4], [1; 4], [2; 4]].concat(), vec![(1, 0), (2, 1)])
}

fn scored(labels: &[usize], edges: &[(usize, usize)], ari: f64) -> Score {
    let tree: Vec<Edge> = edges.iter().map(|&(child, parent)| Edge { child, parent }).collect();
    score(labels, &tree, &chain_of_three(), ari)
}

#[test]
fn a_tree_is_right_whatever_its_labels_and_directions() {
    let labels = [[7; 4], [2; 4], [5; 4]].concat();
    let right = scored(&labels, &[(7, 2), (5, 2)], 1.0);
    assert_eq!(right, Score { ari: 1.0, eligible: true, tree_correct: true });
    let wrong = scored(&labels, &[(2, 7), (5, 7)], 1.0);
    assert_eq!(wrong, Score { ari: 1.0, eligible: true, tree_correct: false });
}

#[test]
fn a_single_sensor_is_no_part_and_spoils_a_perfect_ari() {
    let mut labels = [[0; 4], [1; 4], [2; 4]].concat();
    labels[0] = 9;
    let score_at = |ari| scored(&labels, &[(1, 0), (2, 1)], ari);
    assert_eq!(parts(&labels), 3);
    assert!(!score_at(1.0).eligible && score_at(0.8).eligible);
    assert!(score_at(0.8).tree_correct);
}

#[test]
fn too_many_parts_or_two_for_one_are_never_right() {
    let four = [[0; 4], [1; 4], [2, 2, 3, 3]].concat();
    let score_four = scored(&four, &[(1, 0), (2, 1), (3, 2)], 0.0);
    assert!(!score_four.eligible && !score_four.tree_correct);
    let edges = [(1, 0), (2, 1), (3, 1)].map(|(child, parent)| Edge { child, parent });
    assert_eq!(joints_right(&four, &edges, &chain_of_three()), 2, "two of the three are one joint");
    let doubled = [[0, 0, 1, 1], [2; 4], [2; 4]].concat();
    let score_doubled = scored(&doubled, &[(1, 0), (2, 1)], 0.0);
    assert!(score_doubled.eligible && !score_doubled.tree_correct);
}

#[test]
fn parts_match_one_to_one_and_an_edge_joins_what_is_joined() {
    let truth = chain_of_three();
    let few_wrong = [[7, 7, 7, 2], [2; 4], [5; 4]].concat();
    assert!(parts_match(&few_wrong, &truth));
    assert!(!parts_match(&[[0; 4], [0; 4], [2; 4]].concat(), &truth));
    let joined = |child, parent| joins(&few_wrong, &Edge { child, parent }, &truth);
    assert!(joined(7, 2) && joined(5, 2) && !joined(7, 5) && !joined(7, 9));
}

#[test]
fn parts_that_turn_about_one_place_may_be_joined_either_way() {
    // A trunk 0 with legs 1 and 2 at one place, and a foot 3 on 1.
    let labels = [[0; 4], [1; 4], [2; 4], [3; 4]].concat();
    let truth = Truth { places: vec![0, 0, 1], ..Truth::new(labels.clone(), vec![(1, 0), (2, 0), (3, 1)]) };
    let right = |edges: [(usize, usize); 3]| {
        score(&labels, &edges.map(|(child, parent)| Edge { child, parent }), &truth, 1.0).tree_correct
    };
    assert!(
        right([(1, 0), (2, 0), (3, 1)]) && right([(1, 0), (2, 1), (3, 1)]) && right([(2, 0), (1, 2), (3, 1)])
    );
    assert!(!right([(1, 0), (2, 0), (3, 0)]) && !right([(1, 0), (2, 0), (3, 2)]));
    // A cycle that leaves the foot alone.
    assert!(!right([(1, 0), (2, 1), (0, 2)]));
    assert!(joins(&labels, &Edge { child: 2, parent: 1 }, &truth));
    assert!(!joins(&labels, &Edge { child: 3, parent: 0 }, &truth));
}
