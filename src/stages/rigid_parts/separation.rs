//! Separate parts that hardly move against each other, where the data are exact enough.
//!
//! Iterated to its end, the motion of a rigid part leaves next to nothing of what is felt without noise. One motion of two parts
//! leaves more, however little they move against each other. So clusters that one motion explains only nearly are taken apart into
//! [pieces](super::pieces), sensors are assigned anew, pieces of one part are merged, and clusters grow by the sensors that they
//! explain once they are in. With noise no piece stands out, and the clusters stay as they are. So they do where the error of the model
//! grows with the speed, because pressures are of a whole time step.

use std::collections::BTreeSet;

use rayon::prelude::*;

use super::cluster::{Cluster, MIN_FREEDOM};
use super::halves::slow_share;
use super::pieces::pieces;
use super::search::{EXPLAINED, MIN_CLUSTER, MIN_SENSORS, Search};

/// Residual variance that iterations leave of exact data.
const TOLERANCE: f64 = 2e-5;
/// Iterations in which a motion is learned, and in which it comes to its end.
const ITERATIONS: [usize; 2] = [24, 100];
/// Residual of a sensor by a part, as a share of that by any other, up to which it is on that part.
const BETTER: f64 = 0.2;
/// Variance in slow samples, as a share of that in fast ones, below which an error vanishes with the speed.
const VANISHING: f64 = 0.25;
/// Most rounds of separating, assigning, merging and growing, and of growing in each.
const MAX_ROUNDS: usize = 3;

impl Search {
    /// The clusters as far as they are of one part, and the parts of the others; nothing if no cluster is explained to the end.
    pub(super) fn separated(&mut self, clusters: &[Cluster]) -> Option<Vec<Cluster>> {
        let coarse = (self.felt.tolerance, self.felt.iterations);
        (self.felt.tolerance, self.felt.iterations) = (TOLERANCE, ITERATIONS);
        let found = self.separated_to_the_end(clusters, EXPLAINED * coarse.0);
        if found.is_none() {
            (self.felt.tolerance, self.felt.iterations) = coarse;
        }
        found
    }

    /// The same with the tolerance and the iterations of exact data. A cluster that leaves more than `nearly` is none.
    fn separated_to_the_end(&mut self, clusters: &[Cluster], nearly: f64) -> Option<Vec<Cluster>> {
        let all: Vec<usize> = (0..self.felt.roots.sensors()).collect();
        let converged = |own: &Cluster| Cluster::converged(&self.felt, own.sensors.clone());
        let mut found: Vec<Cluster> = clusters.par_iter().map(converged).collect();
        if !self.are_several(&found) {
            return None;
        }
        let mut before = Vec::new();
        for round in 0..MAX_ROUNDS {
            found = self.apart(found);
            if round == 0 && !found.iter().any(|own| self.is_exact(own) && own.freedom >= MIN_FREEDOM) {
                return None;
            }
            self.complete(&found);
            found = self.assigned(found, &all);
            self.converge(&mut found);
            found = self.merged(found);
            self.converge(&mut found);
            found = self.grown(found);
            found = self.with_pieces_of_the_rest(found);
            found.retain(|own| own.variance() <= nearly);
            let now: Vec<Vec<usize>> = found.iter().map(|own| own.sensors.clone()).collect();
            if now == before {
                break;
            }
            before = now;
        }
        found.par_iter_mut().filter(|own| self.is_exact(own)).for_each(|own| own.learn_well(&self.felt));
        Some(found)
    }

    /// Whether what one motion leaves of a cluster does not vanish in slow samples. If it does, or if there is no more than exact data
    /// leave, no parts can be told from the error of the model.
    fn are_several(&self, clusters: &[Cluster]) -> bool {
        let stays = |own: &Cluster| slow_share(&self.felt, &own.representatives) >= VANISHING;
        clusters.par_iter().filter(|own| !self.is_exact(own)).any(stays)
    }

    /// Whether one motion explains a cluster to the end.
    fn is_exact(&self, cluster: &Cluster) -> bool {
        cluster.variance() <= EXPLAINED * self.felt.tolerance
    }

    fn complete(&mut self, clusters: &[Cluster]) {
        clusters.iter().for_each(|own| own.complete(&mut self.felt));
    }

    fn converge(&self, clusters: &mut [Cluster]) {
        clusters.par_iter_mut().for_each(|own| own.learn_more(&self.felt));
    }

    /// The pieces of each cluster that is not exact, and what is left of it as another one.
    fn apart(&self, clusters: Vec<Cluster>) -> Vec<Cluster> {
        let apart = |cluster: Cluster| {
            if self.is_exact(&cluster) {
                return vec![cluster];
            }
            let (mut found, rest) = pieces(&self.felt, &cluster.sensors);
            if found.is_empty() {
                return vec![cluster];
            }
            found.extend(self.remaining(rest));
            found
        };
        clusters.into_par_iter().map(apart).collect::<Vec<_>>().into_iter().flatten().collect()
    }

    /// What is left of a cluster, if that is one.
    fn remaining(&self, sensors: Vec<usize>) -> Option<Cluster> {
        (sensors.len() >= MIN_CLUSTER).then(|| Cluster::converged(&self.felt, sensors))
    }

