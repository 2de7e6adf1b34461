//! Test how numbers are written.

use super::*;

#[test]
fn rates_are_in_percent_and_the_rest_is_not() {
    let rate = |rate| value(Some(rate), Some(Unit::Rate));
    let rates = [0.0, 0.0004, 0.03749, 0.846, 0.9702, 0.9996, 1.0].map(rate);
    assert_eq!(rates, ["0 %", "0.0 %", "3.7 %", "84.6 %", "97.0 %", "100.0 %", "100 %"]);
    assert_eq!(value(Some(7.388_2), Some(Unit::Parts)), "7.388");
    assert_eq!(value(Some(-0.000_1), Some(Unit::Ari)), "0");
    assert_eq!(value(Some(14.0), Some(Unit::Dimension)), "14");
    assert_eq!(value(Some(0.9), Some(Unit::Coordination)), "0.9");
    let p_value = |p| value(Some(p), Some(Unit::PValue));
    assert_eq!([1.0, 0.0081, 0.001, 1e-9].map(p_value), ["1", "0.008", "0.001", "< 0.001"]);
    assert_eq!(value(None, Some(Unit::Rate)), "–");
    assert_eq!(value(None, None), "–");
}

#[test]
fn thousands_have_commas() {
    assert_eq!(
        [0, 999, 1000, 56_000, 1_234_567].map(thousands),
        ["0", "999", "1,000", "56,000", "1,234,567"]
    );
}

#[test]
fn a_range_has_one_sign_and_equal_ends_are_one_number() {
    let of = |low, high, unit| range(Some((low, high)), Some(unit));
    assert_eq!(of(0.8689, 1.0, Unit::Rate), "86.9 to 100 %");
    assert_eq!(of(0.0, 0.037, Unit::Rate), "0 to 3.7 %");
    assert_eq!(of(1.0, 1.0, Unit::Rate), "100 %");
    assert_eq!(of(-0.2, 0.2, Unit::Ari), "-0.2 to 0.2");
    assert_eq!(of(0.0, 0.05, Unit::PValue), "0 to 0.05");
    assert_eq!(of(14.0, 14.0, Unit::Dimension), "14");
    assert_eq!(range(None, Some(Unit::Rate)), "");
}
