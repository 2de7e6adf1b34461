//! Split clusters whose pieces have nothing in common.

use std::cmp::Reverse;

use rayon::prelude::*;

use super::cluster::Cluster;
use super::search::{PIECE, Search};

impl Search {
    /// Splits clusters into pieces that have nothing in common.
    pub(super) fn split(&mut self, clusters: Vec<Cluster>) -> Vec<Cluster> {
        let mut found = Vec::new();
        for cluster in clusters {
            match self.split_once(&cluster) {
                Some(pieces) => found.extend(pieces),
                None => found.push(cluster),
            }
        }
        found
    }

    /// The pieces of a cluster, if two of them have nothing in common: faces of two parts, say, of rank three each. But only a third face may
    /// link two of one part, and neither explains it. Then the pieces, and the sensors that are left alone, take longer to describe than the
    /// cluster, and it stays.
    fn split_once(&mut self, cluster: &Cluster) -> Option<Vec<Cluster>> {
        let most = (PIECE * cluster.sensors.len() as f64) as usize;
        let mut seeds = self.seeds(&cluster.sensors, most);
        seeds.sort_by_key(|own| Reverse(own.len()));
        seeds.truncate(2);
        let pieces: Vec<Cluster> = seeds.into_par_iter().map(|own| Cluster::new(&self.felt, own)).collect();
        let [first, second] = &pieces[..] else { return None };
        let both = Cluster::union(&self.felt, first, second);
        let saving = first.description_length + second.description_length - both.description_length;
        if saving > self.felt.parameters.min_saving {
            return None;
        }
        let length = self.learned(cluster.sensors.clone()).description_length;
        let before = self.felt.completed.clone();
        let pieces = self.assigned(pieces, &cluster.sensors);
        if self.length_of(&pieces, &cluster.sensors) - length > self.felt.parameters.min_saving {
            self.felt.completed = before;
            return None;
        }
        Some(pieces)
    }
}

#[cfg(test)]
mod tests;
