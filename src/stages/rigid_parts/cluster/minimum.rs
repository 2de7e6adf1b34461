//! Lead the motion of a cluster out of a local minimum of the residual.
//!
//! Alternating least squares ends in a local minimum where it started badly: one rigid motion then seems to leave something of what a part
//! feels. Factors of a larger rank than is needed have fewer such minima (Burer and Monteiro 2005). So the motion is learned once more: from
//! what is felt alone, with one component more, and then without the least one.

use faer::Mat;

use super::{Cluster, Felt, ITERATIONS, key, principal_motion, variance};
use crate::stages::rigid_parts::roots::Roots;

impl Cluster {
    /// Takes the motion that is learned by a component more, or was learned so before, if it leaves less. With too few sensors for that, it
    /// stays.
    pub(super) fn leave_minimum(&mut self, felt: &Felt) {
        let rank = self.rank();
        if self.representatives.len() <= rank + 1 {
            return;
        }
        let own = felt.roots.select_as_they_are(&self.representatives);
        let (as_felt, iterations, weight) = (self.as_felt(&own), felt.iterations[1], felt.weights()[1]);
        let numbers = [felt.tolerance, weight, rank as f64, iterations as f64, self.sensors.len() as f64];
        let key = key(&[&numbers, own.thresholds.as_slice()].concat(), &[&own.values, &as_felt]);
        let known = felt.memory.get(key);
        if known.as_ref().is_some_and(|known| variance(known.residual, known.freedom) >= self.variance()) {
            return;
        }
        let mut other = Self { completed: as_felt, ..self.clone() };
        if let Some(known) = known {
            other.adopt(&known, &own);
        } else {
            // Only what this completes is used of the first motion.
            (other.loadings, other.motion) = principal_motion(&other.completed, rank + 1);
            other.iterate(felt, &own, ITERATIONS[1], weight);
            (other.loadings, other.motion) = principal_motion(&other.completed, rank);
            other.alternate(felt, &own, iterations, weight, key);
        }
        if other.variance() < self.variance() {
            *self = other;
        }
    }

    /// The roots of the representatives where they are felt, and 0 elsewhere, samples × sensors. What is missing is completed as before.
    fn as_felt(&self, own: &Roots) -> Mat<f64> {
        Mat::from_fn(own.samples(), own.sensors(), |t, sensor| match own.values[(t, sensor)] {
            root if root.is_nan() => self.completed[(t, sensor)],
            root if root < own.thresholds[t] => 0.0,
            root => root,
        })
    }
}

#[cfg(test)]
mod tests;
