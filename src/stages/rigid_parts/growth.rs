//! Let settled clusters grow by sensors that they explain once they are in.
//!
//! The end of a cylinder alone feels the motion along its axis, which is no motion of the cluster before it is in.

use rayon::prelude::*;

use super::cluster::{Cluster, MAX_GROUP, ROUNDING};
use super::search::{MIN_GROUP, Search};
use super::separation::{MAX_ROUNDS, best_part};
use super::stratified::stratified;

/// How many times more a cluster may leave with more sensors than without. A sensor of another part adds more.
const MORE: f64 = 1000.0;

impl Search {
    /// Settled clusters with the sensors of no settled one that they explain: those that each fit, and those that fit only together.
    pub(super) fn grown(&mut self, clusters: Vec<Cluster>) -> Vec<Cluster> {
        let separately = |search: &Self, settled: &[Cluster]| -> Vec<Option<Cluster>> {
            let both = (settled, search.wanted(settled));
            both.into_par_iter().map(|(cluster, wanted)| search.with_as_many(cluster, &wanted)).collect()
        };
        let together = |search: &Self, settled: &[Cluster]| -> Vec<Option<Cluster>> {
            let rest = search.in_none(settled);
            settled.par_iter().map(|cluster| search.with_group(cluster, &rest)).collect()
        };
        let clusters = self.grown_by(clusters, separately);
        self.grown_by(clusters, together)
    }

    /// Settled clusters, each replaced by a larger one as long as there are any. Of two that want the same sensor, the one that leaves less
    /// gets it.
    fn grown_by(
        &mut self,
        mut clusters: Vec<Cluster>,
        larger: impl Fn(&Self, &[Cluster]) -> Vec<Option<Cluster>>,
    ) -> Vec<Cluster> {
        for _ in 0..MAX_ROUNDS {
            let (mut settled, other): (Vec<Cluster>, Vec<Cluster>) =
                clusters.into_iter().partition(|own| self.is_settled(own));
            let found = larger(self, &settled);
            let mut found: Vec<(usize, Cluster)> =
                found.into_iter().enumerate().filter_map(|(at, own)| Some((at, own?))).collect();
            found.sort_by(|(_, a), (_, b)| a.variance().total_cmp(&b.variance()));
            let has_grown = !found.is_empty();
            let mut taken: Vec<usize> = Vec::new();
            for (at, own) in found {
                let is_new = |sensor: &&usize| settled[at].sensors.binary_search(sensor).is_err();
                let new: Vec<usize> = own.sensors.iter().filter(is_new).copied().collect();
                if !new.iter().any(|sensor| taken.contains(sensor)) {
                    taken.extend(new);
                    own.complete_roots(&mut self.felt);
                    settled[at] = own;
                }
            }
            clusters = settled.into_iter().chain(self.without(other, &taken)).collect();
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
            if let Some(at) = best_part(&residuals, sensor, 0.0, self.felt.parameters.max_residual_share) {
                wanted[at].push((residuals[at][sensor], sensor));
            }
        }
        let by_residual = |mut own: Vec<(f64, usize)>| {
            own.sort_by(|a, b| a.0.total_cmp(&b.0));
            own.into_iter().map(|(_, sensor)| sensor).collect()
        };
        wanted.into_iter().map(by_residual).collect()
    }

    /// A cluster with the first of some sensors: all, or half of them, and so on, until it is exact and explains them.
    fn with_as_many(&self, cluster: &Cluster, wanted: &[usize]) -> Option<Cluster> {
        let counts = std::iter::successors(Some(wanted.len()), |count| Some(count / 2));
        let with = |count: usize| {
            let both =
                Cluster::learned_longer(&self.felt, [cluster.sensors.as_slice(), &wanted[..count]].concat());
            (self.are_told(count, cluster, &both) && self.is_exact(&both)).then_some(both)
        };
        counts.take_while(|count| *count > 0).find_map(with)
    }

    /// A cluster with those of some sensors that one motion explains together with it, of those of highest affinity. All are tried, then
    /// without the worst third of those that do not fit or that span a component alone, and so on.
    fn with_group(&self, cluster: &Cluster, rest: &[usize]) -> Option<Cluster> {
        let affinity =
            |sensor: usize| cluster.sensors.iter().map(|&own| self.affinities[(own, sensor)]).sum::<f64>();
        let mut order: Vec<(f64, usize)> = rest.iter().map(|&sensor| (affinity(sensor), sensor)).collect();
        order.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut group: Vec<usize> = order.into_iter().take(MAX_GROUP).map(|(_, sensor)| sensor).collect();
        let core: Vec<usize> =
            stratified(cluster.sensors.len(), MAX_GROUP).map(|at| cluster.sensors[at]).collect();
        let most = f64::min(self.felt.explained(), MORE * cluster.variance().max(ROUNDING));
        let with =
            |core: &[usize], group: &[usize]| Cluster::learned_longer(&self.felt, [core, group].concat());
        while group.len() >= MIN_GROUP {
            let both = with(&core, &group);
            let of = |sensor: usize| (both.residual_of(&self.felt, sensor), sensor);
            let mut foreign: Vec<(f64, usize)> =
                group.iter().map(|&sensor| of(sensor)).filter(|(residual, _)| *residual > most).collect();
            if foreign.is_empty() {
                let alone = both.alone();
                foreign.extend(
                    group.iter().filter(|sensor| alone.contains(sensor)).map(|&sensor| (0.0, sensor)),
                );
            }
            if foreign.is_empty() {
                let is_told = self.are_told(group.len(), cluster, &both);
                let all = (is_told && both.variance() <= most).then(|| with(&cluster.sensors, &group));
                return all.filter(|own| own.variance() <= most);
            }
            foreign.sort_by(|a, b| b.0.total_cmp(&a.0));
            foreign.truncate(foreign.len().div_ceil(3));
            group.retain(|sensor| !foreign.iter().any(|(_, other)| other == sensor));
        }
        None
    }

    /// Whether it says something that a cluster explains so many more sensors. As many new components explain them whatever they feel.
    fn are_told(&self, more: usize, cluster: &Cluster, both: &Cluster) -> bool {
        let present = |own: &Cluster| own.present(&self.felt, self.felt.parameters.coarse_tolerance);
        more > present(both).saturating_sub(present(cluster))
    }
}

#[cfg(test)]
mod tests;
