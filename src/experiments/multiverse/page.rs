//! Describe a multiverse for people: first the answer, then the evidence.

use super::super::design::flat;
use super::super::draws::Draws;
use super::design::{Design, Factor};
use super::evaluation::{Evaluation, ShareRow, TOGETHER, VarianceRow};
use crate::analysis::published::{HEADLINE, Unit};
use crate::report::markdown::{row, rule};
use crate::report::numbers;
use crate::report::plot::specifications::{Curve, Point};

/// Sources of variance that are shown of a claim.
const SHOWN: usize = 4;

/// The page.
pub fn page(evaluation: &Evaluation) -> String {
    let Evaluation { design, .. } = evaluation;
    let mut lines = vec!["# A multiverse of replications\n".to_owned()];
    lines.extend([base(evaluation), answer(evaluation), String::new(), made(evaluation)]);
    lines.push("\n## In what share does each claim hold?\n".to_owned());
    lines.push(
        "A claim holds in a specification if its value lies within the accepted range. Without a value it does not hold; \
         the third column counts the specifications with a value. Intervals are 95 % intervals over resamples of the \
         movements, and of the specifications of each. All numbers: [shares.csv](shares.csv).\n"
            .to_owned(),
    );
    lines.extend(shares(evaluation));
    lines.push("\n## What decides?\n".to_owned());
    lines.push(format!(
        "The {SHOWN} largest shares of each claim's variance (ω² of a linear model of all choices). A share of two \
         choices together is what they add to the shares of each alone. Intervals are 95 % intervals by the jackknife \
         over movements. All numbers: [variance.csv](variance.csv).\n"
    ));
    lines.extend(decisive(evaluation));
    lines.push("\n## Specification curves\n".to_owned());
    lines.push(
        "All estimates by size, with their intervals (grey), the accepted range (green) and the published number (dashed). \
         Beneath: the darker, the more of the estimates above have that choice.\n"
            .to_owned(),
    );
    for compared in &design.claims {
        lines.push(format!("![{}](figures/{}.svg)\n", compared.label.replace('\n', " "), compared.id));
    }
    lines.push("## The choices\n".to_owned());
    for factor in &design.factors {
        lines.extend(choices(factor));
    }
    lines.join("\n").trim_end().to_owned() + "\n"
}

/// What the multiverse is of, so that nobody takes it for one of another default.
fn base(evaluation: &Evaluation) -> String {
    let Design { seed, settings, .. } = evaluation.design;
    format!(
        "This multiverse is of `reproduce/paper.toml` as of revision {}, seed {seed}. Every specification has `{}`. It says \
         nothing about a default that is not among the specifications.\n",
        evaluation.all[0].summary.revision,
        flat(settings).join("`, `")
    )
}

