//! Test that the motion of a part leaves a local minimum.

use rand::RngExt;
use rayon::prelude::*;

use super::super::super::testing::felt_of;
use super::*;
use crate::numerics::rng::stream;
use crate::stages::rigid_parts::roots::product;

/// What 40 sensors on an ellipsoid feel of a rigid motion of uneven components.
fn felt(number: usize) -> Felt {
    let mut rng = stream(13, 1, "minimum", number);
    let mut uniform = |rows, columns| Mat::from_fn(rows, columns, |_, _| rng.random_range(-1.0_f64..1.0));
    let sizes = [4.0, 2.0, 1.3, 0.6, 0.3, 0.2];
    let (motion, directions) = (uniform(600, 6), uniform(3, 40));
    let loadings = Mat::from_fn(6, 40, |at, sensor| {
        let direction = directions.col(sensor);
        let n = [0, 1, 2].map(|axis| direction[axis] / direction.norm_l2());
        let place = [0.16 * n[0], 0.13 * n[1], 0.1 * n[2]];
        let [next, last] = [(at + 1) % 3, (at + 2) % 3];
        sizes[at] * if at < 3 { n[at] } else { 10.0 * (place[next] * n[last] - place[last] * n[next]) }
    });
    let mut felt = felt_of(&product(motion.as_ref(), loadings.as_ref())).0;
    (felt.tolerance, felt.iterations) = (2e-5, [24, 100]);
    felt
}

#[test]
fn a_rigid_part_leaves_nothing_wherever_its_motion_started() {
    let left = |number: usize| {
        let felt = felt(number);
        let mut own = Cluster::widest(&felt, (0..40).collect());
        own.completed = own.as_felt(&felt.roots.select_as_they_are(&own.representatives));
        (own.loadings, own.motion) = principal_motion(&own.completed, 6);
        own.learn(&felt, 300, felt.weights()[1]);
        let before = own.variance();
        own.leave_minimum(&felt);
        assert!(own.variance() <= before, "{number}: {before} becomes {}", own.variance());
        [before, own.variance()].map(|variance| variance > felt.tolerance)
    };
    let left: Vec<[bool; 2]> = (0..24).into_par_iter().map(left).collect();
    let stuck = |at: usize| left.iter().filter(|own| own[at]).count();
    // Some of these motions end in a minimum, and none stays there.
    assert!(stuck(0) > 0 && stuck(1) == 0, "{left:?}");
}
