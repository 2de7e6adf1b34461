//! Write the table of claims: for machines as CSV, and for people as Markdown, in a terminal and in the report.

use serde::{Deserialize, Serialize};

use super::figure_rows::Counting;
use super::markdown;
use super::numbers;
use crate::analysis::cells::EstimateCells;
use crate::analysis::claims::{Judged, Verdict};
use crate::analysis::published::{Claim, Unit};
use crate::analysis::statistics::{Estimate, rate_difference};

/// A row of `claims.csv`. A claim that counts draws has two, one for each [`Counting`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Short name of the claim.
    pub id: String,
    /// Which draws are counted.
    pub counting: Counting,
    /// Number of its figure; empty if no figure shows it.
    pub figure: String,
    /// Where the paper says so.
    pub place: String,
    /// What it says.
    pub statement: String,
    /// The unit of all values; empty if nothing is measured.
    pub unit: Option<Unit>,
    /// The paper's value, where it gives a number; empty for the best draw, as the next.
    pub published: Option<f64>,
    /// The paper's value in its own words.
    pub wording: String,
    /// The reproduced value.
    pub value: Option<f64>,
    /// What it is over, and its interval.
    #[serde(flatten)]
    pub cells: EstimateCells,
    /// Lower end of the accepted range; empty for the best draw, as the next two.
    pub accepted_low: Option<f64>,
    /// Upper end of the accepted range.
    pub accepted_high: Option<f64>,
    /// The verdict.
    pub verdict: Option<Verdict>,
    /// Where the value was found, or why there is no value.
    pub found: String,
}

/// Stands in place of a verdict in the rows of the best draw.
const EXTENSION: &str = "extension";

impl Row {
    /// Names of the cells that people see.
    pub const HEADER: [&'static str; 10] = [
        "verdict",
        "claim",
        "published",
        "reproduced",
        "95 % interval",
        "n",
        "single simulations",
        "accepted",
        "where",
        "paper",
    ];

    /// As published: over all draws.
    fn all_draws(claim: &Claim, estimate: &Estimate, found: &str, verdict: Verdict) -> Self {
        let (accepted_low, accepted_high) = claim.accept.unzip();
        Self {
            counting: Counting::AllDraws,
            published: claim.published,
            wording: claim.wording.clone(),
            accepted_low,
            accepted_high,
            verdict: Some(verdict),
            ..Self::best_draw(claim, estimate, found)
        }
    }

    /// The extension: over the draw of highest log posterior of each simulation.
    fn best_draw(claim: &Claim, estimate: &Estimate, found: &str) -> Self {
        Self {
            id: claim.id.clone(),
            counting: Counting::BestDraw,
            figure: claim.figure.clone(),
            place: claim.place.clone(),
            statement: claim.statement.clone(),
            unit: claim.measure.unit(),
            published: None,
            wording: String::new(),
            value: estimate.value,
            cells: estimate.into(),
            accepted_low: None,
            accepted_high: None,
            verdict: None,
            found: found.to_owned(),
        }
    }

    /// The accepted range.
    pub fn accepted(&self) -> Option<(f64, f64)> {
        self.accepted_low.zip(self.accepted_high)
    }

    /// The 95 % interval.
    pub fn interval(&self) -> Option<(f64, f64)> {
        self.cells.low.zip(self.cells.high)
    }

