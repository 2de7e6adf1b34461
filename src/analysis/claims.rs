//! Judge the paper's claims by the values that an experiment gave.
//!
//! What the paper says stands in `reproduce/published.toml`, with the range that counts as reproduced; the
//! program only measures. A claim over several conditions holds if it holds at each that has a value.

use serde::{Deserialize, Serialize};

use super::measure::{Evidence, measure};
use super::one_body::SingleBodies;
use super::published::{Claim, Experiment, HEADLINE, Measure, claims};
use super::statistics::Estimate;
use crate::stages::schema::Sampler;

/// What the run says of a claim.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Verdict {
    /// Every value lies in the range.
    #[serde(rename = "reproduced")]
    Reproduced,
    /// Some value does not.
    #[serde(rename = "not reproduced")]
    NotReproduced,
    /// There is no value.
    #[serde(rename = "not testable")]
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
pub(crate) struct Judged {
    /// The claim.
    pub claim: Claim,
    /// The value that lies farthest towards the outside of the range.
    pub reproduced: Estimate,
    /// Where that value was found.
    pub place: String,
    /// The verdict.
    pub verdict: Verdict,
    /// The same of each simulation's most probable sample, where the claim counts samples: an extension.
    pub best: Option<(Estimate, String)>,
    /// The reading of the paper that the posterior samples follow.
    pub reading: Sampler,
    /// How often single bodies show it, where that was asked for.
    pub single_bodies: Option<SingleBodies>,
}

/// Judges the claims of one experiment.
pub(crate) fn judge(experiment: Experiment, evidence: &Evidence) -> Vec<Judged> {
    let reading = evidence.reading;
    let best = Evidence { conditions: evidence.conditions.best(), baselines: Vec::new(), reading };
    let claims = claims().into_iter().filter(|claim| claim.experiments.contains(&experiment));
    claims.map(|claim| judge_one(claim, evidence, &best)).collect()
}

/// The claim that the paper is cited for.
pub(crate) fn headline(experiment: Experiment, evidence: &Evidence) -> Judged {
    let mut judged = judge(experiment, evidence).into_iter();
    judged.find(|judged| judged.claim.id == HEADLINE).expect("both experiments have it")
}

fn judge_one(claim: Claim, evidence: &Evidence, best: &Evidence) -> Judged {
    let (reproduced, place, verdict) = judge_claim(&claim, evidence);
    let best = claim.measure.counts_samples().then(|| {
        let (estimate, place, _) = judge_claim(&claim, best);
        (estimate, place)
    });
    Judged { claim, reproduced, place, verdict, best, reading: evidence.reading, single_bodies: None }
}

/// Of all values that a claim is about, the one that lies farthest towards the outside of its range, where it was found,
/// and the verdict.
pub(crate) fn judge_claim(claim: &Claim, evidence: &Evidence) -> (Estimate, String, Verdict) {
    worst(claim, &measure(&claim.measure, evidence))
}

/// How far a value lies outside the range of a claim; negative inside.
pub(crate) fn outside(claim: &Claim, value: f64) -> f64 {
    let accept = claim.accept.unwrap_or_default();
    // A bound at the end of a share's scale excludes nothing, so no value is near to it.
    let low = if accept.0 == 0.0 { f64::NEG_INFINITY } else { accept.0 };
    let high = if accept.1 == 1.0 { f64::INFINITY } else { accept.1 };
    (low - value).max(value - high)
}

/// Of all values that a claim is about, the one that lies farthest towards the outside of its range.
fn worst(claim: &Claim, measured: &[(String, Estimate)]) -> (Estimate, String, Verdict) {
    let mut untested = Vec::new();
    let mut worst: Option<(f64, &Estimate, &str)> = None;
    for (place, estimate) in measured {
        match estimate.value {
            None => untested.push(place.as_str()),
            Some(value) => {
                let outside = outside(claim, value);
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
                _ => no_value(&untested),
            };
            (Estimate::default(), reason, Verdict::NotTestable)
        }
        Some((outside, estimate, place)) => {
            let several = measured.len() > 1;
            let missing =
                if untested.is_empty() { String::new() } else { format!("; {}", no_value(&untested)) };
            let place = format!("{}{place}{missing}", if several { "worst: " } else { "" });
            (*estimate, place, if outside <= 0.0 { Verdict::Reproduced } else { Verdict::NotReproduced })
        }
    }
}

/// Names the first few conditions without a value.
fn no_value(places: &[&str]) -> String {
    const NAMED: usize = 4;
    let named = places[..places.len().min(NAMED)].join(", ");
    match places.len().saturating_sub(NAMED) {
        0 => format!("no value: {named}"),
        more => format!("no value: {named} and {more} more"),
    }
}

#[cfg(test)]
mod tests;
