//! Read what the paper claims and shows from `reproduce/published.toml`.

use serde::{Deserialize, Serialize};

use crate::stages::schema::Model;

/// Short name of the claim that the paper is cited for.
pub(crate) const HEADLINE: &str = "tree-accuracy";

const PUBLISHED: &str = include_str!("../../reproduce/published.toml");

/// An experiment of the paper.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Experiment {
    /// Section 5: body schema estimation over the dimensions d of the body map.
    Exp1,
    /// Section 6: body schema estimation over the ratios p of motor coordination.
    Exp2,
}

impl Experiment {
    /// Name on the command line and in every file.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Exp1 => "exp1",
            Self::Exp2 => "exp2",
        }
    }
}

/// A checkable statement of the paper.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Claim {
    /// Short name.
    pub id: String,
    /// The experiments that show it.
    pub experiments: Vec<Experiment>,
    /// Number of the figure that shows it; empty if none does.
    pub figure: String,
    /// Where the paper says so.
    pub place: String,
    /// What it says.
    pub statement: String,
    /// Its value as a number, where the paper gives one.
    #[serde(default)]
    pub published: Option<f64>,
    /// Its value, in the paper's words.
    pub wording: String,
    /// The reproduced values that count as reproduced: a closed range.
    #[serde(default)]
    pub accept: Option<(f64, f64)>,
    /// Successes and trials that a published rate may stand for.
    #[serde(default)]
    pub possible_counts: Vec<(usize, usize)>,
    /// What is measured.
    pub measure: Measure,
}

/// The conditions that a claim is about: all combinations.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct At {
    /// The mixtures; DPGMM-LJ if not given.
    #[serde(default = "joints")]
    pub models: Vec<Model>,
    /// d; those that were run if not given.
    #[serde(default)]
    pub dimensions: Vec<usize>,
    /// p; those that were run if not given.
    #[serde(default)]
    pub coordinations: Vec<f64>,
}

fn joints() -> Vec<Model> {
    vec![Model::DpgmmLj]
}

/// What a claim is about.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub(crate) enum Measure {
    /// Rate of right trees among the eligible posterior samples, at each condition.
    TreeRate {
        /// The conditions.
        at: At,
    },
    /// The same over the posterior samples of all conditions together.
    PooledTreeRate {
        /// The conditions.
        at: At,
    },
    /// Share of all posterior samples that are eligible and have the right tree, at each condition.
    TreeShare {
        /// The conditions.
        at: At,
    },
    /// Mean number of parts, at each condition.
    MeanParts {
        /// The conditions.
        at: At,
    },
    /// Most frequent number of parts, at each condition.
    ModalParts {
        /// The conditions.
        at: At,
    },
    /// Mean adjusted Rand index, at each condition.
    MeanAri {
        /// The conditions.
        at: At,
    },
    /// Median of the adjusted Rand index, at each condition.
    MedianAri {
        /// The conditions.
        at: At,
    },
    /// Smallest p value, after Holm's correction, of Mann–Whitney tests between both mixtures' ARI at each d.
    AriDifference {
        /// d.
        dimensions: Vec<usize>,
    },
    /// Share of the dimensions at which the mean ARI of DPGMM-LJ is lower than that of DPGMM.
    AriWorse {
        /// d.
        dimensions: Vec<usize>,
    },
    /// The dimension with the highest tree rate; the named one if it is among them.
    BestDimension {
        /// The dimension that wins a tie.
        dimension: usize,
    },
    /// The p with the highest tree rate; the named one if it is among them.
    BestCoordination {
        /// The p that wins a tie.
        coordination: f64,
    },
    /// The smallest dimension from which on every tree rate is at least one half.
    FirstDimension {},
    /// p value of the Kruskal–Wallis test that the simulations' tree rates have one distribution at all p
    /// with eligible posterior samples. The simulation is the unit, so that it takes several.
    TreeDependence {},
    /// Share of the conditions, methods by dimensions, in which the mean ARI of the clusterings that are
    /// told the number of clusters exceeds a threshold.
    BaselineShare {
        /// K.
        clusters: usize,
        /// The threshold.
        threshold: f64,
    },
    /// For each of these clusterings, by how much its ARI, averaged over d, is higher with the right number of
    /// clusters than with another.
    BaselineLoss {
        /// The right K.
        right: usize,
        /// The other.
        other: usize,
    },
    /// Nothing that a program could compute.
    Nothing {
        /// Why.
        reason: String,
    },
}

/// Unit of a claim's values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Unit {
    /// A fraction from 0 to 1: of posterior samples, conditions or dimensions.
    Rate,
    /// A number of parts.
    Parts,
    /// An adjusted Rand index, or a difference of two.
    Ari,
    /// d.
    Dimension,
    /// p.
    Coordination,
    /// The p value of a test.
    PValue,
}

impl Measure {
    /// The unit of its values; `None` if nothing is measured.
    pub(crate) fn unit(&self) -> Option<Unit> {
        Some(match self {
            Self::TreeRate { .. }
            | Self::PooledTreeRate { .. }
            | Self::TreeShare { .. }
            | Self::AriWorse { .. }
            | Self::BaselineShare { .. } => Unit::Rate,
            Self::MeanParts { .. } | Self::ModalParts { .. } => Unit::Parts,
            Self::MeanAri { .. } | Self::MedianAri { .. } | Self::BaselineLoss { .. } => Unit::Ari,
            Self::BestDimension { .. } | Self::FirstDimension {} => Unit::Dimension,
            Self::BestCoordination { .. } => Unit::Coordination,
            Self::AriDifference { .. } | Self::TreeDependence {} => Unit::PValue,
            Self::Nothing { .. } => return None,
        })
    }

    /// Whether it counts posterior samples, so that it can count the one of highest log posterior alone.
    pub(crate) fn counts_samples(&self) -> bool {
        matches!(
            self,
            Self::TreeRate { .. }
                | Self::PooledTreeRate { .. }
                | Self::MeanParts { .. }
                | Self::MeanAri { .. }
        )
    }
}

/// A figure of the paper, and what the paper says of it.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Figure {
    /// Name of its files.
    pub name: String,
    /// Its number in the paper.
    pub number: String,
    /// What it shows.
    pub title: String,
    /// Where the paper describes it.
    pub place: String,
    /// What the paper says of it.
    pub says: String,
    /// A value that the picture marks by a line.
    #[serde(default)]
    pub mark: Option<Mark>,
}

/// A value on a figure's scale.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mark {
    /// Where the line is.
    pub value: f64,
    /// What it is.
    pub name: String,
}

/// `reproduce/published.toml`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Published {
    claim: Vec<Claim>,
    figure: Vec<Figure>,
}

fn file() -> Published {
    toml::from_str(PUBLISHED).expect("reproduce/published.toml matches Published; a test checks it")
}

/// The claims of `reproduce/published.toml`, in its order.
pub(crate) fn claims() -> Vec<Claim> {
    file().claim
}

/// The figures of `reproduce/published.toml`, in the paper's order.
pub fn figures() -> Vec<Figure> {
    file().figure
}
