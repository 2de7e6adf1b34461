//! Test that a cluster grows by its own sensors and by no others.

use faer::Mat;
use rand::RngExt;

use super::super::cluster::Felt;
use super::super::completion::Completion;
use super::super::memory::Memory;
use super::super::roots::{Roots, product};
use super::*;
use crate::numerics::rng::stream;
use crate::stages::parameters::Parameters;

/// What 24 sensors on the side of a cylinder feel, four on one end, and four on the other; and six on another part, whose motion differs
/// by a tenth.
fn felt() -> Search {
    let mut rng = stream(2, 1, "growth", 0);
    let mut uniform = |rows, columns| Mat::from_fn(rows, columns, |_, _| rng.random_range(-1.0_f64..1.0));
    let motion = uniform(600, 5);
    let other = &motion + uniform(600, 5) * faer::Scale(0.1);
    // The fifth component is along the axis: the side does not feel it, and the ends do with opposite signs.
    let mut own = uniform(5, 32);
    for sensor in 0..32 {
        own[(4, sensor)] = match sensor {
            0..24 => 0.0,
            24..28 => 1.0,
            _ => -1.0,
        };
    }
    let velocities =
        [product(motion.as_ref(), own.as_ref()), product(other.as_ref(), uniform(5, 6).as_ref())];
    let values = Mat::from_fn(600, 38, |t, sensor| {
        let (part, at) = if sensor < 32 { (0, sensor) } else { (1, sensor - 32) };
        velocities[part][(t, at)].max(0.0)
    });
    let sizes = vec![1.0; 600];
    let roots = Roots { values, thresholds: sizes.clone(), signed: false }.equalised(&sizes, 0.0);
    let completion = Completion::new(&roots, Parameters::default().completion_ridge);
    let memory = Memory::default();
    let felt = Felt {
        roots,
        completed: completion.velocities,
        sizes,
        tolerance: 2e-8,
        iterations: [24, 300],
        parameters: Parameters::default(),
        memory,
    };
    let mut search = Search::new(felt, completion.affinities);
    search.has_exact_model = true;
    search
}

#[test]
fn a_cylinder_grows_by_its_ends_and_not_by_another_part() {
    let mut search = felt();
    let side = Cluster::learned_longer(&search.felt, (0..24).collect());
    assert!(search.is_exact(&side), "{}", side.variance());
    let found = search.grown(vec![side]);
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].sensors, (0..32).collect::<Vec<_>>());
    assert!(found[0].variance() < 1e-6, "{}", found[0].variance());
}

#[test]
fn a_cluster_grows_by_no_sensors_of_another_part() {
    let mut search = felt();
    // With both ends it has all of its motion, and one component to spare.
    let all = Cluster::learned_longer(&search.felt, (0..32).collect());
    let found = search.grown(vec![all]);
    assert_eq!(found[0].sensors, (0..32).collect::<Vec<_>>());
}
