//! Let sensors in no cluster change clusters.

use rayon::prelude::*;

use super::cluster::Cluster;
use super::search::Search;
use super::separation::best_part;

impl Search {
    /// The clusters with those sensors that are in none, and that one explains much better than any other does. They may tell what
    /// its motion lacks.
    pub(super) fn with_rest(&mut self, clusters: Vec<Cluster>) -> Vec<Cluster> {
        if clusters.len() < 2 {
            return clusters;
        }
        let residuals: Vec<Vec<f64>> = clusters.par_iter().map(|own| own.residuals(&self.felt)).collect();
        let mut members: Vec<Vec<usize>> = clusters.iter().map(|own| own.sensors.clone()).collect();
        for sensor in self.in_none(&clusters) {
            if let Some(best) = best_part(&residuals, sensor, 0.0, self.felt.parameters.max_residual_share) {
                members[best].push(sensor);
            }
        }
        let felt = &self.felt;
        let both = clusters.into_par_iter().zip(members);
        let larger = |(own, members): (Cluster, Vec<usize>)| {
            if own.sensors.len() < members.len() { Cluster::new(felt, members) } else { own }
        };
        let clusters: Vec<Cluster> = both.map(larger).collect();
        // Those that none joined have learned their motions anew, too.
        clusters.iter().for_each(|own| own.complete_roots(&mut self.felt));
        clusters
    }
}

#[cfg(test)]
mod tests;
