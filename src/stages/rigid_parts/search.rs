//! Search for the parts: agglomerative merging of clusters by description length (Ma et al. 2007), and assigning sensors by
//! residual (K-subspaces, Bradley and Mangasarian 2000), from small clusters of sensors of high affinity.

use std::collections::{BTreeMap, BTreeSet};

use faer::Mat;
use kodama::Method;
use rayon::prelude::*;

use super::cluster::{Cluster, Felt};
use super::medians::median;
use super::weights::weigh;
use crate::numerics::linkage::largest_clusters;
use crate::stages::parameters::Parameters;

/// Sensors of a seed cluster: the fewest, and the most. Others wait until clusters have grown.
pub(super) const SEED_SENSORS: [usize; 2] = [6, 16];
/// Fewest sensors that several parts can be estimated from: two seed clusters.
pub const MIN_SENSORS: usize = 2 * SEED_SENSORS[0];
/// Share of the sensors of a cluster that each of two pieces has at most, which are tried apart.
pub(super) const PIECE: f64 = 0.6;
/// Fewest sensors of a cluster.
pub(super) const MIN_CLUSTER: usize = 4;
/// Fewest sensors of a group that moves, joins a cluster, or is a face. A single one may be in a cluster by mistake, and any cluster of less
/// than six motions explains one.
pub(super) const MIN_GROUP: usize = 2;
/// Most iterations in which sensors are assigned, and of merging and assigning.
const MAX_ASSIGNMENTS: usize = 3;
const MAX_ALTERNATIONS: usize = 4;
/// Most times that faces are regrouped.
const MAX_REGROUPINGS: usize = 3;

/// Sensors whose clusters are searched for.
pub(super) struct Search {
    pub(super) felt: Felt,
    /// Affinities between sensors, sensors × sensors, 0 to 1.
    pub(super) affinities: Mat<f64>,
    /// Whether the model has no error that counts, however fast parts move. There may be noise. A [separation](super::separation) finds it
    /// out.
    pub(super) has_exact_model: bool,
    /// Whether sensors in no cluster may change clusters. They may not while clusters can still be of two parts each: what such a cluster
    /// explains of other sensors says little.
    pub(super) rest_takes_part: bool,
    /// Groups that were tried elsewhere, and clusters that were to be dispersed, without success: first its sensors, then those of the
    /// clusters around it. They are not tried again as long as these are the same.
    pub(super) failed: BTreeSet<Vec<Vec<usize>>>,
}

impl Search {
    /// Of sensors that felt this, and that have these affinities, sensors × sensors, 0 to 1.
    pub(super) fn new(felt: Felt, affinities: Mat<f64>) -> Self {
        Self { felt, affinities, has_exact_model: false, rest_takes_part: false, failed: BTreeSet::new() }
    }

    /// The clusters, each of one motion. Sensors that no motion explains are in none.
    pub(super) fn clusters(&mut self) -> Vec<Cluster> {
        let seeds = self.seed_clusters();
        let mut clusters = self.converged(seeds);
        if let Some(separated) = self.separated(&clusters) {
            return separated;
        }
        self.rest_takes_part = true;
        if let Some(changed) = self.changed_by_rest(&clusters) {
            clusters = self.converged(changed);
        }
        clusters.par_iter_mut().for_each(|own| own.learn_with_least_rank(&self.felt));
        clusters
    }

    /// The clusters as sensors in none change them, if they do.
    fn changed_by_rest(&mut self, clusters: &[Cluster]) -> Option<Vec<Cluster>> {
        let more = self.with_rest(clusters.to_vec());
        if more.iter().zip(clusters).any(|(own, before)| own.sensors != before.sensors) {
            return Some(more);
        }
        self.regrouped(clusters)
    }

    /// Alternates moves of sensors with regrouping of faces, as long as anything changes.
    fn converged(&mut self, clusters: Vec<Cluster>) -> Vec<Cluster> {
        let mut clusters = self.alternated(clusters);
        for _ in 0..MAX_REGROUPINGS {
            let Some(parts) = self.regrouped(&clusters) else { break };
            clusters = self.alternated(parts);
        }
        clusters
    }

