//! The sections of values and of changes: a table each, with a row for each configuration and a column for each claim.

use super::super::design::{Design, JudgedClaim};
use super::super::results::{ClaimRow, Results};
use crate::analysis::claims::Verdict;
use crate::analysis::published::{Claim, Unit, claims};
use crate::report::markdown::{row, rule};
use crate::report::numbers;
use crate::report::plot::effects::{Column, Line};

/// The values, with the pictures.
pub(super) fn values(results: &Results) -> Vec<String> {
    let published = claims();
    let judged = &results.design.claims;
    let mut lines = vec![
        "\n## Values\n".to_owned(),
        format!(
            "{} Intervals are 95 % intervals over simulations (bootstrap). Of a claim \
         over several conditions, the value is that which lies farthest towards the outside of the accepted range. Bold: within the \
             accepted range.\n",
            match results.design.draws {
                Some(_) => "Configurations with the same movement are run on the same simulations.",
                None => "All configurations are run on the same simulations.",
            }
        ),
    ];
    for (name, claims) in pictures(&results.design) {
        let ids: Vec<&str> = claims.iter().map(|judged| judged.id.as_str()).collect();
        lines.push(format!("![{}]({name})\n", ids.join(", ")));
    }
    lines.push(
        "Green: the accepted range. Dashed: the published number. The orange line is the first configuration.\n".to_owned(),
    );
    let accepted = judged.iter().map(|judged| {
        let claim = judged.find(&published).expect("the design was checked");
        numbers::range(claim.accept, claim.measure.unit())
    });
    lines.extend(header(judged));
    lines.push(row(std::iter::once("accepted".to_owned()).chain(accepted)));
    lines.extend(rows(results, &published, &|row, unit| {
        let value = with_interval(row.value, row.cells.low.zip(row.cells.high), unit);
        if row.verdict == Verdict::Reproduced { format!("**{value}**") } else { value }
    }));
    lines
}

/// The changes from the first configuration.
pub(super) fn changes(results: &Results) -> Vec<String> {
    let mut lines = vec![format!("\n## Changes from “{}”\n", results.configurations[0].name)];
    lines.push(
        "Bold: the interval excludes 0. A claim over several conditions is compared at one of them: that which decides the first \
         configuration's value, among those at which both have one. Simulations are resampled in pairs.\n"
            .to_owned(),
    );
    lines.extend(header(&results.design.claims));
    lines.extend(rows(results, &claims(), &|row, unit| {
        let ends = row.change_low.zip(row.change_high);
        let change = with_interval(row.change, ends, unit);
        if ends.is_some_and(|(low, high)| low > 0.0 || high < 0.0) { format!("**{change}**") } else { change }
    }));
    lines
}

/// The head of a table with a column for each claim.
fn header(judged: &[JudgedClaim]) -> [String; 2] {
    let labels = judged.iter().map(JudgedClaim::name);
    [row(std::iter::once(String::new()).chain(labels)), rule(judged.len() + 1)]
}

/// A row for each configuration.
fn rows(
    results: &Results,
    published: &[Claim],
    cell: &dyn Fn(&ClaimRow, Option<Unit>) -> String,
) -> Vec<String> {
    let units: Vec<Option<Unit>> = results
        .design
        .claims
        .iter()
        .map(|judged| judged.find(published).and_then(|claim| claim.measure.unit()))
        .collect();
    let line = |(place, name): (usize, &String)| {
        let cells = results.claims_of(place).iter().zip(&units).map(|(row, unit)| cell(row, *unit));
        row(std::iter::once(name.clone()).chain(cells))
    };
    results.configurations.iter().map(|one| &one.name).enumerate().map(line).collect()
}

/// The name of each picture, and the claims that it shows.
pub(super) fn pictures(design: &Design) -> impl Iterator<Item = (String, &[JudgedClaim])> {
    /// Panels that the width of a picture has room for.
    const PANELS: usize = 4;
    let chunks = design.claims.chunks(PANELS).enumerate();
    chunks.map(|(at, claims)| (format!("figures/claims-{}.svg", at + 1), claims))
}

/// Panels and lines of the picture of some claims.
pub(super) fn picture(results: &Results, shown: &[JudgedClaim]) -> (Vec<Column>, Vec<Line>) {
    let published = claims();
    let column = |judged: &JudgedClaim| {
        let claim = judged.find(&published).expect("the design was checked");
        Column {
            title: judged.label.clone(),
            share: matches!(claim.measure.unit(), Some(Unit::Rate | Unit::Ari | Unit::Coordination)),
            published: claim.published,
            accepted: claim.accept,
        }
    };
    let line = |(place, name): (usize, &String)| {
        let own = results.claims_of(place);
        let cell = |judged: &JudgedClaim| {
            let row = own.iter().find(|row| row.claim == judged.id)?;
            Some((row.value?, row.cells.low.zip(row.cells.high)))
        };
        Line { label: name.clone(), cells: shown.iter().map(cell).collect() }
    };
    let names = results.configurations.iter().map(|one| &one.name);
    (shown.iter().map(column).collect(), names.enumerate().map(line).collect())
}

/// A value with its interval, where there is one.
fn with_interval(value: Option<f64>, ends: Option<(f64, f64)>, unit: Option<Unit>) -> String {
    let value = numbers::value(value, unit);
    if ends.is_some() { format!("{value} ({})", numbers::range(ends, unit)) } else { value }
}
