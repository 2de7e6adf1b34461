//! Write what an experiment found into one page, `report.html`, that needs no other file and no network.
//!
//! What it is made of is also in the folder (claims.csv, manifest.json, figures/, scenes/), so that it can be made again.

use std::path::Path;

use maud::{Markup, PreEscaped, html};
use serde_json::Value;

use super::claims_table::Row;
use super::document::{STYLE, document};
use super::figure_rows::Counting;
use super::headline::Headline;
use super::overview::overview;
use super::plot::Picture;
use super::ranges;
use super::viewer;
use crate::analysis::claims::Verdict;
use crate::analysis::published::{Figure, figures};
use crate::files::manifest::{HashedFile, Manifest};
use crate::files::provenance::Provenance;
use crate::files::{FileError, read_text, tables, write_text};
use crate::settings::{Described, described};

/// What the page of an experiment is made of.
#[derive(Debug)]
pub struct Page {
    /// The claims, as judged.
    pub rows: Vec<Row>,
    /// The pictures of the figures.
    pub pictures: Vec<Picture>,
    /// What the viewer shows, p rising, each as `viewer::scene::Scene::data` gives it.
    pub scenes: Vec<Value>,
    /// What was run, with all settings, and the files of the folder.
    pub manifest: Manifest,
}

impl Page {
    /// Reads it from the folder of a finished experiment.
    ///
    /// # Errors
    /// If a file of the experiment is missing or malformed.
    pub fn read(folder: &Path) -> Result<Self, FileError> {
        let rows = tables::read_rows(&folder.join("claims.csv"))?;
        let manifest = Manifest::read(folder)?;
        let mut pictures = Vec::new();
        for Figure { name, .. } in figures() {
            let path = folder.join("figures").join(&name).with_added_extension("svg");
            if path.exists() {
                pictures.push(Picture { name, svg: read_text(&path)? });
            }
        }
        let scenes = viewer::stored::read(folder)?;
        Ok(Self { rows, pictures, scenes, manifest })
    }

    /// Writes `report.html` into the folder.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), FileError> {
        write_text(&folder.join("report.html"), &self.html())
    }

    fn html(&self) -> String {
        let Self { rows, pictures, scenes, manifest } = self;
        let experiment = match manifest.experiment.as_deref() {
            Some("exp1") => "Experiment 1: body schema estimation",
            Some("exp2") => "Experiment 2: ratio of motor coordination",
            _ => "Experiment",
        };
        let figures = figures();
        let drawn = figures.iter().filter_map(|figure| {
            let picture = pictures.iter().find(|picture| picture.name == figure.name)?;
            Some((figure, &picture.svg))
        });
        let body = html! {
            body {
                header {
                    h1 { (experiment) }
                    p { "A replication of Mimura, Hagiwara, Taniguchi and Inamura, " em {
                        "Bayesian Body Schema Estimation using Tactile Information obtained through Coordinated \
                         Random Movements"
                    } " (Advanced Robotics, 2017)." }
                    @if let Some(headline) = Headline::of(rows) { (headline.in_html()) }
                    nav {
                        @for (to, name) in SECTIONS { a href={ "#" (to) } { (name) } " " }
                    }
                }
                main {
                    (overview(rows, &class, &mark))
                    p { (manifest.summary.as_deref().unwrap_or_default()) }
                    @if !scenes.is_empty() { (movement_section(scenes)) }
                    (claims_section(rows))
                    section id="figures" {
                        h2 { "Figures" }
                        @for (figure, svg) in drawn { (figure_section(figure, svg, rows)) }
                    }
                    (settings_section(manifest.settings.as_ref().unwrap_or(&Value::Null)))
                    (manifest_section(manifest))
                }
            }
        };
        document(experiment, &[STYLE, viewer::page::STYLE], &body)
    }
}

/// Sections of the page, and what they are called in its navigation.
const SECTIONS: [(&str, &str); 6] = [
    ("overview", "Overview"),
    ("viewer", "Body"),
    ("claims", "Claims"),
    ("figures", "Figures"),
    ("settings", "Settings"),
    ("manifest", "Manifest"),
];

/// The body that moves. Its estimate is one posterior sample, which is said.
fn movement_section(scenes: &[Value]) -> Markup {
    html! {
        h2 { "The body, what it feels, and what it learned" }
        p {
            "The first simulation, as it begins to move, the first three dimensions of its body map, and the posterior sample of \
             DPGMM-LJ with the highest log posterior."
        }
        (viewer::page::section(scenes))
    }
}

fn claims_section(rows: &[Row]) -> Markup {
    let count = |verdict: Verdict| {
        // The headline by the other interpretation does not count.
        let of_run = rows.iter().filter(|row| row.reading == rows[0].reading);
        let with = of_run.filter(|row| row.verdict == Some(verdict)).count();
        format!("{with} {}", verdict.name())
    };
    html! {
        section id="claims" {
            h2 { "Claims" }
            p {
                @if rows.iter().all(|row| row.verdict.is_none()) {
                    "A quick run illustrates what a full run shows, and judges nothing. "
                } @else {
                    (count(Verdict::Reproduced)) ", " (count(Verdict::NotReproduced)) ", " (count(Verdict::NotTestable))
                    ". The accepted range of each was fixed before the first run of its kind. "
                }
                "Rows marked extension count only the most probable sample of each simulation, which the paper does not do."
            }
            table.claims {
                thead {
                    tr {
                        @for name in Row::HEADER {
                            th scope="col" { (name) }
                            @if name == DRAWN_AFTER { th scope="col" { (DRAWN) } }
                        }
                    }
                }
                tbody { @for row in rows { (claim_row(row)) } }
            }
        }
    }
}

