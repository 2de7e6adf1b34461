use std::collections::BTreeMap;

use serde::Deserialize;

use super::*;

#[derive(Deserialize)]
struct Case {
    chains: Vec<Vec<f64>>,
    r_hat: f64,
    ess: f64,
}

#[test]
fn r_hat_and_effective_sample_size_agree_with_arviz() {
    let cases: BTreeMap<String, Case> =
        serde_json::from_str(include_str!("../../../tests/reference/diagnostics.json")).unwrap();
    for (name, case) in cases {
        let found = mixing(&case.chains);
        assert!((found.r_hat.unwrap() - case.r_hat).abs() < 1e-6, "{name}: {found:?}, {}", case.r_hat);
        assert!((found.ess.unwrap() / case.ess - 1.0).abs() < 1e-6, "{name}: {found:?}, {}", case.ess);
    }
}

#[test]
fn chains_that_do_not_move_agree_or_do_not() {
    let still = |values: &[f64]| mixing(&values.iter().map(|x| vec![*x; 50]).collect::<Vec<_>>());
    assert_eq!(still(&[5.0, 5.0]), Mixing { r_hat: Some(1.0), ess: Some(100.0) });
    assert!(still(&[5.0, 6.0]).r_hat.unwrap() > 1e6);
    assert_eq!(mixing(&[vec![1.0, 2.0, 3.0]]), Mixing { r_hat: None, ess: None });
}
