//! Say what the paper is cited for and what came out: a sentence that can be read aloud, and a small table beside it.

use maud::{Markup, html};

use super::claims_table::{Row, markdown_table};
use super::figure_rows::Counting;
use super::{markdown, numbers};
use crate::analysis::claims::Verdict;
use crate::analysis::published::{Claim, HEADLINE, Measure, Unit, claims};
use crate::analysis::statistics::rate_difference;

/// The headline of a run.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Headline {
    /// What came out, and what the paper reports.
    pub sentence: String,
    /// Names of the lines of the table, then a column for each interpretation of the paper.
    columns: Vec<Vec<String>>,
}

impl Headline {
    /// The headline among the claims of a run, first that of the interpretation which the run follows; `None` if they do
    /// not have it.
    pub(crate) fn of(rows: &[Row]) -> Option<Self> {
        let claim = claims().into_iter().find(|claim| claim.id == HEADLINE)?;
        let own: Vec<&Row> =
            rows.iter().filter(|row| row.id == HEADLINE && row.counting == Counting::AllDraws).collect();
        let sentence = sentence(&claim, own.first()?);
        let columns = own.into_iter().map(|row| column(&claim, row));
        Some(Self { sentence, columns: std::iter::once(names(&claim)).chain(columns).collect() })
    }

    /// The table, line by line; the first line is the header.
    fn lines(&self) -> Vec<Vec<&str>> {
        let line = |at: usize| self.columns.iter().map(|column| column[at].as_str()).collect();
        (0..self.columns[0].len()).map(line).collect()
    }

    /// For a terminal.
    pub(crate) fn in_terminal(&self) -> String {
        let width = |column: &Vec<String>| column.iter().map(|cell| cell.chars().count()).max().unwrap_or(0);
        let widths: Vec<usize> = self.columns.iter().map(width).collect();
        let line = |cells: Vec<&str>| {
            let padded = cells.iter().zip(&widths).map(|(cell, &width)| format!("{cell:width$}"));
            padded.collect::<Vec<_>>().join("  ").trim_end().to_owned()
        };
        let lines: Vec<String> = self.lines().into_iter().map(line).collect();
        format!("{}\n\n{}", self.sentence, lines.join("\n"))
    }

    /// For a page in Markdown.
    pub(crate) fn in_markdown(&self) -> String {
        let mut lines: Vec<String> = self.lines().into_iter().map(markdown::row).collect();
        lines.insert(1, markdown::rule(self.columns.len()));
        format!("**{}**\n\n{}", self.sentence, lines.join("\n"))
    }

    /// For the report.
    pub(crate) fn in_html(&self) -> Markup {
        let lines = self.lines();
        let (header, body) = lines.split_first().expect("a table has a header");
        html! {
            p.headline { (self.sentence) }
            table.headline-table {
                thead { tr { @for name in header { th scope="col" { (name) } } } }
                tbody {
                    @for line in body {
                        tr {
                            th scope="row" { (line[0]) }
                            @for (cell, name) in line.iter().zip(header).skip(1) { td data-label=(name) { (cell) } }
                        }
                    }
                }
            }
        }
    }
}

/// The text of `claims.md`: the headline, `preamble`, and the table of all claims.
pub(crate) fn claims_page(preamble: &str, rows: &[Row]) -> String {
    let headline = Headline::of(rows).map_or(String::new(), |headline| headline.in_markdown() + "\n\n");
    format!("{headline}{preamble}\n\n{}", markdown_table(rows))
}

/// Where the paper has it, such as "p = 0.9 and d = 14".
fn place(claim: &Claim) -> String {
    let Measure::TreeRate { at } = &claim.measure else { unreachable!("the headline is a rate of trees") };
    format!("p = {} and d = {}", at.coordinations[0], at.dimensions[0])
}

fn sentence(claim: &Claim, row: &Row) -> String {
    let (place, published) = (place(claim), &claim.wording);
    if row.value.is_none() {
        return format!(
            "There is no eligible sample at {place}, so the tree accuracy cannot be judged; the paper reports {published}."
        );
    }
    let unit = match row.cells.simulations {
        1 => "the chains of one simulation".to_owned(),
        simulations => format!("{simulations} simulations"),
    };
    let interval = numbers::range(row.interval(), Some(Unit::Rate));
    let accepted = numbers::range(row.accepted(), Some(Unit::Rate));
    let verdict = match row.verdict {
        Some(Verdict::Reproduced) => format!(" This lies within the accepted range, {accepted}: reproduced."),
        Some(_) => format!(" This lies outside the accepted range, {accepted}: not reproduced."),
        None => String::new(),
    };
    format!(
        "{} of {} eligible samples at {place} recover the true tree (95 % interval over {unit}: {interval}); the paper reports \
         {published}.{verdict}",
        row.reproduced(),
        numbers::thousands(row.cells.n)
    )
}

/// Names of the lines of the table.
fn names(claim: &Claim) -> Vec<String> {
    let fixed = [
        "tree accuracy",
        "published",
        "reproduced",
        "95 % interval",
        "eligible samples (n)",
        "simulations",
        "accepted range",
        "verdict",
    ];
    let difference = |(k, n): &(usize, usize)| format!("difference, if the published rate is {k}/{n}");
    fixed.into_iter().map(str::to_owned).chain(claim.possible_counts.iter().map(difference)).collect()
}

/// The cells of one interpretation.
fn column(claim: &Claim, row: &Row) -> Vec<String> {
    let rate = |ends| numbers::range(ends, Some(Unit::Rate));
    let fixed = [
        row.reading.map_or(String::new(), |reading| reading.in_words().to_owned()),
        claim.wording.clone(),
        row.reproduced(),
        rate(row.interval()),
        numbers::thousands(row.cells.n),
        row.cells.simulations.to_string(),
        rate(row.accepted()),
        row.verdict_in_words().to_owned(),
    ];
    let difference = |&(k, n): &(usize, usize)| match row.value {
        None => String::new(),
        Some(value) => {
            let (low, high) = rate_difference(value, row.interval().unwrap_or((value, value)), (k, n));
            let points = 100.0 * (value - k as f64 / n as f64);
            format!("{points:+.1} points ({:+.1} to {:+.1})", 100.0 * low, 100.0 * high)
        }
    };
    fixed.into_iter().chain(claim.possible_counts.iter().map(difference)).collect()
}

#[cfg(test)]
mod tests;
