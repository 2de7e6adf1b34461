//! A study's table → DEVIATIONS.md: for each open setting what the paper says, what is chosen, why, and what it does.

use std::fmt::Write as _;

use super::sensitivity::{DEFAULT, Design, Measure, Part, Row, default_value};
use crate::claims;
use crate::plot::effects::{Column, Line};
use crate::schema::Model;
use crate::settings::Settings;

/// The claim that the page asks of: the published tree accuracy.
const HEADLINE: &str = "tree-accuracy";

/// Whether the published tree accuracy survives a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Survival {
    /// The rate is within the range that counts as reproduced.
    Yes,
    /// The rate is not, but its interval reaches it.
    Perhaps,
    /// The whole interval lies above.
    Higher,
    /// The whole interval lies below.
    Lower,
    /// There is no eligible draw.
    Nothing,
}

impl Survival {
    const ALL: [Self; 5] = [Self::Yes, Self::Perhaps, Self::Higher, Self::Lower, Self::Nothing];

    fn of(row: Option<&Row>, (low, high): (f64, f64)) -> Self {
        let Some((rate, row)) = row.and_then(|row| Some((row.estimate?, row))) else { return Self::Nothing };
        let (least, most) = row.low.zip(row.high).unwrap_or((rate, rate));
        match () {
            () if (low..=high).contains(&rate) => Self::Yes,
            () if least > high => Self::Higher,
            () if most < low => Self::Lower,
            () => Self::Perhaps,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Yes => "yes",
            Self::Perhaps => "perhaps",
            Self::Higher => "no, higher",
            Self::Lower => "no, lower",
            Self::Nothing => "no, no eligible draw",
        }
    }
}

/// Rows of a study, with where its main condition is.
pub struct Table<'a> {
    design: &'a Design,
    rows: &'a [Row],
    coordination: f64,
    dimension: usize,
    /// The published value, in the paper's words.
    published: String,
    accept: (f64, f64),
}

impl<'a> Table<'a> {
    /// The main condition is the p of every configuration, and the d of its experiment 2.
    pub fn new(design: &'a Design, rows: &'a [Row]) -> Self {
        let headline = claims::published().into_iter().find(|claim| claim.id == HEADLINE);
        let headline = headline.expect("the headline is published");
        let accept = headline.accept.expect("the headline has a range");
        let settings = design.defaults().expect("a design has been checked");
        let (coordination, dimension) = (settings.motion.coordination, settings.experiment.dimension);
        Self { design, rows, coordination, dimension, published: headline.published, accept }
    }

    /// The values of a part, in their order.
    fn values(&self, part: &str) -> Vec<&'a str> {
        let mut values: Vec<&str> = Vec::new();
        for row in self.rows.iter().filter(|row| row.part == part) {
            if !values.contains(&row.value.as_str()) {
                values.push(&row.value);
            }
        }
        values
    }

    /// A measure at the main condition.
    fn main(&self, part: &str, value: &str, model: Model, measure: Measure) -> Option<&'a Row> {
        self.at(part, value, (self.coordination, self.dimension), model, measure)
    }

    fn at(
        &self,
        part: &str,
        value: &str,
        (coordination, dimension): (f64, usize),
        model: Model,
        measure: Measure,
    ) -> Option<&'a Row> {
        self.rows.iter().find(|row| {
            row.part == part
                && row.value == value
                && row.model == model
                && row.measure == measure
                && row.coordination == coordination
                && row.dimension == dimension
        })
    }

    /// The other conditions of DPGMM-LJ.
    fn others(&self) -> Vec<(f64, usize)> {
        let mut all: Vec<(f64, usize)> = Vec::new();
        for row in self.rows.iter().filter(|row| row.part == DEFAULT && row.model == Model::DpgmmLj) {
            let at = (row.coordination, row.dimension);
            if at != (self.coordination, self.dimension) && !all.contains(&at) {
                all.push(at);
            }
        }
        all
    }

    fn survival(&self, part: &str, value: &str) -> Survival {
        Survival::of(self.main(part, value, Model::DpgmmLj, Measure::Tree), self.accept)
    }
}

/// The panels of every picture.
pub fn columns() -> [Column; 4] {
    let published = claims::figures().into_iter().find(|figure| figure.name == "fig11b-tree");
    let published = published.and_then(|figure| figure.mark).map(|mark| mark.value);
    [
        Column { title: "number\nof parts", share: false, published: None },
        Column { title: "adjusted\nRand index", share: true, published: None },
        Column { title: "tree right,\nDPGMM-LJ", share: true, published },
        Column { title: "tree right,\n+ Prim", share: true, published: None },
    ]
}

