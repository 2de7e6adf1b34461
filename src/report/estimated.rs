//! Show an estimate from one's own data as a page: parts, tree and touch in the viewer, and tables of parts and joints.

use maud::{Markup, html};

use super::document::{STYLE, document};
use super::numbers::percent;
use super::viewer;
use super::viewer::scene::Scene;

/// What was estimated.
#[derive(Debug)]
pub(crate) struct Estimated {
    /// The file of the pressures.
    pub name: String,
    /// What came out, a sentence each.
    pub answers: Vec<String>,
    /// The parts.
    pub parts: Vec<PartLine>,
    /// Parts, tree and touch.
    pub scene: Scene,
    /// How it was made: name and value.
    pub facts: Vec<(&'static str, String)>,
}

/// A part, for the table.
#[derive(Debug)]
pub(crate) struct PartLine {
    /// Its number.
    pub part: usize,
    /// How many sensors are on it.
    pub sensors: usize,
    /// The rank of its motion subspace.
    pub rank: usize,
    /// The residual variance of its sensors, as a share: the median over them.
    pub residual: f64,
}

/// The page, which needs no other file and no network.
pub(crate) fn page(estimated: &Estimated) -> String {
    let Estimated { name, answers, parts, scene, facts } = estimated;
    let body = html! {
        body {
            header {
                h1 { "Estimated parts and tree from " (name) }
                @for answer in answers { p.headline { (answer) } }
            }
            main {
                (viewer::page::section(&[scene.data()]))
                (part_table(parts))
                (edge_table(scene))
                h2 { "How this estimate was made" }
                dl { @for (name, value) in facts { dt { (name) } dd { (value) } } }
                p { "All numbers are in parts.csv, tree.csv, edges.csv and summary.json beside this page." }
            }
        }
    };
    document(name, &[STYLE, viewer::page::STYLE], &body)
}

fn part_table(parts: &[PartLine]) -> Markup {
    html! {
        h2 { "Parts" }
        p { "A part is a rigid body: one rigid motion explains what all its sensors feel. Rank is that of its motion subspace. \
             Residual variance is the share that this motion does not explain, as the median over the sensors of the part." }
        table {
            thead { tr { @for name in ["part", "sensors", "rank", "residual variance"] { th scope="col" { (name) } } } }
            tbody {
                @for PartLine { part, sensors, rank, residual } in parts {
                    tr {
                        td data-label="part" { (part) }
                        td data-label="sensors" { (sensors) }
                        td data-label="rank" { (rank) }
                        td data-label="residual variance" { (percent(*residual)) " %" }
                    }
                }
            }
        }
    }
}

fn edge_table(scene: &Scene) -> Markup {
    let edges = scene.estimate.iter().flat_map(|parts| &parts.tree);
    html! {
        h2 { "Joints" }
        p { "Bootstrap support is the share of trees over resampled blocks of time that have the joint, given the parts: it does \
             not account for sensors that are assigned to a wrong part." }
        table {
            thead { tr { @for name in ["part", "joined to part", "bootstrap support"] { th scope="col" { (name) } } } }
            tbody {
                @for edge in edges {
                    tr {
                        td data-label="part" { (edge.child) }
                        td data-label="joined to part" { (edge.parent) }
                        td data-label="bootstrap support" { @if let Some(share) = edge.support { (percent(share)) " %" } }
                    }
                }
            }
        }
    }
}
