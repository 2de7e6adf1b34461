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

    /// The clusters that take in the sensors of one, with these, if together that costs less: first each sensor for itself, then in groups.
    fn unions(
        &self,
        clusters: &[Option<Cluster>],
        residuals: &[Vec<f64>],
        at: usize,
    ) -> Option<Vec<(usize, Cluster)>> {
        let own = clusters[at].as_ref()?;
        let others: Vec<usize> =
            (0..clusters.len()).filter(|&other| other != at && clusters[other].is_some()).collect();
        let best = |sensor: usize| {
            let (place, least) = smallest(others.iter().map(|&other| residuals[other][sensor]))?;
            Some((others[place], least))
        };
        let alone: Vec<(usize, f64)> =
            own.sensors.iter().map(|&sensor| best(sensor)).collect::<Option<_>>()?;
        let explained = alone.iter().filter(|(_, least)| *least <= EXPLAINED * self.felt.tolerance).count();
        let mut takes: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        own.sensors
            .iter()
            .zip(&alone)
            .for_each(|(&sensor, (to, _))| takes.entry(*to).or_default().push(sensor));
        // What one motion does not explain is no part anyway.
        let separately = (2 * explained > own.sensors.len() || !self.explains(own))
            .then(|| self.shorter(clusters, own, &takes))
            .flatten();
        // Others may explain sensors only once they have them all: these may be all that tells them of a direction.
        separately
            .or_else(|| self.shorter(clusters, own, &self.takes_in_groups(clusters, own, &others, &takes)))
    }

    /// Which cluster takes which sensors, where each group goes to the one that it adds least to, and the others as before.
    fn takes_in_groups(
        &self,
        clusters: &[Option<Cluster>],
        own: &Cluster,
        others: &[usize],
        before: &BTreeMap<usize, Vec<usize>>,
    ) -> BTreeMap<usize, Vec<usize>> {
        let sensors = |at: usize| &clusters[at].as_ref().expect("it is one of the others").sensors;
        let mut takes: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        let groups = self.groups(own);
        for group in &groups {
            let cost = |at: usize| {
                let both = self.with_core(sensors(at), group);
                (both.description_length - self.core(sensors(at)), at)
            };
            let near = self.nearest(group, others.to_vec(), sensors);
            let costs: Vec<(f64, usize)> = near.into_par_iter().map(cost).collect();
            let least =
                costs.into_iter().reduce(|least, other| if other.0 < least.0 { other } else { least });
            takes.entry(least.expect("there are others").1).or_default().extend(group);
        }
        for (&to, sensors) in before {
            let single = sensors.iter().filter(|sensor| !groups.iter().any(|own| own.contains(sensor)));
            takes.entry(to).or_default().extend(single);
        }
        takes
    }

    /// The clusters with what they take from one, if together that costs less, and one motion explains each.
    fn shorter(
        &self,
        clusters: &[Option<Cluster>],
        own: &Cluster,
        takes: &BTreeMap<usize, Vec<usize>>,
    ) -> Option<Vec<(usize, Cluster)>> {
        let unions: Vec<(usize, f64, Cluster)> = takes
            .par_iter()
            .filter(|(_, sensors)| !sensors.is_empty())
            .map(|(&to, sensors)| {
                let before = clusters[to].as_ref().map_or(&[][..], |other| &other.sensors);
                let union = self.learned([before, sensors].concat());
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