impl Table<'_> {
    /// What the picture of a part shows: the default, then each value, at the main condition.
    pub fn lines(&self, part: &str) -> Vec<Line> {
        let line = |label: &str, part: &str, value: &str| {
            let cell = |model, measure| {
                let row = self.main(part, value, model, measure)?;
                Some((row.estimate?, row.low.zip(row.high)))
            };
            let measures = [
                (Model::DpgmmLj, Measure::Parts),
                (Model::DpgmmLj, Measure::Ari),
                (Model::DpgmmLj, Measure::Tree),
                (Model::Dpgmm, Measure::Tree),
            ];
            let cells = measures.into_iter().map(|(model, measure)| cell(model, measure)).collect();
            Line { label: label.to_owned(), cells }
        };
        let values = self.values(part);
        std::iter::once(line(DEFAULT, DEFAULT, ""))
            .chain(values.into_iter().map(|value| line(value, part, value)))
            .collect()
    }

    /// The page.
    pub fn page(&self, revision: &str) -> String {
        let Self { design, published, .. } = self;
        let paper = Settings::paper();
        let mut text = String::new();
        let mut line = |line: &str| writeln!(text, "{line}").expect("a text takes all");
        let (low, high) = self.accept;
        let (p, d) = (self.coordination, self.dimension);
        let all: Vec<Survival> = design
            .part
            .iter()
            .flat_map(|part| {
                self.values(&part.name).into_iter().map(|value| self.survival(&part.name, value))
            })
            .collect();
        line("# What the paper leaves open, and how much it matters\n");
        line(&format!(
            "Would the published tree accuracy, {published}, survive another reasonable choice? Each setting that the paper does \
         not give is varied here around the default, one at a time and in pairs, all on the same simulations. For {} \
         other choices: {}.\n",
            all.len(),
            counts(&all)
        ));
        line(&format!(
            "Made by `reproduce/sensitivity.sh` (revision {revision}): {}; all else as in \
         [reproduce/paper.toml](reproduce/paper.toml). Numbers are at p = {p} and d = {d} unless a column says \
         otherwise. Intervals are 95 % intervals over simulations (bootstrap); *change* is the difference from the \
         default, paired by simulation; in the pictures the orange line is the default, and the dashed one the \
         published rate. A rate is over the eligible draws: five parts and an ARI of 1. All numbers, of \
         every condition and measure: [sensitivity.csv](sensitivity.csv). How the default was chosen: \
         [search.md](reproduce/shown/search/search.md).\n",
            design.summary(),
        ));
        line(&format!(
            "**yes**: the rate lies between {:.1} and {:.1} %, the range that counts as reproduced \
         ([published.toml](reproduce/published.toml)); **perhaps**: it does not, but its interval reaches that range; \
         **no**: the whole interval lies beyond, or there is nothing to count.\n",
            100.0 * low,
            100.0 * high
        ));
        let default = self.survival(DEFAULT, "");
        line(&format!(
            "With the default itself: {} ({}).\n",
            cell(self.main(DEFAULT, "", Model::DpgmmLj, Measure::Tree), true),
            default.name()
        ));
        line(&format!(
            "| setting | the paper says | we chose | why | tree accuracy with other values | does {published} survive? |"
        ));
        line("|---|---|---|---|---|---|");
        for part in &design.part {
            let values = self.values(&part.name);
            let survivals: Vec<Survival> =
                values.iter().map(|value| self.survival(&part.name, value)).collect();
            let rates = values.iter().filter_map(|value| {
                self.main(&part.name, value, Model::DpgmmLj, Measure::Tree).and_then(|row| row.estimate)
            });
            let (least, most) =
                rates.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), rate| (a.min(rate), b.max(rate)));
            let span = if least > most {
                "none".to_owned()
            } else if least == most {
                percent(least)
            } else {
                format!("{} to {}", percent(least), percent(most))
            };
            line(&format!(
                "| [{}](#{}) | {} | {} | {} | {span} | {} |",
                part.title,
                part.name,
                part.paper,
                chosen(part, &paper),
                part.why,
                counts(&survivals)
            ));
        }
        let others = self.others();
        for part in &design.part {
            line(&format!("\n<a id=\"{}\"></a>\n\n## {}\n", part.name, part.title));
            line(&format!("![{}](figures/{}.svg)\n", part.title, part.name));
            let named: Vec<String> = others
                .iter()
                .map(|&(other_p, other_d)| match (other_p == p, other_d == d) {
                    (true, _) => format!("tree at d = {other_d}"),
                    (_, true) => format!("tree at p = {other_p}"),
                    _ => format!("tree at p = {other_p}, d = {other_d}"),
                })
                .collect();
            line(&format!(
                "| value | parts | ARI | eligible draws | tree accuracy | change | survives? | DPGMM + Prim | best draw | {} |",
                named.join(" | ")
            ));
            line(&format!("|{}", "---|".repeat(9 + named.len())));
            let values = self.values(&part.name).into_iter().map(|value| (part.name.as_str(), value));
            for (name, value) in std::iter::once((DEFAULT, "")).chain(values) {
                let main = |measure| self.main(name, value, Model::DpgmmLj, measure);
                let tree = main(Measure::Tree);
                let change = tree.filter(|_| name != DEFAULT).map_or(String::new(), change);
                let failed = main(Measure::Parts).filter(|row| row.failed > 0);
                let failed = failed.map_or(String::new(), |row| {
                    format!("; {} simulations failed: {}", row.failed, row.failure)
                });
                let elsewhere: Vec<String> = others
                    .iter()
                    .map(|&at| cell(self.at(name, value, at, Model::DpgmmLj, Measure::Tree), true))
                    .collect();
                let label = if name == DEFAULT {
                    format!("default: {}", chosen(part, &paper))
                } else {
                    value.to_owned()
                };
                line(&format!(
                    "| {label}{failed} | {} | {} | {} | {} | {change} | {} | {} | {} | {} |",
                    cell(main(Measure::Parts), false),
                    cell(main(Measure::Ari), false),
                    cell(main(Measure::Eligible), true),
                    cell(tree, true),
                    self.survival(name, value).name(),
                    cell(self.main(name, value, Model::Dpgmm, Measure::Tree), true),
                    cell(main(Measure::BestTree), true),
                    elsewhere.join(" | ")
                ));
            }
        }
        text
    }
}

