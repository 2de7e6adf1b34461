//! Describe a comparison for people: a table of values, a table of changes, and what the pictures show.

use super::super::compared::Compared;
use super::super::design::flat;
use super::design::{Configuration, Design};
use super::table::Row;
use crate::analysis::claims::Verdict;
use crate::analysis::published::{Claim, Unit};
use crate::report::markdown::{row, rule};
use crate::report::numbers;
use crate::report::plot::effects::{Column, Line};

/// What a page is made of.
pub struct Page<'a> {
    /// What was compared.
    pub design: &'a Design,
    /// All claims of the paper.
    pub claims: &'a [Claim],
    /// The table.
    pub rows: &'a [Row],
}

impl Page<'_> {
    /// The page. `revision` is that of the program which made the table.
    pub fn text(&self, revision: &str) -> String {
        let Design { title, about, seed, settings, configurations, .. } = self.design;
        let mut lines = vec![format!("# {title}\n")];
        lines.push(format!(
            "Seed {seed}, revision {revision}; the settings of all configurations are [below](#configurations).\n"
        ));
        lines.extend([about.trim().to_owned(), String::new()]);
        lines.push(
            "All configurations are compared on the same simulations. Intervals are 95 % intervals over simulations \
             (bootstrap). Of a claim over several conditions, the value is that which lies farthest towards the outside \
             of the accepted range. All numbers: [comparison.csv](comparison.csv).\n"
                .to_owned(),
        );
        for (name, claims) in self.pictures() {
            let ids: Vec<&str> = claims.iter().map(|compared| compared.id.as_str()).collect();
            lines.push(format!("![{}]({name})\n", ids.join(", ")));
        }
        lines.push(
            "Green: the accepted range. Dashed: the published number. The orange line is the first configuration.\n"
                .to_owned(),
        );
        lines.push("## Values\n".to_owned());
        lines.push("Bold: within the accepted range.\n".to_owned());
        let accepted = self.design.claims.iter().map(|compared| {
            let claim = self.claim(compared);
            numbers::range(claim.accept, claim.measure.unit())
        });
        lines.extend(self.header());
        lines.push(row(std::iter::once("accepted".to_owned()).chain(accepted)));
        lines.extend(self.rows(&|row, unit| {
            let value = with_interval(row.value, row.cells.low.zip(row.cells.high), unit);
            if row.verdict == Verdict::Reproduced { format!("**{value}**") } else { value }
        }));
        lines.push(format!("\n## Changes from “{}”\n", configurations[0].name));
        lines.push(
            "Bold: the interval excludes 0. A claim over several conditions is compared at one of them: that which decides \
             the first configuration's value, among those at which both have one. Simulations are drawn in pairs.\n"
                .to_owned(),
        );
        lines.extend(self.header());
        lines.extend(self.rows(&|row, unit| {
            let ends = row.change_low.zip(row.change_high);
            let change = with_interval(row.change, ends, unit);
            if ends.is_some_and(|(low, high)| low > 0.0 || high < 0.0) {
                format!("**{change}**")
            } else {
                change
            }
        }));
        lines.push("\n## Configurations\n".to_owned());
        lines.extend([row(["name", "settings"]), rule(2)]);
        lines.push(row([
            "all, over `reproduce/paper.toml` of that revision".to_owned(),
            flat(settings).join(", "),
        ]));
        lines.extend(configurations.iter().map(|one| row([one.name.clone(), self.words(one)])));
        lines.join("\n") + "\n"
    }

    /// What a configuration has instead of the first one's values, and what became of it.
    fn words(&self, configuration: &Configuration) -> String {
        let mut words = flat(&configuration.settings);
        let own = self.rows.iter().find(|row| row.configuration == configuration.name);
        if let Some(row) = own.filter(|row| row.failed > 0) {
            words.push(format!("{} movements failed: {}", row.failed, row.failure));
        } else if own.is_some_and(|row| !row.resolved) {
            words.push("the step does not resolve its movements".to_owned());
        }
        words.join(", ")
    }

    /// The head of a table with a column for each claim.
    fn header(&self) -> [String; 2] {
        let labels = self.design.claims.iter().map(|claim| claim.label.replace('\n', " "));
        [row(std::iter::once(String::new()).chain(labels)), rule(self.design.claims.len() + 1)]
    }

    /// A row for each configuration.
    fn rows(&self, cell: &dyn Fn(&Row, Option<Unit>) -> String) -> impl Iterator<Item = String> {
        self.design.configurations.iter().map(move |configuration| {
            let cells = self.design.claims.iter().map(|compared| {
                let unit = self.claim(compared).measure.unit();
                self.row(configuration, compared).map_or("–".to_owned(), |row| cell(row, unit))
            });
            row(std::iter::once(configuration.name.clone()).chain(cells))
        })
    }

    fn claim(&self, compared: &Compared) -> &Claim {
        compared.find(self.claims).expect("the design was checked")
    }

    fn row(&self, configuration: &Configuration, compared: &Compared) -> Option<&Row> {
        self.rows.iter().find(|row| {
            (&row.configuration, &row.claim, row.experiment)
                == (&configuration.name, &compared.id, compared.experiment)
        })
    }

    /// The name of each picture, and the claims that it shows.
    pub fn pictures(&self) -> impl Iterator<Item = (String, &[Compared])> {
        /// Panels that the width of a picture has room for.
        const PANELS: usize = 4;
        let chunks = self.design.claims.chunks(PANELS).enumerate();
        chunks.map(|(at, claims)| (format!("figures/claims-{}.svg", at + 1), claims))
    }

    /// Panels and lines of the picture of some claims.
    pub fn picture(&self, claims: &[Compared]) -> (Vec<Column>, Vec<Line>) {
        let column = |compared: &Compared| {
            let claim = self.claim(compared);
            Column {
                title: compared.label.clone(),
                share: matches!(claim.measure.unit(), Some(Unit::Rate | Unit::Ari | Unit::Coordination)),
                published: claim.published,
                accepted: claim.accept,
            }
        };
        let line = |configuration: &Configuration| {
            let cell = |compared: &Compared| {
                let row = self.row(configuration, compared)?;
                Some((row.value?, row.cells.low.zip(row.cells.high)))
            };
            Line { label: configuration.name.clone(), cells: claims.iter().map(cell).collect() }
        };
        (claims.iter().map(column).collect(), self.design.configurations.iter().map(line).collect())
    }
}

/// A value with its interval, where there is one.
fn with_interval(value: Option<f64>, ends: Option<(f64, f64)>, unit: Option<Unit>) -> String {
    let value = numbers::value(value, unit);
    if ends.is_some() { format!("{value} ({})", numbers::range(ends, unit)) } else { value }
}
