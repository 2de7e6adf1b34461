//! Search for clusters: K-subspaces (Bradley and Mangasarian 2000), with agglomerative merging by description length (Ma et al.
//! 2007).
//!
//! Two steps alternate. The pair of clusters that saves most description length is merged, again and again. Then each sensor is
//! assigned to the cluster whose motion leaves it the smallest residual.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::cluster::Cluster;
use super::roots::Roots;
use super::subspace::ROTATION_RANK;
use crate::numerics::partition::named_by_appearance;
use crate::stages::distance::Distances;

/// Iterations in which the motion of a cluster is learned: of the many seed clusters, and of the few parts.
pub(super) const ITERATIONS: [usize; 2] = [4, 16];
/// Nats per sample that a merge of parts must save: it must show that they share a component.
pub(super) const MIN_SAVING: f64 = 1.0;
/// Degrees of freedom of its residual that a part must have per sample. With fewer, any sensors fit.
pub(super) const MIN_FREEDOM: f64 = 1.0;
/// Most iterations in which sensors are assigned.
const MAX_ASSIGNMENTS: usize = 10;
/// Most iterations of merging and assigning.
const MAX_ALTERNATIONS: usize = 4;

/// Sensors whose clusters are searched for.
pub(super) struct Search<'a> {
    /// Their roots.
    pub roots: Roots,
    /// Distances between them.
    pub distances: &'a Distances,
    /// Iterations in which the motion of a cluster is learned.
    pub iterations: usize,
}

