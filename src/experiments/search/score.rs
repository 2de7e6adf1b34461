//! Score a candidate by the claims that it satisfies.

use super::super::configurations::{Failure, Outcome};
use super::design::{Candidate, Design, Term};
use crate::analysis::claims::{Judged, judge};
use crate::analysis::published::Experiment;
use crate::settings::Settings;
use crate::stages::simulate::Resolution;

/// A candidate that has been tried.
pub struct Tried {
    /// The candidate.
    pub candidate: Candidate,
    /// Weighted credit of all terms; 0 if anything of it failed.
    pub score: f64,
    /// What failed.
    pub failures: Vec<Failure>,
    /// How well the physics step resolved its movements.
    pub resolution: Resolution,
    /// Verdict and credit of each term.
    pub terms: Vec<(Judged, f64)>,
}

impl Tried {
    /// Whether the physics step resolved all its movements.
    pub fn is_resolved(&self) -> bool {
        self.failures.is_empty() && self.resolution.is_resolved()
    }
}

impl Design {
    /// A candidate's verdicts and score.
    pub fn judge(&self, candidate: Candidate, settings: &Settings, outcome: &Outcome) -> Tried {
        let judged = [Experiment::Exp1, Experiment::Exp2]
            .map(|experiment| (experiment, judge(experiment, &outcome.evidence(experiment, settings))));
        let find = |term: &Term| {
            let of = judged.iter().filter(|(experiment, _)| *experiment == term.experiment);
            let mut all = of.flat_map(|(_, judged)| judged);
            all.find(|judged| judged.claim.id == term.claim).expect("the design was checked").clone()
        };
        let terms: Vec<(Judged, f64)> = self
            .score
            .iter()
            .map(|term| {
                let judged = find(term);
                let credit = term.credit(&judged);
                (judged, credit)
            })
            .collect();
        let total: f64 = self.score.iter().map(|term| term.weight).sum();
        let weighted = terms.iter().zip(&self.score).map(|((_, credit), term)| credit * term.weight);
        let score = weighted.sum::<f64>() / total;
        let score = if outcome.failures.is_empty() { score } else { 0.0 };
        let (failures, resolution) = (outcome.failures.clone(), outcome.resolution);
        Tried { candidate, score, failures, resolution, terms }
    }
}

impl Term {
    /// 1 within the accepted range, less outside, 0 where there is nothing to judge.
    fn credit(&self, judged: &Judged) -> f64 {
        let (Some(value), Some((low, high))) = (judged.reproduced.value, judged.claim.accept) else {
            return 0.0;
        };
        let outside = (low - value).max(value - high).max(0.0);
        (1.0 - outside / self.slack).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::claims::Verdict;
    use crate::analysis::published::claims;
    use crate::analysis::statistics::Estimate;
    use crate::stages::schema::Sampler;

    #[test]
    fn credit_is_full_within_the_range_and_falls_to_nothing_outside() {
        let claim = claims().into_iter().find(|claim| claim.id == "tree-accuracy").unwrap();
        let (low, high) = claim.accept.unwrap();
        let term = Term { claim: claim.id.clone(), experiment: Experiment::Exp1, weight: 3.0, slack: 0.2 };
        let credit = |value: Option<f64>| {
            let reproduced = Estimate::bare(value, 10);
            let verdict = Verdict::NotTestable;
            let judged = Judged {
                claim: claim.clone(),
                reproduced,
                place: String::new(),
                verdict,
                best: None,
                reading: Sampler::Equations,
                single_bodies: None,
            };
            term.credit(&judged)
        };
        assert_eq!([low, 0.5 * (low + high), high].map(|value| credit(Some(value))), [1.0; 3]);
        assert!(
            (credit(Some(low - 0.05)) - 0.75).abs() < 1e-12
                && (credit(Some(high + 0.05)) - 0.75).abs() < 1e-12
        );
        assert_eq!([credit(Some(low - 0.3)), credit(None)], [0.0; 2]);
    }
}
