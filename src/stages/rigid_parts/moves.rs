//! Move groups of sensors between clusters: a face that is in a cluster by mistake leaves it as a whole.
//!
//! The ends of a cylinder feel its motion along its axis, which its side does not. If they were merged with the side of another
//! cylinder, they brought that motion with them, and it explains each of them: no sensor leaves by its residual. Together they cost
//! less on their own part, which knows how they rotate.

use rayon::prelude::*;

use super::cluster::Cluster;
use super::search::{MIN_CLUSTER, MIN_SAVING, PIECE, SEED_SENSORS, Search};
use super::stratified::stratified;

/// Fewest sensors of a group. A single one that is in a cluster by mistake spans a component alone.
const MIN_GROUP: usize = 2;
/// Sensors of a group that are tried, and of a cluster that they are tried with. They are as many, so that neither decides alone what
/// the motion is.
const MAX_TRIED: usize = 24;
/// Share of the description of a group that its cluster saves if the group is where it belongs. What the ends of a cylinder share
/// with its side saves 0.4 to 0.75 of it, and with another side −0.8 to 0.2.
const SHARED: f64 = 0.4;

/// Where a group costs less than in its cluster.
enum Place {
    Cluster(usize),
    Alone,
}

/// A cluster, and the same with a group of sensors.
struct Trial {
    without: Cluster,
    with: Cluster,
}

impl Trial {
    /// Description length that the group adds, in nats per sample.
    fn cost(&self) -> f64 {
        self.with.description_length - self.without.description_length
    }

    /// Whether the cluster knows much of the motion of the group, which is `alone` by itself.
    fn is_home(&self, alone: &Cluster) -> bool {
        alone.description_length - self.cost() >= SHARED * alone.description_length
    }
}

impl Search {
    /// The clusters, with each group of sensors where it costs the least: in its cluster, in another, or alone.
    pub(super) fn moved(&mut self, mut clusters: Vec<Cluster>) -> Vec<Cluster> {
        let groups: Vec<Vec<usize>> = clusters.iter().flat_map(|own| self.groups(own)).collect();
        for group in groups {
            // Groups that went before may have taken their cluster apart.
            let holds = |own: &Cluster| group.iter().all(|sensor| own.sensors.binary_search(sensor).is_ok());
            if let Some(home) = clusters.iter().position(holds) {
                self.move_group(&mut clusters, home, &group);
            }
        }
        clusters
    }

    /// Groups of sensors of high affinity in a cluster.
    fn groups(&self, cluster: &Cluster) -> Vec<Vec<usize>> {
        let most = (PIECE * cluster.sensors.len() as f64) as usize;
        let mut groups = self.linked(&cluster.sensors, most);
        groups.retain(|own| own.len() >= MIN_GROUP);
        groups
    }

    /// Moves a group from its cluster to where it costs the least, if that is another place.
    fn move_group(&mut self, clusters: &mut Vec<Cluster>, home: usize, group: &[usize]) {
        let is_left = |sensor: &usize| !group.contains(sensor);
        let rest: Vec<usize> = clusters[home].sensors.iter().copied().filter(is_left).collect();
        if rest.len() < MIN_CLUSTER {
            return;
        }
        let Some(place) = self.better_place(clusters, home, &rest, group) else { return };
        clusters[home] = self.completing(rest);
        match place {
            Place::Cluster(to) => {
                clusters[to] = self.completing([clusters[to].sensors.as_slice(), group].concat());
            }
            Place::Alone if group.len() >= MIN_CLUSTER => clusters.push(self.completing(group.to_vec())),
            Place::Alone => {}
        }
    }

    /// Where a group costs less than with the rest of its cluster.
    fn better_place(
        &self,
        clusters: &[Cluster],
        home: usize,
        rest: &[usize],
        group: &[usize],
    ) -> Option<Place> {
        let tried: Vec<usize> = stratified(group.len(), MAX_TRIED).map(|at| group[at]).collect();
        let (alone, here) = (self.learned(tried.clone()), self.trial(rest, &tried));
        // Any cluster explains a few sensors.
        let is_told = group.len() >= SEED_SENSORS[0];
        if is_told && here.is_home(&alone) {
            return None;
        }
        let others = (0..if is_told { clusters.len() } else { 0 }).into_par_iter().filter(|at| *at != home);
        let others: Vec<(f64, usize)> = others
            .map(|at| (self.trial(&clusters[at].sensors, &tried), at))
            .filter(|(trial, _)| self.explains(&trial.with))
            .map(|(trial, at)| (trial.cost(), at))
            .collect();
        let least = others.into_iter().reduce(|least, other| if other.0 < least.0 { other } else { least });
        match least.filter(|(cost, _)| alone.description_length - cost > MIN_SAVING) {
            Some((cost, at)) => (here.cost() - cost > MIN_SAVING).then_some(Place::Cluster(at)),
            None => (alone.description_length - here.cost() < MIN_SAVING).then_some(Place::Alone),
        }
    }

    /// Some of these sensors, without and with a group.
    fn trial(&self, sensors: &[usize], group: &[usize]) -> Trial {
        let some: Vec<usize> = stratified(sensors.len(), MAX_TRIED).map(|at| sensors[at]).collect();
        let both = [some.as_slice(), group].concat();
        Trial { without: self.learned(some), with: self.learned(both) }
    }

    fn learned(&self, sensors: Vec<usize>) -> Cluster {
        let mut found = Cluster::new(&self.felt, sensors);
        found.learn_more(&self.felt);
        found
    }

    /// A cluster of sensors, which completes what they feel.
    fn completing(&mut self, sensors: Vec<usize>) -> Cluster {
        let found = Cluster::new(&self.felt, sensors);
        found.complete(&mut self.felt);
        found
    }
}

#[cfg(test)]
mod tests;