impl Search<'_> {
    /// The cluster of these sensors.
    pub(super) fn cluster(&self, sensors: Vec<usize>) -> Cluster {
        Cluster::new(&self.roots, sensors, 1, self.iterations)
    }

    /// Clusters of these members; those that are known are not learned again.
    pub(super) fn clusters(&self, members: Vec<Vec<usize>>, known: Vec<Cluster>) -> Vec<Cluster> {
        let mut known: BTreeMap<Vec<usize>, Cluster> =
            known.into_iter().map(|cluster| (cluster.sensors.clone(), cluster)).collect();
        let found: Vec<_> = members.into_iter().map(|own| (known.remove(&own), own)).collect();
        found.into_par_iter().map(|(known, own)| known.unwrap_or_else(|| self.cluster(own))).collect()
    }

    /// Alternates merging, of each cluster with its `near` nearest, and assigning, until nothing changes.
    pub(super) fn alternated(&self, mut clusters: Vec<Cluster>, near: usize) -> Vec<Cluster> {
        for _ in 0..MAX_ALTERNATIONS {
            let before = labels_of(&clusters);
            clusters = self.assigned(self.merged(clusters, near, MIN_SAVING, 0), true);
            if labels_of(&clusters) == before {
                break;
            }
        }
        clusters
    }

    /// Merges the pair of clusters that saves most, again and again, as long as it saves more than `margin` nats. Pairs are each
    /// cluster and its `near` nearest; the first `fixed` clusters are not merged with each other.
    pub(super) fn merged(
        &self,
        clusters: Vec<Cluster>,
        near: usize,
        margin: f64,
        fixed: usize,
    ) -> Vec<Cluster> {
        let mut name = clusters.len();
        let mut clusters: BTreeMap<usize, Cluster> = clusters.into_iter().enumerate().collect();
        let mut unions: BTreeMap<(usize, usize), Cluster> = BTreeMap::new();
        while clusters.len() > 1 {
            let new: Vec<(usize, usize)> = self
                .pairs(&clusters, near)
                .into_iter()
                .filter(|pair| pair.1 >= fixed && !unions.contains_key(pair))
                .collect();
            let made = new.into_par_iter().map(|(a, b)| {
                ((a, b), Cluster::union(&self.roots, &clusters[&a], &clusters[&b], self.iterations))
            });
            unions.extend(made.collect::<Vec<_>>());
            let saving = |(&(a, b), union): (&(usize, usize), &Cluster)| {
                clusters[&a].description_length + clusters[&b].description_length - union.description_length
            };
            let Some((most, pair)) = unions
                .iter()
                .map(|entry| (saving(entry), *entry.0))
                .reduce(|best, other| if other.0 > best.0 { other } else { best })
            else {
                break;
            };
            if most <= margin {
                break;
            }
            let union = unions.remove(&pair).expect("it is the best of these");
            unions.retain(|(a, b), _| ![pair.0, pair.1].iter().any(|gone| a == gone || b == gone));
            clusters.retain(|name, _| *name != pair.0 && *name != pair.1);
            if pair.0 < fixed {
                clusters.insert(pair.0, union);
            } else {
                clusters.insert(name, union);
                name += 1;
            }
        }
        clusters.into_values().collect()
    }

    /// Each cluster with its nearest ones, by average distance.
    fn pairs(&self, clusters: &BTreeMap<usize, Cluster>, near: usize) -> Vec<(usize, usize)> {
        let distance = |a: &Cluster, b: &Cluster| {
            let sum: f64 = a
                .sensors
                .iter()
                .flat_map(|&i| b.sensors.iter().map(move |&j| self.distances.get(i, j)))
                .sum();
            sum / (a.sensors.len() * b.sensors.len()) as f64
        };
        let nearest = |(&name, cluster): (&usize, &Cluster)| {
            let mut others: Vec<(f64, usize)> = clusters
                .iter()
                .filter(|(other, _)| **other != name)
                .map(|(other, own)| {
                    (if near < clusters.len() { distance(cluster, own) } else { 0.0 }, *other)
                })
                .collect();
            others.sort_by(|a, b| a.0.total_cmp(&b.0));
            others
                .into_iter()
                .take(near)
                .map(|(_, other)| (name.min(other), name.max(other)))
                .collect::<Vec<_>>()
        };
        let mut pairs: Vec<(usize, usize)> =
            clusters.iter().collect::<Vec<_>>().into_par_iter().flat_map_iter(nearest).collect();
        pairs.sort_unstable();
        pairs.dedup();
        pairs
    }

    /// Assigns each sensor to the cluster with the smallest residual, and learns the motions again, until no sensor changes.
    ///
    /// With `only_parts`, clusters that cannot be parts are dropped: those that are too small or of too low a rank.
    pub(super) fn assigned(&self, mut clusters: Vec<Cluster>, only_parts: bool) -> Vec<Cluster> {
        for _ in 0..MAX_ASSIGNMENTS {
            let mut sizes: Vec<usize> =
                clusters.iter().map(|cluster| cluster.representatives.len()).collect();
            sizes.sort_unstable();
            let small = sizes[sizes.len() / 2].div_ceil(2);
            let can_be_part = |cluster: &&Cluster| {
                let is_skin = cluster.fit.rank() >= ROTATION_RANK || cluster.representatives.len() >= small;
                cluster.fit.freedom >= MIN_FREEDOM && is_skin
            };
            let parts: Vec<&Cluster> = clusters.iter().filter(can_be_part).collect();
            let kept = if only_parts && !parts.is_empty() { parts } else { clusters.iter().collect() };
            let residuals: Vec<Vec<f64>> =
                kept.par_iter().map(|cluster| self.roots.residuals(&cluster.fit)).collect();
            let best = |sensor: usize| {
                smallest(residuals.iter().map(|residuals| residuals[sensor])).map_or(0, |(at, _)| at)
            };
            let labels: Vec<usize> = (0..self.roots.sensors()).map(best).collect();
            let labels = named_by_appearance(&labels);
            if labels == labels_of(&clusters) {
                break;
            }
            clusters = self.clusters(members(&labels), clusters);
        }
        clusters
    }
}

/// The sensors of each cluster.
pub(super) fn members(labels: &[usize]) -> Vec<Vec<usize>> {
    let mut members = vec![Vec::new(); labels.iter().max().map_or(0, |last| last + 1)];
    labels.iter().enumerate().for_each(|(sensor, &label)| members[label].push(sensor));
    members
}

/// The cluster of each sensor, by appearance.
pub(super) fn labels_of(clusters: &[Cluster]) -> Vec<usize> {
    let mut labels = vec![0; clusters.iter().map(|cluster| cluster.sensors.len()).sum()];
    for (at, cluster) in clusters.iter().enumerate() {
        cluster.sensors.iter().for_each(|&sensor| labels[sensor] = at);
    }
    named_by_appearance(&labels)
}

/// The first of the smallest numbers, and its place.
pub(super) fn smallest(values: impl Iterator<Item = f64>) -> Option<(usize, f64)> {
    values.enumerate().reduce(|best, other| if other.1 < best.1 { other } else { best })
}
