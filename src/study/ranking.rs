//! Rank configurations by the score of the claims that they reproduce.

use serde::Serialize;

use super::choices::merge;
use super::design::{Design, JudgedClaim};
use super::plan::plan;
use super::results::{ClaimRow, Results};
use crate::analysis::claims::Verdict;

/// A configuration and its score: a row of `ranking.csv`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct RankRow {
    /// Its place, from 1.
    pub rank: usize,
    /// Its number.
    pub configuration: usize,
    /// Its name.
    pub name: String,
    /// Weighted share of the claims that it reproduces, with partial credit near their ranges; 0 if anything of it failed.
    pub score: f64,
    /// Whether the physics step resolves all its movements.
    pub resolved: bool,
    /// Number of scored claims that it reproduces.
    pub reproduced: usize,
    /// Number of scored claims.
    pub claims: usize,
    /// Names of the claims that it reproduces.
    pub which: String,
    /// What it has instead of the base's values.
    pub settings: String,
}

/// All configurations by their score, those that the physics step resolves first.
pub(super) struct Ranking {
    /// The best first.
    pub rows: Vec<RankRow>,
}

impl Ranking {
    /// Of a finished study. Of equal scores the earlier configuration stays first.
    pub(super) fn of(results: &Results) -> Self {
        let scored: Vec<(usize, &JudgedClaim)> = scored(&results.design);
        let mut rows: Vec<RankRow> = Vec::new();
        for (place, one) in results.configurations.iter().enumerate() {
            let claims = results.claims_of(place);
            let of_score = || scored.iter().map(|&(at, judged)| (judged, &claims[at]));
            let total: f64 = of_score().filter_map(|(judged, _)| judged.weight).sum();
            let weighted: f64 =
                of_score().map(|(judged, row)| judged.weight.unwrap_or_default() * credit(judged, row)).sum();
            let reproduced: Vec<&str> = of_score()
                .filter(|(_, row)| row.verdict == Verdict::Reproduced)
                .map(|(judged, _)| judged.id.as_str())
                .collect();
            rows.push(RankRow {
                rank: 0,
                configuration: one.number,
                name: one.name.clone(),
                score: if one.failed == 0 { weighted / total } else { 0.0 },
                resolved: one.resolved,
                reproduced: reproduced.len(),
                claims: scored.len(),
                which: reproduced.join(" "),
                settings: one.settings.clone(),
            });
        }
        // Stable.
        rows.sort_by(|a, b| b.resolved.cmp(&a.resolved).then(b.score.total_cmp(&a.score)));
        rows.iter_mut().enumerate().for_each(|(at, row)| row.rank = at + 1);
        Self { rows }
    }

    /// The text of best.toml: the settings of the best configuration, unless the physics step does not resolve it.
    pub(super) fn best(&self, results: &Results) -> Option<String> {
        let best = self.rows.first().filter(|best| best.resolved)?;
        let plan = plan(&results.design).ok()?;
        let found = plan.iter().find(|one| one.number == best.configuration)?;
        let mut settings = results.design.settings.clone();
        merge(&mut settings, &found.changes);
        let text = toml::to_string(&settings).expect("a table can be written");
        Some(format!("# The configuration {}.\n{text}", best.name))
    }
}

/// The claims that count, with their places in the design.
pub(super) fn scored(design: &Design) -> Vec<(usize, &JudgedClaim)> {
    design.claims.iter().enumerate().filter(|(_, judged)| judged.weight.is_some()).collect()
}

/// 1 within the accepted range, less outside, 0 where there is nothing to judge.
fn credit(judged: &JudgedClaim, row: &ClaimRow) -> f64 {
    let (Some(value), Some(slack)) = (row.value, judged.slack) else { return 0.0 };
    let outside = (row.accepted_low - value).max(value - row.accepted_high).max(0.0);
    (1.0 - outside / slack).max(0.0)
}

#[cfg(test)]
mod tests;
