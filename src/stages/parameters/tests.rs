//! Test what parameters may be.

use super::*;

#[test]
fn each_parameter_can_be_changed_within_its_range() {
    let default = Parameters::default().values();
    for (at, name) in Parameters::NAMES.iter().enumerate() {
        let own = default[at];
        let with = |value: f64| Parameters::changed([(*name, value)]);
        // Nothing else changes.
        let mut expected = default.clone();
        expected[at] = if name.ends_with("tolerance") { 1.5 * own } else { 3.0 * own };
        assert_eq!(with(expected[at]).unwrap().values(), expected, "{name}");
        for value in [0.0, -own, f64::NAN, f64::INFINITY, 101.0 * own, own / 1000.0] {
            assert!(with(value).is_err(), "{name} = {value}");
        }
    }
}

#[test]
fn what_cannot_be_used_is_named() {
    for (name, value, expected) in [
        ("neighbours", 2.5, "parameter `neighbours` is 2.5, but must be a whole number from 1 to 500"),
        ("min_saving", 31.0, "parameter `min_saving` is 31, but must be 0.003 to 30"),
        ("neighbors", 2.0, "no parameter is called `neighbors`; there are: samples, completion_ridge, "),
        ("min_tolerance", 1e-5, "must rise, but are [\"0.00000002\", \"0.00002\", \"0.00001\", \"0.05\"]"),
    ] {
        let error = Parameters::changed([(name, value)]).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }
}
