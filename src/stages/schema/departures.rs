//! Name where the first author's public code departs from the paper's equations, each departure a setting of its own.
//!
//! T. Mimura, `Dirichlet_Process_Gaussian_Mixture_Model_with_Latent_Joints` on GitHub (mimuratomohiro), commits e258b30 and
//! db7d96b of 15 June 2017. What is here follows a description of what that code computes. Whether exactly that code made
//! the published figures is not said.

use serde::{Deserialize, Serialize};

use crate::numerics::range::{Checked, check, count};
pub use crate::stages::mixture::MeanCovariance;

/// Where Prim's algorithm starts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Root {
    /// At component 0, even if it is not active; then no two active components are joined.
    #[serde(rename = "component-0")]
    ComponentZero,
    /// At the first active component.
    FirstActive,
}

/// How the weights of a point's components are computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Densities {
    /// As densities. Where all of them underflow to 0, the point keeps its label.
    Plain,
    /// As logarithms of densities, which do not underflow.
    Logarithmic,
}

/// The distribution of a component without sensors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum EmptyComponents {
    /// The prior with the inverse of its scale Ψ₀, which is the prior itself where Ψ₀ is the identity.
    Inverse,
    /// The prior.
    Prior,
}

/// The departures of the authors' code, `[schema.authors]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Departures {
    /// Added to each density in an edge's weight, in the unit of densities on the map; 0: nothing. A collapsed weight has
    /// no such density.
    pub density_floor: f64,
    /// Number of sensors from which on a component is active; 2 in the paper ("more than one").
    pub smallest_part: usize,
    /// Where Prim's algorithm starts.
    pub root: Root,
    /// Whether a component that the tree does not join keeps a joint to the root, from the time when both were active or
    /// else at the origin of the map, and counts it as data where it has sensors.
    pub stale_joints: bool,
    /// How the weights of a point's components are computed.
    pub densities: Densities,
    /// Whether the joints of a component enter its scatter. They always enter its count and its mean.
    pub joints_in_scatter: bool,
    /// The covariance of a component's mean.
    pub mean_covariance: MeanCovariance,
    /// The distribution of a component without sensors.
    pub empty_components: EmptyComponents,
}

impl Departures {
    /// None: the equations of the paper.
    pub const NONE: Self = Self {
        density_floor: 0.0,
        smallest_part: 2,
        root: Root::FirstActive,
        stale_joints: false,
        densities: Densities::Logarithmic,
        joints_in_scatter: true,
        mean_covariance: MeanCovariance::Component,
        empty_components: EmptyComponents::Prior,
    };

    /// Weight of an edge from which on it is as good as none, where Prim's algorithm starts at component 0.
    pub const NO_EDGE: f64 = 16_777_216.0;

    /// Checks the range of each setting.
    ///
    /// # Errors
    /// The first setting that is outside its range.
    pub fn check(&self) -> Checked {
        let floor = self.density_floor;
        let range = "0 (no floor) to 1: it is added to a density";
        check("schema.authors.density_floor", floor, (0.0..=1.0).contains(&floor), range)?;
        count("schema.authors.smallest_part", self.smallest_part)
    }
}
