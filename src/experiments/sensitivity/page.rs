//! Write the page of a study: for each open setting what the paper says, what we chose, why, and what other values do.

use super::design::{DEFAULT, Design, Factor, default_value};
use super::survival::{Survival, counts};
use super::table::{Measure, Row};
use crate::analysis::published::{HEADLINE, claims, figures};
use crate::analysis::statistics::quantile;
use crate::report::markdown::{row, rule};
use crate::report::plot::effects::{Column, Line};
use crate::settings::Settings;
use crate::stages::schema::Model;

/// The page of a study: its rows, with where its main condition is.
pub struct Page<'a> {
    design: &'a Design,
    rows: &'a [Row],
    coordination: f64,
    dimension: usize,
    /// The published value, in the paper's words.
    published: String,
    accept: (f64, f64),
    simulations: usize,
}

impl<'a> Page<'a> {
    /// The main condition is the p of every configuration, and the d of its experiment 2.
    pub fn new(design: &'a Design, rows: &'a [Row]) -> Self {
        let headline = claims().into_iter().find(|claim| claim.id == HEADLINE);
        let headline = headline.expect("the headline is published");
        let accept = headline.accept.expect("the headline has a range");
        let settings = design.defaults().expect("a design has been checked");
        let (coordination, dimension) = (settings.motion.coordination, settings.experiment.dimension);
        let simulations = settings.experiment.simulations;
        Self { design, rows, coordination, dimension, published: headline.wording, accept, simulations }
    }

    /// The values of a factor, in their order.
    fn values(&self, factor: &str) -> Vec<&'a str> {
        let mut values: Vec<&str> = Vec::new();
        for row in self.rows.iter().filter(|row| row.factor == factor) {
            if !values.contains(&row.value.as_str()) {
                values.push(&row.value);
            }
        }
        values
    }

    /// A measure at the main condition.
    fn main(&self, factor: &str, value: &str, model: Model, measure: Measure) -> Option<&'a Row> {
        self.at(factor, value, (self.coordination, self.dimension), model, measure)
    }

    fn at(
        &self,
        factor: &str,
        value: &str,
        (coordination, dimension): (f64, usize),
        model: Model,
        measure: Measure,
    ) -> Option<&'a Row> {
        self.rows.iter().find(|row| {
            row.factor == factor
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
        for row in self.rows.iter().filter(|row| row.factor == DEFAULT && row.model == Model::DpgmmLj) {
            let at = (row.coordination, row.dimension);
            if at != (self.coordination, self.dimension) && !all.contains(&at) {
                all.push(at);
            }
        }
        all
    }

    fn survival(&self, factor: &str, value: &str) -> Survival {
        Survival::of(self.main(factor, value, Model::DpgmmLj, Measure::Tree), self.accept)
    }
}

/// The panels of every picture.
pub fn columns() -> [Column; 4] {
    let published = figures().into_iter().find(|figure| figure.name == "fig11b-tree");
    let published = published.and_then(|figure| figure.mark).map(|mark| mark.value);
    let column =
        |title: &str, share, published| Column { title: title.to_owned(), share, published, accepted: None };
    [
        column("number\nof parts", false, None),
        column("adjusted\nRand index", true, None),
        column("tree right,\nDPGMM-LJ", true, published),
        column("tree right,\n+ Prim", true, None),
    ]
}

