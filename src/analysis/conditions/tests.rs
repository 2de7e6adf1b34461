//! Test means, rates and intervals of conditions.

use super::*;

fn sample(chain: usize, log_posterior: Option<f64>) -> Record {
    Record {
        simulation: 1,
        coordination: 0.9,
        dimension: 14,
        model: crate::stages::schema::Model::DpgmmLj,
        chain,
        sweep: 1,
        parts: 5,
        log_posterior,
        ari: 1.0,
        eligible: false,
        tree_correct: true,
    }
}

#[test]
fn of_samples_that_differ_by_rounding_the_first_is_the_most_probable() {
    let best = |values: &[Option<f64>]| {
        let records: Vec<Record> =
            values.iter().enumerate().map(|(chain, value)| sample(chain, *value)).collect();
        let best = Conditions::new(records, 1, 1).best();
        assert!(best.records.len() == 1 && best.records[0].eligible);
        best.records[0].chain
    };
    assert_eq!(best(&[Some(9000.0), Some(9123.4 - 1e-8), Some(9123.4), Some(9123.39)]), 1);
    assert_eq!(best(&[Some(-5.0), None, Some(-4.0)]), 2);
    assert_eq!(best(&[None, None]), 0);
}

#[test]
fn a_rate_of_0_or_1_counts_simulations_and_any_other_counts_samples() {
    let interval = |groups: &[Vec<f64>]| pooled_rate(groups).interval;
    // Three simulations with a hundred samples each, and one without an eligible one.
    let wrong = [vec![0.0; 100], vec![0.0; 100], vec![0.0; 100], Vec::new()];
    assert_eq!(interval(&wrong), rate(0, 3).interval);
    assert_eq!((pooled_rate(&wrong).value, pooled_rate(&wrong).n), (Some(0.0), 300));
    let right = [vec![1.0; 100], vec![1.0; 50]];
    assert_eq!(interval(&right), rate(2, 2).interval);
    // One simulation alone has nothing but its samples, and one sample that differs leaves the bootstrap something to see.
    assert_eq!(interval(&right[..1]), rate(100, 100).interval);
    let mixed = [vec![1.0; 100], vec![1.0, 0.0]];
    assert_eq!(interval(&mixed), rate(101, 102).interval);
    assert_eq!(interval(&[Vec::new(), Vec::new()]), None);
}
