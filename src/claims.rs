//! Published claims and an experiment's records → a verdict on each claim.
//!
//! What the paper says stands in `reproduce/published.toml`, with the range that counts as reproduced; this
//! file only measures. A claim over several dimensions holds if it holds at each that has a sample.

use std::io::Write;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::figures::Conditions;
use crate::record::tables::write_rows;
use crate::record::{FileError, write_whole};
use crate::schema::Model;
use crate::statistics::{Estimate, mann_whitney, mean, rate, rate_difference, smallest_adjusted};

const PUBLISHED: &str = include_str!("../reproduce/published.toml");

/// A checkable statement of the paper.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Claim {
    /// Short name.
    pub id: String,
    /// Number of the figure that shows it.
    pub figure: String,
    /// Where the paper says so.
    pub place: String,
    /// What it says.
    pub statement: String,
    /// Its value, in the paper's words.
    pub published: String,
    /// The reproduced values that count as reproduced: a closed range.
    pub accept: (f64, f64),
    /// Successes and trials that a published rate may stand for.
    #[serde(default)]
    pub possible_counts: Vec<(usize, usize)>,
    /// What is measured.
    pub measure: Measure,
}

/// What a claim is about.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Measure {
    /// Rate of right trees among the eligible samples, at each dimension.
    TreeRate {
        /// The mixture.
        model: Model,
        /// The dimensions.
        dimensions: Vec<usize>,
    },
    /// The same over the samples of all dimensions together.
    PooledTreeRate {
        /// The mixture.
        model: Model,
        /// The dimensions.
        dimensions: Vec<usize>,
    },
    /// Mean number of parts, of each model at each dimension.
    MeanParts {
        /// The mixtures.
        models: Vec<Model>,
        /// The dimensions.
        dimensions: Vec<usize>,
    },
    /// Mean adjusted Rand index, of each model at each dimension.
    MeanAri {
        /// The mixtures.
        models: Vec<Model>,
        /// The dimensions.
        dimensions: Vec<usize>,
    },
    /// Smallest p value, after Holm's correction, of Mann–Whitney tests between both models' ARI at each
    /// dimension.
    AriDifference {
        /// The dimensions.
        dimensions: Vec<usize>,
    },
    /// The dimension with the highest tree rate; the named one if it is among them.
    BestDimension {
        /// The mixture.
        model: Model,
        /// The dimension that wins a tie.
        dimension: usize,
    },
}

/// What the run says of a claim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Every value lies in the range.
    Reproduced,
    /// Some value does not.
    NotReproduced,
    /// There is no value.
    NotTestable,
}

impl Verdict {
    /// As written in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Reproduced => "reproduced",
            Self::NotReproduced => "not reproduced",
            Self::NotTestable => "not testable",
        }
    }
}

/// A claim, its worst value, and its verdict.
#[derive(Debug, Clone, PartialEq)]
pub struct Judged {
    /// The claim.
    pub claim: Claim,
    /// The value that lies farthest towards the outside of the range.
    pub reproduced: Estimate,
    /// Where that value was found.
    pub place: String,
    /// The verdict.
    pub verdict: Verdict,
}

/// The claims of `reproduce/published.toml`, in its order.
pub fn published() -> Vec<Claim> {
    #[derive(Deserialize)]
    struct File {
        claim: Vec<Claim>,
    }
    let file: File =
        toml::from_str(PUBLISHED).expect("reproduce/published.toml matches Claim; a test checks it");
    file.claim
}

