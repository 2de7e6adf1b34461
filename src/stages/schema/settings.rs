//! Settings of the two mixture models and their sampler, `[schema]`, with their ranges.

use serde::{Deserialize, Serialize};

use super::departures::Departures;
use super::error::MAX_LABELS;
use crate::numerics::range::{Checked, check, count, moderate};

/// The mixture model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Model {
    /// Dirichlet-process Gaussian mixture model; its tree is found afterwards by Prim's algorithm.
    Dpgmm,
    /// The DPGMM with latent joints: the paper's method.
    DpgmmLj,
}

impl Model {
    /// Both models, the baseline first.
    pub const ALL: [Self; 2] = [Self::Dpgmm, Self::DpgmmLj];

    /// Name on the command line and in every file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Dpgmm => "dpgmm",
            Self::DpgmmLj => "dpgmm-lj",
        }
    }
}

/// The weight of an edge in the update of the tree (equation 22).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum EdgeWeight {
    /// Each child keeps its joint q_s, whichever parent it is weighed with.
    Literal,
    /// A joint is drawn for each pair of active components, and gives the weight of that pair.
    Pairwise,
    /// The joint is integrated out: −log N(μ_s; μ_c, Σ_s + Σ_c).
    Collapsed,
}

/// How the labels of a chain are initialised.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Start {
    /// Uniform over the K components.
    Uniform,
    /// The K clusters of k-means from one random start.
    KMeans,
    /// All points in one component.
    Single,
    /// Weights by stick-breaking, labels from them alone, means by k-means, and identity covariances.
    StickBreaking,
    /// Overdispersed starts, one chain after the other: all points in one component, k-means, uniform.
    #[serde(rename = "apart")]
    Overdispersed,
}

impl Start {
    /// What a chain of this number starts with.
    pub fn of_chain(self, chain: usize) -> Self {
        match self {
            Self::Overdispersed => [Self::Single, Self::KMeans, Self::Uniform][chain % 3],
            own => own,
        }
    }
}

/// The scale Ψ₀ of the components' prior; the setting `scale` multiplies it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Prior {
    /// covariance(x) / K^(2/d), by Fraley & Raftery (2007).
    FraleyRaftery,
    /// The identity, in the unit of the map.
    Identity,
    /// covariance(x)⁻¹.
    InverseCovariance,
}

/// The algorithm that samples the posterior: Gibbs sampling by the paper's equations or by the authors' code, or split–merge moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sampler {
    /// The paper's equations.
    Equations,
    /// The first author's public code, as [`Departures`] from the equations.
    AuthorsCode,
    /// Neither: split–merge moves on the mixture without truncation, with joints and trees integrated out.
    SplitMerge,
}

impl Sampler {
    /// The interpretation of the paper in words, as a headline has it.
    pub fn in_words(self) -> &'static str {
        match self {
            Self::Equations => "equations interpretation",
            Self::AuthorsCode => "authors' code interpretation",
            Self::SplitMerge => "split-merge sampler",
        }
    }
}

/// Which posterior samples of a chain are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Keep {
    /// The last one.
    Last,
    /// Every one after burn-in.
    All,
}

/// The mixture, its prior and its sampler (section 3).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Schema {
    /// The algorithm that samples the posterior.
    pub sampler: Sampler,
    /// K, number of components of the weak-limit approximation.
    pub components: usize,
    /// γ of Dir(γ/K).
    pub concentration: f64,
    /// k₀, weight of the prior mean, in observations.
    pub mean_weight: f64,
    /// ν₀ − d, where ν₀ > d − 1 are the degrees of freedom of the inverse Wishart.
    pub extra_freedom: f64,
    /// The prior scale Ψ₀.
    pub prior: Prior,
    /// Multiplies the prior scale.
    pub scale: f64,
    /// Weight of the tree's edges.
    pub edge_weight: EdgeWeight,
    /// What a chain starts with.
    pub start: Start,
    /// Gibbs sweeps of each chain.
    pub sweeps: usize,
    /// Independent chains.
    pub chains: usize,
    /// Which posterior samples are kept.
    pub keep: Keep,
    /// Sweeps dropped where every posterior sample is kept.
    pub burn_in: usize,
    /// How the authors' code departs from the equations; they count where it is the sampler.
    pub authors: Departures,
}

impl Schema {
    /// How the sampler departs from the equations.
    pub fn departures(&self) -> &Departures {
        match self.sampler {
            Sampler::Equations | Sampler::SplitMerge => &Departures::NONE,
            Sampler::AuthorsCode => &self.authors,
        }
    }

    /// Number of posterior samples that are kept.
    pub fn posterior_samples(&self) -> usize {
        match self.keep {
            Keep::Last => self.chains,
            Keep::All => self.chains.saturating_mul(self.sweeps.saturating_sub(self.burn_in)),
        }
    }

    /// Checks the range of each setting, and that the posterior samples of `sensors` sensors are not too many to keep.
    ///
    /// # Errors
    /// The first setting that is outside its range.
    pub fn check(&self, sensors: usize) -> Checked {
        check("schema.components", self.components, (1..=1000).contains(&self.components), "1 to 1000")?;
        moderate("schema.concentration", self.concentration)?;
        moderate("schema.mean_weight", self.mean_weight)?;
        let freedom = self.extra_freedom;
        check("schema.extra_freedom", freedom, (-0.99..=1e6).contains(&freedom), "-0.99 to 1000000")?;
        moderate("schema.scale", self.scale)?;
        count("schema.sweeps", self.sweeps)?;
        check("schema.chains", self.chains, (1..=1_000_000).contains(&self.chains), "1 to 1000000")?;
        let sweeps = self.chains.saturating_mul(self.sweeps);
        check("schema.chains * schema.sweeps", sweeps, sweeps <= 1_000_000_000, "at most 1000000000")?;
        if self.keep == Keep::All {
            check("schema.burn_in", self.burn_in, self.burn_in < self.sweeps, "below schema.sweeps")?;
        }
        self.authors.check()?;
        let samples = self.posterior_samples();
        check(
            "schema.chains * (schema.sweeps - schema.burn_in)",
            samples,
            samples <= 1_000_000 && samples * sensors <= MAX_LABELS,
            "at most 1000000 samples where all are kept, and at most 1000000000 labels with all sensors",
        )
    }
}
