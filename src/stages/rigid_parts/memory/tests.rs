//! Test that what is remembered is what would be computed, and that old results are forgotten.

use rand::RngExt;

use super::super::cluster::{Cluster, Felt};
use super::super::testing::felt_of;
use super::*;
use crate::numerics::rng::stream;

#[test]
fn the_last_results_are_remembered_and_older_ones_are_not() {
    let memory = Memory::default();
    memory.add(0, 0);
    for at in 1..=2 * GENERATION as u64 {
        // What is asked for again stays.
        assert_eq!(memory.get(0).as_deref(), Some(&0));
        memory.add(at, at);
    }
    assert_eq!(memory.get(1), None);
    assert_eq!(memory.clone().get(2 * GENERATION as u64 - 1).as_deref(), Some(&(2 * GENERATION as u64 - 1)));
    assert_eq!(memory.get(u64::MAX), None);
}

#[test]
fn a_key_tells_numbers_and_their_places_apart() {
    let matrix = |values: [f64; 2]| Mat::from_fn(2, 1, |at, _| values[at]);
    let keys = [
        key(&[1.0], &[&matrix([2.0, 3.0])]),
        key(&[1.0], &[&matrix([3.0, 2.0])]),
        key(&[1.0, 2.0], &[&matrix([2.0, 3.0])]),
        key(&[], &[&Mat::from_fn(1, 2, |_, at| [2.0, 3.0][at])]),
        key(&[], &[&matrix([2.0, 3.0])]),
        key(&[0.0], &[]),
        key(&[-0.0], &[]),
    ];
    for (at, own) in keys.iter().enumerate() {
        assert!(!keys[..at].contains(own), "{at}");
    }
    assert_eq!(keys[0], key(&[1.0], &[&matrix([2.0, 3.0])]));
}

/// What twelve sensors on a part feel, with noise.
fn felt() -> Felt {
    let mut rng = stream(9, 1, "memory", 0);
    let mut uniform = |rows, columns| Mat::from_fn(rows, columns, |_, _| rng.random_range(-1.0_f64..1.0));
    felt_of(&(uniform(200, 4) * uniform(4, 12) + uniform(200, 12) * faer::Scale(0.1))).0
}

#[test]
fn a_remembered_cluster_is_the_same_to_the_bit() {
    let felt = felt();
    let told = || {
        let mut own = Cluster::new(&felt, (0..12).collect());
        own.learn_with_least_rank(&felt);
        let mut after = self::felt();
        own.complete_roots(&mut after);
        (own.predicted(), after.completed, own.rank(), own.description_length, own.freedom, own.variance())
    };
    let first = told();
    let count = || felt.memory.0.lock().unwrap().now.len();
    let learned = count();
    assert!(learned >= 4, "{learned}");
    assert_eq!((told(), count()), (first, learned));
}