/// Judges a claim.
pub fn judge(claim: Claim, conditions: &Conditions) -> Judged {
    // A bound at the end of a share's scale excludes nothing, so no value is near to it.
    let low = if claim.accept.0 == 0.0 { f64::NEG_INFINITY } else { claim.accept.0 };
    let high = if claim.accept.1 == 1.0 { f64::INFINITY } else { claim.accept.1 };
    let measured = measure(&claim.measure, conditions);
    let mut untested = Vec::new();
    let mut worst: Option<(f64, &Estimate, &str)> = None;
    for (place, estimate) in &measured {
        match estimate.value {
            None => untested.push(place.as_str()),
            Some(value) => {
                // How far outside the range; negative inside.
                let outside = (low - value).max(value - high);
                if worst.is_none_or(|(most, ..)| outside > most) {
                    worst = Some((outside, estimate, place));
                }
            }
        }
    }
    let (reproduced, place, verdict) = match worst {
        None => (
            Estimate { value: None, n: 0, interval: None },
            "no sample to judge by".to_owned(),
            Verdict::NotTestable,
        ),
        Some((outside, estimate, place)) => {
            let several = measured.len() > 1;
            let missing = if untested.is_empty() {
                String::new()
            } else {
                format!("; no sample: {}", untested.join(", "))
            };
            let place = format!("{}{place}{missing}", if several { "worst: " } else { "" });
            (*estimate, place, if outside <= 0.0 { Verdict::Reproduced } else { Verdict::NotReproduced })
        }
    };
    Judged { claim, reproduced, place, verdict }
}

/// All values that a claim is about, each with its place.
fn measure(measure: &Measure, conditions: &Conditions) -> Vec<(String, Estimate)> {
    let tree_rate = |model, d| {
        let (correct, eligible) = conditions.trees(model, d);
        rate(correct, eligible)
    };
    let each = |models: &[Model], dimensions: &[usize], estimate: &dyn Fn(Model, usize) -> Estimate| {
        let place = |model: Model, d| match models {
            [_] => format!("d = {d}"),
            _ => format!("{} at d = {d}", model.name()),
        };
        models
            .iter()
            .flat_map(|&model| dimensions.iter().map(move |&d| (model, d)))
            .map(|(model, d)| (place(model, d), estimate(model, d)))
            .collect()
    };
    match measure {
        Measure::TreeRate { model, dimensions } => each(&[*model], dimensions, &tree_rate),
        Measure::PooledTreeRate { model, dimensions } => {
            let (correct, eligible) = dimensions
                .iter()
                .map(|&d| conditions.trees(*model, d))
                .fold((0, 0), |sum, next| (sum.0 + next.0, sum.1 + next.1));
            vec![("all d".to_owned(), rate(correct, eligible))]
        }
        Measure::MeanParts { models, dimensions } => {
            each(models, dimensions, &|model, d| conditions.mean_parts(model, d))
        }
        Measure::MeanAri { models, dimensions } => {
            each(models, dimensions, &|model, d| mean(&conditions.aris(model, d)))
        }
        Measure::AriDifference { dimensions } => {
            let run: Vec<_> = dimensions
                .iter()
                .map(|&d| Model::ALL.map(|model| conditions.aris(model, d)))
                .filter(|[first, second]| !first.is_empty() && !second.is_empty())
                .collect();
            let p_values: Vec<f64> = run.iter().map(|[first, second]| mann_whitney(first, second)).collect();
            let n = run.iter().flatten().map(Vec::len).sum();
            vec![("all d".to_owned(), Estimate { value: smallest_adjusted(&p_values), n, interval: None })]
        }
        Measure::BestDimension { model, dimension } => {
            let rates: Vec<(usize, f64)> = conditions
                .dimensions()
                .into_iter()
                .filter_map(|d| Some((d, tree_rate(*model, d).value?)))
                .collect();
            let highest = rates.iter().map(|(_, rate)| *rate).reduce(f64::max);
            let best: Vec<usize> =
                rates.iter().filter(|(_, rate)| Some(*rate) == highest).map(|(d, _)| *d).collect();
            // Without a rate at the published dimension there is nothing to compare with.
            let tested = rates.iter().any(|(d, _)| d == dimension);
            let value =
                if best.contains(dimension) { Some(dimension) } else { best.first().filter(|_| tested) };
            let n = rates.iter().map(|(d, _)| conditions.trees(*model, *d).1).sum();
            let place = match highest {
                Some(highest) => format!("{:.1} % at d = {}", 100.0 * highest, list(&best)),
                None => "no eligible sample".to_owned(),
            };
            vec![(place, Estimate { value: value.map(|&d| d as f64), n, interval: None })]
        }
    }
}

fn list(dimensions: &[usize]) -> String {
    dimensions.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")
}

