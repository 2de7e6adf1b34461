//! The sections of shares, variance and curves: what all configurations of a grid or of draws say together.

use super::super::evaluation::{Evaluation, ShareRow, TOGETHER, VarianceRow};
use super::super::levels::DrawCounts;
use super::super::results::Results;
use crate::analysis::published::{HEADLINE, Unit};
use crate::report::markdown::{row, rule};
use crate::report::numbers;
use crate::report::plot::specifications::{Curve, Point};

/// Sources of variance that are shown of a claim.
const SHOWN: usize = 4;

/// The answer, how the configurations were drawn, and the share of each claim.
pub(super) fn shares(evaluation: &Evaluation) -> Vec<String> {
    let mut lines = vec![answer(evaluation) + "\n"];
    if let Some(draws) = evaluation.results.design.draws {
        lines.push(drawn(draws));
    }
    lines.push("\n## In what share does each claim hold?\n".to_owned());
    lines.push(
        "A claim holds in a configuration if its value lies within the accepted range. Without a value it does not hold; \
         the third column counts the configurations with a value. Intervals are 95 % intervals over resamples of the \
         movements, and of the configurations of each. All numbers: [shares.csv](shares.csv).\n"
            .to_owned(),
    );
    lines.extend(table(evaluation));
    lines
}

/// The largest sources of variance of each claim.
pub(super) fn variance(evaluation: &Evaluation) -> Vec<String> {
    let mut lines = vec!["\n## What decides?\n".to_owned()];
    lines.push(format!(
        "The {SHOWN} largest shares of each claim's variance (ω² of a linear model of all choices). A share of two \
         choices together is what they add to the shares of each alone. Intervals are 95 % intervals by the jackknife \
         over movements. All numbers: [variance.csv](variance.csv).\n"
    ));
    lines.extend([row(["claim", "n", "single choices", "two together"]), rule(4)]);
    for judged in &evaluation.results.design.claims {
        let of = |pairs: bool| {
            let own = evaluation.variance.iter().filter(|row| row.claim == judged.id);
            let own =
                own.filter(|row| row.with.is_empty() != pairs && row.share.is_some_and(|share| share > 0.0));
            let name = |row: &VarianceRow| match row.with.as_str() {
                "" => row.factor.clone(),
                other => format!("{} × {other}", row.factor),
            };
            let words =
                by_share(own).into_iter().take(SHOWN).map(|row| format!("{} {}", name(row), in_words(row)));
            words.collect::<Vec<String>>().join("; ")
        };
        let n = evaluation.variance.iter().find(|row| row.claim == judged.id).map_or(0, |row| row.n);
        lines.push(row([judged.name(), n.to_string(), of(false), of(true)]));
    }
    lines
}

/// The pictures of all values of each claim.
pub(super) fn curves(results: &Results) -> Vec<String> {
    let mut lines = vec![
        "\n## Specification curves\n".to_owned(),
        "All estimates by size, with their intervals (grey), the accepted range (green) and the published number (dashed). \
         Beneath: the darker, the more of the estimates above have that choice.\n"
            .to_owned(),
    ];
    for judged in &results.design.claims {
        lines.push(format!("![{}](figures/{}.svg)\n", judged.name(), judged.id));
    }
    lines
}

/// The answer in a paragraph.
fn answer(evaluation: &Evaluation) -> String {
    let find = |group: &str, claim: &str| {
        evaluation.shares.iter().find(|row| row.group == group && row.claim == claim)
    };
    let of = |group: &str, claim: &str| find(group, claim).map_or("–".to_owned(), share);
    let all = &evaluation.results.configurations;
    let resolved = all.iter().filter(|one| one.resolved).count();
    let failed = all.iter().filter(|one| one.failed > 0).count();
    let mut words = values(evaluation);
    if find("all", HEADLINE).is_some() {
        words += &format!(
            "Of all configurations, {} have a tree accuracy within the accepted range; of the {resolved} whose movements the time \
             step resolves, {}. ",
            of("all", HEADLINE),
            of("resolved", HEADLINE),
        );
    }
    words += &format!(
        "All claims together hold in {} of the configurations. {failed} of them failed: their movement was unstable, or their \
         sensors gave no map.",
        of("all", TOGETHER),
    );
    let headline = evaluation.variance.iter().filter(|row| row.claim == HEADLINE && row.with.is_empty());
    if let [first, second, ..] = &by_share(headline.filter(|row| row.share.is_some()))[..] {
        words += &format!(
            " What decides the tree accuracy most is the {} ({} of its variance), then the {} ({}).",
            first.factor,
            in_words(first),
            second.factor,
            in_words(second)
        );
    }
    if let Some(joint) = &evaluation.joint {
        let (middle, low, high) = (joint.expected, joint.expected_low, joint.expected_high);
        let percent = |share: f64| numbers::value(Some(share), Some(Unit::Rate));
        words += &format!(
            " {} configurations have samples of separate chains. If the published rate were true in each of these, {} of \
             them would lie within the range by chance (95 % of simulated multiverses: {} to {}). In fact {} of them do; \
             {} of simulated multiverses have as few.",
            joint.n,
            percent(middle),
            percent(low),
            percent(high),
            percent(joint.share),
            percent(joint.as_low)
        );
    }
    words
}

