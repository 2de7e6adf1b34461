//! Give a cluster of sensors its motion subspace and its description length (Ma et al. 2007).
//!
//! The description length is what it takes to encode what the sensors feel up to a tolerance. Each component of the motion takes
//! ½ ln(1 + its variance over the tolerance). Each informative root beyond these takes the same of the residual variance: both
//! are the likelihood of probabilistic principal components (Tipping and Bishop 1999). Each loading takes ½ ln n over n, for n
//! samples (Schwarz 1978). Clusters of one part share components, so that their union is shorter than both.

use super::factorisation::Fit;
use super::roots::Roots;
use super::stratified::stratified;
use crate::numerics::eigen::largest;

/// Sensors of a cluster that its motion is learned from, spread over all.
pub(super) const MAX_SENSORS: usize = 64;
/// Tolerance, as a share of a sensor's mean square: more residual variance is encoded as noise is, and less costs little.
pub(super) const TOLERANCE: f64 = 0.01;
/// How many higher ranks in a row must be longer so that none higher is tried: one may have had a bad start.
const PATIENCE: usize = 2;

/// A cluster of sensors.
pub(super) struct Cluster {
    /// In ascending order.
    pub sensors: Vec<usize>,
    /// Those that the motion is learned from.
    pub representatives: Vec<usize>,
    /// Their motion.
    pub fit: Fit,
    /// Description length per sample, in nats; see the head of this file.
    pub description_length: f64,
}

impl Cluster {
    /// Learns the motion of sensors in so many iterations, with the rank, of `least` and more, of the shortest description.
    pub(super) fn new(roots: &Roots, sensors: Vec<usize>, least: usize, iterations: usize) -> Self {
        let representatives: Vec<usize> =
            stratified(sensors.len(), MAX_SENSORS).map(|at| sensors[at]).collect();
        let own = roots.select(&representatives);
        let start = own.start();
        let most = start.max_rank();
        let with_rank = |k: usize| {
            let fit = own.fit(&start, k, iterations);
            (description_length(&fit, sensors.len()), fit)
        };
        // The length falls with the rank, and then rises.
        let mut best = with_rank(least.min(most));
        let mut longer = 0;
        for k in best.1.rank() + 1..=most {
            let next = with_rank(k);
            if next.0 < best.0 {
                (best, longer) = (next, 0);
            } else {
                longer += 1;
            }
            if longer == PATIENCE {
                break;
            }
        }
        let (description_length, fit) = best;
        Self { sensors, representatives, fit, description_length }
    }

    /// The union of two clusters.
    pub(super) fn union(roots: &Roots, a: &Self, b: &Self, iterations: usize) -> Self {
        let mut sensors = [a.sensors.as_slice(), &b.sensors].concat();
        sensors.sort_unstable();
        // Iterations from the motions of both would end near these. That is no better than from the start, and merges seed
        // clusters of different parts.
        Self::new(roots, sensors, a.fit.rank().max(b.fit.rank()), iterations)
    }

    /// Whether the residual variance is more than `most`, so that one motion does not explain what the sensors feel.
    pub(super) fn is_mixed(&self, most: f64) -> bool {
        self.fit.residual > most * self.fit.freedom
    }
}

/// Description length per sample, in nats, of a cluster of so many sensors; see the head of this file.
fn description_length(fit: &Fit, sensors: usize) -> f64 {
    let samples = fit.samples() as f64;
    let k = fit.rank() as f64;
    // The fit may be of a share of the sensors only.
    let ratio = sensors as f64 / fit.sensors() as f64;
    // Half of the sensors feel a motion, the others its opposite; with signs, all feel it, which adds a constant.
    let scale = ratio / (2.0 * samples * TOLERANCE);
    let variances =
        largest(fit.scatter().as_ref(), fit.rank()).map_or_else(|_| Vec::new(), |eigen| eigen.values);
    let motion: f64 = variances.iter().map(|variance| (scale * variance).max(0.0).ln_1p()).sum();
    let residual = if fit.freedom > 0.0 { (fit.residual / fit.freedom / TOLERANCE).ln_1p() } else { 0.0 };
    0.5 * (motion + ratio * fit.freedom * residual + sensors as f64 * k * samples.ln() / samples)
}
