//! Split clusters that one motion does not explain: search each again, on its own informative samples.

use super::cluster::Cluster;
use super::observations::Observations;
use super::search::{ITERATIONS, MIN_SAVING, members};
use super::starts::{MIN_SENSORS, SEED_SIZES};
use crate::numerics::partition::named_by_appearance;

/// Residual variance, as a share, from which on a cluster may be several parts.
const MAX_RESIDUAL: f64 = 0.05;

impl Observations<'_> {
    /// Splits clusters, and those that they are split into, until one motion explains each.
    pub(super) fn split(&self, mut labels: Vec<usize>) -> Vec<usize> {
        let mut left = members(&labels);
        let mut next = left.len();
        while let Some(cluster) = left.pop() {
            let Some(parts) = self.split_once(&cluster) else { continue };
            let parts: Vec<Vec<usize>> = members(&parts)
                .into_iter()
                .map(|own| own.into_iter().map(|at| cluster[at]).collect())
                .collect();
            for own in parts {
                own.iter().for_each(|&sensor| labels[sensor] = next);
                next += 1;
                left.push(own);
            }
        }
        named_by_appearance(&labels)
    }

    /// The label of each sensor of a cluster, if it is several parts.
    fn split_once(&self, cluster: &[usize]) -> Option<Vec<usize>> {
        if cluster.len() < MIN_SENSORS {
            return None;
        }
        let samples = self.informative_samples(cluster);
        let roots = self.roots(cluster, &samples[1]);
        let of = |sensors: Vec<usize>| Cluster::new(&roots, sensors, 1, ITERATIONS[1]);
        let whole = of((0..cluster.len()).collect());
        if !whole.is_mixed(MAX_RESIDUAL) {
            return None;
        }
        // One start: more make the sensors on the end of a part a cluster of its own.
        let labels = self.clustered(cluster, &samples, &SEED_SIZES[..1]);
        let parts = members(&labels);
        let count = parts.len();
        let sum: f64 = parts.into_iter().map(|own| of(own).description_length).sum();
        (count > 1 && whole.description_length - sum > MIN_SAVING).then_some(labels)
    }
}
