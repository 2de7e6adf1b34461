use super::*;
use crate::analysis::cells::EstimateCells;
use crate::analysis::published::Experiment;

#[test]
fn credit_is_full_within_the_range_and_falls_to_nothing_outside() {
    let judged = JudgedClaim {
        id: "tree-accuracy".to_owned(),
        experiment: Experiment::Exp1,
        label: String::new(),
        weight: Some(3.0),
        slack: Some(0.2),
    };
    let (low, high) = (0.6, 0.9);
    let credit = |value: Option<f64>| {
        let row = ClaimRow {
            configuration: 1,
            name: String::new(),
            claim: judged.id.clone(),
            experiment: Experiment::Exp1,
            accepted_low: low,
            accepted_high: high,
            value,
            cells: EstimateCells::default(),
            found: String::new(),
            verdict: Verdict::NotTestable,
            change: None,
            change_low: None,
            change_high: None,
        };
        super::credit(&judged, &row)
    };
    assert_eq!([low, 0.5 * (low + high), high].map(|value| credit(Some(value))), [1.0; 3]);
    assert!(
        (credit(Some(low - 0.05)) - 0.75).abs() < 1e-12 && (credit(Some(high + 0.05)) - 0.75).abs() < 1e-12
    );
    assert_eq!([credit(Some(low - 0.3)), credit(None)], [0.0; 2]);
}
