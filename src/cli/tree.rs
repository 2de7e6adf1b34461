//! The subcommand tree.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Result, ensure};
use clap::Args;
use serde::Serialize;

use super::options::{TruthFiles, paper, with_default};
use super::output::say;
use super::touch::TouchFile;
use crate::files::graph::{Link, Node, dot, graphml};
use crate::files::tables::{read_parts, write_rows_of};
use crate::files::{prepare_folder, write_text};
use crate::numerics::partition::sizes;
use crate::numerics::rng::stream;
use crate::report::text_tree::text_tree;
use crate::stages::evaluate::{Score, score};
use crate::stages::joints::{Joints, Pair, joints};
use crate::stages::parameters::Parameters;
use crate::stages::rigid_parts::MAX_RANK;
use crate::stages::tree::Truth;

/// Estimates how given parts are joined, from their motions and the speeds of their joints (docs/estimate.md).
#[derive(Args)]
#[command(after_help = "Example:\n  bodyschema tree tactile.npy --parts parts.csv --out joined")]
pub(super) struct Tree {
    #[command(flatten)]
    file: TouchFile,
    /// Part of each sensor: a .csv file with columns sensor,part; a sensor without a row is left out
    #[arg(long, value_name = "FILE")]
    parts: PathBuf,
    /// Rank of the motion of each part, 1 to 6 [default: chosen from the data]
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u64).range(1..=MAX_RANK as u64))]
    components: Option<u64>,
    #[arg(long, value_name = "S", help = with_default("Master seed of all random numbers", paper().experiment.seed))]
    seed: Option<u64>,
    #[command(flatten)]
    truth: TruthFiles,
    /// Folder to write to
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

#[derive(Serialize)]
struct TreeRow {
    child: usize,
    parent: usize,
    support: f64,
}

#[derive(Serialize)]
struct EdgeRow {
    part: usize,
    other: usize,
    correlation: f64,
    information: f64,
    support: f64,
    in_tree: bool,
}

impl Tree {
    /// Runs the subcommand.
    pub(super) fn run(self) -> Result<ExitCode> {
        let out = &self.out;
        let all = self.file.read()?;
        let (name, count) = (all.name.clone(), all.tactile.sensors());
        let parts = read_parts(&self.parts, count)?;
        let truth = self.truth.read(count)?;
        let recording = all.cleaned();
        for (sensor, fault) in recording.dropped.iter().filter(|(sensor, _)| parts[*sensor].is_some()) {
            eprintln!("bodyschema: {name}: sensor {sensor} is {fault}, and is left out");
        }
        let own = recording.of_sensors(&parts);
        let labels: Vec<usize> = own.iter().copied().flatten().collect();
        ensure!(!labels.is_empty(), "{name}: no sensor that has a part feels anything");
        refuse_truth(out)?;
        prepare_folder(out)?;
        let mut rng = stream(self.seed.unwrap_or(paper().experiment.seed), 1, "co-motion", 0);
        let rank = self.components.map(|k| k as usize);
        let found =
            joints(&recording.tactile, recording.signed, &own, rank, &Parameters::default(), &mut rng);
        write(out, &found, &labels)?;
        print(&found, &labels)?;
        if let Some(truth) = truth {
            let all = recording.truth(&truth);
            let kept =
                all.labels.iter().zip(&own).filter(|(_, part)| part.is_some()).map(|(label, _)| *label);
            let truth = Truth { labels: kept.collect(), ..all };
            print_score(&score(&labels, &found.tree, &truth, 1.0))?;
        }
        Ok(ExitCode::SUCCESS)
    }
}

/// Refuses a folder whose tree.csv is the true one, which would be lost.
pub(super) fn refuse_truth(out: &Path) -> Result<()> {
    ensure!(
        !out.join("labels.csv").is_file(),
        "{}: holds true parts (labels.csv) and their tree.csv, which would be overwritten; give another --out",
        out.display()
    );
    Ok(())
}

/// Prints how parts and tree compare with the truth.
pub(super) fn print_score(score: &Score) -> Result<()> {
    say(format!("against the truth: {}", in_words(score)))
}

/// A score, in words.
pub(super) fn in_words(score: &Score) -> String {
    let recovered = if score.tree_correct { "recovered" } else { "not recovered" };
    format!("adjusted Rand index {:.3}, true tree {recovered}", score.ari)
}

/// The files that [`write`] writes.
pub(super) const FILES: [&str; 4] = ["tree.csv", "tree.dot", "tree.graphml", "edges.csv"];

/// Writes the tree, also as graph programs read it, and all pairs of parts. In: how parts are joined, and the part of each sensor.
pub(super) fn write(out: &Path, found: &Joints, labels: &[usize]) -> Result<()> {
    let sizes = sizes(labels);
    let node = |(part, rank): (&usize, &usize)| Node { part: *part, sensors: sizes[part], rank: *rank };
    let nodes: Vec<Node> = found.ranks.iter().map(node).collect();
    let link = |pair: &Pair| Link {
        parts: [pair.part, pair.other],
        correlation: pair.correlation,
        information: pair.information,
        support: pair.support,
    };
    let links: Vec<Link> = found.pairs.iter().filter(|pair| pair.in_tree).map(link).collect();
    write_text(&out.join("tree.dot"), &dot(&nodes, &links))?;
    write_text(&out.join("tree.graphml"), &graphml(&nodes, &links))?;
    let edges = found.tree.iter().map(|edge| TreeRow {
        child: edge.child,
        parent: edge.parent,
        support: found.support(edge),
    });
    write_rows_of(&out.join("tree.csv"), &["child", "parent", "support"], edges)?;
    let pairs = found.pairs.iter().map(|pair| EdgeRow {
        part: pair.part,
        other: pair.other,
        correlation: pair.correlation,
        information: pair.information,
        support: pair.support,
        in_tree: pair.in_tree,
    });
    let columns = ["part", "other", "correlation", "information", "support", "in_tree"];
    Ok(write_rows_of(&out.join("edges.csv"), &columns, pairs)?)
}

/// Prints the tree, with the bootstrap support of each edge.
pub(super) fn print(found: &Joints, labels: &[usize]) -> Result<()> {
    let sizes = sizes(labels);
    let parts: Vec<(usize, usize)> = found.ranks.iter().map(|(part, rank)| (*part, *rank)).collect();
    let place = |part: usize| parts.iter().position(|(label, _)| *label == part).unwrap_or_default();
    let edge = |pair: &Pair| (place(pair.part), place(pair.other), format!("{:.0} %", 100.0 * pair.support));
    let edges: Vec<_> = found.pairs.iter().filter(|pair| pair.in_tree).map(edge).collect();
    let name = |at: usize| {
        let (part, rank) = parts[at];
        format!("part {part} ({} sensors, motion of rank {rank})", sizes[&part])
    };
    if !edges.is_empty() {
        say("tree, with the bootstrap support of each edge (given the parts):")?;
    }
    text_tree(parts.len(), &edges, &name).into_iter().try_for_each(say)
}
