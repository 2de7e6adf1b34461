//! Lead the motion of a cluster out of a local minimum of the residual.
//!
//! Alternating least squares ends in a local minimum where it started badly: one rigid motion then seems to leave something of what a part
//! feels. Factors of a larger rank than is needed have fewer such minima (Burer and Monteiro 2005). So the motion is learned once more: from
//! what is felt alone, with one component more, and then without the least one.

use faer::Mat;

use super::{Cluster, Felt, ITERATIONS, principal_motion};

impl Cluster {
    /// Takes the motion that is learned by a component more, if it leaves less. With too few sensors for that, it stays.
    pub(super) fn leave_minimum(&mut self, felt: &Felt) {
        let rank = self.rank();
        if self.representatives.len() <= rank + 1 {
            return;
        }
        let mut other = self.clone();
        other.completed = self.as_felt(felt);
        for (rank, iterations) in [(rank + 1, ITERATIONS[1]), (rank, felt.iterations[1])] {
            (other.loadings, other.motion) = principal_motion(&other.completed, rank);
            other.learn(felt, iterations, felt.weights()[1]);
        }
        if other.variance() < self.variance() {
            *self = other;
        }
    }

    /// The roots of the representatives where they are felt, and 0 elsewhere, samples × sensors. What is missing is completed as before.
    fn as_felt(&self, felt: &Felt) -> Mat<f64> {
        let own = felt.roots.select_as_they_are(&self.representatives);
        Mat::from_fn(own.samples(), own.sensors(), |t, sensor| match own.values[(t, sensor)] {
            root if root.is_nan() => self.completed[(t, sensor)],
            root if root < own.thresholds[t] => 0.0,
            root => root,
        })
    }
}

#[cfg(test)]
mod tests;
