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
    /// What it leaves open, a sentence each.
    pub doubts: Vec<String>,
    /// The parts.
    pub parts: Vec<PartLine>,
    /// The joints.
    pub joints: Vec<JointLine>,
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
    /// The share of repeats that have it, where there are repeats.
    pub repeated: Option<f64>,
}

/// A joint, for the table.
#[derive(Debug)]
pub(crate) struct JointLine {
    /// The parts that it joins.
    pub parts: [usize; 2],
    /// Its bootstrap support, 0 to 1.
    pub support: f64,
    /// The share of repeats that have it, where there are repeats.
    pub repeated: Option<f64>,
}

/// The page, which needs no other file and no network.
pub(crate) fn page(estimated: &Estimated) -> String {
    let Estimated { name, answers, doubts, parts, joints, scene, facts } = estimated;
    let body = html! {
        body {
            header {
                h1 { "Estimated parts and tree from " (name) }
                @for answer in answers { p.headline { (answer) } }
                @if !doubts.is_empty() {
                    p { "This leaves open:" }
                    ul { @for doubt in doubts { li { (doubt) } } }
                }
            }
            main {
                (viewer::page::section(&[scene.data()]))
                (part_table(parts))
                (joint_table(joints))
                h2 { "How this estimate was made" }
                dl { @for (name, value) in facts { dt { (name) } dd { (value) } } }
                p { "All numbers are in parts.csv, tree.csv, edges.csv and summary.json beside this page, and those of repeats in repeats.csv." }
            }
        }
    };
    document(name, &[STYLE, viewer::page::STYLE], &body)
}

/// What is said of repeats, if there are any.
const REPEATED: &str = "Found again is the share of estimates from resampled times that have it.";

fn part_table(parts: &[PartLine]) -> Markup {
    let has_repeats = parts.iter().any(|part| part.repeated.is_some());
    html! {
        h2 { "Parts" }
        p { "A part is a rigid body: one rigid motion explains what all its sensors feel. Rank is that of its motion subspace. \
             Residual variance is the share that this motion does not explain, as the median over the sensors of the part. "
            @if has_repeats { (REPEATED) } }
        table {
            thead { tr {
                @for name in ["part", "sensors", "rank", "residual variance"] { th scope="col" { (name) } }
                @if has_repeats { th scope="col" { "found again" } }
            } }
            tbody {
                @for PartLine { part, sensors, rank, residual, repeated } in parts {
                    tr {
                        td data-label="part" { (part) }
                        td data-label="sensors" { (sensors) }
                        td data-label="rank" { (rank) }
                        td data-label="residual variance" { (percent(*residual)) " %" }
                        @if let Some(share) = repeated { td data-label="found again" { (percent(*share)) " %" } }
                    }
                }
            }
        }
    }
}

fn joint_table(joints: &[JointLine]) -> Markup {
    let has_repeats = joints.iter().any(|joint| joint.repeated.is_some());
    html! {
        h2 { "Joints" }
        p { "Bootstrap support is the share of trees over resampled blocks of time that have the joint, given the parts: it does \
             not account for sensors that are assigned to a wrong part. "
            @if has_repeats { (REPEATED) " This accounts for parts, too." } }
        table {
            thead { tr {
                @for name in ["part", "joined to part", "bootstrap support"] { th scope="col" { (name) } }
                @if has_repeats { th scope="col" { "found again" } }
            } }
            tbody {
                @for JointLine { parts: [part, other], support, repeated } in joints {
                    tr {
                        td data-label="part" { (part) }
                        td data-label="joined to part" { (other) }
                        td data-label="bootstrap support" { (percent(*support)) " %" }
                        @if let Some(share) = repeated { td data-label="found again" { (percent(*share)) " %" } }
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
