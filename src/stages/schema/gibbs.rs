//! Run one Gibbs sweep of the DPGMM or the DPGMM-LJ (algorithm 1, equations 15 to 22).
//!
//! The order is z, (μ, Σ), π, then the joints q and the tree C. The paper has q before π; neither depends on the other. (μ, Σ) of
//! a component are drawn together, which has the same target as drawing one given the other. z, (μ, Σ) and π are draws from full
//! conditionals under the weak-limit approximation (Ishwaran & Zarepour 2002). C is not: it is set to the tree of highest probability
//! instead of being drawn, as the paper does, so that the chain is only approximately a Gibbs sampler of the DPGMM-LJ ("approximate
//! Gibbs sampling", section 3.3). With `pairwise` edge weights, the joints that are kept are those of the chosen edges, so that q is
//! no draw from its conditional, either. With the tree held fixed the sweep is exact.
//!
//! The first author's code has the same order but for π and (μ, Σ), which do not depend on each other; where
//! else it departs from the equations, [`Departures`] say.

use nalgebra::{DMatrix, DVector};
use rand::distr::weighted::WeightedIndex;
use rand::{Rng, RngExt};
use rand_distr::{Beta, Gamma};

use super::components::Components;
use super::departures::{Densities, Departures};
use super::error::InferenceError;
use super::latent_tree::{LatentTree, Update};
use super::settings::{Model, Schema, Start};
use crate::stages::mixture::{
    Gaussian, NormalInverseWishart, Points, SufficientStatistics, assignments, lloyd,
};
use crate::stages::tree::{Edge, shortest};

/// The state of one chain.
pub struct Chain<'a> {
    points: &'a Points,
    prior: &'a NormalInverseWishart,
    settings: &'a Schema,
    departures: &'a Departures,
    components: Components<'a>,
    model: Model,
    /// z: the component of each point.
    pub labels: Vec<usize>,
    /// (μ, Σ) of each of the K components.
    pub gaussians: Vec<Gaussian>,
    /// log π.
    pub log_weights: Vec<f64>,
    /// q and C. Without joints for a DPGMM.
    pub tree: LatentTree,
    /// Sufficient statistics of each component's points.
    statistics: Vec<SufficientStatistics>,
}

impl<'a> Chain<'a> {
    /// Starts a chain from the labels that `settings.start` asks for, and draws all other variables given them.
    ///
    /// # Errors
    /// [`InferenceError::Rounding`] if a covariance is not positive definite in floating point.
    pub fn start(
        points: &'a Points,
        prior: &'a NormalInverseWishart,
        settings: &'a Schema,
        model: Model,
        rng: &mut impl Rng,
    ) -> Result<Self, InferenceError> {
        let labels = match settings.start {
            Start::StickBreaking => Vec::new(),
            _ => start_labels(points, settings, rng),
        };
        let departures = settings.departures();
        let mut chain = Self {
            points,
            prior,
            settings,
            components: Components::new(prior, departures)?,
            departures,
            model,
            labels,
            gaussians: Vec::new(),
            log_weights: Vec::new(),
            tree: LatentTree::new(points.origin()),
            statistics: Vec::new(),
        };
        if settings.start == Start::StickBreaking {
            chain.break_stick(rng);
            chain.update_joints(rng)?;
        } else {
            chain.update_statistics();
            chain.draw_given_labels(rng)?;
        }
        Ok(chain)
    }

    /// Runs one sweep: updates every variable once.
    ///
    /// # Errors
    /// As for [`Self::start`].
    pub fn sweep(&mut self, rng: &mut impl Rng) -> Result<(), InferenceError> {
        self.draw_labels(rng);
        self.update_statistics();
        let (statistics, smallest) = (&self.statistics, self.departures.smallest_part as f64);
        self.tree.drop_inactive(self.departures, |k| statistics[k].count() >= smallest);
        self.draw_given_labels(rng)
    }

    fn draw_given_labels(&mut self, rng: &mut impl Rng) -> Result<(), InferenceError> {
        self.draw_gaussians(rng)?;
        self.draw_weights(rng);
        self.update_joints(rng)
    }

    fn update_joints(&mut self, rng: &mut impl Rng) -> Result<(), InferenceError> {
        match self.model {
            Model::Dpgmm => Ok(()),
            Model::DpgmmLj => self.update_tree(rng),
        }
    }

    /// Starts as the authors' code does: π by stick-breaking with β_k ~ Beta(1, γ/K), z drawn from π alone, μ the centres
    /// of k-means and Σ the identity.
    fn break_stick(&mut self, rng: &mut impl Rng) {
        let (points, size) = (self.points, self.settings.components);
        let weights = stick(self.settings, rng);
        self.labels = labels_from(&weights, points.count, rng);
        self.log_weights = weights.iter().map(|weight| weight.ln()).collect();
        let clusters = statistics(points, &lloyd(points, size, rng).labels, size);
        let identity = DMatrix::identity(points.dims, points.dims);
        self.gaussians = clusters.iter().map(|data| Gaussian::new(data.mean(), identity.clone())).collect();
        self.update_statistics();
    }

    /// z_i ~ Categorical ∝ π_k N(x_i; μ_k, Σ_k) (equation 15).
    fn draw_labels(&mut self, rng: &mut impl Rng) {
        let underflow = self.departures.densities == Densities::Plain;
        let (gaussians, weights) = (&self.gaussians, &self.log_weights);
        assignments::draw_labels(self.points, gaussians, weights, underflow, &mut self.labels, rng);
    }

