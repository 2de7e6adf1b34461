//! Test that the information metric is a metric, whatever the symbols, and that twins that are not are rejected.

use bodyschema::stages::distance::{Distances, information_metric};
use bodyschema::stages::quantise::Symbols;
use proptest::prelude::*;

/// Four sensors over up to 40 samples of up to five symbols.
fn symbols() -> impl Strategy<Value = Symbols> {
    (1_usize..=40, 2_usize..=5).prop_flat_map(|(samples, levels)| {
        prop::collection::vec(0..levels as u8, 4 * samples).prop_map(move |values| Symbols {
            samples,
            levels,
            values,
        })
    })
}

const TOLERANCE: f64 = 1e-9;

fn series(symbols: &Symbols, sensor: usize) -> &[u8] {
    &symbols.values[sensor * symbols.samples..][..symbols.samples]
}

/// Whether one sensor's symbol tells the other's, both ways.
fn same_but_for_names(symbols: &Symbols, i: usize, j: usize) -> bool {
    let pairs: Vec<(u8, u8)> =
        series(symbols, i).iter().copied().zip(series(symbols, j).iter().copied()).collect();
    pairs.iter().all(|a| pairs.iter().all(|b| (a.0 == b.0) == (a.1 == b.1)))
}

fn axioms(symbols: &Symbols, distances: &Distances) -> Result<(), String> {
    for i in 0..4 {
        for j in 0..4 {
            let d = distances.get(i, j);
            if d < 0.0 {
                return Err(format!("negative: {d}"));
            }
            if (d - distances.get(j, i)).abs() > TOLERANCE {
                return Err(format!("not symmetric: {d} and {}", distances.get(j, i)));
            }
            if (d < TOLERANCE) != same_but_for_names(symbols, i, j) {
                return Err(format!("identity: {d}"));
            }
            for k in 0..4 {
                if distances.get(i, k) > d + distances.get(j, k) + TOLERANCE {
                    return Err("triangle".to_owned());
                }
            }
        }
    }
    Ok(())
}

/// H(X|Y) alone, by way of the metric with a constant: D(X, constant) = H(X).
fn conditional_entropy_only(symbols: &Symbols, distances: &Distances) -> Distances {
    let entropy = |sensor: usize| {
        let share = |level: u8| {
            let count = series(symbols, sensor).iter().filter(|&&symbol| symbol == level).count();
            count as f64 / symbols.samples as f64
        };
        (0..symbols.levels as u8).map(share).filter(|p| *p > 0.0).map(|p| -p * p.log2()).sum::<f64>()
    };
    // H(X|Y) = (D + H(X) - H(Y)) / 2.
    let values =
        (0..16).map(|at| (distances.get(at / 4, at % 4) + entropy(at / 4) - entropy(at % 4)) / 2.0).collect();
    Distances { sensors: 4, values }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]

    #[test]
    fn the_axioms_of_a_metric_hold(symbols in symbols()) {
        prop_assert_eq!(axioms(&symbols, &information_metric(&symbols)), Ok(()));
    }

    #[test]
    fn names_of_symbols_and_order_of_samples_do_not_matter(symbols in symbols(), shift in 1_u8..5) {
        let before = information_metric(&symbols);
        let mut renamed = symbols.clone();
        let levels = symbols.levels as u8;
        for value in &mut renamed.values[..symbols.samples] {
            *value = (*value + shift) % levels;
        }
        let mut reversed = symbols.clone();
        reversed.values.chunks_mut(symbols.samples).for_each(<[u8]>::reverse);
        for after in [information_metric(&renamed), information_metric(&reversed)] {
            for (a, b) in before.values.iter().zip(&after.values) {
                prop_assert!((a - b).abs() < TOLERANCE, "{} {}", a, b);
            }
        }
    }
}

#[test]
fn twins_that_are_no_metric_are_rejected() {
    // X and Y independent bits, (X, Y) together, and a constant.
    let values = [[0, 0, 1, 1], [0, 1, 0, 1], [0, 1, 2, 3], [0, 0, 0, 0]].concat();
    let symbols = Symbols { samples: 4, levels: 4, values };
    let distances = information_metric(&symbols);
    axioms(&symbols, &distances).unwrap();

    let one_sided = conditional_entropy_only(&symbols, &distances);
    assert!(axioms(&symbols, &one_sided).is_err());
    let squared = Distances { sensors: 4, values: distances.values.iter().map(|d| d * d).collect() };
    assert!(axioms(&symbols, &squared).is_err(), "a squared metric breaks the triangle");
    let shifted = Distances { sensors: 4, values: distances.values.iter().map(|d| d + 0.1).collect() };
    assert!(axioms(&symbols, &shifted).is_err());
}