    /// Merges clusters, and assigns sensors and groups of sensors to others, in turn, as long as anything changes.
    fn alternated(&mut self, mut clusters: Vec<Cluster>) -> Vec<Cluster> {
        let every = self.every();
        let mut before = Vec::new();
        for _ in 0..MAX_ALTERNATIONS {
            clusters = self.merged(clusters);
            clusters.par_iter_mut().for_each(|own| own.learn_with_least_rank(&self.felt));
            clusters = self.assigned(clusters, &every);
            if self.rest_takes_part {
                clusters = self.with_rest(clusters);
            }
            let count = clusters.len();
            clusters = self.split(clusters);
            if clusters.len() > count {
                clusters = self.assigned(clusters, &every);
            }
            clusters = self.moved(clusters);
            clusters = self.dispersed(clusters);
            let now: Vec<Vec<usize>> = clusters.iter().map(|own| own.sensors.clone()).collect();
            if now == before {
                break;
            }
            before = now;
        }
        clusters
    }

    /// The residual variance that is still explained, of a sensor that is in no cluster.
    pub(super) fn most_residual(&self) -> f64 {
        self.felt.parameters.max_open_residual * self.felt.tolerance
    }

    /// All sensors as one cluster.
    pub(super) fn whole(&self) -> Cluster {
        Cluster::new(&self.felt, self.every())
    }

    /// All sensors.
    pub(super) fn every(&self) -> Vec<usize> {
        (0..self.felt.roots.sensors()).collect()
    }

    /// The sensors that are in none of these clusters.
    pub(super) fn in_none(&self, clusters: &[Cluster]) -> Vec<usize> {
        unclustered(clusters, &self.every())
    }

    /// The seed clusters that one motion explains.
    fn seed_clusters(&mut self) -> Vec<Cluster> {
        let seeds = self.seeds(&self.every(), SEED_SENSORS[1]);
        self.calibrate(&seeds);
        self.unmixed(&seeds)
    }

    /// Sets the tolerance to the median residual variance of these clusters, weighs the samples by what the clusters leave there, and sets it
    /// anew.
    pub(super) fn calibrate(&mut self, clusters: &[Vec<usize>]) {
        self.set_tolerance(clusters);
        let found = self.unmixed(clusters);
        weigh(&mut self.felt, &found);
        self.set_tolerance(clusters);
    }

    /// Sets the tolerance to the median residual variance of these clusters, within bounds.
    fn set_tolerance(&mut self, clusters: &[Vec<usize>]) {
        let Parameters { min_tolerance, max_tolerance, .. } = self.felt.parameters;
        self.felt.tolerance = min_tolerance;
        let variance = |own: &Vec<usize>| Cluster::widest(&self.felt, own.clone()).variance();
        let variances = clusters.par_iter().map(variance).collect();
        self.felt.tolerance = median(variances).clamp(min_tolerance, max_tolerance.max(min_tolerance));
    }

    /// The clusters of these sensors that one motion explains.
    fn unmixed(&self, seeds: &[Vec<usize>]) -> Vec<Cluster> {
        let found: Vec<Cluster> = seeds.par_iter().map(|own| Cluster::new(&self.felt, own.clone())).collect();
        let most = self.felt.parameters.max_seed_residual * self.felt.tolerance;
        found.into_iter().filter(|own| own.variance() <= most).collect()
    }

    /// Small clusters of some sensors, of at most so many, by average linkage on their affinities.
    pub(super) fn seeds(&self, sensors: &[usize], most: usize) -> Vec<Vec<usize>> {
        let mut seeds = self.linked(sensors, most);
        seeds.retain(|own| own.len() >= SEED_SENSORS[0]);
        seeds
    }

    /// Clusters of some sensors, of at most so many, by average linkage on their affinities.
    pub(super) fn linked(&self, sensors: &[usize], most: usize) -> Vec<Vec<usize>> {
        let distance = |i: usize, j: usize| 1.0 - self.affinities[(sensors[i], sensors[j])];
        let farthest = 1.0 - self.felt.parameters.min_affinity;
        let found = largest_clusters(sensors.len(), distance, Method::Average, most, farthest);
        found.into_iter().map(|own| own.into_iter().map(|at| sensors[at]).collect()).collect()
    }

