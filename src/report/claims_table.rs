//! Write the table of claims: for machines as CSV, and for people as Markdown, in a terminal and in the report.

use serde::{Deserialize, Serialize};

use super::figure_rows::Counting;
use super::markdown;
use super::numbers;
use crate::analysis::cells::EstimateCells;
use crate::analysis::claims::{Judged, Verdict};
use crate::analysis::one_body::{OneBody, SingleBodies};
use crate::analysis::published::{Claim, HEADLINE, Unit};
use crate::analysis::statistics::{Estimate, rate_difference};
use crate::stages::schema::Sampler;

/// A row of `claims.csv`. A claim that counts draws has two, one for each [`Counting`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Short name of the claim.
    pub id: String,
    /// Which draws are counted.
    pub counting: Counting,
    /// The reading of the paper that they follow. Beside the claims of a run, the other reading has its headline.
    #[serde(default)]
    pub reading: Option<Sampler>,
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
    /// Single bodies with a value; empty for the best draw, as the next.
    #[serde(default)]
    pub bodies: Option<usize>,
    /// Share of them in which the published value would have been seen.
    #[serde(default)]
    pub bodies_share: Option<f64>,
    /// Lower end of its 95 % interval.
    #[serde(default)]
    pub bodies_low: Option<f64>,
    /// Upper end of its 95 % interval.
    #[serde(default)]
    pub bodies_high: Option<f64>,
    /// Share of them in which all other claims hold, too.
    #[serde(default)]
    pub bodies_together: Option<f64>,
    /// The verdict on single bodies.
    #[serde(default)]
    pub one_body: Option<OneBody>,
}

/// Stands in place of a verdict in the rows of the best draw.
const EXTENSION: &str = "extension";

impl Row {
    /// Names of the cells that people see.
    pub const HEADER: [&'static str; 11] = [
        "verdict",
        "claim",
        "published",
        "reproduced",
        "95 % interval",
        "n",
        "single simulations",
        "accepted",
        "one body shows it",
        "where",
        "paper",
    ];

    /// As published: over all draws.
    fn all_draws(judged: &Judged) -> Self {
        let Judged { claim, reproduced, place, verdict, single_bodies, .. } = judged;
        let (accepted_low, accepted_high) = claim.accept.unzip();
        let tested = single_bodies.as_ref().filter(|bodies| bodies.alone.n > 0);
        let (bodies_low, bodies_high) = tested.and_then(|bodies| bodies.alone.interval).unzip();
        Self {
            counting: Counting::AllDraws,
            reading: Some(judged.reading),
            published: claim.published,
            wording: claim.wording.clone(),
            accepted_low,
            accepted_high,
            verdict: Some(*verdict),
            bodies: tested.map(|bodies| bodies.alone.n),
            bodies_share: tested.and_then(|bodies| bodies.alone.value),
            bodies_low,
            bodies_high,
            bodies_together: tested.and_then(|bodies| bodies.together.value),
            one_body: tested.and_then(SingleBodies::verdict),
            ..Self::best_draw(claim, judged.reading, reproduced, place)
        }
    }

    /// The extension: over the draw of highest log posterior of each simulation.
    fn best_draw(claim: &Claim, reading: Sampler, estimate: &Estimate, found: &str) -> Self {
        Self {
            id: claim.id.clone(),
            counting: Counting::BestDraw,
            reading: Some(reading),
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
            bodies: None,
            bodies_share: None,
            bodies_low: None,
            bodies_high: None,
            bodies_together: None,
            one_body: None,
        }
    }

    /// The share of single bodies that show the claim, in words.
    fn bodies_in_words(&self) -> String {
        let share = |value: Option<f64>| numbers::value(value, Some(Unit::Rate));
        let (Some(verdict), Some(bodies)) = (self.one_body, self.bodies) else { return String::new() };
        let interval = numbers::range(self.bodies_low.zip(self.bodies_high), Some(Unit::Rate));
        format!(
            "{}: {} of {bodies} bodies ({interval}); with all others {}",
            verdict.name(),
            share(self.bodies_share),
            share(self.bodies_together)
        )
    }

    /// The claim, with the reading that its draws follow where two readings have it.
    pub fn claim(&self) -> String {
        match self.reading.filter(|_| self.id == HEADLINE) {
            Some(reading) => format!("{}, {}", self.statement, reading.in_words()),
            None => self.statement.clone(),
        }
    }

    /// Its name on the screen.
    fn short_name(&self) -> String {
        match self.reading.filter(|_| self.id == HEADLINE) {
            Some(Sampler::Equations) => format!("{} (equations)", self.id),
            Some(Sampler::AuthorsCode) => format!("{} (authors' code)", self.id),
            Some(Sampler::SplitMerge) => format!("{} (split-merge)", self.id),
            None => self.id.clone(),
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
    pub fn in_words(&self) -> [String; 11] {
        let claim = match self.counting {
            Counting::AllDraws => self.claim(),
            Counting::BestDraw => format!("{}: draw of highest log posterior", self.claim()),
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
            self.bodies_in_words(),
            self.found.clone(),
            paper,
        ]
    }
}

/// The table of claims: a row for each claim, followed by one for the best draws if the claim counts draws.
pub fn rows(judged: &[Judged]) -> Vec<Row> {
    let both = |judged: &Judged| {
        let best = judged.best.as_ref();
        let best =
            best.map(|(estimate, place)| Row::best_draw(&judged.claim, judged.reading, estimate, place));
        std::iter::once(Row::all_draws(judged)).chain(best)
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
    let header = ["verdict", "claim", "published", "reproduced", "95 % interval", "n", "one body shows it"]
        .map(str::to_owned);
    let cells = |row: Row| {
        let name = row.short_name();
        let one_body = row.one_body.map_or("", OneBody::name).to_owned();
        let [verdict, _, published, reproduced, interval, n, ..] = row.in_words();
        [verdict, name, published, reproduced, interval, n, one_body]
    };
    let rows: Vec<_> = std::iter::once(header).chain(self::rows(judged).into_iter().map(cells)).collect();
    let widths: Vec<usize> =
        (0..7).map(|column| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0)).collect();
    let line = |row: &[String; 7]| {
        let cells: Vec<String> =
            row.iter().zip(&widths).map(|(cell, &width)| format!("{cell:width$}")).collect();
        cells.join(" | ").trim_end().to_owned()
    };
    rows.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// Published and reproduced rate side by side, with the difference, for a claim whose counts may be known.
pub fn comparison(judged: &Judged) -> Option<String> {
    let Judged { claim, reproduced, verdict, reading, .. } = judged;
    let reading = reading.in_words();
    let &(k, n) = claim.possible_counts.first()?;
    let Some(value) = reproduced.value else {
        return Some(format!(
            "{}, {reading}: published {} | reproduced no rate, 0 of 0 eligible draws | {}",
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
        "{}, {reading}: published {} | reproduced {} | n = {} | 95 % interval {} | difference {:+.1} points, 95 % interval {} | {}",
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
