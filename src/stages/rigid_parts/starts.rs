//! Cluster sensors from several starts, seed clusters of neighbouring sensors, and choose the shortest description.
//!
//! Seed clusters are like the superpixels of image segmentation: average linkage makes them so small that nearly all of them are
//! on one part each. The result of the search depends on them.

use kodama::Method;
use rayon::prelude::*;

use super::observations::Observations;
use super::search::{ITERATIONS, Search, labels_of, members};
use crate::numerics::linkage;

/// Sensors of a seed cluster on average: for each start.
pub(super) const SEED_SIZES: [usize; 3] = [6, 9, 12];
/// Fewest sensors that several parts can be estimated from: two seed clusters.
pub const MIN_SENSORS: usize = 2 * SEED_SIZES[0];
/// Most seed clusters.
const MAX_SEEDS: usize = 100;
/// Nearest clusters that a cluster may merge with: of the many seed clusters, and of the few parts.
const NEIGHBOURS: [usize; 2] = [4, 3];

impl Observations<'_> {
    /// The clusters of some sensors, from starts with seed clusters of these sizes, as a label of each sensor.
    ///
    /// `samples` are those for seed clusters, and those for parts.
    pub(super) fn clustered(
        &self,
        sensors: &[usize],
        samples: &[Vec<usize>; 2],
        seed_sizes: &[usize],
    ) -> Vec<usize> {
        let n = sensors.len();
        let distances = &self.distances_between(sensors);
        let [coarse, fine] = [0, 1].map(|at| {
            let roots = self.roots(sensors, &samples[at]);
            Search { roots, distances, iterations: ITERATIONS[at] }
        });
        let found = |size: &usize| {
            let count = (n / size).clamp(1, MAX_SEEDS);
            let labels = linkage::clusters(n, |i, j| distances.get(i, j), Method::Average, count);
            let seeds = coarse.clusters(members(&labels), Vec::new());
            let clusters = coarse.assigned(coarse.merged(seeds, NEIGHBOURS[0], 0.0, 0), false);
            let labels = labels_of(&coarse.alternated(clusters, usize::MAX));
            let clusters = fine.alternated(fine.clusters(members(&labels), Vec::new()), NEIGHBOURS[1]);
            (clusters.iter().map(|cluster| cluster.description_length).sum::<f64>(), labels_of(&clusters))
        };
        let starts: Vec<(f64, Vec<usize>)> = seed_sizes.par_iter().map(found).collect();
        // The first of the shortest. The length decides, not the number of parts: one motion for two parts leaves much residual.
        let best = starts.into_iter().reduce(|best, other| if other.0 < best.0 { other } else { best });
        best.expect("there are starts").1
    }
}
