//! Test that tables are read and refused.

use super::*;

#[test]
fn the_truth_is_read_back_and_its_mistakes_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let (labels, tree) = (folder.path().join("labels.csv"), folder.path().join("tree.csv"));
    let truth = Truth::new(vec![3, 3, 1, 7], vec![(1, 3), (7, 1)]);
    write_truth(&labels, &tree, &truth).unwrap();
    assert_eq!(read_truth(&labels, &tree, 4).unwrap(), truth);

    // A trunk with two legs at one place.
    let shared = Truth { places: vec![0, 0], ..Truth::new(vec![0, 0, 1, 2], vec![(1, 0), (2, 0)]) };
    write_truth(&labels, &tree, &shared).unwrap();
    assert_eq!(std::fs::read_to_string(&tree).unwrap(), "child,parent,place\n1,0,0\n2,0,0\n");
    assert_eq!(read_truth(&labels, &tree, 4).unwrap(), shared);

    // A body of many parts, its edges from the leaves to the root.
    let many = 20_000;
    let long = Truth::new((0..many).collect(), (1..many).rev().map(|i| (i, i - 1)).collect());
    write_truth(&labels, &tree, &long).unwrap();
    assert_eq!(read_truth(&labels, &tree, many).unwrap(), long);

    let rejects = |label_rows: &str, tree_rows: &str, expected: &str| {
        std::fs::write(&labels, label_rows).unwrap();
        std::fs::write(&tree, tree_rows).unwrap();
        let message = read_truth(&labels, &tree, 3).unwrap_err().to_string();
        assert!(message.contains(expected) && !message.contains('\n'), "{message:?} lacks {expected:?}");
    };
    let (good_labels, good_tree) = ("sensor,part\n0,0\n1,1\n2,2\n", "child,parent\n1,0\n2,1\n");
    rejects("sensor,part\n0,0\n1,1\n1,1\n", good_tree, "sensor 1 has two parts");
    rejects("sensor,part\n0,0\n1,1\n", good_tree, "sensor 2 of 3 has no part");
    rejects("sensor,part\n0,0\n1,1\n3,1\n", good_tree, "there is no sensor 3");
    rejects("sensor,part\n0,0\n1,x\n", good_tree, "line 3: ");
    rejects("sensor;part\n0;0\n", good_tree, "missing field `sensor`");
    rejects(good_labels, "child,parent\n1,0\n", "1 edges do not make a tree over 3 parts");
    rejects(good_labels, "child,parent\n1,0\n0,1\n", "do not make a tree");
    rejects(good_labels, "child,parent\n1,0\n9,0\n", "part 9 has no sensor");
    rejects(good_labels, "child,parent\n1,0\n0,1\n2,0\n", "3 edges do not make a tree over 3 parts");
    rejects(good_labels, "child,parent\n1,0\n2,2\n", "do not make a tree");
    rejects(good_labels, "child,parent,place\n1,0,0\n2,0,\n", "line 3: the joint has no place");
    rejects(good_labels, "", "0 edges do not make a tree");
    rejects("", good_tree, "sensor 0 of 3 has no part");
    rejects("sensor,part\n0,0\n1,-1\n", good_tree, "line 3: ");
    rejects("sensor,part\n0,0\n1,99999999999999999999\n", good_tree, "line 3: ");
    rejects("sensor,part\n0,0\n1\n", good_tree, "line: 3");
    rejects("sensor,sensor,part\n0,0,0\n", good_tree, "duplicate field `sensor`");
    rejects("sensor,part\n0,\"a\nb\"\n", good_tree, "line 2: ");
    rejects("\u{feff}sensor,part\n0,0\n1,1\n2,x\n", good_tree, "line 4: ");
}