fn chosen(part: &Part, paper: &Settings) -> String {
    let value = |key: &String| {
        let name = key.split_once('.').map_or(key.as_str(), |(_, name)| name);
        format!("{name} = {}", default_value(paper, key).unwrap_or_default())
    };
    part.settings.iter().map(value).collect::<Vec<_>>().join(", ")
}

/// How many of each kind.
fn counts(survivals: &[Survival]) -> String {
    let count = |kind: Survival| survivals.iter().filter(|found| **found == kind).count();
    let kinds = Survival::ALL.into_iter().map(|kind| (kind, count(kind))).filter(|(_, count)| *count > 0);
    kinds.map(|(kind, count)| format!("{count} × {}", kind.name())).collect::<Vec<_>>().join("; ")
}

fn percent(rate: f64) -> String {
    format!("{:.0} %", 100.0 * rate)
}

/// A value with its interval and number of samples.
fn cell(row: Option<&Row>, share: bool) -> String {
    let Some((row, value)) = row.and_then(|row| Some((row, row.estimate?))) else {
        return "none".to_owned();
    };
    let number = |value: f64| if share { format!("{:.0}", 100.0 * value) } else { format!("{value:.2}") };
    let unit = if share { " %" } else { "" };
    let interval = row.low.zip(row.high);
    let interval =
        interval.map_or(String::new(), |(low, high)| format!("{} to {}; ", number(low), number(high)));
    format!("{}{unit} ({interval}n = {})", number(value), row.n)
}

/// A difference of rates in points with its interval.
fn change(row: &Row) -> String {
    let Some(difference) = row.difference else { return "none".to_owned() };
    let points = |value: f64| format!("{:+.0}", 100.0 * value);
    let interval = row.difference_low.zip(row.difference_high);
    let interval =
        interval.map_or(String::new(), |(low, high)| format!(" ({} to {})", points(low), points(high)));
    format!("{}{interval}", points(difference))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_published_rate_survives_where_the_range_is_met_or_reached() {
        let row = |estimate, interval: Option<(f64, f64)>| {
            let (low, high) = interval.unzip();
            Row {
                part: DEFAULT.to_owned(),
                value: String::new(),
                coordination: 0.9,
                dimension: 14,
                model: Model::DpgmmLj,
                measure: Measure::Tree,
                estimate,
                n: 10,
                low,
                high,
                simulations: 2,
                lowest: None,
                highest: None,
                difference: None,
                difference_low: None,
                difference_high: None,
                failed: 0,
                failure: String::new(),
            }
        };
        let of = |estimate, interval| Survival::of(Some(&row(estimate, interval)), (0.7, 0.9));
        assert_eq!(of(Some(0.8), Some((0.1, 1.0))), Survival::Yes);
        assert_eq!(of(Some(0.95), Some((0.85, 1.0))), Survival::Perhaps);
        assert_eq!(of(Some(0.95), Some((0.91, 1.0))), Survival::Higher);
        assert_eq!(of(Some(0.4), Some((0.2, 0.6))), Survival::Lower);
        assert_eq!(of(Some(0.4), None), Survival::Lower);
        assert_eq!(of(None, None), Survival::Nothing);
        assert_eq!(Survival::of(None, (0.7, 0.9)), Survival::Nothing);
        let all = [Survival::Yes, Survival::Lower, Survival::Yes];
        assert_eq!(counts(&all), "2 × yes; 1 × no, lower");
    }
}
