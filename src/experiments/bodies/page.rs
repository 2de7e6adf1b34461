//! Describe the study of bodies for people.

use std::collections::BTreeSet;

use super::design::{Design, Recording, Way};
use super::movement::{EdgeRow, Row};
use crate::analysis::published::Unit;
use crate::analysis::statistics::{mean, rate};
use crate::estimate::Verdict;
use crate::report::markdown::{row, rule};
use crate::report::numbers;
use crate::report::plot::effects::{Cell, Column, Line};

/// Bins of support: from where on, and up to where.
const BINS: [(f64, Option<f64>); 6] = [
    (0.0, Some(0.5)),
    (0.5, Some(0.8)),
    (0.8, Some(0.95)),
    (0.95, Some(0.99)),
    (0.99, Some(1.0)),
    (1.0, None),
];

/// Whether a row is right in some respect.
type Right = fn(&Row) -> bool;

/// What is compared, by columns.
const METHODS: [(&str, Right); 9] = [
    ("parts", |row| row.parts_right),
    ("tree", |row| row.tree_right),
    ("tree of true parts", |row| row.tree_of_true_parts_right),
    ("nearest sensors", |row| row.nearest_right),
    ("information of sensors", |row| row.chow_liu_right),
    ("principal components", |row| row.components_right),
    ("neighbour joining", |row| row.joining_right),
    ("DPGMM-LJ", |row| row.dpgmm_lj_right),
    ("DPGMM + Prim", |row| row.dpgmm_prim_right),
];

/// The same over the narrow panels of the picture, in which DPGMM stands over both of its own.
const TITLES: [&str; METHODS.len()] = [
    "parts",
    "tree",
    "true\nparts",
    "nearest",
    "infor-\nmation",
    "compo-\nnents",
    "neigh-\nbours",
    "DPGMM\n-LJ",
    "\n+ Prim",
];

/// The picture, in the folder of the study.
pub(super) const PICTURE: &str = "figures/bodies.svg";

/// What a page is made of.
pub(super) struct Page<'a> {
    /// What was studied.
    pub design: &'a Design,
    /// A row for each recording.
    pub rows: &'a [Row],
    /// A row for each edge.
    pub edges: &'a [EdgeRow],
}

