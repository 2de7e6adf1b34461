//! Run the split–merge sampler: moves that divide the points of one to three clusters anew, and Gibbs sweeps between them.
//!
//! Its target, with π and the joints q integrated out, is
//!
//! p(z, μ, Σ, x) ∝ γ^K ∏_k Γ(n_k) NIW(μ_k, Σ_k) ∏_{i in k} N(x_i; μ_k, Σ_k) × (1 / K^(K−2)) Σ_C ∏_{(s, c) in C} N(μ_s; μ_c, Σ_s + Σ_c),
//!
//! the Dirichlet-process mixture itself, not truncated at K components, and a uniform prior over the trees C of its
//! clusters. Without joints (DPGMM) the last factor is missing. See `docs/method.md`.

use rand::seq::IndexedRandom;
use rand::seq::index::sample_array;
use rand::{Rng, RngExt};
use rand_distr::Gamma;

use super::clusters::{Cluster, graph, log_joints};
use super::collapsed::collapsed_labels;
use super::division::{Division, SplitProposal};
use super::neighbours::Neighbours;
use crate::stages::mixture::{
    Gaussian, NormalInverseWishart, Points, Rounding, SufficientStatistics, assignments,
};
use crate::stages::schema::joints::draw_between;
use crate::stages::schema::settings::Model;
use crate::stages::schema::weighted_trees::WeightedGraph;
use crate::stages::tree::{Edge, shortest};

/// A move over the clusters of a few points, its ends.
#[derive(Debug, Clone, Copy)]
enum Move {
    /// Splits the cluster of two points, or merges both of theirs.
    SplitOrMerge(SplitProposal),
    /// Divides the points of the clusters of two points anew.
    SplitAnew(SplitProposal),
    /// Makes three clusters of two, or two of three: two clusters may have shared a third part between them, and no split of
    /// one of them is likely.
    TwoOrThree(SplitProposal),
}

/// The moves of a sweep.
const MOVES: [Move; 10] = [
    Move::SplitOrMerge(SplitProposal::Tempered(1.0)),
    Move::SplitOrMerge(SplitProposal::Uninformed),
    Move::TwoOrThree(SplitProposal::Tempered(1.0)),
    Move::SplitAnew(SplitProposal::Tempered(1.0)),
    Move::SplitAnew(SplitProposal::Tempered(0.5)),
    Move::SplitOrMerge(SplitProposal::Tempered(0.1)),
    Move::SplitOrMerge(SplitProposal::Uninformed),
    Move::TwoOrThree(SplitProposal::Tempered(0.3)),
    Move::SplitAnew(SplitProposal::Tempered(0.3)),
    Move::SplitAnew(SplitProposal::Tempered(0.5)),
];

/// What a move does to the clusters of its ends: their points are divided anew.
#[derive(Debug, Clone)]
struct Regrouping {
    /// The points that have the clusters now, each its own.
    before: Vec<usize>,
    /// The points that have those that are proposed.
    after: Vec<usize>,
    /// How many of the points, from the first, were drawn by drawing a cluster each, and a point of it.
    by_cluster: usize,
    /// What a division goes by.
    care: SplitProposal,
}

/// What is proposed. It is accepted by the product of two ratios.
struct Proposal {
    /// Numbers of the clusters that would go.
    old: Vec<usize>,
    /// Those that would come.
    new: Vec<Cluster>,
    /// Log ratio of the targets, and of the probabilities that the ends are drawn.
    log_ratio: f64,
    /// Log ratio of the probabilities of both divisions.
    log_divisions: f64,
}

/// Clusters that a chain may have: a bound for the memory, far above what a body has.
const MOST_CLUSTERS: usize = 256;

/// What all chains of a map share.
pub(crate) struct Target<'a> {
    /// x.
    pub points: &'a Points,
    /// The prior of the clusters' Gaussians.
    pub prior: &'a NormalInverseWishart,
    /// γ.
    pub concentration: f64,
    /// With joints or without.
    pub model: Model,
    /// Which points a move is likely to be drawn for.
    pub neighbours: Neighbours,
}

/// The state of one chain.
pub(crate) struct SplitMerge<'a> {
    target: &'a Target<'a>,
    /// z: the cluster of each point.
    pub labels: Vec<usize>,
    clusters: Vec<Cluster>,
}