/// How many configurations have a value of the headline, and where these lie.
fn values(evaluation: &Evaluation) -> String {
    let design = &evaluation.results.design;
    let Some(at) = design.claims.iter().position(|judged| judged.id == HEADLINE) else {
        return String::new();
    };
    let Curve { points, accepted: (low, high), published, .. } = evaluation.curve(at);
    let count = |holds: &dyn Fn(&Point) -> bool| points.iter().filter(|point| holds(point)).count();
    let reach = published.map_or(0, |published| {
        count(&|point| point.interval.is_some_and(|(low, high)| (low..=high).contains(&published)))
    });
    format!(
        "Of {} configurations, {} have an eligible sample, and with it a tree accuracy. {} of these lie within the accepted \
         range, {} below it ({} at 0 %) and {} above; the intervals of {reach} reach the published number. ",
        evaluation.results.configurations.len(),
        points.len(),
        count(&|point| (low..=high).contains(&point.value)),
        count(&|point| point.value < low),
        count(&|point| point.value == 0.0),
        count(&|point| point.value > high),
    )
}

/// The rows with the largest shares first.
fn by_share<'a>(rows: impl Iterator<Item = &'a VarianceRow>) -> Vec<&'a VarianceRow> {
    let mut rows: Vec<&VarianceRow> = rows.collect();
    rows.sort_by(|a, b| b.share.unwrap_or_default().total_cmp(&a.share.unwrap_or_default()));
    rows
}

fn share(row: &ShareRow) -> String {
    with_ends(row.share, row.low.zip(row.high), " (", ")")
}

fn in_words(row: &VarianceRow) -> String {
    with_ends(row.share, row.low.zip(row.high), ", ", "")
}

/// A share with its interval, where there is one.
fn with_ends(share: Option<f64>, ends: Option<(f64, f64)>, open: &str, close: &str) -> String {
    let share = numbers::value(share, Some(Unit::Rate));
    match ends {
        Some(_) => format!("{share}{open}{}{close}", numbers::range(ends, Some(Unit::Rate))),
        None => share,
    }
}

/// How configurations were drawn.
fn drawn(draws: DrawCounts) -> String {
    let DrawCounts { movements, distances, maps, inferences, .. } = draws;
    format!(
        "There are {movements} movements, of each {distances} matrices of distances, of each {maps} kinds of body map, of each \
         {inferences} ways to infer. They are drawn evenly from all combinations of the options below, by a scrambled Sobol sequence. \
         `bodyschema study DESIGN --only NUMBER` runs one configuration again, and writes all its settings."
    )
}

/// A row for each claim, a column for each group.
fn table(evaluation: &Evaluation) -> Vec<String> {
    let groups = evaluation.groups();
    let header = groups.iter().map(|(name, n)| format!("{name} (n = {n})"));
    let header = ["claim", "accepted", "with a value"].map(str::to_owned).into_iter().chain(header);
    let mut lines = vec![row(header), rule(groups.len() + 3)];
    let claims = evaluation.results.design.claims.iter().zip(&evaluation.claims);
    let named = claims.map(|(judged, claim)| {
        let accepted = numbers::range(claim.accept, claim.measure.unit());
        (judged.id.as_str(), judged.name(), accepted)
    });
    for (id, label, accepted) in named.chain([(TOGETHER, TOGETHER.to_owned(), String::new())]) {
        let cells = groups.iter().map(|(group, _)| {
            let found = evaluation.shares.iter().find(|row| row.group == *group && row.claim == id);
            found.map_or("–".to_owned(), share)
        });
        let all = evaluation.shares.iter().find(|row| row.group == groups[0].0 && row.claim == id);
        let with_value = all.map_or(0, |row| row.with_value).to_string();
        lines.push(row([label, accepted, with_value].into_iter().chain(cells)));
    }
    lines
}
