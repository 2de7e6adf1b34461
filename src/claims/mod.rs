//! Published claims and an experiment's records → a verdict on each claim.
//!
//! What the paper says stands in `reproduce/published.toml`, with the range that counts as reproduced; the
//! program only measures. A claim over several conditions holds if it holds at each that has a sample.

mod measure;
pub mod table;

use serde::Deserialize;

use self::measure::measure;
use crate::conditions::{BaselineEstimate, Conditions};
use crate::reproduce::Experiment;
use crate::schema::Model;
use crate::statistics::Estimate;

const PUBLISHED: &str = include_str!("../../reproduce/published.toml");

/// A checkable statement of the paper.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Claim {
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
    /// Its value, in the paper's words.
    pub published: String,
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
pub struct At {
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
pub enum Measure {
    /// Rate of right trees among the eligible draws, at each condition.
    TreeRate {
        /// The conditions.
        at: At,
    },
    /// The same over the draws of all conditions together.
    PooledTreeRate {
        /// The conditions.
        at: At,
    },
    /// Share of all draws that are eligible and have the right tree, at each condition.
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
    /// with eligible draws. The simulation is the unit, so that it takes several.
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

impl Measure {
    /// Whether it counts draws, so that it can count the draw of highest log posterior alone.
    fn counts_draws(&self) -> bool {
        matches!(
            self,
            Self::TreeRate { .. }
                | Self::PooledTreeRate { .. }
                | Self::MeanParts { .. }
                | Self::MeanAri { .. }
        )
    }
}

/// What a run offers to judge claims by.
#[derive(Debug, Clone)]
pub struct Evidence {
    /// All draws.
    pub conditions: Conditions,
    /// The clusterings that are told the number of clusters.
    pub baselines: Vec<BaselineEstimate>,
}

/// What the run says of a claim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Every value lies in the range.
    Reproduced,
    /// Some value does not.
    NotReproduced,
    /// There is no value.
    NotTestable,
}

impl Verdict {
    /// As written in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Reproduced => "reproduced",
            Self::NotReproduced => "not reproduced",
            Self::NotTestable => "not testable",
        }
    }
}

/// A claim, its worst value, and its verdict.
#[derive(Debug, Clone, PartialEq)]
pub struct Judged {
    /// The claim.
    pub claim: Claim,
    /// The value that lies farthest towards the outside of the range.
    pub reproduced: Estimate,
    /// Where that value was found.
    pub place: String,
    /// The verdict.
    pub verdict: Verdict,
    /// The same of the draws of highest log posterior, where the claim counts draws: an extension.
    pub best: Option<(Estimate, String)>,
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
pub fn published() -> Vec<Claim> {
    file().claim
}

/// The figures of `reproduce/published.toml`, in the paper's order.
pub fn figures() -> Vec<Figure> {
    file().figure
}

/// Judges the claims of one experiment.
pub fn judge(experiment: Experiment, evidence: &Evidence) -> Vec<Judged> {
    let best = Evidence { conditions: evidence.conditions.best(), baselines: Vec::new() };
    let claims = published().into_iter().filter(|claim| claim.experiments.contains(&experiment));
    claims.map(|claim| judge_one(claim, evidence, &best)).collect()
}

fn judge_one(claim: Claim, evidence: &Evidence, best: &Evidence) -> Judged {
    let (reproduced, place, verdict) = worst(&claim, &measure(&claim.measure, evidence));
    let best = claim.measure.counts_draws().then(|| {
        let (estimate, place, _) = worst(&claim, &measure(&claim.measure, best));
        (estimate, place)
    });
    Judged { claim, reproduced, place, verdict, best }
}

/// Of all values that a claim is about, the one that lies farthest towards the outside of its range.
fn worst(claim: &Claim, measured: &[(String, Estimate)]) -> (Estimate, String, Verdict) {
    let accept = claim.accept.unwrap_or_default();
    // A bound at the end of a share's scale excludes nothing, so no value is near to it.
    let low = if accept.0 == 0.0 { f64::NEG_INFINITY } else { accept.0 };
    let high = if accept.1 == 1.0 { f64::INFINITY } else { accept.1 };
    let mut untested = Vec::new();
    let mut worst: Option<(f64, &Estimate, &str)> = None;
    for (place, estimate) in measured {
        match estimate.value {
            None => untested.push(place.as_str()),
            Some(value) => {
                // How far outside the range; negative inside.
                let outside = (low - value).max(value - high);
                if worst.is_none_or(|(most, ..)| outside > most) {
                    worst = Some((outside, estimate, place));
                }
            }
        }
    }
    match worst {
        None => {
            let reason = match &claim.measure {
                Measure::Nothing { reason } => reason.clone(),
                _ if untested.is_empty() => "the run has no such condition".to_owned(),
                _ => no_sample(&untested),
            };
            (Estimate::default(), reason, Verdict::NotTestable)
        }
        Some((outside, estimate, place)) => {
            let several = measured.len() > 1;
            let missing =
                if untested.is_empty() { String::new() } else { format!("; {}", no_sample(&untested)) };
            let place = format!("{}{place}{missing}", if several { "worst: " } else { "" });
            (*estimate, place, if outside <= 0.0 { Verdict::Reproduced } else { Verdict::NotReproduced })
        }
    }
}

/// Names the first few conditions without a sample.
fn no_sample(places: &[&str]) -> String {
    const NAMED: usize = 4;
    let named = places[..places.len().min(NAMED)].join(", ");
    match places.len().saturating_sub(NAMED) {
        0 => format!("no sample: {named}"),
        more => format!("no sample: {named} and {more} more"),
    }
}

#[cfg(test)]
mod tests;