impl<'a> SplitMerge<'a> {
    /// Starts from labels, any numbers, and draws the Gaussians given them.
    ///
    /// # Errors
    /// [`Rounding`] if a covariance is not positive definite in floating point.
    pub(crate) fn start(
        target: &'a Target<'a>,
        labels: &[usize],
        rng: &mut impl Rng,
    ) -> Result<Self, Rounding> {
        let size = labels.iter().max().map_or(0, |largest| largest + 1);
        let mut members = vec![Vec::new(); size];
        labels.iter().enumerate().for_each(|(i, &label)| members[label].push(i));
        members.retain(|members| !members.is_empty());
        let clusters: Result<Vec<Cluster>, Rounding> = members
            .into_iter()
            .map(|members| Cluster::draw(target.points, target.prior, members, rng))
            .collect();
        let mut chain = Self { target, labels: vec![0; labels.len()], clusters: clusters? };
        chain.number();
        Ok(chain)
    }

    /// Runs one sweep: ten moves, then the tree, its joints, some labels and the Gaussians, then all labels.
    ///
    /// # Errors
    /// As for [`Self::start`].
    pub(crate) fn sweep(&mut self, rng: &mut impl Rng) -> Result<(), Rounding> {
        for proposed in MOVES {
            self.try_move(proposed, rng)?;
        }
        self.draw_gaussians(rng)?;
        self.draw_labels(rng)
    }

    /// Draws the ends of a move, and proposes it (Jain and Neal 2004).
    fn try_move(&mut self, proposed: Move, rng: &mut impl Rng) -> Result<(), Rounding> {
        if let Some(regrouping) = self.draw_ends(proposed, rng)
            && let Some(proposal) = self.propose(&regrouping, rng)?
            && accepted(proposal.log_ratio + proposal.log_divisions, rng)
        {
            self.adopt(proposal);
        }
        Ok(())
    }

    /// Draws the ends of a move; `None` if they have no clusters that it could change.
    ///
    /// For two ends: a cluster and a point of it, evenly, and then another point. For three: two clusters and a point of each,
    /// evenly, and then any third point.
    fn draw_ends(&self, proposed: Move, rng: &mut impl Rng) -> Option<Regrouping> {
        match proposed {
            Move::SplitOrMerge(care) | Move::SplitAnew(care) => {
                let first = self.point_of(rng.random_range(0..self.clusters.len()), rng);
                let second = self.target.neighbours.second(first, rng)?;
                let (one, both) = (vec![first], vec![first, second]);
                let together = self.labels[first] == self.labels[second];
                let (before, after) = match (proposed, together) {
                    (Move::SplitAnew(_), true) => return None,
                    (Move::SplitAnew(_), false) => (both.clone(), both),
                    (_, true) => (one, both),
                    (_, false) => (both, one),
                };
                Some(Regrouping { before, after, by_cluster: 1, care })
            }
            Move::TwoOrThree(care) => {
                let clusters: [usize; 2] = sample_array(rng, self.clusters.len())?;
                let two = clusters.map(|k| self.point_of(k, rng));
                let third = rng.random_range(0..self.labels.len());
                if two.contains(&third) {
                    return None;
                }
                let (two, three) = (two.to_vec(), [two.as_slice(), &[third]].concat());
                let within = clusters.contains(&self.labels[third]);
                let (before, after) = if within { (two, three) } else { (three, two) };
                Some(Regrouping { before, after, by_cluster: 2, care })
            }
        }
    }

    /// A point of a cluster.
    fn point_of(&self, k: usize, rng: &mut impl Rng) -> usize {
        *self.clusters[k].members.choose(rng).expect("a cluster has points")
    }

    /// Draws what a move proposes; `None` if it would change nothing, or make too many clusters.
    ///
    /// The Gaussians of new clusters are drawn from their posterior given the points alone, so that of the ratio of
    /// targets and proposals these remain: the marginal likelihoods of the points, the prior of the partition, the
    /// probabilities of both divisions, the factor of the joints, and the probability that the ends were drawn.
    fn propose(&self, regrouping: &Regrouping, rng: &mut impl Rng) -> Result<Option<Proposal>, Rounding> {
        let Regrouping { before, after, by_cluster, care } = regrouping;
        let Target { points, prior, .. } = *self.target;
        if after.len() > before.len() && self.clusters.len() >= MOST_CLUSTERS {
            return Ok(None);
        }
        let old: Vec<usize> = before.iter().map(|&end| self.labels[end]).collect();
        let mut members: Vec<usize> = old.iter().flat_map(|&k| self.clusters[k].members.clone()).collect();
        members.sort_unstable();
        let was = Division::new(points, prior, &members, before, *care)?;
        let side =
            |i: usize| old.iter().position(|k| *k == self.labels[i]).expect("a point of these clusters");
        let log_was = was.log_probability(side);
        let is = if before == after { was } else { Division::new(points, prior, &members, after, *care)? };
        let (sides, log_is) = is.draw(rng);
        if old.len() == sides.len()
            && old.iter().zip(&sides).all(|(&k, side)| self.clusters[k].members == *side)
        {
            return Ok(None);
        }
        let new: Vec<Cluster> = sides
            .into_iter()
            .map(|members| Cluster::draw(points, prior, members, rng))
            .collect::<Result<_, Rounding>>()?;
        let clusters = self.clusters.len();
        let ends_before = log_ends(clusters, old.iter().take(*by_cluster).map(|&k| &self.clusters[k]));
        let ends_after = log_ends(clusters + new.len() - old.len(), new.iter().take(*by_cluster));
        let log_ratio = self.gain(&old, &new)? + ends_after - ends_before;
        Ok(Some(Proposal { old, new, log_ratio, log_divisions: log_was - log_is }))
    }

