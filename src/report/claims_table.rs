//! Judged claims → the table of claims: as CSV, for people, and the first claim's comparison in a line.

use serde::{Deserialize, Serialize};

use super::markdown::number;
use crate::analysis::claims::Judged;
use crate::analysis::published::Claim;
use crate::analysis::statistics::{Estimate, rate_difference};

/// A row of `claims.csv`: a claim, or what the draws of highest log posterior say of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Short name of the claim.
    pub id: String,
    /// Number of its figure; empty if none shows it.
    pub figure: String,
    /// Where the paper says so.
    pub place: String,
    /// What it says.
    pub statement: String,
    /// Its value in the paper's words; empty for the extension.
    pub published: String,
    /// The reproduced value.
    pub reproduced: Option<f64>,
    /// Number of samples.
    pub n: usize,
    /// Lower end of the 95 % interval.
    pub low: Option<f64>,
    /// Upper end of the 95 % interval.
    pub high: Option<f64>,
    /// Simulations that the samples are from.
    pub simulations: usize,
    /// Lowest value of a single simulation.
    pub lowest: Option<f64>,
    /// Highest value of a single simulation.
    pub highest: Option<f64>,
    /// The accepted range, `low..high`.
    pub accepted: String,
    /// reproduced, not reproduced, not testable; or extension.
    pub verdict: String,
    /// Where the value was found, or why there is none.
    pub found: String,
}

impl Row {
    /// Names of its cells.
    pub const HEADER: [&'static str; 10] = [
        "claim",
        "paper",
        "published",
        "reproduced",
        "n",
        "95 % interval",
        "single simulations",
        "accepted",
        "verdict",
        "where",
    ];

    fn new(claim: &Claim, estimate: &Estimate, found: &str, verdict: &str) -> Self {
        let (low, high) = estimate.interval.unzip();
        let (lowest, highest) = estimate.spread.unzip();
        Self {
            id: claim.id.clone(),
            figure: claim.figure.clone(),
            place: claim.place.clone(),
            statement: claim.statement.clone(),
            published: claim.published.clone(),
            reproduced: estimate.value,
            n: estimate.n,
            low,
            high,
            simulations: estimate.simulations,
            lowest,
            highest,
            accepted: claim.accepted(),
            verdict: verdict.to_owned(),
            found: found.to_owned(),
        }
    }

    /// Its cells, as [`Row::HEADER`] names them.
    pub fn cells(&self) -> [String; 10] {
        let paper = match self.figure.as_str() {
            "" => self.place.clone(),
            figure => format!("figure {figure}, {}", self.place),
        };
        [
            self.statement.clone(),
            paper,
            self.published.clone(),
            number(self.reproduced),
            self.n.to_string(),
            range(self.low, self.high),
            range(self.lowest, self.highest),
            self.accepted.replace("..", " to "),
            self.verdict.clone(),
            self.found.clone(),
        ]
    }
}

/// The verdict of rows that show an extension.
pub const EXTENSION: &str = "extension";

/// The table of claims: a row a claim, followed by one of the extension where the claim counts draws.
pub fn rows(judged: &[Judged]) -> Vec<Row> {
    let both = |judged: &Judged| {
        let Judged { claim, reproduced, place, verdict, best } = judged;
        let extension = best.as_ref().map(|(estimate, place)| Row {
            statement: format!("{}: draw of highest log posterior", claim.statement),
            published: String::new(),
            accepted: String::new(),
            ..Row::new(claim, estimate, place, EXTENSION)
        });
        std::iter::once(Row::new(claim, reproduced, place, verdict.name())).chain(extension)
    };
    judged.iter().flat_map(both).collect()
}

/// The text of `claims.md`: `preamble`, the table, and the comparison of the first claim.
pub fn markdown(preamble: &str, judged: &[Judged]) -> String {
    let mut lines = vec![
        format!("{preamble}\n"),
        format!("| {} |", Row::HEADER.join(" | ")),
        format!("|{}", "---|".repeat(Row::HEADER.len())),
    ];
    lines.extend(rows(judged).iter().map(|row| format!("| {} |", row.cells().join(" | "))));
    lines.extend(judged.iter().filter_map(comparison).map(|line| format!("\n{line}")));
    lines.join("\n") + "\n"
}

/// The table for a terminal, a line a claim.
pub fn terminal_table(judged: &[Judged]) -> String {
    let mut rows =
        vec![["claim", "published", "reproduced", "n", "95 % interval", "verdict"].map(str::to_owned)];
    rows.extend(self::rows(judged).into_iter().map(|row| {
        let [_, _, published, reproduced, n, interval, _, _, verdict, _] = row.cells();
        [row.id, published, reproduced, n, interval, verdict]
    }));
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
    if claim.possible_counts.is_empty() {
        return None;
    }
    let percent = |x: f64| format!("{:.1}", 100.0 * x);
    let Some(value) = reproduced.value else {
        return Some(format!(
            "{}: published {} | reproduced no rate, 0 of 0 eligible samples | {}",
            claim.statement,
            claim.published,
            verdict.name()
        ));
    };
    let (low, high) = reproduced.interval.unwrap_or((value, value));
    let (k, n) = claim.possible_counts[0];
    let differences: Vec<String> = claim
        .possible_counts
        .iter()
        .map(|&(k, n)| {
            let (low, high) = rate_difference(value, (low, high), (k, n));
            format!("{:+.1} to {:+.1} if published {k}/{n}", 100.0 * low, 100.0 * high)
        })
        .collect();
    Some(format!(
        "{}: published {} | reproduced {} % | n = {} | 95 % interval {} to {} % | difference {:+.1} points, 95 % \
         interval {} | {}",
        claim.statement,
        claim.published,
        percent(value),
        reproduced.n,
        percent(low),
        percent(high),
        100.0 * (value - k as f64 / n as f64),
        differences.join(", "),
        verdict.name()
    ))
}

fn range(low: Option<f64>, high: Option<f64>) -> String {
    low.zip(high)
        .map_or("none".to_owned(), |(low, high)| format!("{} to {}", number(Some(low)), number(Some(high))))
}
