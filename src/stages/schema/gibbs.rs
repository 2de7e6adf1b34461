//! Run one Gibbs sweep of the DPGMM or the DPGMM-LJ (algorithm 1, equations 15 to 22).
//!
//! Order as in the paper: z, then (μ, Σ), then π, then the joints q and the tree C. (μ, Σ) of a component
//! are drawn together, which has the same target as drawing one given the other. All but the last update
//! are draws from full conditionals under the weak-limit approximation (Ishwaran & Zarepour 2002). The
//! last is not: C is set to the tree of highest probability instead of being drawn, as the paper does, so
//! that the chain is only approximately a Gibbs sampler of the DPGMM-LJ ("approximate Gibbs sampling",
//! section 3.3). With the tree held fixed it is exact.

use nalgebra::DVector;
use rand::{Rng, RngExt};
use rand_distr::Gamma;

use super::error::InferenceError;
use super::joints;
use super::settings::{EdgeWeight, Model, Schema, Start};
use crate::stages::mixture::{
    Augmented, Gaussian, NormalInverseWishart, Points, Rounding, SufficientStatistics, assignments, lloyd,
};
use crate::stages::tree::{Edge, prim};

/// A latent joint with its edge of the tree.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// The components it connects.
    pub edge: Edge,
    /// q, in the coordinates of the centred points.
    pub position: DVector<f64>,
}

