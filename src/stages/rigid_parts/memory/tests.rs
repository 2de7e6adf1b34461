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

/// What 60 sensors on a part feel, with noise of this size. Values of one are missing.
fn felt(noise: f64) -> Felt {
    let mut rng = stream(9, 1, "memory", 0);
    let mut uniform = |rows, columns| Mat::from_fn(rows, columns, |_, _| rng.random_range(-1.0_f64..1.0));
    let mut felt = felt_of(&(uniform(200, 4) * uniform(4, 60) + uniform(200, 60) * faer::Scale(noise))).0;
    (0..20).for_each(|t| felt.roots.values[(9 * t, 3)] = f64::NAN);
    felt
}

/// All that is learned of the first sensors of these, and what then completes their roots.
fn told(felt: &Felt, sensors: usize) -> (Mat<f64>, Mat<f64>, [usize; 2], [u64; 3]) {
    let mut own = Cluster::new(felt, (0..sensors).collect());
    own.learn_with_least_rank(felt);
    let mut after = self::felt(0.0);
    own.complete_roots(&mut after);
    let numbers = [own.description_length, own.freedom, own.variance()].map(f64::to_bits);
    (own.predicted(), after.completed, [own.rank(), own.present(felt, felt.tolerance)], numbers)
}

#[test]
fn what_is_remembered_is_what_would_be_learned_to_the_bit() {
    let memory = Memory::default();
    let noisy = |change: fn(&mut Felt)| {
        let mut felt = felt(0.1);
        change(&mut felt);
        felt
    };
    let exact = |iterations| Felt { tolerance: 2e-8, iterations, ..felt(0.0) };
    // They differ from the first in one thing each. The last ones converge before all iterations are made.
    let all = [
        noisy(|_| ()),
        noisy(|felt| felt.tolerance *= 2.0),
        noisy(|felt| felt.iterations[0] += 1),
        noisy(|felt| felt.iterations[1] += 1),
        noisy(|felt| felt.roots.thresholds[7] *= 2.0),
        noisy(|felt| felt.roots.values[(7, 2)] += 0.1),
        noisy(|felt| felt.completed[(7, 2)] += 0.1),
        exact([24, 300]),
        exact([24, 100]),
    ];
    for sensors in [12, 59, 60] {
        let fresh: Vec<_> = all.iter().map(|felt| told(felt, sensors)).collect();
        for _ in 0..2 {
            for (at, (felt, fresh)) in all.iter().zip(&fresh).enumerate() {
                let shared = Felt {
                    roots: felt.roots.select_as_they_are(&(0..60).collect::<Vec<_>>()),
                    completed: felt.completed.clone(),
                    sizes: felt.sizes.clone(),
                    memory: memory.clone(),
                    ..*felt
                };
                assert!(told(&shared, sensors) == *fresh, "{sensors} sensors, case {at}");
            }
        }
    }
}

#[test]
fn what_was_learned_is_asked_for() {
    let felt = felt(0.1);
    told(&felt, 12);
    let first = {
        let mut own = felt.memory.0.lock().unwrap();
        assert!(own.now.len() >= 4, "{}", own.now.len());
        own.before = std::mem::take(&mut own.now);
        own.before.clone()
    };
    told(&felt, 12);
    // The very same results are in the new generation, and none was learned again.
    let own = felt.memory.0.lock().unwrap();
    assert_eq!((own.now.len(), own.before.len()), (first.len(), 0));
    assert!(own.now.iter().all(|(key, found)| Arc::ptr_eq(found, &first[key])));
}