    /// Takes what is proposed.
    fn adopt(&mut self, Proposal { mut old, new, .. }: Proposal) {
        old.sort_unstable();
        old.iter().rev().for_each(|&k| drop(self.clusters.swap_remove(k)));
        self.clusters.extend(new);
        self.number();
    }

    /// Log ratio of the target with the clusters `new` for those of the numbers `old`, to the target as it is, the
    /// densities of Gaussians under their posteriors apart.
    fn gain(&self, old: &[usize], new: &[Cluster]) -> Result<f64, Rounding> {
        let Target { concentration, model, .. } = *self.target;
        let own = |cluster: &Cluster| cluster.log_mass(concentration);
        let before: Vec<&Cluster> = self.clusters.iter().collect();
        let kept = self.clusters.iter().enumerate().filter(|(k, _)| !old.contains(k));
        let after: Vec<&Cluster> = kept.map(|(_, cluster)| cluster).chain(new).collect();
        let points =
            new.iter().map(own).sum::<f64>() - old.iter().map(|&k| own(&self.clusters[k])).sum::<f64>();
        Ok(points + log_joints(model, &after)? - log_joints(model, &before)?)
    }

    /// The tree and its joints given (μ, Σ) of all clusters; some labels given these, with (μ, Σ) integrated out; and then
    /// (μ, Σ) given the points and joints of each (equations 16 to 18). The tree and the joints are forgotten again.
    fn draw_gaussians(&mut self, rng: &mut impl Rng) -> Result<(), Rounding> {
        let mut data = self.points_and_joints(rng)?;
        let mut labels = self.labels.clone();
        collapsed_labels(self.target.points, self.target.prior, &mut data, &mut labels, rng)?;
        self.take(labels)?;
        self.draw_gaussians_given(&data, rng)
    }

    /// The same with all labels kept.
    ///
    /// # Errors
    /// As for [`Self::start`].
    pub(crate) fn draw_gaussians_alone(&mut self, rng: &mut impl Rng) -> Result<(), Rounding> {
        let data = self.points_and_joints(rng)?;
        self.draw_gaussians_given(&data, rng)
    }

    /// The statistics of the points and joints of each cluster, for a tree and joints that are drawn.
    fn points_and_joints(&self, rng: &mut impl Rng) -> Result<Vec<SufficientStatistics>, Rounding> {
        let mut data: Vec<SufficientStatistics> =
            self.clusters.iter().map(|cluster| cluster.statistics.clone()).collect();
        for (i, j) in self.draw_tree(rng)? {
            let information = |k: usize| self.clusters[k].gaussian().information();
            let joint = draw_between(&information(i), &information(j), rng)?;
            data[i].add(joint.as_slice());
            data[j].add(joint.as_slice());
        }
        Ok(data)
    }

    fn draw_gaussians_given(
        &mut self,
        data: &[SufficientStatistics],
        rng: &mut impl Rng,
    ) -> Result<(), Rounding> {
        for (cluster, data) in self.clusters.iter_mut().zip(data) {
            cluster.take(self.target.prior.posterior(data)?.draw(rng));
        }
        Ok(())
    }

    /// Takes new labels of the same clusters, none of which is empty.
    fn take(&mut self, labels: Vec<usize>) -> Result<(), Rounding> {
        let mut members = vec![Vec::new(); self.clusters.len()];
        labels.iter().enumerate().for_each(|(i, &label)| members[label].push(i));
        for (cluster, members) in self.clusters.iter_mut().zip(members) {
            if members != cluster.members {
                cluster.statistics = SufficientStatistics::of(self.target.points, &members);
                cluster.log_marginal = self.target.prior.log_marginal(&cluster.statistics)?;
                cluster.members = members;
            }
        }
        self.labels = labels;
        Ok(())
    }

