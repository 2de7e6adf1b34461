use super::*;

#[test]
fn variation_of_information_of_known_partitions() {
    assert_eq!(variation_of_information(&[0, 0, 1, 1], &[7, 7, 3, 3]), 0.0);
    // One says nothing, the other one bit.
    assert!((variation_of_information(&[0, 0, 0, 0], &[0, 0, 1, 1]) - 1.0).abs() < 1e-12);
    // Independent: each says one bit beyond the other.
    assert!((variation_of_information(&[0, 0, 1, 1], &[0, 1, 0, 1]) - 2.0).abs() < 1e-12);
}

#[test]
fn the_consensus_is_what_most_say_whatever_they_call_it() {
    let samples: [&[usize]; 4] =
        [&[3, 3, 3, 0, 0, 0], &[0, 0, 0, 5, 5, 5], &[1, 1, 1, 2, 2, 2], &[1, 1, 2, 2, 2, 2]];
    let found = consensus(&samples);
    assert_eq!(found.labels, [0, 0, 0, 1, 1, 1]);
    assert_eq!(found.certainty, [1.0, 1.0, 0.75, 1.0, 1.0, 1.0]);
    assert!(found.loss > 0.0 && found.loss < 0.5);
}

#[test]
fn the_consensus_is_the_vote_on_each_sensor_where_no_draw_has_all_right() {
    // Each sample has one sensor on the wrong part, and each another one.
    let right = [0, 0, 0, 0, 1, 1, 1, 1];
    let sample = |wrong: usize| {
        let mut labels = right.to_vec();
        labels[wrong] = 1 - labels[wrong];
        labels
    };
    let samples: Vec<Vec<usize>> = (0..8).map(sample).collect();
    let found = consensus(&samples.iter().map(Vec::as_slice).collect::<Vec<_>>());
    assert_eq!(found.labels, right);
    assert_eq!(found.certainty, [0.875; 8]);
}

#[test]
fn a_minority_that_comes_first_does_not_decide() {
    // 120 samples merge the first two parts, and 480 do not; no two are alike, for each has two sensors astray.
    let sample = |at: usize| {
        let parts = if at < 120 { [0, 0, 1] } else { [0, 1, 2] };
        let mut labels: Vec<usize> = (0..90).map(|i| parts[i / 30]).collect();
        labels[at % 60 + 30] = parts[0];
        labels[at / 60] = parts[2];
        labels
    };
    let samples: Vec<Vec<usize>> = (0..600).map(sample).collect();
    let found = consensus(&samples.iter().map(Vec::as_slice).collect::<Vec<_>>());
    assert_eq!(found.labels, (0..90).map(|i| i / 30).collect::<Vec<_>>());
}

#[test]
fn a_draw_is_named_after_the_consensus_and_what_is_new_comes_after_it() {
    let mut sample = Sample {
        chain: 0,
        sweep: 1,
        labels: vec![7, 7, 7, 2, 2, 4],
        tree: vec![Edge { child: 7, parent: 2 }, Edge { child: 4, parent: 7 }],
        joints: Vec::new(),
        log_posterior: None,
    };
    named_after(&[0, 0, 0, 1, 1, 1], &mut sample);
    assert_eq!(sample.labels, [0, 0, 0, 1, 1, 2]);
    assert_eq!(sample.tree, [Edge { child: 0, parent: 1 }, Edge { child: 2, parent: 0 }]);
}

#[test]
fn a_part_that_a_draw_splits_counts_for_its_larger_half() {
    let samples: [&[usize]; 3] = [&[0, 0, 0, 1], &[0, 0, 0, 1], &[0, 0, 2, 1]];
    assert_eq!(consensus(&samples).certainty, [1.0, 1.0, 2.0 / 3.0, 1.0]);
}
