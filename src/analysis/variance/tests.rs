use rand::RngExt;
use rand_distr::StandardNormal;
use serde::Deserialize;

use super::*;
use crate::numerics::rng::{Stream, stream};

#[derive(Deserialize)]
struct Reference {
    values: Vec<f64>,
    clusters: Vec<usize>,
    units: Vec<Vec<usize>>,
    levels: Vec<Vec<usize>>,
    /// Value, lower and upper end, of each factor and then of each pair.
    shares: Vec<[f64; 3]>,
}

fn reference() -> (Table, Vec<[f64; 3]>) {
    let text = include_str!("../../../tests/reference/variance.json");
    let Reference { values, clusters, units, levels, shares } = serde_json::from_str(text).unwrap();
    (Table { values, clusters, units, levels }, shares)
}

#[test]
fn shares_and_their_intervals_are_those_of_the_reference() {
    let (table, expected) = reference();
    let found = table.shares();
    assert_eq!(found.len(), expected.len());
    for ((source, share), expected) in found.into_iter().zip(expected) {
        let (low, high) = share.interval.unwrap();
        for (found, expected) in [share.value.unwrap(), low, high].into_iter().zip(expected) {
            assert!((found - expected).abs() < 1e-9, "{source:?}: {found} and {expected}");
        }
    }
}

#[test]
fn what_no_number_depends_on_has_no_share_and_a_constant_has_none_to_give() {
    let (table, _) = reference();
    // The third factor of the reference, shuffled against everything.
    let idle: Vec<usize> = (0..table.values.len()).map(|at| at * 7 % 5).collect();
    let own: Vec<usize> = (0..table.values.len()).collect();
    let with_idle =
        Table { units: vec![own.clone(), own], levels: vec![table.levels[0].clone(), idle], ..table.clone() };
    let share = with_idle.shares()[1].1;
    assert!(share.value.unwrap() < 0.05, "{share:?}");
    let constant = Table { values: vec![0.5; table.values.len()], ..table };
    assert!(constant.shares().iter().all(|(_, share)| share.value.is_none()));
}

/// What differs from movement to movement is no share of a factor that only movements have.
#[test]
fn a_factor_of_whole_units_takes_nothing_of_what_units_differ_by() {
    let mut rng = stream(1, 0, "variance", 0);
    let mut excess = |unit_of_factor: bool| -> f64 {
        let all: f64 = (0..200)
            .map(|_| {
                let units: Vec<usize> = (0..128).map(|at| at / 8).collect();
                let effects: Vec<f64> = (0..16).map(|_| rng.sample(StandardNormal)).collect();
                let levels = units.iter().map(|unit| unit % 4).collect();
                let noise =
                    |unit: &usize, rng: &mut Stream| effects[*unit] + rng.sample::<f64, _>(StandardNormal);
                let values = units.iter().map(|unit| noise(unit, &mut rng)).collect();
                let own = if unit_of_factor { units.clone() } else { (0..128).collect() };
                let table = Table { values, clusters: units, units: vec![own], levels: vec![levels] };
                table.omega_squared(&[Source::Factor(0)])[0].unwrap()
            })
            .sum();
        all / 200.0
    };
    let fair = excess(true);
    assert!(fair.abs() < 0.02, "{fair}");
    // The twin that takes each number for a unit of its own finds a share where there is none.
    let naive = excess(false);
    assert!(naive > 0.05, "{naive}");
}

#[test]
fn a_table_that_is_too_small_has_no_shares() {
    let two = vec![vec![0, 1], vec![0, 1]];
    let table = Table { values: vec![1.0, 2.0], clusters: vec![1, 2], units: two.clone(), levels: two };
    assert!(table.shares().iter().all(|(_, share)| share.value.is_none()));
    let none = vec![Vec::new()];
    let empty = Table { values: Vec::new(), clusters: Vec::new(), units: none.clone(), levels: none };
    assert!(empty.shares().iter().all(|(_, share)| share.value.is_none()));
}
