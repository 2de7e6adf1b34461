//! Test that the pieces of some sensors are found, and none in noise.

use rand::RngExt;

use super::super::memory::Memory;
use super::super::roots::Roots;
use super::*;
use crate::numerics::rng::stream;
use crate::stages::parameters::Parameters;

/// What 24 sensors on each of two parts feel, whose motions of rank four differ by a share of their size; and noise of such a size,
/// as a share of the largest root.
fn felt(difference: f64, noise: f64) -> Felt {
    let mut rng = stream(1, 1, "pieces", 0);
    let mut uniform = |rows, columns| Mat::from_fn(rows, columns, |_, _| rng.random_range(-1.0_f64..1.0));
    let motion = uniform(500, 4);
    let other = &motion + uniform(500, 4) * faer::Scale(difference);
    let velocities = [motion * uniform(4, 24), other * uniform(4, 24)];
    let errors = uniform(500, 48);
    let values = Mat::from_fn(500, 48, |t, sensor| {
        (velocities[sensor / 24][(t, sensor % 24)] + noise * errors[(t, sensor)]).max(0.0)
    });
    let sizes = vec![1.0; 500];
    let roots = Roots { values, thresholds: sizes.clone(), signed: false }.equalised(&sizes, 0.0);
    let completed = Completion::new(&roots, Parameters::default().completion_ridge).velocities;
    Felt {
        roots,
        completed,
        sizes,
        tolerance: 2e-5,
        iterations: [24, 100],
        parameters: Parameters::default(),
        memory: Memory::default(),
    }
}

fn found(felt: &Felt) -> (Vec<Vec<usize>>, Vec<usize>) {
    let (found, rest) = pieces(felt, &(0..48).collect::<Vec<_>>());
    (found.into_iter().map(|own| own.sensors).collect(), rest)
}

#[test]
fn parts_that_hardly_move_against_each_other_are_told_apart() {
    let felt = felt(0.1, 0.0);
    let whole = Cluster::learned_longer(&felt, (0..48).collect());
    assert!(
        (1e-4..1e-2).contains(&whole.variance()),
        "one motion nearly explains both: {}",
        whole.variance()
    );
    // A sensor whose velocity hardly differs may be on either.
    let (mut found, rest) = found(&felt);
    found.sort();
    let wrong = |own: &Vec<usize>, part: usize| own.iter().filter(|sensor| *sensor / 24 != part).count();
    assert_eq!(found.len(), 2, "{found:?}");
    assert!(wrong(&found[0], 0) + wrong(&found[1], 1) + rest.len() <= 2, "{found:?} {rest:?}");
}

#[test]
fn one_part_is_one_piece_and_noise_makes_none() {
    assert_eq!(found(&felt(0.0, 0.0)), (vec![(0..48).collect()], vec![]));
    for difference in [0.0, 0.1] {
        assert_eq!(found(&felt(difference, 0.1)), (vec![], (0..48).collect()), "{difference}");
    }
}
