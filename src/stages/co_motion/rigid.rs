//! Mend estimated parts by what a rigid body is: one motion explains all that its sensors feel.
//!
//! In: pressures and an estimated part of each sensor. Out: parts without those that are pieces of others, and each sensor
//! on the part whose motion explains it best. A part that is two parts in truth is not taken apart.

use std::cmp::Ordering;

use rayon::prelude::*;

use super::motion::Felt;
use crate::numerics::partition::{named_by_appearance, sizes};
use crate::stages::sense::Tactile;

/// Most turns, in each of which sensors move, or two parts become one.
const ROUNDS: usize = 20;
/// What a motion of both may leave of the sensors' squares beyond what two motions leave, on the mean over sensors, so that
/// both are one part.
const SAME: f64 = 0.03;
/// What another part's motion may leave beyond what its own leaves, so that both are looked at together.
const PERHAPS: f64 = 0.3;
/// The difference of shares up to which two motions explain a sensor alike.
const NEARLY: f64 = 0.01;

/// Parts that are rigid: an estimated part for each sensor, named 0, 1, … in order of appearance.
///
/// In: M × T pressures, of any sign, and the estimated part of each sensor, any numbers.
pub fn rigid_parts(tactile: &Tactile, labels: &[usize]) -> Vec<usize> {
    let felt = Felt::new(tactile);
    let mut labels = named_by_appearance(labels);
    for _ in 0..ROUNDS {
        let left = Left::new(&felt, &labels);
        let moved = named_by_appearance(&left.best_parts(&labels));
        if moved != labels {
            labels = moved;
        } else if let Some((kept, other)) = left.same_parts(&felt, &labels) {
            labels.iter_mut().filter(|label| **label == other).for_each(|label| *label = kept);
            labels = named_by_appearance(&labels);
        } else {
            break;
        }
    }
    labels
}

/// What the motion of each part leaves unexplained.
struct Left {
    /// The share of each sensor's squares: sensors × parts.
    shares: Vec<Vec<f64>>,
    /// Components of each part's motion.
    components: Vec<usize>,
}

impl Left {
    fn new(felt: &Felt, labels: &[usize]) -> Self {
        let parts = sizes(labels).len();
        let (motions, components): (Vec<_>, Vec<usize>) =
            (0..parts).map(|part| felt.motions(&sensors_of(labels, part), None)).unzip();
        let left = |sensor: usize| motions.iter().map(|motions| felt.left(sensor, motions)).collect();
        Self { shares: (0..labels.len()).into_par_iter().map(left).collect(), components }
    }

    /// For each sensor the part whose motion has fewest components of those that explain it nearly as well as any: a motion
    /// of more may owe them to sensors of other parts. Of equal ones, that which leaves least, and the sensor's own.
    fn best_parts(&self, labels: &[usize]) -> Vec<usize> {
        let best = |(left, &own): (&Vec<f64>, &usize)| {
            let least = left.iter().copied().fold(f64::INFINITY, f64::min);
            let order = |part: usize| (self.components[part], left[part], part != own);
            let near = (0..left.len()).filter(|part| left[*part] <= least + NEARLY);
            near.min_by(|a, b| order(*a).partial_cmp(&order(*b)).unwrap_or(Ordering::Equal)).unwrap_or(own)
        };
        self.shares.iter().zip(labels).map(best).collect()
    }

    /// Two parts that one motion of no more components explains nearly as well as their own do. Those come first whose
    /// motions explain each other's sensors best.
    fn same_parts(&self, felt: &Felt, labels: &[usize]) -> Option<(usize, usize)> {
        let parts = self.components.len();
        let mean =
            |of: &[usize], by: usize| mean_of(of.iter().map(|sensor| self.shares[*sensor][by]).collect());
        let own: Vec<Vec<usize>> = (0..parts).map(|part| sensors_of(labels, part)).collect();
        let apart = |a: usize, b: usize| {
            (mean(&own[a], b) - mean(&own[a], a)).max(mean(&own[b], a) - mean(&own[b], b))
        };
        let pairs = (0..parts).flat_map(|a| (a + 1..parts).map(move |b| (a, b)));
        let mut near: Vec<(f64, usize, usize)> = pairs.map(|(a, b)| (apart(a, b), a, b)).collect();
        near.retain(|(apart, ..)| *apart <= PERHAPS);
        near.sort_by(|one, other| one.0.total_cmp(&other.0));
        let is_one = |a: usize, b: usize| {
            let both = [own[a].as_slice(), &own[b]].concat();
            let components = self.components[a].max(self.components[b]);
            let (motions, _) = felt.motions(&both, Some(components));
            let together = mean_of(both.par_iter().map(|sensor| felt.left(*sensor, &motions)).collect());
            let alone = mean_of(both.iter().map(|sensor| self.shares[*sensor][labels[*sensor]]).collect());
            together - alone <= SAME
        };
        near.into_iter().map(|(_, a, b)| (a, b)).find(|(a, b)| is_one(*a, *b))
    }
}

/// The sensors of a part.
fn sensors_of(labels: &[usize], part: usize) -> Vec<usize> {
    (0..labels.len()).filter(|sensor| labels[*sensor] == part).collect()
}

fn mean_of(shares: Vec<f64>) -> f64 {
    shares.iter().sum::<f64>() / shares.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::rng::stream;
    use crate::stages::agent::{Agent, Skin};
    use crate::stages::sense::{Sense, sense};
    use crate::stages::simulate::fixtures::{INTERVAL, Scene};
    use crate::stages::simulate::simulate;

    #[test]
    fn pieces_become_parts_and_sensors_go_to_theirs() {
        let mut scene = Scene::new();
        (scene.motion.coordination, scene.physics.duration) = (0.5, 1000.0);
        let agent = Agent::new(&scene.geometry, &Skin { around: 8, along: 4, caps: 0 });
        let rng = &mut stream(3, 1, "motion", 0);
        let trajectory = simulate(&agent, &scene.motion, &scene.physics, INTERVAL, rng, &|| ()).unwrap();
        let tactile = sense(&agent, &trajectory, &Sense { interval: INTERVAL, fluid_density: 1010.0 });
        let truth = agent.labels();
        assert_eq!(rigid_parts(&tactile, &truth), truth);
        let mut mixed = truth.clone();
        // Half of the first part is a part of its own, and four sensors of the third are on the fourth.
        mixed[16..32].fill(9);
        mixed[64..68].fill(3);
        assert_eq!(rigid_parts(&tactile, &mixed), truth);
    }
}
