//! The section of factors, one at a time: for each open setting what the paper says, what the base has, why, and what other values
//! do.

use super::super::choices::value_of;
use super::super::design::Factor;
use super::super::measures::{Measure, MeasureRow};
use super::super::results::{ConfigurationRow, Results};
use super::survival::{Survival, counts};
use crate::analysis::published::{HEADLINE, claims, figures};
use crate::analysis::statistics::quantile;
use crate::report::markdown::{row, rule};
use crate::report::plot::effects::{Column, Line};
use crate::settings::Settings;
use crate::stages::schema::Model;

/// The rows of a study, and its main condition: the p of every configuration, and the d of its experiment 2.
struct Study<'a> {
    results: &'a Results,
    base: Settings,
    /// The published value, in the paper's words, and the range that counts as reproduced.
    published: String,
    accept: (f64, f64),
}

/// The section.
pub(super) fn section(results: &Results) -> Vec<String> {
    let study = Study::new(results);
    let mut lines = study.introduction();
    lines.extend(study.overview());
    for (at, factor) in study.shown() {
        lines.extend(study.of_factor(at, factor));
    }
    lines
}

/// Name, panels and lines of the picture of each factor.
pub(super) fn pictures(results: &Results) -> Vec<(String, Vec<Column>, Vec<Line>)> {
    let study = Study::new(results);
    let picture =
        |(at, factor): (usize, &Factor)| (format!("figures/{}.svg", factor.name), columns(), study.lines(at));
    study.shown().map(picture).collect()
}

/// The panels of every picture.
fn columns() -> Vec<Column> {
    let published = figures().into_iter().find(|figure| figure.name == "fig11b-tree");
    let published = published.and_then(|figure| figure.mark).map(|mark| mark.value);
    let column =
        |title: &str, share, published| Column { title: title.to_owned(), share, published, accepted: None };
    vec![
        column("number\nof parts", false, None),
        column("adjusted\nRand index", true, None),
        column("tree right,\nDPGMM-LJ", true, published),
        column("tree right,\n+ Prim", true, None),
    ]
}

impl<'a> Study<'a> {
    fn new(results: &'a Results) -> Self {
        let headline = claims().into_iter().find(|claim| claim.id == HEADLINE);
        let headline = headline.expect("the headline is published");
        let accept = headline.accept.expect("the headline has a range");
        let base =
            Settings::overlaid([&results.design.settings], "the base").expect("the design was planned");
        Self { results, base, published: headline.wording, accept }
    }

    /// The factors that have a configuration: with `--only`, not all of them.
    fn shown(&self) -> impl Iterator<Item = (usize, &'a Factor)> {
        let results = self.results;
        let factors = results.design.factors.iter().enumerate();
        factors.filter(|(at, _)| results.configurations.iter().any(|one| !one.labels[*at].is_empty()))
    }