/// The answer in a paragraph.
fn answer(evaluation: &Evaluation) -> String {
    let find = |group: &str, claim: &str| {
        evaluation.shares.iter().find(|row| row.group == group && row.claim == claim)
    };
    let of = |group: &str, claim: &str| find(group, claim).map_or("–".to_owned(), in_words);
    let resolved = evaluation.all.iter().filter(|one| one.summary.resolved).count();
    let failed = evaluation.all.iter().filter(|one| one.summary.failed > 0).count();
    let mut words = values(evaluation);
    words += &format!(
        "Of all specifications, {} have a tree accuracy within the accepted range; of the {resolved} whose movements the time \
         step resolves, {}. All claims together hold in {}. {failed} specifications failed: their movement was unstable, or \
         their sensors gave no map.",
        of("all", HEADLINE),
        of("resolved", HEADLINE),
        of("all", TOGETHER),
    );
    let headline = evaluation.variance.iter().filter(|row| row.claim == HEADLINE && row.with.is_empty());
    let mut sources: Vec<&VarianceRow> = headline.filter(|row| row.share.is_some()).collect();
    sources.sort_by(|a, b| b.share.unwrap_or_default().total_cmp(&a.share.unwrap_or_default()));
    if let [first, second, ..] = &sources[..] {
        words += &format!(
            " What decides the tree accuracy most is the {} ({} of its variance), then the {} ({}).",
            first.factor,
            variance(first),
            second.factor,
            variance(second)
        );
    }
    if let Some(joint) = &evaluation.joint {
        let (middle, low, high) = (joint.expected, joint.expected_low, joint.expected_high);
        let percent = |share: f64| numbers::value(Some(share), Some(Unit::Rate));
        words += &format!(
            " {} specifications have samples of separate chains. If the published rate were true in each of these, {} of \
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

/// How many specifications have a value of the headline, and where these lie.
fn values(evaluation: &Evaluation) -> String {
    let Some(at) = evaluation.design.claims.iter().position(|compared| compared.id == HEADLINE) else {
        return String::new();
    };
    let Curve { points, accepted: (low, high), published, .. } = evaluation.curve(at);
    let count = |holds: &dyn Fn(&Point) -> bool| points.iter().filter(|point| holds(point)).count();
    let reach = published.map_or(0, |published| {
        count(&|point| point.interval.is_some_and(|(low, high)| (low..=high).contains(&published)))
    });
    format!(
        "Of {} specifications, {} have an eligible sample, and with it a tree accuracy. {} of these lie within the accepted \
         range, {} below it ({} at 0 %) and {} above; the intervals of {reach} reach the published number. ",
        evaluation.all.len(),
        points.len(),
        count(&|point| (low..=high).contains(&point.value)),
        count(&|point| point.value < low),
        count(&|point| point.value == 0.0),
        count(&|point| point.value > high),
    )
}

fn in_words(row: &ShareRow) -> String {
    with_ends(row.share, row.low.zip(row.high), " (", ")")
}

fn variance(row: &VarianceRow) -> String {
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

/// How it was made.
fn made(evaluation: &Evaluation) -> String {
    let Draws { movements, distances, maps, inferences } = evaluation.design.draws;
    format!(
        "Made by `bodyschema multiverse`: {movements} movements, of each {distances} matrices of distances, of each {maps} \
         kinds of body map, of each {inferences} ways to infer. They are drawn evenly from all combinations of the choices \
         below, by a scrambled Sobol sequence. A specification can be run again by its number, with `bodyschema multiverse \
         --only NUMBER`; its settings are in specifications/NUMBER/settings.toml. All values: \
         [multiverse.csv](multiverse.csv); what each specification is: [specifications.csv](specifications.csv)."
    )
}

/// A row for each claim, a column for each group.
fn shares(evaluation: &Evaluation) -> Vec<String> {
    let groups: Vec<(String, usize)> =
        evaluation.groups().into_iter().map(|(name, members)| (name, members.len())).collect();
    let header = groups.iter().map(|(name, n)| format!("{name} (n = {n})"));
    let header = ["claim", "accepted", "with a value"].map(str::to_owned).into_iter().chain(header);
    let mut lines = vec![row(header), rule(groups.len() + 3)];
    let claims = evaluation.design.claims.iter().zip(&evaluation.claims);
    let named = claims.map(|(compared, claim)| {
        let accepted = numbers::range(claim.accept, claim.measure.unit());
        (compared.id.as_str(), compared.label.replace('\n', " "), accepted)
    });
    for (id, label, accepted) in named.chain([(TOGETHER, TOGETHER.to_owned(), String::new())]) {
        let cells = groups.iter().map(|(group, _)| {
            let found = evaluation.shares.iter().find(|row| row.group == *group && row.claim == id);
            found.map_or("–".to_owned(), in_words)
        });
        let all = evaluation.shares.iter().find(|row| row.group == groups[0].0 && row.claim == id);
        let with_value = all.map_or(0, |row| row.with_value).to_string();
        lines.push(row([label, accepted, with_value].into_iter().chain(cells)));
    }
    lines
}

/// The largest shares of variance of each claim.
fn decisive(evaluation: &Evaluation) -> Vec<String> {
    let mut lines = vec![row(["claim", "n", "single choices", "two together"]), rule(4)];
    for compared in &evaluation.design.claims {
        let of = |pairs: bool| {
            let own = evaluation.variance.iter().filter(|row| row.claim == compared.id);
            let mut own: Vec<&VarianceRow> = own
                .filter(|row| row.with.is_empty() != pairs && row.share.is_some_and(|share| share > 0.0))
                .collect();
            own.sort_by(|a, b| b.share.unwrap_or_default().total_cmp(&a.share.unwrap_or_default()));
            let name = |row: &VarianceRow| match row.with.as_str() {
                "" => row.factor.clone(),
                other => format!("{} × {other}", row.factor),
            };
            let words: Vec<String> =
                own.iter().take(SHOWN).map(|row| format!("{} {}", name(row), variance(row))).collect();
            words.join("; ")
        };
        let n = evaluation.variance.iter().find(|row| row.claim == compared.id).map_or(0, |row| row.n);
        lines.push(row([compared.label.replace('\n', " "), n.to_string(), of(false), of(true)]));
    }
    lines
}

fn choices(factor: &Factor) -> Vec<String> {
    let mut lines = vec![format!("**{}.** The paper: {}.\n", factor.name, factor.paper)];
    lines.extend([row(["option", "settings", "why"]), rule(3)]);
    lines.extend(factor.options.iter().map(|option| {
        let mut settings = flat(&option.settings);
        if let Some(gains) = option.gains {
            settings.push(format!(
                "natural frequency {} rad/s, damping × step = {} × axial inertia",
                gains.frequency, gains.spin_damping
            ));
        }
        row([option.label.clone(), settings.join(", "), option.why.clone()])
    }));
    lines.push(String::new());
    lines
}
