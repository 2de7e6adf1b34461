//! Disperse a cluster among others: one whose sensors others explain, each for itself, is no part.
//!
//! Sensors whose normals lie along a hinge, or meet it, feel the same on both of its parts. Those of both parts are alike, and make a
//! cluster of their own. It is merged with neither part, since some of its sensors do not fit that one.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::cluster::Cluster;
use super::search::{EXPLAINED, MIN_SAVING, Search, smallest};

impl Search {
    /// The clusters, without those whose sensors cost less on others: each sensor then goes where its residual is the smallest. Small
    /// clusters are tried first.
    pub(super) fn dispersed(&mut self, clusters: Vec<Cluster>) -> Vec<Cluster> {
        let mut residuals: Vec<Vec<f64>> = clusters.par_iter().map(|own| own.residuals(&self.felt)).collect();
        let mut order: Vec<usize> = (0..clusters.len()).collect();
        order.sort_by_key(|&at| clusters[at].sensors.len());
        let mut clusters: Vec<Option<Cluster>> = clusters.into_iter().map(Some).collect();
        for at in order {
            let Some(unions) = self.unions(&clusters, &residuals, at) else { continue };
            clusters[at] = None;
            for (to, union) in unions {
                union.complete(&mut self.felt);
                residuals[to] = union.residuals(&self.felt);
                clusters[to] = Some(union);
            }
        }
        clusters.into_iter().flatten().collect()
    }

    /// The clusters that take in the sensors of one, with these, if together that costs less.
    fn unions(
        &self,
        clusters: &[Option<Cluster>],
        residuals: &[Vec<f64>],
        at: usize,
    ) -> Option<Vec<(usize, Cluster)>> {
        let own = clusters[at].as_ref()?;
        let mut takes: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        let mut explained = 0;
        for &sensor in &own.sensors {
            let by_others = residuals.iter().enumerate().map(|(other, of)| {
                if other == at || clusters[other].is_none() { f64::INFINITY } else { of[sensor] }
            });
            let (to, least) = smallest(by_others)?;
            explained += usize::from(least <= EXPLAINED * self.felt.tolerance);
            takes.entry(to).or_default().push(sensor);
        }
        // Others may explain the rest only once they have it: it may be all that tells them of a direction. What one motion does not explain
        // is no part anyway.
        if self.explains(own) && 2 * explained <= own.sensors.len() {
            return None;
        }
        let unions: Vec<(usize, f64, Cluster)> = takes
            .into_par_iter()
            .map(|(to, sensors)| {
                let before = clusters[to].as_ref().map_or(&[][..], |other| &other.sensors);
                let union = self.learned([before, &sensors].concat());
                (to, union.description_length - self.learned(before.to_vec()).description_length, union)
            })
            .collect();
        let cost: f64 = unions.iter().map(|(_, cost, _)| cost).sum();
        let saving = self.learned(own.sensors.clone()).description_length - cost;
        let is_shorter = saving > MIN_SAVING && unions.iter().all(|(_, _, union)| self.explains(union));
        is_shorter.then(|| unions.into_iter().map(|(to, _, union)| (to, union)).collect())
    }
}

#[cfg(test)]
mod tests;