    /// Its verdict in a word, or that it is an extension.
    pub fn verdict_in_words(&self) -> &'static str {
        self.verdict.map_or(EXTENSION, Verdict::name)
    }

    /// The reproduced value in its unit.
    pub fn reproduced(&self) -> String {
        numbers::value(self.value, self.unit)
    }

    /// Its cells for people, as [`Row::HEADER`] names them.
    pub fn in_words(&self) -> [String; 10] {
        let claim = match self.counting {
            Counting::AllDraws => self.statement.clone(),
            Counting::BestDraw => format!("{}: draw of highest log posterior", self.statement),
        };
        let paper = match self.figure.as_str() {
            "" => self.place.clone(),
            figure => format!("figure {figure}, {}", self.place),
        };
        let spread = self.cells.lowest.zip(self.cells.highest);
        [
            self.verdict_in_words().to_owned(),
            claim,
            self.wording.clone(),
            self.reproduced(),
            numbers::range(self.interval(), self.unit),
            self.unit.map_or(String::new(), |_| self.cells.n.to_string()),
            numbers::range(spread, self.unit),
            numbers::range(self.accepted(), self.unit),
            self.found.clone(),
            paper,
        ]
    }
}

/// The table of claims: a row for each claim, followed by one for the best draws if the claim counts draws.
pub fn rows(judged: &[Judged]) -> Vec<Row> {
    let both = |Judged { claim, reproduced, place, verdict, best }: &Judged| {
        let best = best.as_ref().map(|(estimate, place)| Row::best_draw(claim, estimate, place));
        std::iter::once(Row::all_draws(claim, reproduced, place, *verdict)).chain(best)
    };
    judged.iter().flat_map(both).collect()
}

/// The text of `claims.md`: `preamble`, the table, and the comparison of the first claim.
pub fn markdown(preamble: &str, judged: &[Judged]) -> String {
    let mut lines =
        vec![format!("{preamble}\n"), markdown::row(Row::HEADER), markdown::rule(Row::HEADER.len())];
    lines.extend(rows(judged).iter().map(|row| markdown::row(row.in_words())));
    lines.extend(judged.iter().filter_map(comparison).map(|line| format!("\n{line}")));
    lines.join("\n") + "\n"
}

/// The table for a terminal, a line for each row.
pub fn terminal_table(judged: &[Judged]) -> String {
    let header = ["verdict", "claim", "published", "reproduced", "95 % interval", "n"].map(str::to_owned);
    let cells = |row: Row| {
        let [verdict, _, published, reproduced, interval, n, ..] = row.in_words();
        [verdict, row.id, published, reproduced, interval, n]
    };
    let rows: Vec<_> = std::iter::once(header).chain(self::rows(judged).into_iter().map(cells)).collect();
    let widths: Vec<usize> =
        (0..6).map(|column| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0)).collect();
    let line = |row: &[String; 6]| {
        let cells: Vec<String> =
            row.iter().zip(&widths).map(|(cell, &width)| format!("{cell:width$}")).collect();
        cells.join(" | ").trim_end().to_owned()
    };
    rows.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// Published and reproduced rate side by side, with the difference, for a claim whose counts may be known.
pub fn comparison(judged: &Judged) -> Option<String> {
    let Judged { claim, reproduced, verdict, .. } = judged;
    let &(k, n) = claim.possible_counts.first()?;
    let Some(value) = reproduced.value else {
        return Some(format!(
            "{}: published {} | reproduced no rate, 0 of 0 eligible draws | {}",
            claim.statement,
            claim.wording,
            verdict.name()
        ));
    };
    let interval = reproduced.interval.unwrap_or((value, value));
    let difference = |&(k, n): &(usize, usize)| {
        let (low, high) = rate_difference(value, interval, (k, n));
        format!("{:+.1} to {:+.1} if published {k}/{n}", 100.0 * low, 100.0 * high)
    };
    let differences: Vec<String> = claim.possible_counts.iter().map(difference).collect();
    Some(format!(
        "{}: published {} | reproduced {} | n = {} | 95 % interval {} | difference {:+.1} points, 95 % interval {} | {}",
        claim.statement,
        claim.wording,
        numbers::value(Some(value), Some(Unit::Rate)),
        reproduced.n,
        numbers::range(Some(interval), Some(Unit::Rate)),
        100.0 * (value - k as f64 / n as f64),
        differences.join(", "),
        verdict.name()
    ))
}

#[cfg(test)]
mod tests;
