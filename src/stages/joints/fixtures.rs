//! Planar parts in a row, and their motions, for tests.

use rand::RngExt;

use crate::numerics::rng::stream;
use crate::stages::rigid_parts::MotionSubspace;

/// Planar parts in a row, each joined to the next: the motion that the sides of each feel, velocity across and angular velocity;
/// and the motion that its ends feel, velocity along.
pub(super) fn row(parts: usize, samples: usize) -> (Vec<MotionSubspace>, Vec<MotionSubspace>) {
    let mut rng = stream(1, 1, "row", 0);
    let mut across = vec![Vec::new(); parts];
    let mut along = vec![Vec::new(); parts];
    for _ in 0..samples {
        let mut uniform = || rng.random_range(-1.0..1.0);
        let (mut velocity, mut rate) = ([uniform(), uniform()], uniform());
        for part in 0..parts {
            if part > 0 {
                // To the joint, half a length further on; into the next part's frame; to its middle.
                let joint: [f64; 2] = [velocity[0], velocity[1] + 0.5 * rate];
                let (sine, cosine) = (3.0 * uniform()).sin_cos();
                rate = uniform();
                velocity =
                    [cosine * joint[0] - sine * joint[1], sine * joint[0] + cosine * joint[1] + 0.5 * rate];
            }
            across[part].extend([velocity[1], rate]);
            along[part].push(velocity[0]);
        }
    }
    let motions =
        |bases: Vec<Vec<f64>>, rank| bases.into_iter().map(|basis| MotionSubspace { rank, basis }).collect();
    (motions(across, 2), motions(along, 1))
}