    /// Computes the sufficient statistics of each component from the labels.
    fn update_statistics(&mut self) {
        self.statistics = statistics(self.points, &self.labels, self.settings.components);
    }

    /// (μ_k, Σ_k) given the component's points and joints (equations 16 and 17).
    fn draw_gaussians(&mut self, rng: &mut impl Rng) -> Result<(), InferenceError> {
        self.gaussians = self.components.draw(&self.statistics, &self.tree, rng)?;
        Ok(())
    }

    /// π ~ Dir(γ/K + n_1, …, γ/K + n_K) (equation 19), as Gamma draws that are not divided by their sum: no update
    /// needs the sum.
    fn draw_weights(&mut self, rng: &mut impl Rng) {
        let share = self.settings.concentration / self.settings.components as f64;
        let draw = |data: &SufficientStatistics| {
            let gamma = Gamma::new(share + data.count(), 1.0).expect("γ > 0");
            rng.sample::<f64, _>(gamma).ln()
        };
        self.log_weights = self.statistics.iter().map(draw).collect();
    }

    /// q and C (equations 18 and 22).
    fn update_tree(&mut self, rng: &mut impl Rng) -> Result<(), InferenceError> {
        let update = Update {
            components: &self.gaussians,
            active: &self.active(),
            edge_weight: self.settings.edge_weight,
            departures: self.departures,
        };
        self.tree.update(update, rng)
    }

    /// The active components: those of more than one point (section 3.2), or as many as `schema.authors.smallest_part` says.
    pub fn active(&self) -> Vec<usize> {
        let smallest = self.departures.smallest_part as f64;
        (0..self.statistics.len()).filter(|&k| self.statistics[k].count() >= smallest).collect()
    }

    /// The tree of this state. For the DPGMM-LJ it is C. For the DPGMM it is the baseline of section 5.2: Prim's
    /// algorithm on the Euclidean distances between the means of the components.
    pub fn edges(&self) -> Vec<Edge> {
        match self.model {
            Model::DpgmmLj => self.tree.joints.iter().map(|joint| joint.edge).collect(),
            Model::Dpgmm => {
                let means: Vec<DVector<f64>> = self.gaussians.iter().map(Gaussian::mean).collect();
                shortest(&self.active(), &means)
            }
        }
    }

    /// q of each edge of the tree, on the body map. None for a DPGMM.
    pub fn joints(&self) -> Vec<Vec<f64>> {
        self.tree.joints.iter().map(|joint| self.points.uncentred(&joint.position)).collect()
    }

    /// log p(x, z) with π and all (μ, Σ) integrated out, all constants included.
    ///
    /// Both models use that of the DPGMM, so that their posterior samples can be compared. The joints are left out: with them, μ
    /// and Σ cannot be integrated in closed form.
    ///
    /// # Errors
    /// [`InferenceError::Rounding`].
    pub fn log_posterior(&self) -> Result<f64, InferenceError> {
        let concentration = self.settings.concentration;
        let share = concentration / self.settings.components as f64;
        let labels = libm::lgamma(concentration) - libm::lgamma(concentration + self.points.count as f64);
        let occupied = self.statistics.iter().filter(|data| data.count() > 0.0);
        let component = |data: &SufficientStatistics| {
            let count = libm::lgamma(share + data.count()) - libm::lgamma(share);
            Ok(count + self.prior.log_marginal(data)?)
        };
        Ok(labels + occupied.map(component).sum::<Result<f64, InferenceError>>()?)
    }
}

/// The labels that a chain starts with, before anything else is drawn.
pub(super) fn start_labels(points: &Points, settings: &Schema, rng: &mut impl Rng) -> Vec<usize> {
    let components = settings.components;
    match settings.start.of_chain(0) {
        Start::Uniform => (0..points.count).map(|_| rng.random_range(0..components)).collect(),
        Start::KMeans => lloyd(points, components, rng).labels,
        Start::Single | Start::Overdispersed => vec![0; points.count],
        Start::StickBreaking => labels_from(&stick(settings, rng), points.count, rng),
    }
}

/// Weights of the K components by stick-breaking, with β_k ~ Beta(1, γ/K).
fn stick(settings: &Schema, rng: &mut impl Rng) -> Vec<f64> {
    let size = settings.components;
    let beta = Beta::new(1.0, settings.concentration / size as f64).expect("γ > 0");
    let mut rest = 1.0;
    let mut piece = || {
        let broken = rng.sample::<f64, _>(beta);
        (rest * broken, rest *= 1.0 - broken).0
    };
    (0..size).map(|_| piece()).collect()
}

fn labels_from(weights: &[f64], count: usize, rng: &mut impl Rng) -> Vec<usize> {
    let draw = WeightedIndex::new(weights).expect("the first piece is positive");
    (0..count).map(|_| rng.sample(&draw)).collect()
}

/// Sufficient statistics of each component's points.
fn statistics(points: &Points, labels: &[usize], components: usize) -> Vec<SufficientStatistics> {
    let mut members = vec![Vec::new(); components];
    for (i, &label) in labels.iter().enumerate() {
        members[label].push(i);
    }
    members.iter().map(|members| SufficientStatistics::of(points, members)).collect()
}

#[cfg(test)]
mod tests;
