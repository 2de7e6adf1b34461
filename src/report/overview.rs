//! Show what was claimed beside the headline, what came out, and how sure that is: a line for each claim that could be tested.

use maud::{Markup, html};

use super::claims_table::Row;
use super::numbers;
use super::ranges;
use crate::analysis::published::HEADLINE;

/// The claims of a run in one picture, a line each, with `mark` before its verdict.
pub(crate) fn overview(
    rows: &[Row],
    class: &dyn Fn(&Row) -> String,
    mark: &dyn Fn(&Row) -> &'static str,
) -> Markup {
    // The headline has a sentence and a table of its own.
    let others = rows.iter().filter(|row| row.id != HEADLINE);
    let tested = others.filter_map(|row| Some((row, ranges::drawing(row)?)));
    html! {
        section id="overview" {
            h2 { "What else was claimed, and what came out" }
            (ranges::legend())
            ul.overview {
                @for (row, drawing) in tested {
                    li class=(class(row)) {
                        span.verdict { (mark(row)) " " (row.verdict_in_words()) }
                        span.claim { (row.claim()) }
                        (drawing)
                        span.numbers { (in_words(row)) }
                    }
                }
            }
        }
    }
}

/// Published and reproduced value, the latter with its interval.
fn in_words(row: &Row) -> String {
    let published = if row.wording.is_empty() { String::new() } else { format!("{} → ", row.wording) };
    let interval =
        row.interval().map_or(String::new(), |ends| format!(" ({})", numbers::range(Some(ends), row.unit)));
    format!("{published}{}{interval}", row.reproduced())
}
