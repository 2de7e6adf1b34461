//! Test what is said of another value of a setting.

use super::super::super::measures::Measure;
use super::*;
use crate::analysis::cells::EstimateCells;
use crate::stages::schema::Model;

#[test]
fn the_published_rate_survives_where_the_range_is_met_or_reached() {
    let row = |value, interval: Option<(f64, f64)>| {
        let (low, high) = interval.unzip();
        MeasureRow {
            configuration: 1,
            coordination: 0.9,
            dimension: 14,
            model: Model::DpgmmLj,
            measure: Measure::Tree,
            value,
            cells: EstimateCells { n: 10, low, high, simulations: 2, lowest: None, highest: None },
            change: None,
            change_low: None,
            change_high: None,
            failed: 0,
            failure: String::new(),
        }
    };
    let of = |value, interval| Survival::of(Some(&row(value, interval)), (0.7, 0.9));
    assert_eq!(of(Some(0.8), Some((0.1, 1.0))), Survival::Yes);
    assert_eq!(of(Some(0.95), Some((0.85, 1.0))), Survival::Perhaps);
    assert_eq!(of(Some(0.95), Some((0.91, 1.0))), Survival::Higher);
    assert_eq!(of(Some(0.4), Some((0.2, 0.6))), Survival::Lower);
    assert_eq!(of(Some(0.4), None), Survival::Lower);
    assert_eq!(of(None, None), Survival::Nothing);
    assert_eq!(Survival::of(None, (0.7, 0.9)), Survival::Nothing);
    let all = [Survival::Yes, Survival::Lower, Survival::Yes];
    assert_eq!(counts(&all), "2 × yes; 1 × no, lower");
}