/// The state of one chain.
pub struct Chain<'a> {
    points: &'a Points,
    prior: &'a NormalInverseWishart,
    settings: &'a Schema,
    model: Model,
    /// z: the component of each point.
    pub labels: Vec<usize>,
    /// (μ, Σ) of each of the K components.
    pub gaussians: Vec<Gaussian>,
    /// log π.
    pub log_weights: Vec<f64>,
    /// q and C: a joint for each edge of the tree. Empty for a DPGMM.
    pub joints: Vec<Joint>,
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
        let components = settings.components;
        let labels = match settings.start {
            Start::Uniform => (0..points.count).map(|_| rng.random_range(0..components)).collect(),
            Start::KMeans => lloyd(points, components, rng).labels,
            Start::Single => vec![0; points.count],
        };
        let mut chain = Self {
            points,
            prior,
            settings,
            model,
            labels,
            gaussians: Vec::new(),
            log_weights: Vec::new(),
            joints: Vec::new(),
            statistics: Vec::new(),
        };
        chain.update_statistics();
        chain.draw_given_labels(rng)?;
        Ok(chain)
    }

    /// Runs one sweep: updates every variable once.
    ///
    /// # Errors
    /// As for [`Self::start`].
    pub fn sweep(&mut self, rng: &mut impl Rng) -> Result<(), InferenceError> {
        self.draw_labels(rng);
        self.update_statistics();
        self.drop_inactive_joints();
        self.draw_given_labels(rng)
    }

    fn draw_given_labels(&mut self, rng: &mut impl Rng) -> Result<(), InferenceError> {
        self.draw_gaussians(rng)?;
        self.draw_weights(rng);
        match self.model {
            Model::Dpgmm => Ok(()),
            Model::DpgmmLj => self.update_tree(rng),
        }
    }

    /// z_i ~ Categorical ∝ π_k N(x_i; μ_k, Σ_k) (equation 15).
    fn draw_labels(&mut self, rng: &mut impl Rng) {
        assignments::draw_labels(self.points, &self.gaussians, &self.log_weights, &mut self.labels, rng);
    }

    /// Computes the sufficient statistics of each component from the labels.
    fn update_statistics(&mut self) {
        let mut members = vec![Vec::new(); self.settings.components];
        for (i, &label) in self.labels.iter().enumerate() {
            members[label].push(i);
        }
        self.statistics =
            members.iter().map(|members| SufficientStatistics::of(self.points, members)).collect();
    }

    /// Drops the joints of components that are no longer active: a joint is drawn "for each activated
    /// component" (section 3.2).
    fn drop_inactive_joints(&mut self) {
        let statistics = &self.statistics;
        self.joints.retain(|Joint { edge, .. }| {
            is_active(&statistics[edge.child]) && is_active(&statistics[edge.parent])
        });
    }

    /// (μ_k, Σ_k) given the component's points and joints (equations 16 and 17).
    fn draw_gaussians(&mut self, rng: &mut impl Rng) -> Result<(), InferenceError> {
        let mut data = self.statistics.clone();
        for Joint { edge, position } in &self.joints {
            data[edge.child].add(position.as_slice());
            data[edge.parent].add(position.as_slice());
        }
        let draw = |data: &SufficientStatistics| Ok(self.prior.posterior(data)?.draw(rng));
        self.gaussians = data.iter().map(draw).collect::<Result<_, InferenceError>>()?;
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

    /// Draws q, and sets C to the minimum spanning tree over the active components (equations 18 and 22).
    fn update_tree(&mut self, rng: &mut impl Rng) -> Result<(), InferenceError> {
        let active = self.active();
        let informations = self.informations(&active);
        self.joints = match self.settings.edge_weight {
            EdgeWeight::Literal => self.literal_tree(&active, &informations, rng),
            EdgeWeight::Pairwise => self.pairwise_tree(&active, &informations, rng),
            EdgeWeight::Collapsed => self.collapsed_tree(&active, &informations, rng),
        }?;
        Ok(())
    }

    /// The information matrix of each active component, which the draws of its joints need.
    fn informations(&self, active: &[usize]) -> Informations {
        let mut informations = vec![None; self.gaussians.len()];
        active.iter().for_each(|&k| informations[k] = Some(self.gaussians[k].information()));
        Informations(informations)
    }

    /// The tree weighed by the joint that each child has ([`EdgeWeight::Literal`]).
    ///
    /// Each component but the root has one joint, drawn given the parent it has. A component that has no parent (newly
    /// active, or the root of the last tree) draws its joint from its own Gaussian.
    fn literal_tree(
        &self,
        active: &[usize],
        informations: &Informations,
        rng: &mut impl Rng,
    ) -> Result<Vec<Joint>, InferenceError> {
        let components = &self.gaussians;
        let mut own: Vec<Option<DVector<f64>>> = vec![None; components.len()];
        for &s in active {
            let edge = self.joints.iter().map(|joint| joint.edge).find(|edge| edge.child == s);
            own[s] = Some(match edge {
                Some(edge) => informations.draw_joint(edge, rng)?,
                None => components[s].draw(rng),
            });
        }
        let joint = |s: usize| own[s].as_ref().expect("every active component has a joint");
        let edges = prim(active, |s, c| joints::cost(joint(s), &components[s], &components[c]));
        Ok(edges.into_iter().map(|edge| Joint { edge, position: joint(edge.child).clone() }).collect())
    }

    /// The tree weighed by a joint for each pair of components ([`EdgeWeight::Pairwise`]).
    fn pairwise_tree(
        &self,
        active: &[usize],
        informations: &Informations,
        rng: &mut impl Rng,
    ) -> Result<Vec<Joint>, InferenceError> {
        let components = &self.gaussians;
        let size = components.len();
        let mut drawn: Vec<Option<(f64, DVector<f64>)>> = vec![None; size * size];
        for (at, &s) in active.iter().enumerate() {
            for &c in &active[..at] {
                let q = informations.draw_joint(Edge { child: s, parent: c }, rng)?;
                drawn[c * size + s] = Some((joints::cost(&q, &components[s], &components[c]), q));
            }
        }
        let pair = |s: usize, c: usize| {
            drawn[s.min(c) * size + s.max(c)].as_ref().expect("drawn for every active pair")
        };
        let edges = prim(active, |s, c| pair(s, c).0);
        let joint = |edge: Edge| Joint { edge, position: pair(edge.child, edge.parent).1.clone() };
        Ok(edges.into_iter().map(joint).collect())
    }

    /// The tree weighed with the joints integrated out, and then a joint for each of its edges
    /// ([`EdgeWeight::Collapsed`]).
    fn collapsed_tree(
        &self,
        active: &[usize],
        informations: &Informations,
        rng: &mut impl Rng,
    ) -> Result<Vec<Joint>, InferenceError> {
        let components = &self.gaussians;
        let mut lost = None;
        let cost = |s: usize, c: usize| {
            joints::collapsed_cost(&components[s], &components[c]).unwrap_or_else(|error| {
                lost = Some(error);
                f64::INFINITY
            })
        };
        let edges = prim(active, cost);
        if let Some(error) = lost {
            return Err(error.into());
        }
        let joint = |edge| Ok(Joint { edge, position: informations.draw_joint(edge, rng)? });
        edges.into_iter().map(joint).collect()
    }

    /// The active components: those of more than one point (section 3.2).
    pub fn active(&self) -> Vec<usize> {
        (0..self.statistics.len()).filter(|&k| is_active(&self.statistics[k])).collect()
    }

    /// The tree of this state. For the DPGMM-LJ it is C. For the DPGMM it is the baseline of section 5.2: Prim's
    /// algorithm on the Euclidean distances between the means of the components.
    pub fn tree(&self) -> Vec<Edge> {
        match self.model {
            Model::DpgmmLj => self.joints.iter().map(|joint| joint.edge).collect(),
            Model::Dpgmm => {
                let means: Vec<DVector<f64>> = self.gaussians.iter().map(Gaussian::mean).collect();
                prim(&self.active(), |a, b| means[a].metric_distance(&means[b]))
            }
        }
    }

    /// log p(x, z) with π and all (μ, Σ) integrated out, all constants included.
    ///
    /// Both models use that of the DPGMM, so that their draws can be compared. The joints are left out: with them, μ
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

/// The [information](Gaussian::information) of each active component.
struct Informations(Vec<Option<Augmented>>);

impl Informations {
    /// Draws a joint on an edge between two active components (equation 18).
    fn draw_joint(&self, edge: Edge, rng: &mut impl Rng) -> Result<DVector<f64>, Rounding> {
        let information = |k: usize| self.0[k].as_ref().expect("joints connect active components");
        joints::draw_between(information(edge.child), information(edge.parent), rng)
    }
}

fn is_active(data: &SufficientStatistics) -> bool {
    data.count() > 1.0
}

#[cfg(test)]
mod tests;