#[derive(Serialize)]
struct Row<'a> {
    id: &'a str,
    figure: &'a str,
    statement: &'a str,
    published: &'a str,
    reproduced: Option<f64>,
    n: usize,
    low: Option<f64>,
    high: Option<f64>,
    tolerance: String,
    verdict: &'a str,
}

/// Writes `claims.csv`; `tolerance` is the accepted range, `low..high`.
///
/// # Errors
/// If the file cannot be written.
pub fn write_csv(path: &Path, judged: &[Judged]) -> Result<(), FileError> {
    let rows = judged.iter().map(|Judged { claim, reproduced, verdict, .. }| {
        let (low, high) = reproduced.interval.unzip();
        Row {
            id: &claim.id,
            figure: &claim.figure,
            statement: &claim.statement,
            published: &claim.published,
            reproduced: reproduced.value,
            n: reproduced.n,
            low,
            high,
            tolerance: format!("{}..{}", claim.accept.0, claim.accept.1),
            verdict: verdict.name(),
        }
    });
    write_rows(path, rows)
}

/// Writes `claims.md`: `preamble`, the table, and the comparison of the first claim.
///
/// # Errors
/// If the file cannot be written.
pub fn write_markdown(path: &Path, preamble: &str, judged: &[Judged]) -> Result<(), FileError> {
    write_whole(path, |file| {
        writeln!(file, "{preamble}\n")?;
        writeln!(
            file,
            "| claim | paper | published | reproduced | n | 95 % interval | accepted | verdict | where |"
        )?;
        writeln!(file, "|---|---|---|---|---|---|---|---|---|")?;
        for Judged { claim, reproduced, place, verdict } in judged {
            writeln!(
                file,
                "| {} | figure {}, {} | {} | {} | {} | {} | {} to {} | {} | {place} |",
                claim.statement,
                claim.figure,
                claim.place,
                claim.published,
                number(reproduced.value),
                reproduced.n,
                interval(reproduced),
                claim.accept.0,
                claim.accept.1,
                verdict.name(),
            )?;
        }
        for line in judged.iter().filter_map(comparison) {
            writeln!(file, "\n{line}")?;
        }
        Ok(())
    })
}

