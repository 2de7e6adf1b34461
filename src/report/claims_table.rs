//! Write the table of claims: for machines as CSV, and for people as Markdown, in a terminal and in the report.

use serde::{Deserialize, Serialize};

use super::figure_rows::Counting;
use super::markdown;
use super::numbers;
use crate::analysis::cells::EstimateCells;
use crate::analysis::claims::{Judged, Verdict};
use crate::analysis::one_body::{OneBody, SingleBodies};
use crate::analysis::published::{Claim, HEADLINE, Unit};
use crate::analysis::statistics::Estimate;
use crate::stages::schema::Sampler;

/// A row of `claims.csv`. A claim that counts posterior samples has two, one for each [`Counting`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Short name of the claim.
    pub id: String,
    /// Which posterior samples are counted.
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
    /// The paper's value, where it gives a number; empty for the best sample, as the next.
    pub published: Option<f64>,
    /// The paper's value in its own words.
    pub wording: String,
    /// The reproduced value.
    pub value: Option<f64>,
    /// What it is over, and its interval.
    #[serde(flatten)]
    pub cells: EstimateCells,
    /// Lower end of the accepted range; empty for the best sample, as the next two.
    pub accepted_low: Option<f64>,
    /// Upper end of the accepted range.
    pub accepted_high: Option<f64>,
    /// The verdict.
    pub verdict: Option<Verdict>,
    /// Where the value was found, or why there is no value.
    pub found: String,
    /// Single bodies with a value; empty for the best sample, as the next.
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

/// Stands in place of a verdict in the rows of the most probable sample.
const EXTENSION: &str = "extension";

/// Stands in place of a verdict in a quick run.
const ILLUSTRATION: &str = "illustration";

impl Row {
    /// Names of the cells that people see.
    pub const HEADER: [&'static str; 11] = [
        "verdict",
        "claim",
        "published",
        "reproduced",
        "95 % interval",
        "n",
        "range over simulations",
        "accepted",
        "single simulations that show it",
        "where",
        "paper",
    ];

    /// As published: over all posterior samples.
    fn all_samples(judged: &Judged) -> Self {
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
            ..Self::best_sample(claim, judged.reading, reproduced, place)
        }
    }

    /// The extension: over the sample of highest log posterior of each simulation.
    fn best_sample(claim: &Claim, reading: Sampler, estimate: &Estimate, found: &str) -> Self {
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

    /// How many single simulations show the claim, such as "5 of 20"; empty where that was not asked for.
    fn shown_by(&self) -> String {
        let (Some(share), Some(simulations)) = (self.bodies_share, self.bodies) else { return String::new() };
        format!("{} of {simulations}", count(share, simulations))
    }

    /// The same with its interval, and how many of them show all claims of the experiment.
    fn shown_by_in_words(&self) -> String {
        let (Some(together), Some(simulations)) = (self.bodies_together, self.bodies) else {
            return String::new();
        };
        let interval = numbers::range(self.bodies_low.zip(self.bodies_high), Some(Unit::Rate));
        let all = match count(together, simulations) {
            0 => "none shows".to_owned(),
            1 => "1 shows".to_owned(),
            several => format!("{several} show"),
        };
        format!("{} ({interval}); {all} all claims", self.shown_by())
    }

    /// The claim, with the reading that its posterior samples follow where two readings have it.
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

    /// Its verdict in a word, or why it has none.
    pub fn verdict_in_words(&self) -> &'static str {
        let without = match self.counting {
            Counting::AllDraws => ILLUSTRATION,
            Counting::BestDraw => EXTENSION,
        };
        self.verdict.map_or(without, Verdict::name)
    }

    /// The reproduced value in its unit.
    pub fn reproduced(&self) -> String {
        numbers::value(self.value, self.unit)
    }

    /// Its cells for people, as [`Row::HEADER`] names them.
    pub fn in_words(&self) -> [String; 11] {
        let claim = match self.counting {
            Counting::AllDraws => self.claim(),
            Counting::BestDraw => format!("{}: most probable sample", self.claim()),
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
            self.shown_by_in_words(),
            self.found.clone(),
            paper,
        ]
    }
}

/// How many a share of so many is.
fn count(share: f64, of: usize) -> usize {
    (share * of as f64).round() as usize
}

/// The table of claims: a row for each claim, followed by one for the best samples if the claim counts samples.
pub(crate) fn rows(judged: &[Judged]) -> Vec<Row> {
    let both = |judged: &Judged| {
        let best = judged.best.as_ref();
        let best =
            best.map(|(estimate, place)| Row::best_sample(&judged.claim, judged.reading, estimate, place));
        std::iter::once(Row::all_samples(judged)).chain(best)
    };
    judged.iter().flat_map(both).collect()
}

/// The rows of a quick run: an illustration, in which nothing is judged.
pub(crate) fn illustrated(rows: Vec<Row>) -> Vec<Row> {
    rows.into_iter().map(|row| Row { verdict: None, one_body: None, ..row }).collect()
}

/// The table in Markdown.
pub(crate) fn markdown_table(rows: &[Row]) -> String {
    let mut lines = vec![markdown::row(Row::HEADER), markdown::rule(Row::HEADER.len())];
    lines.extend(rows.iter().map(|row| markdown::row(row.in_words())));
    lines.join("\n") + "\n"
}

/// The table for a terminal, a line for each row.
pub(crate) fn terminal_table(rows: &[Row]) -> String {
    let header =
        ["verdict", "claim", "published", "reproduced", "95 % interval", "n", "simulations that show it"]
            .map(str::to_owned);
    let cells = |row: &Row| {
        let [verdict, _, published, reproduced, interval, n, ..] = row.in_words();
        [verdict, row.short_name(), published, reproduced, interval, n, row.shown_by()]
    };
    let rows: Vec<_> = std::iter::once(header).chain(rows.iter().map(cells)).collect();
    let widths: Vec<usize> =
        (0..7).map(|column| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0)).collect();
    let line = |row: &[String; 7]| {
        let cells: Vec<String> =
            row.iter().zip(&widths).map(|(cell, &width)| format!("{cell:width$}")).collect();
        cells.join(" | ").trim_end().to_owned()
    };
    rows.iter().map(line).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
pub(crate) mod tests;