    /// Merges the pair of clusters that saves most, again and again, as long as one motion explains the union, and both have
    /// components in common.
    pub(super) fn merged(&mut self, clusters: Vec<Cluster>) -> Vec<Cluster> {
        let Parameters { min_saving, min_tolerance, .. } = self.felt.parameters;
        let mut name = clusters.len();
        let mut clusters: BTreeMap<usize, Cluster> = clusters.into_iter().enumerate().collect();
        // Those that are not one part are `None`.
        let mut unions: BTreeMap<(usize, usize), Option<Cluster>> = BTreeMap::new();
        while clusters.len() > 1 {
            let pairs = self.pairs(&clusters);
            let new = pairs.iter().copied().filter(|pair| !unions.contains_key(pair));
            let new: Vec<(usize, usize)> = new.collect();
            let union =
                |(a, b)| ((a, b), self.may_be_one(Cluster::union(&self.felt, &clusters[&a], &clusters[&b])));
            unions.extend(new.into_par_iter().map(union).collect::<Vec<_>>());
            let mut best = best_merge(&clusters, &unions, &pairs, min_saving);
            if best.is_none() && self.felt.tolerance >= min_tolerance {
                // More iterations may show what the first ones leave open. A separation, whose tolerance is lower, begins with many.
                let open = unions.par_iter_mut().filter(|(pair, _)| pairs.contains(pair));
                open.filter_map(|(_, union)| union.as_mut()).for_each(|union| union.learn_longer(&self.felt));
                best = best_merge(&clusters, &unions, &pairs, min_saving);
            }
            let Some((a, b)) = best else { break };
            let mut union = unions.remove(&(a, b)).flatten().expect("it is the best of these");
            if !self.is_one(&clusters[&a], &clusters[&b], &mut union) {
                unions.insert((a, b), None);
                continue;
            }
            union.complete_roots(&mut self.felt);
            unions.retain(|(c, d), _| ![a, b].iter().any(|gone| c == gone || d == gone));
            clusters.remove(&a);
            clusters.remove(&b);
            clusters.insert(name, union);
            name += 1;
        }
        clusters.into_values().collect()
    }

    /// Whether two clusters have components in common, and one motion explains both.
    fn is_one(&self, a: &Cluster, b: &Cluster, union: &mut Cluster) -> bool {
        Cluster::have_common(a, b, union, &self.felt) && self.explains_in_the_end(union)
    }

    /// Whether the motion of a cluster explains it, at once or after more iterations.
    pub(super) fn explains_in_the_end(&self, cluster: &mut Cluster) -> bool {
        if !self.explains(cluster) {
            cluster.learn_longer(&self.felt);
        }
        self.explains(cluster)
    }

    /// Whether the motion of a cluster explains it, or has too few degrees of freedom to tell.
    pub(super) fn explains(&self, cluster: &Cluster) -> bool {
        cluster.variance() <= self.felt.explained() || cluster.freedom <= 0.5
    }

    /// A cluster, unless its first iterations leave so much that more would not explain it. In a separation, whose tolerance is lower, only
    /// more iterations can tell, so every cluster stays.
    pub(super) fn may_be_one(&self, cluster: Cluster) -> Option<Cluster> {
        let is_near = cluster.variance() <= self.most_residual() || self.explains(&cluster);
        (is_near || self.felt.tolerance < self.felt.parameters.min_tolerance).then_some(cluster)
    }

    /// Each cluster with those of highest affinity, on average.
    fn pairs(&self, clusters: &BTreeMap<usize, Cluster>) -> Vec<(usize, usize)> {
        let names: Vec<usize> = clusters.keys().copied().collect();
        let mut found: Vec<(usize, usize)> = names
            .par_iter()
            .flat_map_iter(|&a| {
                let others: Vec<usize> = names.iter().copied().filter(|&b| b != a).collect();
                let nearest = self.nearest(&clusters[&a].sensors, others, |b| &clusters[&b].sensors);
                nearest.into_iter().map(move |b| (a.min(b), a.max(b)))
            })
            .collect();
        found.sort_unstable();
        found.dedup();
        found
    }

