//! Move groups of sensors between clusters: a face that is in a cluster by mistake leaves it as a whole.
//!
//! The ends of a cylinder feel its motion along its axis, which its side does not. If they were merged with the side of another
//! cylinder, they brought that motion with them, and it explains each of them: no sensor leaves by its residual. Together they cost
//! less on their own part, which knows how they rotate.

use rayon::prelude::*;

use super::cluster::{Cluster, MAX_GROUP};
use super::search::{MIN_CLUSTER, MIN_GROUP, PIECE, SEED_SENSORS, Search};
use super::stratified::stratified;

/// Where a group costs less than in its cluster.
enum Place {
    Cluster(usize),
    Alone,
}

impl Search {
    /// The clusters, with each group of sensors where it costs the least: in its cluster, in another, or alone.
    pub(super) fn moved(&mut self, mut clusters: Vec<Cluster>) -> Vec<Cluster> {
        let groups: Vec<Vec<usize>> = clusters.iter().flat_map(|own| self.groups(own)).collect();
        let mut cores: Vec<f64> = clusters.par_iter().map(|own| self.core(&own.sensors)).collect();
        for group in groups {
            // Groups that went before may have taken their cluster apart.
            let holds = |own: &Cluster| group.iter().all(|sensor| own.sensors.binary_search(sensor).is_ok());
            let Some(home) = clusters.iter().position(holds) else { continue };
            for changed in self.move_group(&mut clusters, &cores, home, &group) {
                cores.resize(clusters.len(), 0.0);
                cores[changed] = self.core(&clusters[changed].sensors);
            }
        }
        clusters
    }

    /// Groups of sensors of high affinity in a cluster.
    pub(super) fn groups(&self, cluster: &Cluster) -> Vec<Vec<usize>> {
        let most = (PIECE * cluster.sensors.len() as f64) as usize;
        let mut groups = self.linked(&cluster.sensors, most);
        groups.retain(|own| own.len() >= MIN_GROUP);
        groups
    }

    /// Moves a group from its cluster to where it costs the least, if that is another place. Returns the clusters that have changed.
    fn move_group(
        &mut self,
        clusters: &mut Vec<Cluster>,
        cores: &[f64],
        home: usize,
        group: &[usize],
    ) -> Vec<usize> {
        let is_left = |sensor: &usize| !group.contains(sensor);
        let rest: Vec<usize> = clusters[home].sensors.iter().copied().filter(is_left).collect();
        if rest.len() < MIN_CLUSTER {
            return Vec::new();
        }
        // Any cluster explains a few sensors, so that these go to none.
        let count = if group.len() >= SEED_SENSORS[0] { clusters.len() } else { 0 };
        let others = (0..count).filter(|at| *at != home).collect();
        let near = self.nearest(group, others, |at| &clusters[at].sensors);
        let around = near.iter().map(|&at| &clusters[at].sensors);
        let trial: Vec<Vec<usize>> =
            [&group.to_vec(), &clusters[home].sensors].into_iter().chain(around).cloned().collect();
        if self.failed.contains(&trial) {
            return Vec::new();
        }
        let Some(place) = self.better_place(clusters, cores, near, &rest, group) else {
            self.failed.insert(trial);
            return Vec::new();
        };
        clusters[home] = self.completing(rest);
        match place {
            Place::Cluster(to) => {
                clusters[to] = self.completing([clusters[to].sensors.as_slice(), group].concat());
                vec![home, to]
            }
            Place::Alone if group.len() >= MIN_CLUSTER => {
                clusters.push(self.completing(group.to_vec()));
                vec![home, clusters.len() - 1]
            }
            Place::Alone => vec![home],
        }
    }

    /// Where a group costs less than with the rest of its cluster: in one of the clusters that are near, or alone. `cores` has the
    /// description length of the core of each cluster.
    fn better_place(
        &self,
        clusters: &[Cluster],
        cores: &[f64],
        near: Vec<usize>,
        rest: &[usize],
        group: &[usize],
    ) -> Option<Place> {
        let min_saving = self.felt.parameters.min_saving;
        let (tried, has_near) = (tried_of(group), !near.is_empty());
        let both = || self.learned([tried_of(rest), tried.clone()].concat()).description_length;
        let alone = || self.learned(tried.clone()).description_length;
        // Side by side, since each alone keeps one core busy.
        let ((least, alone), (both, rest)) = rayon::join(
            || {
                let sensors = |at: usize| &clusters[at].sensors;
                rayon::join(|| self.least_cost(&tried, near, sensors, |at| cores[at]), alone)
            },
            || rayon::join(both, || self.core(rest)),
        );
        let here = both - rest;
        if has_near && here <= min_saving {
            // No other can save as much, since none costs less than nothing.
            return None;
        }
        match least.filter(|(cost, _)| alone - cost > min_saving) {
            Some((cost, at)) => (here - cost > min_saving).then_some(Place::Cluster(at)),
            None => (alone - here < min_saving).then_some(Place::Alone),
        }
    }

    /// What the sensors of a group that are tried cost with the cluster that they cost least with, and that cluster: of some clusters,
    /// where one motion explains both. `core` gives the description length of the core of a cluster.
    pub(super) fn least_cost<'a>(
        &self,
        tried: &[usize],
        clusters: Vec<usize>,
        sensors: impl Fn(usize) -> &'a Vec<usize> + Sync,
        core: impl Fn(usize) -> f64 + Sync,
    ) -> Option<(f64, usize)> {
        let cost = |at: usize| {
            let both = self.explained([tried_of(sensors(at)).as_slice(), tried].concat())?;
            Some((both.description_length - core(at), at))
        };
        let costs: Vec<Option<(f64, usize)>> = clusters.into_par_iter().map(cost).collect();
        costs.into_iter().flatten().reduce(|least, other| if other.0 < least.0 { other } else { least })
    }

    /// Description length of the core of a cluster: some of its sensors, spread over all.
    pub(super) fn core(&self, sensors: &[usize]) -> f64 {
        self.learned(tried_of(sensors)).description_length
    }

    /// A cluster of sensors, whose motion is learned in more iterations, if that explains it.
    pub(super) fn explained(&self, sensors: Vec<usize>) -> Option<Cluster> {
        let mut found = self.may_be_one(Cluster::new(&self.felt, sensors))?;
        found.learn_longer(&self.felt);
        self.explains(&found).then_some(found)
    }

    /// A cluster of sensors, whose motion is learned in more iterations.
    pub(super) fn learned(&self, sensors: Vec<usize>) -> Cluster {
        let mut found = Cluster::new(&self.felt, sensors);
        found.learn_longer(&self.felt);
        found
    }

    /// A cluster of sensors, which completes what they feel.
    fn completing(&mut self, sensors: Vec<usize>) -> Cluster {
        let found = Cluster::new(&self.felt, sensors);
        found.complete_roots(&mut self.felt);
        found
    }
}

/// Sensors that stand for others in a trial, spread over all of them.
pub(super) fn tried_of(sensors: &[usize]) -> Vec<usize> {
    stratified(sensors.len(), MAX_GROUP).map(|at| sensors[at]).collect()
}

#[cfg(test)]
mod tests;