/// The column of the drawings, and the one that it follows.
const DRAWN: &str = "drawn";
const DRAWN_AFTER: &str = "reproduced";

fn claim_row(row: &Row) -> Markup {
    html! {
        tr class=(class(row)) {
            @for (name, cell) in Row::HEADER.into_iter().zip(row.in_words()) {
                td data-label=(name) { @if name == "verdict" { (mark(row)) " " } (cell) }
                @if name == DRAWN_AFTER {
                    td data-label=(DRAWN) { @if let Some(drawing) = ranges::drawing(row) { (drawing) } }
                }
            }
        }
    }
}

fn figure_section(figure: &Figure, svg: &str, rows: &[Row]) -> Markup {
    let of_figure = |row: &&Row| row.figure == figure.number && row.counting == Counting::AllDraws;
    html! {
        figure id=(figure.name) {
            h3 { "Figure " (figure.number) ". " (figure.title) }
            figcaption {
                p { b { "The paper" } " (" (figure.place) "): " (figure.says) }
                @for row in rows.iter().filter(of_figure) {
                    p class=(class(row)) {
                        (mark(row)) " " b { (row.verdict_in_words()) } ": " (row.claim())
                        @if row.value.is_some() { " — published " (row.wording) ", reproduced " (row.reproduced()) }
                        " (" (row.found) ")"
                    }
                }
            }
            (PreEscaped(svg_element(svg)))
            p.data { "Data: " a href={ "figures/" (figure.name) ".csv" } { "figures/" (figure.name) ".csv" } }
        }
    }
}

/// The element without the declaration that a file of its own begins with.
fn svg_element(svg: &str) -> &str {
    svg.find("<svg").map_or(svg, |start| &svg[start..])
}

fn settings_section(settings: &Value) -> Markup {
    let value = |key: &str| key.split('.').fold(settings, |table, name| &table[name]);
    // Of a random movement there is no rhythm.
    let all = described().into_iter().filter(|own| !value(&own.key).is_null());
    html! {
        section id="settings" {
            h2 { "Settings" }
            p { "Stated: the paper gives the value (in the section named). Ours: it does not, and this is our choice. \
                 A value that this run changed is marked." }
            table.settings {
                thead { tr { th scope="col" { "setting" } th scope="col" { "value" } th scope="col" { "source" }
                    th scope="col" { "meaning" } } }
                tbody {
                    @for Described { key, default, source, meaning } in all {
                        @let value = text(value(&key));
                        @let default = text(&default);
                        tr {
                            td data-label="setting" { code { (key) } }
                            td data-label="value" {
                                (value)
                                @if value != default { " " b { "changed from " (default) } }
                            }
                            td data-label="source" { (source) }
                            td data-label="meaning" { (meaning) }
                        }
                    }
                }
            }
        }
    }
}

fn manifest_section(manifest: &Manifest) -> Markup {
    let Provenance { program, revision, streams, ode, rustc, libc, cpu } = &manifest.provenance;
    let seed = manifest.seed.to_string();
    let facts = [
        ("program", program.as_str()),
        ("revision", revision),
        ("seed", &seed),
        ("streams", streams),
        ("rustc", rustc),
        ("libc", libc.as_deref().unwrap_or_default()),
        ("cpu", cpu.as_deref().unwrap_or_default()),
    ];
    html! {
        section id="manifest" {
            h2 { "Manifest" }
            dl {
                @for (name, value) in facts {
                    dt { (name) } dd { (value) }
                }
                dt { "ODE" } dd { (ode.version) " (" (ode.configuration) ")" }
            }
            p { "When and how the run was made, on how many threads and with how much memory, is in run.json beside \
                 this report." }
            h3 { "Files" }
            table.files {
                thead { tr { th scope="col" { "file" } th scope="col" { "SHA-256" } } }
                tbody {
                    @for HashedFile { file, sha256 } in &manifest.outputs {
                        tr {
                            td data-label="file" { (file) }
                            td data-label="SHA-256" { code { (sha256) } }
                        }
                    }
                }
            }
        }
    }
}

/// A value for a reader: strings without quotes, lists by commas, nothing for nothing.
fn text(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        Value::Array(items) => items.iter().map(text).collect::<Vec<_>>().join(", "),
        Value::Number(number) => number.as_f64().map_or(number.to_string(), |value| {
            // 1.0 and 1 are the same setting.
            if number.is_f64() { format!("{value}") } else { number.to_string() }
        }),
        other => other.to_string(),
    }
}

fn class(row: &Row) -> String {
    row.verdict_in_words().replace(' ', "-")
}

/// A sign beside the word, so that colour is not alone in telling verdicts apart.
fn mark(row: &Row) -> &'static str {
    match row.verdict {
        Some(Verdict::Reproduced) => "✓",
        Some(Verdict::NotReproduced) => "✗",
        Some(Verdict::NotTestable) => "–",
        None => "+",
    }
}
