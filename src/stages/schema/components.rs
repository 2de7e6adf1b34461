//! Sample (μ, Σ) of every component given its sensors and joints (equations 16 and 17).

use nalgebra::{DMatrix, DVector};
use rand::Rng;

use super::departures::{Departures, EmptyComponents};
use super::error::InferenceError;
use super::latent_tree::{Joint, LatentTree};
use crate::stages::mixture::{Gaussian, NormalInverseWishart, Rounding, SufficientStatistics};

/// The conditional distributions of the components.
#[derive(Debug)]
pub struct Components<'a> {
    prior: &'a NormalInverseWishart,
    /// Its m₀ and Ψ₀, which every draw starts from.
    mean: DVector<f64>,
    scale: DMatrix<f64>,
    /// What a component without sensors is drawn from, if that is not the prior.
    empty: Option<NormalInverseWishart>,
    departures: &'a Departures,
}

impl<'a> Components<'a> {
    /// Under a prior, and with the departures from the equations that are asked for.
    ///
    /// # Errors
    /// [`InferenceError::Rounding`] if the inverse of the prior's scale is not positive definite in floating point.
    pub fn new(prior: &'a NormalInverseWishart, departures: &'a Departures) -> Result<Self, InferenceError> {
        let empty = match departures.empty_components {
            EmptyComponents::Prior => None,
            EmptyComponents::Inverse => Some(prior.with_inverse_scale().ok_or(Rounding)?),
        };
        Ok(Self { prior, mean: prior.mean(), scale: prior.scale(), empty, departures })
    }

    /// Draws all components.
    ///
    /// # Errors
    /// [`InferenceError::Rounding`] if a scale is not positive definite in floating point.
    pub fn draw(
        &self,
        statistics: &[SufficientStatistics],
        tree: &LatentTree,
        rng: &mut impl Rng,
    ) -> Result<Vec<Gaussian>, InferenceError> {
        let posteriors = self.posteriors(statistics, tree);
        posteriors.map(|posterior| Ok(posterior?.draw_with(self.departures.mean_covariance, rng))).collect()
    }

    /// What each component is drawn from, given the sufficient statistics of its sensors.
    pub fn posteriors<'b>(
        &'b self,
        statistics: &'b [SufficientStatistics],
        tree: &'b LatentTree,
    ) -> impl Iterator<Item = Result<NormalInverseWishart, Rounding>> + 'b {
        let joints = self.joints_of(statistics, tree);
        statistics.iter().zip(joints).map(|(sensors, joints)| match &self.empty {
            Some(empty) if sensors.count() == 0.0 => Ok(empty.clone()),
            _ if self.departures.joints_in_scatter || joints.is_empty() => {
                let mut data = sensors.clone();
                joints.iter().for_each(|joint| data.add(joint.as_slice()));
                self.prior.posterior(&data)
            }
            _ => self.without_scatter(sensors, &joints),
        })
    }

    /// The joints that each component takes for data.
    fn joints_of<'b>(
        &self,
        statistics: &[SufficientStatistics],
        tree: &'b LatentTree,
    ) -> Vec<Vec<&'b DVector<f64>>> {
        let mut joints = vec![Vec::new(); statistics.len()];
        let occupied = |k: usize| statistics[k].count() > 0.0;
        for Joint { edge, position } in tree.joints.iter().chain(&tree.stale) {
            // A joint of components that were active when it was drawn.
            if !self.departures.stale_joints || occupied(edge.child) {
                joints[edge.child].push(position);
                if !self.departures.stale_joints || occupied(edge.parent) {
                    joints[edge.parent].push(position);
                }
            }
        }
        joints
    }

    /// The posterior in which joints count and move the mean, but do not enter the scatter about it.
    ///
    /// With N sensors and joints together of mean x̄, n sensors of mean x̄ₛ: Ψ = Ψ₀ + Σ (x − x̄ₛ)(x − x̄ₛ)ᵀ + n (x̄ₛ − x̄)(x̄ₛ − x̄)ᵀ
    /// + k₀ N / (k₀ + N) (x̄ − m₀)(x̄ − m₀)ᵀ, a sum of what is never negative.
    fn without_scatter(
        &self,
        sensors: &SufficientStatistics,
        joints: &[&DVector<f64>],
    ) -> Result<NormalInverseWishart, Rounding> {
        let Self { prior, mean: before, .. } = self;
        let (count, own) = (sensors.count(), sensors.mean());
        let total = count + joints.len() as f64;
        let sum = joints.iter().fold(&own * count, |sum, joint| sum + *joint);
        let (mean, weight) = (sum / total, prior.mean_weight());
        let mut scale = self.scale.clone();
        if count > 0.0 {
            scale += sensors.scatter();
        }
        let (apart, pulled) = (own - &mean, &mean - before);
        scale.ger(count, &apart, &apart, 1.0);
        scale.ger(weight * total / (weight + total), &pulled, &pulled, 1.0);
        let centre = (before * weight + mean * total) / (weight + total);
        let freedom = prior.degrees_of_freedom + total;
        NormalInverseWishart::new(centre, weight + total, scale, freedom).ok_or(Rounding)
    }
}
