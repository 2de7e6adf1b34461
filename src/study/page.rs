//! Write the page of a study: the question, then the sections that its design asks for.

mod factors;
mod ranking;
mod shares;
mod survival;
mod trade_offs;
mod values;

use super::choices::flat;
use super::design::{Factor, Section, Vary};
use super::evaluation::Evaluation;
use super::ranking::Ranking;
use super::results::Results;
use crate::files::FileError;
use crate::report::markdown::{row, rule};
use crate::report::plot::{self, PlotError};

/// The page.
pub(super) fn text(results: &Results, evaluation: Option<&Evaluation>, ranking: Option<&Ranking>) -> String {
    let design = &results.design;
    let mut lines = vec![format!("# {}\n", design.title)];
    let mut sections = Vec::new();
    for section in &design.sections {
        if !sections.is_empty() {
            sections.push(String::new());
        }
        sections.extend(match section {
            Section::Values => values::values(results),
            Section::Changes => values::changes(results),
            Section::Factors => factors::section(results),
            Section::Shares => evaluation.map(shares::shares).unwrap_or_default(),
            Section::Variance => evaluation.map(shares::variance).unwrap_or_default(),
            Section::Curves => shares::curves(results),
            Section::Ranking => ranking.map(|ranking| ranking::section(results, ranking)).unwrap_or_default(),
            Section::TradeOffs => trade_offs::section(results),
        });
    }
    // A page begins with its question, and with the answer where the program knows it.
    let is_answer = |line: &String| !line.starts_with("\n##");
    let answers = sections.iter().take(1).filter(|line| is_answer(line)).count();
    if !design.about.is_empty() {
        lines.extend([design.about.trim().to_owned(), String::new()]);
    }
    lines.extend(sections.drain(..answers));
    lines.push(provenance(results));
    lines.extend(sections);
    lines.extend(match (design.vary, design.configurations.is_empty()) {
        (Some(Vary::OneAtATime), _) => Vec::new(),
        (_, false) => configurations(results),
        _ => options(&design.factors),
    });
    let mut text = lines.join("\n").trim_end().to_owned() + "\n";
    while text.contains("\n\n\n") {
        text = text.replace("\n\n\n", "\n\n");
    }
    text
}

/// How the numbers were made.
fn provenance(results: &Results) -> String {
    let design = &results.design;
    let settings = flat(&design.settings);
    let settings = match settings.is_empty() {
        true => String::new(),
        false => format!("; all have `{}` instead", settings.join(", ")),
    };
    let count = results.configurations.len();
    let of = match results.planned > count {
        true => format!(" of the {} of the design", results.planned),
        false => String::new(),
    };
    format!(
        "**Configurations:** {}{of}, over `reproduce/paper.toml` of revision {}{settings}. Seed {}. Made by `bodyschema study`; \
         [configurations.csv](configurations.csv) says what each is, and [study.csv](study.csv) has each claim's value, n, interval and \
         verdict.\n",
        count, results.revision, design.seed
    )
}

/// Names and texts of all pictures.
///
/// # Errors
/// If one cannot be drawn.
pub(super) fn pictures(
    results: &Results,
    evaluation: Option<&Evaluation>,
) -> Result<Vec<(String, String)>, FileError> {
    let failed = |error: PlotError| FileError::new(std::path::Path::new("figures"), error.0);
    let mut all = Vec::new();
    let design = &results.design;
    if design.has(Section::Values) {
        for (name, claims) in values::pictures(design) {
            let (columns, lines) = values::picture(results, claims);
            all.push((name, plot::effects::render(&columns, &lines, true).map_err(failed)?));
        }
    }
    if design.has(Section::Factors) {
        for (name, columns, lines) in factors::pictures(results) {
            all.push((name, plot::effects::render(&columns, &lines, true).map_err(failed)?));
        }
    }
    if let Some(evaluation) = evaluation.filter(|_| design.has(Section::Curves)) {
        for (at, judged) in design.claims.iter().enumerate() {
            let picture = plot::specifications::render(&evaluation.curve(at)).map_err(failed)?;
            all.push((format!("figures/{}.svg", judged.id), picture));
        }
    }
    Ok(all)
}

/// What each named configuration is, and what became of it.
fn configurations(results: &Results) -> Vec<String> {
    let mut lines = vec!["\n## Configurations\n".to_owned(), row(["name", "settings"]), rule(2)];
    lines.extend(results.configurations.iter().map(|one| {
        let mut words: Vec<String> =
            Some(one.settings.clone()).filter(|words| !words.is_empty()).into_iter().collect();
        if one.failed > 0 {
            words.push(format!("{} movements failed: {}", one.failed, one.failure));
        } else if !one.resolved {
            words.push("the time step does not resolve its movements".to_owned());
        }
        row([one.name.clone(), words.join(", ")])
    }));
    lines
}

/// The options of each factor, with their reasons.
fn options(factors: &[Factor]) -> Vec<String> {
    let mut lines = vec!["\n## The options\n".to_owned()];
    for factor in factors {
        lines.push(format!("**{}.** The paper: {}.\n", factor.heading(), factor.paper));
        lines.extend([row(["option", "settings", "why"]), rule(3)]);
        lines.extend(factor.options.iter().map(|option| {
            let gains = option.gains.map(|gains| gains.in_words());
            let settings: Vec<String> = flat(&option.settings).into_iter().chain(gains).collect();
            row([option.label.clone(), settings.join(", "), option.why.clone()])
        }));
        lines.push(String::new());
    }
    lines
}
