//! Separate parts that hardly move against each other, without much noise.
//!
//! Iterated to its end, the motion of a rigid part leaves next to nothing of what is felt without noise. One motion of two parts
//! leaves more, however little they move against each other. So clusters that one motion explains only nearly are taken apart into
//! [pieces](super::pieces), sensors are assigned anew, pieces of one part are merged, and clusters [grow](super::growth) by the
//! sensors that they explain once they are in. This is done for a coarse idea of what is exact, and then for a finer one. With noise no
//! piece stands out, and the clusters stay as they are.
//!
//! With pressures over a time step the model has an error. It grows with the speed, so that it is large at few samples. A cluster with such
//! a residual is not taken apart.

use rayon::prelude::*;

use super::cluster::Cluster;
use super::halves::slow_share;
use super::pieces::pieces;
use super::search::{MIN_CLUSTER, MIN_SENSORS, Search};
use super::weights::calm_share;
use crate::stages::parameters::Parameters;

/// Iterations in which a motion is learned, and in which it comes to its end: for the coarse idea of what is exact, and for the fine one.
const ITERATIONS: [[usize; 2]; 2] = [[24, 100], [24, 300]];
/// Most rounds of separating, assigning, merging and growing, and of growing in each.
pub(super) const MAX_ROUNDS: usize = 3;

impl Search {
    /// The clusters as far as they are of one part, and the parts of the others; nothing if no parts can be told apart.
    pub(super) fn separated(&mut self, clusters: &[Cluster]) -> Option<Vec<Cluster>> {
        let before = (self.felt.tolerance, self.felt.iterations);
        let (mut last, mut found) = (before, None::<Vec<Cluster>>);
        let Parameters { coarse_tolerance, fine_tolerance, .. } = self.felt.parameters;
        let levels = [(coarse_tolerance, ITERATIONS[0]), (fine_tolerance, ITERATIONS[1])];
        for (at, level) in levels.into_iter().enumerate() {
            (self.felt.tolerance, self.felt.iterations) = level;
            let learned = |own: &Cluster| Cluster::learned_longer(&self.felt, own.sensors.clone());
            let start: Vec<Cluster> = found.as_deref().unwrap_or(clusters).par_iter().map(learned).collect();
            if at == 0 {
                let [nothing, much, told] = self.left_by(&start);
                self.has_exact_model = told > 0 && 2 * (nothing + much) >= told;
                let some_are_settled = || start.par_iter().any(|own| self.is_settled(own));
                if !self.has_exact_model && much == 0 && !some_are_settled() {
                    // Nothing shows which are of several parts.
                    break;
                }
            } else if !self.quarter_leaves_nothing(&start) {
                break;
            }
            if self.nothing_is_left_to_separate(&start) {
                if self.has_exact_model {
                    continue;
                }
                break;
            }
            let Some(more) = self.separated_at(start, self.felt.parameters.max_residual * before.0) else {
                break;
            };
            (last, found) = (level, Some(more));
        }
        (self.felt.tolerance, self.felt.iterations) = last;
        let mut found = found?;
        found
            .par_iter_mut()
            .filter(|own| self.is_exact(own))
            .for_each(|own| own.learn_with_least_rank(&self.felt));
        if !self.has_exact_model {
            // What a part may leave, and which rank it has, is then as before.
            let (exact, mut other): (Vec<Cluster>, Vec<Cluster>) =
                found.into_iter().partition(|own| self.is_exact(own));
            (self.felt.tolerance, self.felt.iterations) = before;
            other.par_iter_mut().for_each(|own| {
                *own = Cluster::new(&self.felt, std::mem::take(&mut own.sensors));
                own.learn_with_least_rank(&self.felt);
            });
            found = [exact, other].concat();
        }
        Some(found)
    }

