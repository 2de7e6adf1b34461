//! Planar parts in a row, and what sensors simulate_and_sense, for tests.

use rand::RngExt;

use super::motion::Motion;
use crate::numerics::rng::stream;

/// Planar parts in a row, each joined to the next: what each feels of its velocity across, and of its rate; and what the ends of each
/// feel of its velocity along.
pub fn row(parts: usize, samples: usize) -> (Vec<Motion>, Vec<Motion>) {
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
    let motions = |values: Vec<Vec<f64>>, components| {
        values.into_iter().map(|values| Motion { components, values }).collect()
    };
    (motions(across, 2), motions(along, 1))
}

/// The pressures on a sensor that feels what c says of w, numbers by time.
pub fn felt<'a>(w: &'a [f64], c: &'a [f64]) -> impl Iterator<Item = f32> + 'a {
    let reach = move |w: &[f64]| w.iter().zip(c).map(|(w, c)| w * c).sum::<f64>();
    w.chunks(c.len()).map(move |w| reach(w).max(0.0).powi(2) as f32)
}