/// The table for a terminal, a line a claim.
pub fn terminal_table(judged: &[Judged]) -> String {
    let mut rows =
        vec![["claim", "published", "reproduced", "n", "95 % interval", "verdict"].map(str::to_owned)];
    rows.extend(judged.iter().map(|Judged { claim, reproduced, verdict, .. }| {
        [
            claim.id.clone(),
            claim.published.clone(),
            number(reproduced.value),
            reproduced.n.to_string(),
            interval(reproduced),
            verdict.name().to_owned(),
        ]
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
    let successes = (value * reproduced.n as f64).round() as usize;
    let (k, n) = claim.possible_counts[0];
    let differences: Vec<String> = claim
        .possible_counts
        .iter()
        .map(|&(k, n)| {
            let (low, high) = rate_difference((successes, reproduced.n), (k, n));
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

fn number(value: Option<f64>) -> String {
    value.map_or("none".to_owned(), |value| format!("{}", (value * 1e3).round() / 1e3))
}

fn interval(estimate: &Estimate) -> String {
    let ends = |(low, high): (f64, f64)| format!("{} to {}", number(Some(low)), number(Some(high)));
    estimate.interval.map_or("none".to_owned(), ends)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pipeline::Record;

    fn record(model: Model, dimension: usize, parts: usize, ari: f64, tree_correct: bool) -> Record {
        Record {
            simulation: 1,
            dimension,
            model,
            chain: 0,
            sweep: 1,
            parts,
            log_posterior: 0.0,
            ari,
            eligible: ari == 1.0,
            tree_correct,
        }
    }

    fn judge_by_id(id: &str, records: &[Record]) -> Judged {
        let claim = published().into_iter().find(|claim| claim.id == id).unwrap();
        judge(claim, &Conditions::new(records))
    }

    #[test]
    fn the_published_claims_load_with_the_accuracy_first() {
        let claims = published();
        assert_eq!((claims[0].id.as_str(), claims[0].published.as_str()), ("tree-accuracy", "84.6 %"));
        assert!(claims.iter().all(|claim| claim.accept.0 <= claim.accept.1));
    }

    #[test]
    fn a_rate_is_judged_on_both_sides_of_its_range() {
        for (correct, verdict) in
            [(20, Verdict::NotReproduced), (17, Verdict::Reproduced), (14, Verdict::NotReproduced)]
        {
            let records: Vec<_> = (0..20).map(|i| record(Model::DpgmmLj, 14, 5, 1.0, i < correct)).collect();
            let judged = judge_by_id("tree-accuracy", &records);
            assert_eq!((judged.verdict, judged.reproduced.n), (verdict, 20), "{correct}");
        }
    }

    #[test]
    fn without_an_eligible_sample_there_is_no_rate() {
        let judged = judge_by_id("tree-accuracy", &[record(Model::DpgmmLj, 14, 6, 0.9, false)]);
        assert_eq!((judged.verdict, judged.reproduced.value), (Verdict::NotTestable, None));
        assert!(comparison(&judged).unwrap().contains("no rate, 0 of 0"));
    }

    #[test]
    fn the_worst_dimension_decides() {
        let records = [record(Model::DpgmmLj, 2, 5, 0.5, false), record(Model::DpgmmLj, 3, 7, 0.9, false)];
        let parts = judge_by_id("number-of-parts", &records);
        assert_eq!((parts.verdict, parts.reproduced.value), (Verdict::NotReproduced, Some(7.0)));
        assert!(parts.place.starts_with("worst: d = 3; no sample: d = 4"), "{}", parts.place);
        assert_eq!(judge_by_id("ari-unknown-number", &records).reproduced.value, Some(0.5));
    }

    #[test]
    fn a_tie_for_the_best_dimension_counts_and_a_better_one_does_not() {
        let at = |d, correct| record(Model::DpgmmLj, d, 5, 1.0, correct);
        let tie = judge_by_id("best-dimension", &[at(12, true), at(14, true)]);
        assert_eq!(tie.verdict, Verdict::Reproduced);
        let better = judge_by_id("best-dimension", &[at(12, true), at(14, false)]);
        assert_eq!((better.verdict, better.reproduced.value), (Verdict::NotReproduced, Some(12.0)));
    }

    #[test]
    fn the_worst_of_a_one_sided_range_is_the_one_nearest_to_its_bound() {
        let at = |d, ari| record(Model::DpgmmLj, d, 5, ari, false);
        let judged = judge_by_id("ari-unknown-number", &[at(3, 1.0), at(4, 0.85), at(5, 0.95)]);
        assert_eq!((judged.verdict, judged.reproduced.value), (Verdict::Reproduced, Some(0.85)));
    }

    #[test]
    fn the_best_dimension_is_not_testable_where_the_published_one_was_not_run() {
        let judged = judge_by_id("best-dimension", &[record(Model::DpgmmLj, 4, 5, 1.0, true)]);
        assert_eq!(judged.verdict, Verdict::NotTestable);
    }

    #[test]
    fn a_clear_difference_in_ari_is_seen() {
        let records: Vec<_> = (0..30)
            .flat_map(|i| {
                [
                    record(Model::Dpgmm, 5, 5, 0.9 + 0.001 * i as f64, false),
                    record(Model::DpgmmLj, 5, 5, 0.5, false),
                ]
            })
            .collect();
        assert_eq!(judge_by_id("ari-no-difference", &records).verdict, Verdict::NotReproduced);
        assert_eq!(judge_by_id("ari-no-difference", &records[..1]).verdict, Verdict::NotTestable);
    }

    #[test]
    fn the_comparison_carries_difference_and_both_intervals() {
        let records: Vec<_> = (0..20).map(|i| record(Model::DpgmmLj, 14, 5, 1.0, i < 19)).collect();
        let line = comparison(&judge_by_id("tree-accuracy", &records)).unwrap();
        for part in [
            "published 84.6 %",
            "reproduced 95.0 %",
            "n = 20",
            "difference +10.4 points",
            "if published 11/13",
            "if published 77/91",
        ] {
            assert!(line.contains(part), "{line:?} lacks {part:?}");
        }
    }
}