    /// The same with one idea of what is exact. A cluster that leaves more than `nearly` is none.
    fn separated_at(&mut self, mut found: Vec<Cluster>, nearly: f64) -> Option<Vec<Cluster>> {
        let all = self.every();
        let mut before = Vec::new();
        for round in 0..MAX_ROUNDS {
            found = self.apart(found);
            if round == 0 && !found.iter().any(|own| self.is_exact(own)) {
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
        Some(found)
    }

    /// Of the clusters that can be told: how many leave nothing, as one part does; how many leave much at all speeds, as several parts do;
    /// and how many there are. If most leave nothing or much, the model is exact. If it has an error, a part leaves something between,
    /// which vanishes in slow samples. With noise no piece will be exact.
    fn left_by(&self, clusters: &[Cluster]) -> [usize; 3] {
        let told = self.told(clusters);
        let leaves_nothing = |own: &&&Cluster| own.variance() <= self.felt.parameters.max_exact_residual;
        let leaves_much = |own: &&&Cluster| {
            !self.is_exact(own)
                && slow_share(&self.felt, &own.representatives) >= self.felt.parameters.max_slow_share
        };
        [told.iter().filter(leaves_nothing).count(), told.par_iter().filter(leaves_much).count(), told.len()]
    }

    /// Whether all clusters are exact; without an exact model, whether all that can be told are settled.
    fn nothing_is_left_to_separate(&self, clusters: &[Cluster]) -> bool {
        if self.has_exact_model {
            return clusters.iter().all(|own| self.is_exact(own));
        }
        self.told(clusters).par_iter().all(|own| self.is_settled(own))
    }

    /// Whether a cluster is of one part: it is exact, or the model is not, and what it leaves is an error of the model.
    pub(super) fn is_settled(&self, cluster: &Cluster) -> bool {
        let is_uneven =
            || self.is_told(cluster) && calm_share(&self.felt, cluster) < self.felt.parameters.max_calm_share;
        self.is_exact(cluster) || !self.has_exact_model && is_uneven()
    }

    /// Whether one motion explains a cluster to the end, of enough that others would not do as well.
    pub(super) fn is_exact(&self, cluster: &Cluster) -> bool {
        cluster.variance() <= self.felt.explained() && self.is_told(cluster)
    }

    /// Whether a cluster has enough informative values to tell whether one motion explains it. One motion explains any few sensors.
    fn is_told(&self, cluster: &Cluster) -> bool {
        cluster.freedom >= self.felt.parameters.min_freedom
    }

    /// Those of these clusters that have enough.
    fn told<'a>(&self, clusters: &'a [Cluster]) -> Vec<&'a Cluster> {
        clusters.iter().filter(|own| self.is_told(own)).collect()
    }

    /// Whether a quarter of the clusters leave nothing, so that a finer idea of what is exact may find more.
    fn quarter_leaves_nothing(&self, clusters: &[Cluster]) -> bool {
        let told = self.told(clusters);
        4 * told.iter().filter(|own| own.variance() <= self.felt.parameters.max_exact_residual).count()
            >= told.len()
    }

    fn complete(&mut self, clusters: &[Cluster]) {
        clusters.iter().for_each(|own| own.complete_roots(&mut self.felt));
    }

    fn converge(&self, clusters: &mut [Cluster]) {
        clusters.par_iter_mut().for_each(|own| own.learn_longer(&self.felt));
    }

    /// The pieces of each cluster that is not settled, and what is left of it as another one.
    fn apart(&self, clusters: Vec<Cluster>) -> Vec<Cluster> {
        let apart = |cluster: Cluster| {
            if self.is_settled(&cluster) {
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
        (sensors.len() >= MIN_CLUSTER).then(|| Cluster::learned_longer(&self.felt, sensors))
    }

    /// With the pieces of all sensors that are in no settled cluster: those that were scattered over several.
    fn with_pieces_of_the_rest(&mut self, clusters: Vec<Cluster>) -> Vec<Cluster> {
        let (mut settled, other): (Vec<Cluster>, Vec<Cluster>) =
            clusters.into_iter().partition(|own| self.is_settled(own));
        let rest = self.in_none(&settled);
        if rest.len() < MIN_SENSORS {
            return settled.into_iter().chain(other).collect();
        }
        let (found, _) = pieces(&self.felt, &rest);
        self.complete(&found);
        let taken: Vec<usize> = found.iter().flat_map(|own| own.sensors.iter().copied()).collect();
        settled.extend(found);
        settled.into_iter().chain(self.without(other, &taken)).collect()
    }

    /// Clusters without these sensors.
    pub(super) fn without(&self, clusters: Vec<Cluster>, taken: &[usize]) -> Vec<Cluster> {
        let without = |cluster: Cluster| {
            let left: Vec<usize> =
                cluster.sensors.iter().copied().filter(|sensor| !taken.contains(sensor)).collect();
            if left.len() == cluster.sensors.len() { Some(cluster) } else { self.remaining(left) }
        };
        clusters.into_iter().filter_map(without).collect()
    }
}

/// The part whose motion explains a sensor best, if it leaves no more than `most`, or no more than the share `better` of what that of any
/// other leaves.
pub(super) fn best_part(residuals: &[Vec<f64>], sensor: usize, most: f64, better: f64) -> Option<usize> {
    let mut order: Vec<(f64, usize)> =
        residuals.iter().enumerate().map(|(at, own)| (own[sensor], at)).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    let next = order.get(1).map_or(f64::INFINITY, |next| next.0);
    order.first().filter(|best| best.0 <= f64::max(most, better * next)).map(|best| best.1)
}

#[cfg(test)]
mod tests;
