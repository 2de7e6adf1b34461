//! Hold the state of a chain of the split–merge sampler: a partition of the points, and a Gaussian for each cluster.

use rand::Rng;

use crate::stages::mixture::{
    Augmented, Gaussian, NormalInverseWishart, Points, Rounding, SufficientStatistics,
};
use crate::stages::schema::joints::collapsed_cost;
use crate::stages::schema::settings::Model;
use crate::stages::schema::weighted_trees::WeightedGraph;

/// A cluster of the partition.
#[derive(Debug, Clone)]
pub(super) struct Cluster {
    /// Its points, rising.
    pub members: Vec<usize>,
    /// Their sufficient statistics.
    pub statistics: SufficientStatistics,
    /// log m(X): the marginal likelihood of its points.
    pub log_marginal: f64,
    /// (μ, Σ).
    gaussian: Gaussian,
    /// The same, as the weights of edges need it.
    pub moments: Augmented,
}

impl Cluster {
    /// A cluster of these points, its Gaussian drawn from their posterior.
    ///
    /// # Errors
    /// [`Rounding`].
    pub(super) fn draw(
        points: &Points,
        prior: &NormalInverseWishart,
        members: Vec<usize>,
        rng: &mut impl Rng,
    ) -> Result<Self, Rounding> {
        let statistics = SufficientStatistics::of(points, &members);
        let gaussian = prior.posterior(&statistics)?.draw(rng);
        let (log_marginal, moments) = (prior.log_marginal(&statistics)?, gaussian.moments());
        Ok(Self { members, statistics, log_marginal, gaussian, moments })
    }

    /// (μ, Σ).
    pub(super) fn gaussian(&self) -> &Gaussian {
        &self.gaussian
    }

    /// Takes another (μ, Σ).
    pub(super) fn take(&mut self, gaussian: Gaussian) {
        self.moments = gaussian.moments();
        self.gaussian = gaussian;
    }

    /// Number of its points.
    pub(super) fn count(&self) -> f64 {
        self.members.len() as f64
    }

    /// log (γ Γ(n) m(X)): its factor in p(x, z), the joints apart.
    pub(super) fn log_mass(&self, concentration: f64) -> f64 {
        concentration.ln() + libm::lgamma(self.count()) + self.log_marginal
    }
}

/// The weights of all trees over some Gaussians: N(μ_s; μ_c, Σ_s + Σ_c) for each edge, joints integrated out.
///
/// # Errors
/// [`Rounding`].
pub fn graph(moments: &[&Augmented]) -> Result<WeightedGraph, Rounding> {
    WeightedGraph::new(moments.len(), |i, j| Ok(-collapsed_cost(moments[i], moments[j])?))
}

/// log of the mean over all trees of ∏ N(μ_s; μ_c, Σ_s + Σ_c): the factor of the latent joints under a uniform prior over
/// the K^(K−2) trees of K clusters. 0 without joints.
///
/// # Errors
/// [`Rounding`].
pub(super) fn log_joints(model: Model, clusters: &[&Cluster]) -> Result<f64, Rounding> {
    if model == Model::Dpgmm || clusters.len() < 2 {
        return Ok(0.0);
    }
    let count = clusters.len() as f64;
    let moments: Vec<&Augmented> = clusters.iter().map(|cluster| &cluster.moments).collect();
    Ok(graph(&moments)?.log_sum() - (count - 2.0) * count.ln())
}