    /// Exact clusters with those sensors of no exact one that fit them much better than any other, as many as leave them exact. The end
    /// of a cylinder alone feels the motion along its axis, which is no motion of the cluster before it is in.
    fn grown(&mut self, mut clusters: Vec<Cluster>) -> Vec<Cluster> {
        for _ in 0..MAX_ROUNDS {
            let (exact, other): (Vec<Cluster>, Vec<Cluster>) =
                clusters.into_iter().partition(|own| self.is_exact(own));
            let wanted = self.wanted(&exact);
            let more = |(own, wanted): (&Cluster, &Vec<usize>)| self.with_as_many(own, wanted);
            let more: Vec<Option<Cluster>> = exact.par_iter().zip(&wanted).map(more).collect();
            let has_grown = more.iter().any(Option::is_some);
            let taken: Vec<usize> = more.iter().flatten().flat_map(|own| own.sensors.clone()).collect();
            more.iter().flatten().for_each(|own| own.complete(&mut self.felt));
            let exact = exact.into_iter().zip(more).map(|(own, more)| more.unwrap_or(own));
            clusters = exact.chain(self.without(other, &taken)).collect();
            if !has_grown {
                break;
            }
        }
        clusters
    }

    /// For each cluster, the sensors of none that fit it much better than any other, the best first.
    fn wanted(&self, clusters: &[Cluster]) -> Vec<Vec<usize>> {
        let residuals: Vec<Vec<f64>> = clusters.par_iter().map(|own| own.residuals(&self.felt)).collect();
        let mut wanted: Vec<Vec<(f64, usize)>> = vec![Vec::new(); clusters.len()];
        for sensor in self.in_none(clusters) {
            if let Some(at) = explaining(&residuals, sensor, 0.0) {
                wanted[at].push((residuals[at][sensor], sensor));
            }
        }
        let by_residual = |mut own: Vec<(f64, usize)>| {
            own.sort_by(|a, b| a.0.total_cmp(&b.0));
            own.into_iter().map(|(_, sensor)| sensor).collect()
        };
        wanted.into_iter().map(by_residual).collect()
    }

    /// A cluster with the first of some sensors: all, or half of them, and so on, until it is exact and has components in common
    /// with them.
    fn with_as_many(&self, cluster: &Cluster, wanted: &[usize]) -> Option<Cluster> {
        let counts = std::iter::successors(Some(wanted.len()), |count| Some(count / 2));
        let with = |count: usize| {
            let both =
                Cluster::converged(&self.felt, [cluster.sensors.as_slice(), &wanted[..count]].concat());
            let more = Cluster::widest(&self.felt, wanted[..count].to_vec());
            let have_common = Cluster::have_common(cluster, &more, &both, self.felt.tolerance);
            (have_common && self.is_exact(&both)).then_some(both)
        };
        counts.take_while(|count| *count > 0).find_map(with)
    }

    /// With the pieces of all sensors that are in no exact cluster: those that were scattered over several.
    fn with_pieces_of_the_rest(&mut self, clusters: Vec<Cluster>) -> Vec<Cluster> {
        let (mut exact, other): (Vec<Cluster>, Vec<Cluster>) =
            clusters.into_iter().partition(|own| self.is_exact(own));
        let rest = self.in_none(&exact);
        if rest.len() < MIN_SENSORS {
            return exact.into_iter().chain(other).collect();
        }
        let (found, _) = pieces(&self.felt, &rest);
        self.complete(&found);
        let taken: Vec<usize> = found.iter().flat_map(|own| own.sensors.iter().copied()).collect();
        exact.extend(found);
        exact.into_iter().chain(self.without(other, &taken)).collect()
    }

    /// The sensors that are in none of these clusters.
    fn in_none(&self, clusters: &[Cluster]) -> Vec<usize> {
        let home: BTreeSet<usize> = clusters.iter().flat_map(|own| own.sensors.iter().copied()).collect();
        (0..self.felt.roots.sensors()).filter(|sensor| !home.contains(sensor)).collect()
    }

    /// Clusters without these sensors.
    fn without(&self, clusters: Vec<Cluster>, taken: &[usize]) -> Vec<Cluster> {
        let without = |cluster: Cluster| {
            let left: Vec<usize> =
                cluster.sensors.iter().copied().filter(|sensor| !taken.contains(sensor)).collect();
            if left.len() == cluster.sensors.len() { Some(cluster) } else { self.remaining(left) }
        };
        clusters.into_iter().filter_map(without).collect()
    }
}

/// The part whose motion explains a sensor best, if it leaves no more than this, or much less than that of any other does.
pub(super) fn explaining(residuals: &[Vec<f64>], sensor: usize, most: f64) -> Option<usize> {
    let mut order: Vec<(f64, usize)> =
        residuals.iter().enumerate().map(|(at, own)| (own[sensor], at)).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    let next = order.get(1).map_or(f64::INFINITY, |next| next.0);
    order.first().filter(|best| best.0 <= f64::max(most, BETTER * next)).map(|best| best.1)
}