    /// The clusters of highest affinity with some sensors, on average, the highest first.
    pub(super) fn nearest<'a>(
        &self,
        sensors: &[usize],
        clusters: Vec<usize>,
        of: impl Fn(usize) -> &'a Vec<usize>,
    ) -> Vec<usize> {
        let affinity = |other: &[usize]| {
            let sum: f64 =
                sensors.iter().flat_map(|&i| other.iter().map(move |&j| self.affinities[(i, j)])).sum();
            sum / (sensors.len() * other.len()) as f64
        };
        let mut order: Vec<(f64, usize)> =
            clusters.into_iter().map(|name| (affinity(of(name)), name)).collect();
        order.sort_by(|one, other| other.0.total_cmp(&one.0));
        order.truncate(self.felt.parameters.neighbours);
        order.into_iter().map(|(_, name)| name).collect()
    }

    /// Assigns each of these sensors to the cluster that leaves it the smallest residual, if that explains it; else it stays where it is.
    /// Clusters keep none but these sensors, and those with fewer than [`MIN_CLUSTER`] vanish. What the clusters complete of the roots is
    /// kept in `felt`.
    pub(super) fn assigned(&mut self, mut clusters: Vec<Cluster>, sensors: &[usize]) -> Vec<Cluster> {
        let tolerance = self.felt.tolerance;
        for _ in 0..MAX_ASSIGNMENTS {
            let residuals: Vec<Vec<f64>> = clusters.par_iter().map(|own| own.residuals(&self.felt)).collect();
            let mut members: Vec<Vec<usize>> = vec![Vec::new(); clusters.len()];
            let own: BTreeMap<usize, usize> = clusters
                .iter()
                .enumerate()
                .flat_map(|(at, cluster)| cluster.sensors.iter().map(move |&sensor| (sensor, at)))
                .collect();
            let alone: BTreeSet<usize> = clusters.iter().flat_map(Cluster::alone).collect();
            for &sensor in sensors {
                // A sensor that spans a component alone has no residual in its own cluster. So it moves if another cluster explains it.
                let judged = |(at, of): (usize, &Vec<f64>)| {
                    let is_own = own.get(&sensor) == Some(&at);
                    if is_own && alone.contains(&sensor) { f64::MAX } else { of[sensor] }
                };
                let Some((best, least)) = smallest(residuals.iter().enumerate().map(judged)) else {
                    continue;
                };
                let explains = least <= self.felt.explained();
                let to = match own.get(&sensor) {
                    Some(&own)
                        if !explains || residuals[own][sensor] <= tolerance && !alone.contains(&sensor) =>
                    {
                        Some(own)
                    }
                    _ if explains => Some(best),
                    _ => None,
                };
                if let Some(to) = to {
                    members[to].push(sensor);
                }
            }
            if clusters.iter().zip(&members).all(|(cluster, own)| cluster.sensors == *own) {
                break;
            }
            let felt = &self.felt;
            clusters = clusters
                .into_par_iter()
                .zip(members)
                .filter(|(_, own)| own.len() >= MIN_CLUSTER)
                .map(|(cluster, own)| if cluster.sensors == own { cluster } else { Cluster::new(felt, own) })
                .collect();
            for cluster in &clusters {
                cluster.complete_roots(&mut self.felt);
            }
        }
        clusters
    }

    /// Description length of some sensors: of these clusters, and of each sensor that is in none.
    pub(super) fn length_of(&self, clusters: &[Cluster], sensors: &[usize]) -> f64 {
        let alone = unclustered(clusters, sensors).into_iter().map(|sensor| vec![sensor]);
        let all: Vec<Vec<usize>> = clusters.iter().map(|own| own.sensors.clone()).chain(alone).collect();
        let lengths: Vec<f64> = all.into_par_iter().map(|own| self.learned(own).description_length).collect();
        lengths.iter().sum()
    }
}

/// Those of some sensors that are in none of these clusters.
fn unclustered(clusters: &[Cluster], sensors: &[usize]) -> Vec<usize> {
    let taken: BTreeSet<usize> = clusters.iter().flat_map(|own| own.sensors.iter().copied()).collect();
    sensors.iter().copied().filter(|sensor| !taken.contains(sensor)).collect()
}

/// The pair of clusters whose union saves most, if that is more than `min_saving`.
fn best_merge(
    clusters: &BTreeMap<usize, Cluster>,
    unions: &BTreeMap<(usize, usize), Option<Cluster>>,
    pairs: &[(usize, usize)],
    min_saving: f64,
) -> Option<(usize, usize)> {
    let saving = |&(a, b): &(usize, usize)| {
        let union = unions[&(a, b)].as_ref()?;
        let both = clusters[&a].description_length + clusters[&b].description_length;
        Some((both - union.description_length, (a, b)))
    };
    let best = pairs.iter().filter_map(saving);
    let best = best.reduce(|best, other| if other.0 > best.0 { other } else { best });
    best.filter(|(saving, _)| *saving > min_saving).map(|(_, pair)| pair)
}

/// The first of the smallest numbers, and its place.
pub(super) fn smallest(values: impl Iterator<Item = f64>) -> Option<(usize, f64)> {
    values.enumerate().reduce(|best, other| if other.1 < best.1 { other } else { best })
}