    /// A tree over the clusters, given their Gaussians; none without joints.
    fn draw_tree(&self, rng: &mut impl Rng) -> Result<Vec<(usize, usize)>, Rounding> {
        match self.target.model {
            Model::Dpgmm => Ok(Vec::new()),
            Model::DpgmmLj => Ok(self.graph()?.draw_tree(rng)),
        }
    }

    /// The weights of all trees over the clusters.
    ///
    /// # Errors
    /// As for [`Self::start`].
    pub(crate) fn graph(&self) -> Result<WeightedGraph, Rounding> {
        graph(&self.clusters.iter().map(|cluster| &cluster.moments).collect::<Vec<_>>())
    }

    /// The labels of all points but one of each cluster, given weights π of the clusters that there are (Chang and Fisher
    /// 2013). One point of each, drawn evenly, stays, so that none is emptied; that choice has the probability ∏ 1 / n_k, and
    /// new labels are accepted with what it becomes.
    fn draw_labels(&mut self, rng: &mut impl Rng) -> Result<(), Rounding> {
        let log_weights: Vec<f64> = self
            .clusters
            .iter()
            .map(|cluster| {
                let gamma = Gamma::new(cluster.count(), 1.0).expect("a cluster has points");
                rng.sample::<f64, _>(gamma).max(f64::MIN_POSITIVE).ln()
            })
            .collect();
        let anchors: Vec<usize> = self
            .clusters
            .iter()
            .map(|cluster| *cluster.members.choose(rng).expect("a cluster has points"))
            .collect();
        let gaussians: Vec<Gaussian> =
            self.clusters.iter().map(|cluster| cluster.gaussian().clone()).collect();
        let mut labels = self.labels.clone();
        assignments::draw_labels(self.target.points, &gaussians, &log_weights, false, &mut labels, rng);
        anchors.iter().enumerate().for_each(|(k, &anchor)| labels[anchor] = k);
        if labels == self.labels {
            return Ok(());
        }
        let mut counts = vec![0.0; self.clusters.len()];
        labels.iter().for_each(|&label| counts[label] += 1.0);
        let ratio: f64 = self
            .clusters
            .iter()
            .zip(counts)
            .map(|(cluster, count)| cluster.count().ln() - f64::ln(count))
            .sum();
        if accepted(ratio, rng) {
            self.take(labels)?;
        }
        Ok(())
    }

    /// Gives each point the number of its cluster.
    fn number(&mut self) {
        for (k, cluster) in self.clusters.iter().enumerate() {
            cluster.members.iter().for_each(|&i| self.labels[i] = k);
        }
    }

    /// A tree over the clusters, drawn; for the DPGMM that of Prim's algorithm over those of more than one point.
    ///
    /// # Errors
    /// As for [`Self::start`].
    pub(crate) fn edges(&self, rng: &mut impl Rng) -> Result<Vec<Edge>, Rounding> {
        if self.target.model == Model::Dpgmm {
            let means: Vec<_> = self.clusters.iter().map(|own| own.gaussian().mean()).collect();
            let nodes: Vec<usize> =
                (0..means.len()).filter(|&k| self.clusters[k].members.len() > 1).collect();
            return Ok(shortest(&nodes, &means));
        }
        Ok(self.draw_tree(rng)?.into_iter().map(|(child, parent)| Edge { child, parent }).collect())
    }

    /// log p(x, z) of the Dirichlet-process mixture, with π and all (μ, Σ) integrated out and the joints left out.
    pub(crate) fn log_posterior(&self) -> f64 {
        let concentration = self.target.concentration;
        let own = |cluster: &Cluster| cluster.log_mass(concentration);
        libm::lgamma(concentration) - libm::lgamma(concentration + self.labels.len() as f64)
            + self.clusters.iter().map(own).sum::<f64>()
    }
}

/// Log probability that some clusters, of so many, are drawn one after the other, and a point of each: 1 / (K n_1) for one, and
/// 1 / (K n_1 (K − 1) n_2) for two.
fn log_ends<'a>(clusters: usize, drawn: impl Iterator<Item = &'a Cluster>) -> f64 {
    drawn.enumerate().map(|(at, cluster)| -((clusters - at) as f64 * cluster.count()).ln()).sum()
}

/// Whether a proposal of this log acceptance ratio is accepted.
fn accepted(log_ratio: f64, rng: &mut impl Rng) -> bool {
    rng.random::<f64>().ln() < log_ratio
}

#[cfg(test)]
mod tests;
