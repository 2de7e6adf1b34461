//! Disperse a cluster among others: one whose sensors all cost less there is no part.
//!
//! Sensors whose normals lie along a hinge, or meet it, feel the same on both of its parts. Those of both parts are alike, and make a
//! cluster of their own. It is merged with neither part, since some of its sensors do not fit that one.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use rayon::prelude::*;

use super::cluster::Cluster;
use super::moves::tried_of;
use super::search::{Search, smallest};

/// A cluster that is not dispersed, and what tells whether it should be.
struct Kept {
    cluster: Cluster,
    /// Description length of its core, and of it all with a motion learned in more iterations, once they are asked for.
    core: OnceLock<f64>,
    length: OnceLock<f64>,
    /// Residual variance of each sensor of the body by its motion.
    residuals: Vec<f64>,
}

impl Search {
    /// The clusters, without those whose sensors cost less on others. Small clusters are tried first.
    pub(super) fn dispersed(&mut self, clusters: Vec<Cluster>) -> Vec<Cluster> {
        let mut order: Vec<usize> = (0..clusters.len()).collect();
        order.sort_by_key(|&at| clusters[at].sensors.len());
        let kept = |own: Cluster| Some(self.kept(own));
        let mut clusters: Vec<Option<Kept>> = clusters.into_par_iter().map(kept).collect();
        for at in order {
            let Some(own) = clusters[at].take() else { continue };
            let others: Vec<(usize, &Kept)> =
                clusters.iter().enumerate().filter_map(|(at, other)| Some((at, other.as_ref()?))).collect();
            let near = (0..others.len()).collect();
            let near = self.nearest(&own.cluster.sensors, near, |at| &others[at].1.cluster.sensors);
            let around = near.iter().map(|&at| &others[at].1.cluster);
            let trial: Vec<Vec<usize>> =
                [&own.cluster].into_iter().chain(around).map(|own| own.sensors.clone()).collect();
            let unions = if self.failed.contains(&trial) { None } else { self.unions(&own, &others) };
            let Some(unions) = unions else {
                self.failed.insert(trial);
                clusters[at] = Some(own);
                continue;
            };
            for (to, union) in unions {
                union.complete_roots(&mut self.felt);
                clusters[to] = Some(self.kept(union));
            }
        }
        clusters.into_iter().flatten().map(|own| own.cluster).collect()
    }

    fn kept(&self, cluster: Cluster) -> Kept {
        let residuals = cluster.residuals(&self.felt);
        Kept { cluster, core: OnceLock::new(), length: OnceLock::new(), residuals }
    }

    /// Description length of a cluster.
    fn length(&self, own: &Kept) -> f64 {
        *own.length.get_or_init(|| self.learned(own.cluster.sensors.clone()).description_length)
    }

    /// The clusters that take in the sensors of one, with these, if together that costs less.
    ///
    /// First each sensor goes where its residual is the smallest. This is tried if others explain most of them, or one motion does not
    /// explain the cluster itself, which then is no part anyway. Then groups of sensors go where they cost the least: they may be all that
    /// tells a part of a direction, so that it explains none of them before it has them. Such faces feel few directions, and one motion
    /// explains them within the tolerance. What it explains less well may be a part that hardly moves against its neighbours, so that
    /// each could take a group of it: groups of such a cluster stay.
    fn unions(&self, own: &Kept, others: &[(usize, &Kept)]) -> Option<Vec<(usize, Cluster)>> {
        let sensors = &own.cluster.sensors;
        let best = |&sensor: &usize| smallest(others.iter().map(|(_, other)| other.residuals[sensor]));
        let by_residual: Vec<(usize, f64)> = sensors.iter().map(best).collect::<Option<_>>()?;
        let is_explained = |least: f64| least <= self.felt.explained();
        let explained = by_residual.iter().filter(|(_, least)| is_explained(*least)).count();
        let mut places: Vec<usize> = by_residual.into_iter().map(|(place, _)| place).collect();
        // What one motion leaves of the cluster, if it explains it.
        let left = OnceLock::new();
        let left = || left.get_or_init(|| self.explained(sensors.clone()).map(|own| own.variance()));
        let is_tried = 2 * explained > sensors.len() || left().is_none();
        if is_tried && let Some(unions) = self.shorter(own, others, &places) {
            return Some(unions);
        }
        if left().is_some_and(|left| left > self.felt.tolerance) {
            return None;
        }
        let mut is_new = false;
        for group in self.groups(&own.cluster) {
            let sensors_of = |at: usize| &others[at].1.cluster.sensors;
            let core = |at: usize| *others[at].1.core.get_or_init(|| self.core(sensors_of(at)));
            let near = self.nearest(&group, (0..others.len()).collect(), sensors_of);
            let least = self.least_cost(&tried_of(&group), near, sensors_of, core);
            // Where none explains it, its sensors stay where their residuals are the smallest.
            let Some((_, place)) = least else { continue };
            for sensor in group {
                let at = sensors.binary_search(&sensor).expect("its cluster has it");
                is_new |= !is_tried || places[at] != place;
                places[at] = place;
            }
        }
        // Where one cluster takes all, they are merged, if at all.
        let is_shared = places.iter().any(|&place| place != places[0]);
        if is_new && is_shared { self.shorter(own, others, &places) } else { None }
    }

    /// The clusters at these places with the sensors that they take, if together that costs less, and one motion explains each.
    fn shorter(
        &self,
        own: &Kept,
        others: &[(usize, &Kept)],
        places: &[usize],
    ) -> Option<Vec<(usize, Cluster)>> {
        let mut takes: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (&sensor, &place) in own.cluster.sensors.iter().zip(places) {
            takes.entry(place).or_default().push(sensor);
        }
        let union = |(place, sensors): (usize, Vec<usize>)| {
            let before: &Kept = others[place].1;
            Some((place, self.explained([&before.cluster.sensors[..], &sensors].concat())?))
        };
        let unions: Vec<Option<(usize, Cluster)>> = takes.into_par_iter().map(union).collect();
        let unions: Vec<(usize, Cluster)> = unions.into_iter().collect::<Option<_>>()?;
        let cost =
            |(place, union): &(usize, Cluster)| union.description_length - self.length(others[*place].1);
        let saving = self.length(own) - unions.iter().map(cost).sum::<f64>();
        let is_shorter = saving > self.felt.parameters.min_saving;
        is_shorter.then(|| unions.into_iter().map(|(place, union)| (others[place].0, union)).collect())
    }
}

#[cfg(test)]
mod tests;