impl Page<'_> {
    /// The rows of a recording of movements of some way.
    fn rows_of(&self, way: Way, recording: &Recording) -> Vec<&Row> {
        self.rows.iter().filter(|row| is_of(row, way, recording)).collect()
    }

    /// The picture: how often each method is right, of each recording at each p.
    pub(super) fn picture(&self) -> (Vec<Column>, Vec<Line>) {
        let column =
            |title: &str| Column { title: title.to_owned(), share: true, published: None, accepted: None };
        let cell = |rows: &[&Row], right: Right| -> Cell {
            let rate = rate(rows.iter().filter(|row| right(row)).count(), rows.len());
            Some((rate.value?, rate.interval))
        };
        let line = |way: Way, recording: &Recording| {
            let own = self.rows_of(way, recording);
            let noise =
                if recording.noise > 0.0 { format!(", noise {}", recording.noise) } else { String::new() };
            Line {
                label: format!("{}, T = {}{noise}", way.words(), recording.samples),
                cells: METHODS.map(|(_, right)| cell(&own, right)).to_vec(),
            }
        };
        let recordings = &self.design.recordings;
        let ways = self.design.ways().into_iter();
        let lines = ways.flat_map(|way| recordings.iter().map(move |recording| line(way, recording)));
        (TITLES.map(column).to_vec(), lines.collect())
    }

    /// The page.
    pub(super) fn text(&self) -> String {
        [self.methods(), self.by_fit(), self.by_body(), self.supports()].concat().join("\n")
    }

    /// How often each method is right.
    fn methods(&self) -> Vec<String> {
        let &Self { design, rows, .. } = self;
        let mut lines = vec![
        "# Parts and tree of any body\n".to_owned(),
        about(design, rows),
        "\n## How often is it right?\n".to_owned(),
        "Parts are right if each estimated part is one true part by most of its sensors, and the other way round. A \
         tree is right if its parts are right and all its edges are. Four rival trees are over the same estimated \
         parts. They are those of the nearest sensors, of the most mutual information of sensors, on average (Chow and Liu 1968), and of \
         principal components, and that of neighbour joining (Saitou and Nei 1987). The components are the six leading ones of the \
         roots on each part, taken as Gaussian. Neighbour joining takes −ln of the correlations of joint speeds. DPGMM-LJ and \
         DPGMM + Prim: the posterior sample of highest log posterior of all chains, on a body map of 14 dimensions; [estimate.md](../../estimate.md#accuracy) says why they \
         recover fewer trees here than in the experiments. In brackets: 95 % intervals (Wilson), as if all simulations \
         were alike. They differ by body, as the next table shows.\n"
            .to_owned(),
        format!("![How often each method is right]({PICTURE})\n"),
    ];
        let kind = (!design.kinds.is_empty()).then_some("movement");
        let header = kind.into_iter().chain(["p", "T", "noise", "n"]).chain(METHODS.map(|(name, _)| name));
        lines.push(row(header));
        lines.push(rule(kind.iter().count() + 4 + METHODS.len()));
        for way in design.ways() {
            for recording in &design.recordings {
                let own = self.rows_of(way, recording);
                let cells = [
                    way.coordination.to_string(),
                    recording.samples.to_string(),
                    recording.noise.to_string(),
                    own.len().to_string(),
                ];
                let cells = way.name().map(str::to_owned).into_iter().chain(cells);
                lines.push(row(cells.chain(METHODS.map(|(_, right)| share(&own, right)))));
            }
        }
        lines
    }

    /// How often the tree is right, by the verdict on the fit; nothing of a study that has no verdicts.
    fn by_fit(&self) -> Vec<String> {
        if self.rows.iter().all(|row| row.fit.is_empty()) {
            return Vec::new();
        }
        let mut lines = vec![
            "\n## Does the verdict on the fit tell?\n".to_owned(),
            "In how many recordings `estimate` gives each verdict, and how often the tree is then right. Trees count here also where it shows \
             none. All p are together; recordings in which nothing could be estimated are left out.\n"
                .to_owned(),
        ];
        let verdicts = [Verdict::Good, Verdict::Doubtful, Verdict::DoesNotFit].map(|one| one.to_string());
        let ways = self.design.ways();
        let kinds: BTreeSet<Option<&str>> = ways.iter().map(Way::name).collect();
        let kind = (!self.design.kinds.is_empty()).then_some("movement").map(str::to_owned);
        let header = kind.iter().cloned().chain(["T", "noise"].map(str::to_owned));
        lines.push(row(header.chain(verdicts.clone())));
        lines.push(rule(kind.iter().count() + 2 + verdicts.len()));
        for kind in kinds {
            for &Recording { samples, noise } in &self.design.recordings {
                let own = |fit: &String| {
                    let of_kind = self.rows.iter().filter(|row| row.kind.as_deref() == kind);
                    let own = of_kind.filter(|row| (row.samples, row.noise) == (samples, noise));
                    let own: Vec<&Row> = own.filter(|row| row.fit == *fit).collect();
                    if own.is_empty() {
                        return "0".to_owned();
                    }
                    format!("{}, of which {} right", own.len(), share(&own, |row| row.tree_right))
                };
                let first =
                    kind.map(str::to_owned).into_iter().chain([samples.to_string(), noise.to_string()]);
                lines.push(row(first.chain(verdicts.iter().map(own))));
            }
        }
        lines
    }

    /// How often the tree of each body is right.
    fn by_body(&self) -> Vec<String> {
        let &Self { design, rows, .. } = self;
        let longest = longest(design);
        let mut lines = vec![
            "\n## Body by body\n".to_owned(),
            format!(
                "With {} samples and noise {}: in how many simulations the tree over the estimated parts is right, and \
                 the mean adjusted Rand index.\n",
                longest.samples, longest.noise
            ),
        ];
        let header = ["body".to_owned(), "parts".to_owned()];
        let ways = design.ways();
        lines.push(row(header.into_iter().chain(ways.iter().map(Way::words))));
        lines.push(rule(2 + ways.len()));
        for body in rows.chunk_by(|a, b| a.body == b.body) {
            let at = |way: &Way| {
                let own: Vec<&Row> = body.iter().filter(|row| is_of(row, *way, &longest)).collect();
                let right = own.iter().filter(|row| row.tree_right).count();
                let ari: Vec<f64> = own.iter().map(|row| row.ari).collect();
                format!("{right} of {} ({:.2})", own.len(), mean(&ari).value.unwrap_or(0.0))
            };
            let first = [body[0].body.clone(), body[0].true_parts.to_string()];
            lines.push(row(first.into_iter().chain(ways.iter().map(at))));
        }
        lines
    }

    /// How often edges are right, by their support.
    fn supports(&self) -> Vec<String> {
        let mut lines = vec![
            "\n## Is the bootstrap support calibrated?\n".to_owned(),
            "All edges of all estimated trees, by their bootstrap support (`support`): mean support, share of right \
             edges, 95 % interval (Wilson), and number of edges. Support is given the parts: other samples of the same \
             recording do not show that parts are wrong. So edges over right parts and edges over wrong parts are \
             counted apart. An edge is right if it joins parts that are joined, where each estimated part stands for \
             the true part of most of its sensors.\n"
                .to_owned(),
        ];
        let bins = BINS.map(|(low, high)| match high {
            None => "100 %".to_owned(),
            Some(high) => format!("{} to {} %", numbers::percent(low), numbers::percent(high)),
        });
        lines.push(row(["T", "noise", "parts"].map(str::to_owned).into_iter().chain(bins)));
        lines.push(rule(3 + BINS.len()));
        for recording in &self.design.recordings {
            lines.extend([true, false].map(|parts_right| self.calibration(recording, parts_right)));
        }
        lines.push(String::new());
        lines
    }

    /// How often edges of these recordings are right, by their support.
    fn calibration(&self, recording: &Recording, parts_right: bool) -> String {
        let of_row =
            |row: &Row| (row.body.clone(), row.kind.clone(), row.coordination.to_bits(), row.movement);
        let of_edge = |edge: &EdgeRow| {
            (edge.body.clone(), edge.kind.clone(), edge.coordination.to_bits(), edge.movement)
        };
        let Recording { samples, noise } = *recording;
        let recordings: BTreeSet<_> = self
            .rows
            .iter()
            .filter(|row| (row.samples, row.noise, row.parts_right) == (samples, noise, parts_right))
            .map(of_row)
            .collect();
        let edges: Vec<&EdgeRow> = self
            .edges
            .iter()
            .filter(|edge| {
                (edge.samples, edge.noise) == (samples, noise) && recordings.contains(&of_edge(edge))
            })
            .collect();
        let parts = if parts_right { "right" } else { "wrong" };
        let first = [samples.to_string(), noise.to_string(), parts.to_owned()];
        row(first.into_iter().chain(BINS.map(|(low, high)| bin(&edges, low, high))))
    }
}