    /// The base.
    fn first(&self) -> &'a ConfigurationRow {
        &self.results.configurations[0]
    }

    /// The configurations with other values of a factor, in their order.
    fn values(&self, factor: usize) -> impl Iterator<Item = &'a ConfigurationRow> + Clone {
        self.results.configurations.iter().filter(move |one| !one.labels[factor].is_empty())
    }

    /// A measure at the main condition.
    fn main(&self, of: &ConfigurationRow, model: Model, measure: Measure) -> Option<&'a MeasureRow> {
        self.at(of, self.condition(), model, measure)
    }

    fn condition(&self) -> (f64, usize) {
        (self.base.motion.coordination, self.base.experiment.dimension)
    }

    fn at(
        &self,
        of: &ConfigurationRow,
        (coordination, dimension): (f64, usize),
        model: Model,
        measure: Measure,
    ) -> Option<&'a MeasureRow> {
        self.results.measures.iter().find(|row| {
            row.configuration == of.number
                && row.model == model
                && row.measure == measure
                && row.coordination == coordination
                && row.dimension == dimension
        })
    }

    /// The other conditions of DPGMM-LJ.
    fn others(&self) -> Vec<(f64, usize)> {
        let mut all: Vec<(f64, usize)> = Vec::new();
        let own = self.results.measures.iter();
        for row in own.filter(|row| row.configuration == self.first().number && row.model == Model::DpgmmLj) {
            let at = (row.coordination, row.dimension);
            if at != self.condition() && !all.contains(&at) {
                all.push(at);
            }
        }
        all
    }

    fn survival(&self, of: &ConfigurationRow) -> Survival {
        Survival::of(self.main(of, Model::DpgmmLj, Measure::Tree), self.accept)
    }

    /// What the picture of a factor shows: the base, then each value, at the main condition.
    fn lines(&self, factor: usize) -> Vec<Line> {
        let line = |label: &str, of: &ConfigurationRow| {
            let cell = |(model, measure)| {
                let row = self.main(of, model, measure)?;
                Some((row.value?, row.cells.low.zip(row.cells.high)))
            };
            let measures = [
                (Model::DpgmmLj, Measure::Parts),
                (Model::DpgmmLj, Measure::Ari),
                (Model::DpgmmLj, Measure::Tree),
                (Model::Dpgmm, Measure::Tree),
            ];
            Line { label: label.to_owned(), cells: measures.into_iter().map(cell).collect() }
        };
        std::iter::once(line(&self.first().name, self.first()))
            .chain(self.values(factor).map(|one| line(&one.labels[factor], one)))
            .collect()
    }

    /// The question, the answers counted, the configuration, and how to read them.
    fn introduction(&self) -> Vec<String> {
        let Self { published, accept: (low, high), .. } = self;
        let (p, d) = self.condition();
        let values: Vec<&ConfigurationRow> = self.shown().flat_map(|(at, _)| self.values(at)).collect();
        let survivals: Vec<Survival> = values.iter().map(|one| self.survival(one)).collect();
        vec![
            format!(
                "Would the published tree accuracy, {published}, survive another reasonable choice of a setting that the \
                 paper leaves open? The answers for {} other choices, of one setting or of a pair, are: {}.\n",
                survivals.len(),
                counts(&survivals)
            ),
            format!(
                "All choices run on the same simulations. Numbers are at p = {p} and d = {d} unless a column says otherwise. \
                 Intervals are 95 % intervals over simulations (bootstrap). *Change* is the difference from the default in percentage \
                 points, paired by simulation. In the pictures the orange line is the default, and the dashed line is the published \
                 rate. [measures.csv](measures.csv) has all numbers, of every condition and measure.\n"
            ),
            format!(
                "**yes**: the rate lies between {:.1} and {:.1} %, the range that counts as reproduced \
                 (`reproduce/published.toml`). **perhaps**: the rate lies outside, but its interval reaches that range. \
                 **no**: the whole interval lies outside, or there is no eligible sample.\n",
                100.0 * low,
                100.0 * high
            ),
            self.data(&values),
            format!(
                "The default itself: {} ({}). These are {} simulations.\n",
                cell(self.main(self.first(), Model::DpgmmLj, Measure::Tree), true),
                self.survival(self.first()).name(),
                self.base.experiment.simulations
            ),
        ]
    }

    /// How many samples each answer is over.
    fn data(&self, values: &[&ConfigurationRow]) -> String {
        let samples = |measure: Measure| {
            let rows = values.iter().map(|one| self.main(one, Model::DpgmmLj, measure));
            let mut counts: Vec<f64> = rows.map(|row| row.map_or(0, |row| row.cells.n) as f64).collect();
            counts.sort_by(f64::total_cmp);
            counts
        };
        let (all, eligible) = (samples(Measure::Parts), samples(Measure::Tree));
        let (Some(fewest), Some(most)) = (eligible.first(), eligible.last()) else {
            return "**Data behind each answer:** none.\n".to_owned();
        };
        format!(
            "**Data behind each answer:** {} simulations and a median of {} posterior samples, of which {fewest} to {most} are \
             eligible (median {}). A sample is eligible if it has the right number of parts and an adjusted Rand index \
             (ARI) of 1. The tree accuracy is the share of eligible samples that recover the true tree. Few eligible \
             samples make wide intervals: read \u{201c}perhaps\u{201d} as \u{201c}not enough data\u{201d}.\n",
            self.base.experiment.simulations,
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
        for (at, factor) in self.shown() {
            let survivals: Vec<Survival> = self.values(at).map(|one| self.survival(one)).collect();
            lines.push(row([
                format!("[{}](#{})", factor.heading(), factor.name),
                factor.paper.clone(),
                chosen(&self.base, factor),
                factor.why.clone(),
                self.span(at),
                counts(&survivals),
            ]));
        }
        lines
    }

    /// The lowest and the highest tree accuracy that other values of a factor give.
    fn span(&self, factor: usize) -> String {
        let rates =
            self.values(factor).filter_map(|one| self.main(one, Model::DpgmmLj, Measure::Tree)?.value);
        let (least, most) =
            rates.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), rate| (a.min(rate), b.max(rate)));
        match () {
            () if least > most => "none".to_owned(),
            () if least == most => percent(least),
            () => format!("{} to {}", percent(least), percent(most)),
        }
    }

    /// The picture of a factor, and a row for the base and for each other value.
    fn of_factor(&self, at: usize, factor: &Factor) -> Vec<String> {
        let (name, title) = (&factor.name, factor.heading());
        let others = self.others();
        let (own_p, own_d) = self.condition();
        let elsewhere = others.iter().map(|&(p, d)| match (p == own_p, d == own_d) {
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
        let base = format!("default: {}", chosen(&self.base, factor));
        let mut lines = vec![
            format!("\n<a id=\"{name}\"></a>\n\n## {title}\n"),
            format!("![{title}](figures/{name}.svg)\n"),
            row(&header),
            rule(header.len()),
            self.line(self.first(), &base, &others),
        ];
        lines.extend(self.values(at).map(|one| self.line(one, &one.labels[at], &others)));
        lines
    }

    /// What a configuration gives.
    fn line(&self, of: &ConfigurationRow, label: &str, others: &[(f64, usize)]) -> String {
        let main = |measure| self.main(of, Model::DpgmmLj, measure);
        let tree = main(Measure::Tree);
        let failed = main(Measure::Parts).filter(|row| row.failed > 0);
        let failed = failed
            .map_or(String::new(), |row| format!("; {} simulations failed: {}", row.failed, row.failure));
        let is_base = of.number == self.first().number;
        let mut cells = vec![
            format!("{label}{failed}"),
            cell(main(Measure::Parts), false),
            cell(main(Measure::Ari), false),
            cell(main(Measure::Eligible), true),
            cell(tree, true),
            tree.filter(|_| !is_base).map_or(String::new(), change),
            self.survival(of).name().to_owned(),
            cell(self.main(of, Model::Dpgmm, Measure::Tree), true),
            cell(main(Measure::BestTree), true),
        ];
        let at = |&at| cell(self.at(of, at, Model::DpgmmLj, Measure::Tree), true);
        cells.extend(others.iter().map(at));
        row(cells)
    }
}

/// The default of a factor's settings.
fn chosen(base: &Settings, factor: &Factor) -> String {
    let value = |key: &String| {
        let name = key.split_once('.').map_or(key.as_str(), |(_, name)| name);
        format!("{name} = {}", value_of(base, key).unwrap_or_default())
    };
    factor.settings.iter().map(value).collect::<Vec<_>>().join(", ")
}

fn percent(rate: f64) -> String {
    format!("{:.0} %", 100.0 * rate)
}

/// A value with its interval and n.
fn cell(row: Option<&MeasureRow>, share: bool) -> String {
    let Some((row, value)) = row.and_then(|row| Some((row, row.value?))) else {
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
fn change(row: &MeasureRow) -> String {
    let Some(difference) = row.change else { return "none".to_owned() };
    let points = |value: f64| format!("{:+.0}", 100.0 * value);
    let interval = row.change_low.zip(row.change_high);
    let interval =
        interval.map_or(String::new(), |(low, high)| format!(" ({} to {})", points(low), points(high)));
    format!("{}{interval}", points(difference))
}
