//! Write and print the posterior that the split–merge sampler gives.

use std::path::Path;

use anyhow::Result;
use serde::Serialize;

use super::output::say;
use super::tree::print_score;
use crate::analysis::diagnostics::Mixing;
use crate::analysis::posterior::Posterior;
use crate::files::tables::write_rows;
use crate::numerics::partition::sizes;
use crate::report::text_tree::text_tree;
use crate::stages::evaluate::score;
use crate::stages::tree::Truth;

#[derive(Serialize)]
struct CountRow {
    parts: usize,
    probability: f64,
}

#[derive(Serialize)]
struct SensorRow {
    sensor: usize,
    part: usize,
    probability: f64,
}

#[derive(Serialize)]
struct EdgeRow {
    part: usize,
    other: usize,
    probability: f64,
    in_tree: bool,
}

#[derive(Serialize)]
struct MixingRow {
    quantity: &'static str,
    r_hat: Option<f64>,
    ess: Option<f64>,
}

/// Writes posterior.csv, parts.csv, edges.csv and diagnostics.csv.
pub(super) fn write(out: &Path, posterior: &Posterior) -> Result<()> {
    let counts = posterior.parts.iter().map(|&(parts, probability)| CountRow { parts, probability });
    write_rows(&out.join("posterior.csv"), counts)?;
    let consensus = &posterior.consensus;
    let sensors = consensus.labels.iter().zip(&consensus.certainty).enumerate();
    let sensor =
        |(sensor, (&part, &probability)): (usize, (&usize, &f64))| SensorRow { sensor, part, probability };
    write_rows(&out.join("parts.csv"), sensors.map(sensor))?;
    if let Some(tree) = &posterior.tree {
        let edge = |&(part, other, probability): &(usize, usize, f64)| EdgeRow {
            part,
            other,
            probability,
            in_tree: tree.tree.contains(&(part, other)),
        };
        write_rows(&out.join("edges.csv"), tree.edges.iter().map(edge))?;
    }
    let mixing = posterior.mixing.iter();
    let row = |(quantity, mixing): &(&'static str, Mixing)| MixingRow {
        quantity,
        r_hat: mixing.r_hat,
        ess: mixing.ess,
    };
    Ok(write_rows(&out.join("diagnostics.csv"), mixing.map(row))?)
}

/// Prints the number of parts, the tree, and whether the chains have mixed; and how the consensus compares with the truth, if
/// that is known.
pub(super) fn print(posterior: &Posterior, truth: Option<&Truth>, eligible_ari: f64) -> Result<()> {
    let counts: Vec<String> =
        posterior.parts.iter().map(|(parts, share)| format!("{parts} ({})", percent(*share))).collect();
    say(format!("number of parts: {}", counts.join(", ")))?;
    let consensus = &posterior.consensus;
    let sizes = sizes(&consensus.labels);
    let certainty = |part: usize| {
        let own = consensus.labels.iter().zip(&consensus.certainty).filter(|(label, _)| **label == part);
        own.map(|(_, certainty)| certainty).sum::<f64>() / sizes[&part] as f64
    };
    let name = |part: usize| {
        format!("part {part} ({} sensors, mean probability {})", sizes[&part], percent(certainty(part)))
    };
    let edges = posterior.tree.as_ref().map_or(Vec::new(), |tree| {
        let own = tree.edges.iter().filter(|(a, b, _)| tree.tree.contains(&(*a, *b)));
        own.map(|(a, b, probability)| (*a, *b, percent(*probability))).collect()
    });
    if !edges.is_empty() {
        say("tree, with the posterior probability of each edge (given the parts):")?;
    }
    for line in text_tree(sizes.len(), &edges, &name) {
        say(line)?;
    }
    if let Some(tree) = &posterior.tree {
        say(format!("posterior probability of this tree, given these parts: {}", percent(tree.probability)))?;
    }
    if let Some(truth) = truth {
        let summary = posterior.summary();
        print_score(&score(&summary.labels, &summary.tree, truth, eligible_ari))?;
    }
    if let Some(what) = posterior.unmixed() {
        eprintln!(
            "bodyschema: the chains have not mixed: {what}; more --sweeps may help, see diagnostics.csv"
        );
    }
    Ok(())
}

fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}