fn about(design: &Design, rows: &[Row]) -> String {
    let unresolved = rows.iter().filter(|row| !row.resolved).count();
    let resolved = match unresolved {
        0 => "No movement is too fast for the time step.".to_owned(),
        count => {
            format!("The movements of {count} of {} recordings are too fast for the time step.", rows.len())
        }
    };
    let kinds: Vec<&str> = design.kinds.iter().map(|kind| kind.name.as_str()).collect();
    let (moves, each) = match kinds.as_slice() {
        [] => ("moves at random", String::new()),
        kinds => ("moves", format!("in each way ({}) ", kinds.join(", "))),
    };
    format!(
        "How often do `bodyschema estimate` and other methods recover the parts and the tree of a body that {moves}? \
         The first table answers this.\n\n\
         The committed study is not of the default configuration. Its design, \
         [bodies.toml](../../../reproduce/bodies.toml), moves as today's default does (`reproduce/paper.toml` as of \
         revision d8a6986, with two-way fluid coupling). Three things differ: a time step of 0.02 s, eight levels of \
         its own for each sensor, and skins that cover the ends of the parts. `reproduce/seeds.toml` says which revision \
         it ran with.\n\n\
         {} bodies; simulations of each {each}at each p: {}; seed {}; chains of each mixture: {}. {resolved} \
         `bodyschema bodies --design DESIGN` makes such a page, and `reproduce/bodies.sh` that of the committed study. \
         Each recording is a row of [recordings.csv](recordings.csv), each edge \
         of [edges.csv](edges.csv). How it works: [estimate.md](../../estimate.md).",
        design.bodies.len(),
        design.movements,
        design.seed,
        design.chains
    )
}

fn is_of(row: &Row, way: Way, recording: &Recording) -> bool {
    let moved = row.kind.as_deref() == way.name() && row.coordination == way.coordination;
    moved && row.samples == recording.samples && row.noise == recording.noise
}

/// The longest recording of least noise.
fn longest(design: &Design) -> Recording {
    let order = |one: &&Recording, other: &&Recording| {
        one.samples.cmp(&other.samples).then(other.noise.total_cmp(&one.noise))
    };
    *design.recordings.iter().max_by(order).expect("a design has recordings")
}

/// The share of rows that are right, with its interval.
fn share(rows: &[&Row], right: Right) -> String {
    written(rows.iter().filter(|row| right(row)).count(), rows.len())
}

fn written(right: usize, n: usize) -> String {
    let rate = rate(right, n);
    let value = numbers::value(rate.value, Some(Unit::Rate));
    match rate.interval {
        None => value,
        interval => format!("{value} ({})", numbers::range(interval, Some(Unit::Rate))),
    }
}

/// Of the edges of some support: its mean, the share that is right, and how many there are.
fn bin(edges: &[&EdgeRow], low: f64, high: Option<f64>) -> String {
    let within = |edge: &&&EdgeRow| edge.support >= low && high.is_none_or(|high| edge.support < high);
    let own: Vec<&EdgeRow> = edges.iter().filter(within).copied().collect();
    let supports: Vec<f64> = own.iter().map(|edge| edge.support).collect();
    let Some(support) = mean(&supports).value else { return "–".to_owned() };
    let right = written(own.iter().filter(|edge| edge.right).count(), own.len());
    format!("{} → {right} of {}", numbers::value(Some(support), Some(Unit::Rate)), own.len())
}

#[cfg(test)]
mod tests;