impl Page<'_> {
    /// What the picture of a factor shows: the default, then each value, at the main condition.
    pub fn lines(&self, factor: &str) -> Vec<Line> {
        let line = |label: &str, factor: &str, value: &str| {
            let cell = |model, measure| {
                let row = self.main(factor, value, model, measure)?;
                Some((row.estimate?, row.cells.low.zip(row.cells.high)))
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
        let values = self.values(factor);
        std::iter::once(line(DEFAULT, DEFAULT, ""))
            .chain(values.into_iter().map(|value| line(value, factor, value)))
            .collect()
    }

    /// The page, which begins with the question and its answer.
    pub fn text(&self, revision: &str) -> String {
        let mut lines = vec!["# What the paper leaves open, and how much it matters\n".to_owned()];
        lines.extend(self.introduction(revision));
        lines.extend(self.overview());
        for factor in &self.design.factors {
            lines.extend(self.section(factor));
        }
        lines.join("\n") + "\n"
    }

    /// The question, the answers counted, the configuration, and how to read them.
    fn introduction(&self, revision: &str) -> [String; 5] {
        let Self { design, published, accept: (low, high), coordination: p, dimension: d, .. } = self;
        let pairs = design.factors.iter().flat_map(|factor| {
            self.values(&factor.name).into_iter().map(|value| (factor.name.as_str(), value))
        });
        let pairs: Vec<(&str, &str)> = pairs.collect();
        let survivals: Vec<Survival> =
            pairs.iter().map(|(factor, value)| self.survival(factor, value)).collect();
        [
            format!(
                "Would the published tree accuracy, {published}, survive another reasonable choice of a setting that the \
                 paper leaves open? The answers for {} other choices, of one setting or of a pair, are: {}.\n",
                survivals.len(),
                counts(&survivals)
            ),
            format!(
                "**Configuration:** the default, `reproduce/paper.toml` of revision {revision}, but {}. \
                 `reproduce/sensitivity.sh` makes this page. All choices run on the same simulations. Numbers are at p = \
                 {p} and d = {d} unless a column says otherwise. Intervals are 95 % intervals over simulations (bootstrap). \
                 *Change* is the difference from the default in percentage points, paired by simulation. In the pictures \
                 the orange line is the default, and the dashed line is the published rate. \
                 [sensitivity.csv](sensitivity.csv) has all numbers, of every condition and measure.\n",
                design.summary()
            ),
            format!(
                "**yes**: the rate lies between {:.1} and {:.1} %, the range that counts as reproduced \
                 (`reproduce/published.toml`). **perhaps**: the rate lies outside, but its interval reaches that range. \
                 **no**: the whole interval lies outside, or there is no eligible sample.\n",
                100.0 * low,
                100.0 * high
            ),
            self.data(&pairs),
            format!(
                "The default itself: {} ({}). These are {} simulations; `docs/results.md` has the results of the default.\n",
                cell(self.main(DEFAULT, "", Model::DpgmmLj, Measure::Tree), true),
                self.survival(DEFAULT, "").name(),
                self.simulations
            ),
        ]
    }

    /// How many draws each answer is over.
    fn data(&self, pairs: &[(&str, &str)]) -> String {
        let draws = |measure: Measure| {
            let rows = pairs.iter().map(|(factor, value)| self.main(factor, value, Model::DpgmmLj, measure));
            let mut counts: Vec<f64> = rows.map(|row| row.map_or(0, |row| row.cells.n) as f64).collect();
            counts.sort_by(f64::total_cmp);
            counts
        };
        let (all, eligible) = (draws(Measure::Parts), draws(Measure::Tree));
        let (Some(fewest), Some(most)) = (eligible.first(), eligible.last()) else {
            return "**Data behind each answer:** none.\n".to_owned();
        };
        format!(
            "**Data behind each answer:** {} simulations and a median of {} posterior samples, of which {fewest} to {most} are \
             eligible (median {}). A sample is eligible if it has the right number of parts and an adjusted Rand index \
             (ARI) of 1. The tree accuracy is the share of eligible samples that recover the true tree. Few eligible \
             samples make wide intervals: read \u{201c}perhaps\u{201d} as \u{201c}not enough data\u{201d}. This page shows the \
             effect of one choice; the multiverse (`reproduce/multiverse.sh`) combines all of them.\n",
            self.simulations,
            quantile(&all, 0.5),
            quantile(&eligible, 0.5)
        )
    }

    /// A row for each factor: what the paper says, what we chose and why, and what other values give.
    fn overview(&self) -> Vec<String> {
        let survive = format!("does {} survive?", self.published);
        let header =
            ["setting", "the paper says", "we chose", "why", "tree accuracy with other values", &survive];
        let mut lines = vec![row(header), rule(header.len())];
        for factor in &self.design.factors {
            let values = self.values(&factor.name);
            let survivals: Vec<Survival> =
                values.iter().map(|value| self.survival(&factor.name, value)).collect();
            lines.push(row([
                format!("[{}](#{})", factor.title, factor.name),
                factor.paper.clone(),
                chosen(factor),
                factor.why.clone(),
                self.span(&factor.name),
                counts(&survivals),
            ]));
        }
        lines
    }

    /// The lowest and the highest tree accuracy that other values of a factor give.
    fn span(&self, factor: &str) -> String {
        let rate = |value| self.main(factor, value, Model::DpgmmLj, Measure::Tree)?.estimate;
        let rates = self.values(factor).into_iter().filter_map(rate);
        let (least, most) =
            rates.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), rate| (a.min(rate), b.max(rate)));
        match () {
            () if least > most => "none".to_owned(),
            () if least == most => percent(least),
            () => format!("{} to {}", percent(least), percent(most)),
        }
    }

    /// The picture of a factor, and a row for the default and for each other value.
    fn section(&self, factor: &Factor) -> Vec<String> {
        let Factor { name, title, .. } = factor;
        let others = self.others();
        let elsewhere = others.iter().map(|&(p, d)| match (p == self.coordination, d == self.dimension) {
            (true, _) => format!("tree at d = {d}"),
            (_, true) => format!("tree at p = {p}"),
            _ => format!("tree at p = {p}, d = {d}"),
        });
        const COLUMNS: [&str; 9] = [
            "value",
            "parts",
            "ARI",
            "eligible samples",
            "tree accuracy",
            "change",
            "survives?",
            "DPGMM + Prim",
            "most probable sample",
        ];
        let header: Vec<String> = COLUMNS.map(str::to_owned).into_iter().chain(elsewhere).collect();
        let mut lines = vec![
            format!("\n<a id=\"{name}\"></a>\n\n## {title}\n"),
            format!("![{title}](figures/{name}.svg)\n"),
            row(&header),
            rule(header.len()),
            self.line(factor, None, &others),
        ];
        lines.extend(self.values(name).into_iter().map(|value| self.line(factor, Some(value), &others)));
        lines
    }

    /// What one value of a factor gives; the default if there is no value.
    fn line(&self, factor: &Factor, value: Option<&str>, others: &[(f64, usize)]) -> String {
        let (name, at_value) = value.map_or((DEFAULT, ""), |value| (factor.name.as_str(), value));
        let main = |measure| self.main(name, at_value, Model::DpgmmLj, measure);
        let tree = main(Measure::Tree);
        let label = value.map_or_else(|| format!("default: {}", chosen(factor)), str::to_owned);
        let failed = main(Measure::Parts).filter(|row| row.failed > 0);
        let failed = failed
            .map_or(String::new(), |row| format!("; {} simulations failed: {}", row.failed, row.failure));
        let mut cells = vec![
            format!("{label}{failed}"),
            cell(main(Measure::Parts), false),
            cell(main(Measure::Ari), false),
            cell(main(Measure::Eligible), true),
            cell(tree, true),
            tree.filter(|_| value.is_some()).map_or(String::new(), change),
            self.survival(name, at_value).name().to_owned(),
            cell(self.main(name, at_value, Model::Dpgmm, Measure::Tree), true),
            cell(main(Measure::BestTree), true),
        ];
        let at = |&at| cell(self.at(name, at_value, at, Model::DpgmmLj, Measure::Tree), true);
        cells.extend(others.iter().map(at));
        row(cells)
    }
}

/// The default of a factor's settings.
fn chosen(factor: &Factor) -> String {
    let paper = Settings::paper();
    let value = |key: &String| {
        let name = key.split_once('.').map_or(key.as_str(), |(_, name)| name);
        format!("{name} = {}", default_value(&paper, key).unwrap_or_default())
    };
    factor.settings.iter().map(value).collect::<Vec<_>>().join(", ")
}

fn percent(rate: f64) -> String {
    format!("{:.0} %", 100.0 * rate)
}

/// A value with its interval and n.
fn cell(row: Option<&Row>, share: bool) -> String {
    let Some((row, value)) = row.and_then(|row| Some((row, row.estimate?))) else {
        return "none".to_owned();
    };
    let number = |value: f64| if share { format!("{:.0}", 100.0 * value) } else { format!("{value:.2}") };
    let unit = if share { " %" } else { "" };
    let interval = row.cells.low.zip(row.cells.high);
    let interval =
        interval.map_or(String::new(), |(low, high)| format!("{} to {}; ", number(low), number(high)));
    format!("{}{unit} ({interval}n = {})", number(value), row.cells.n)
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
