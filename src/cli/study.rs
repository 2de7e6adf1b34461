//! The subcommand study.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Result;
use clap::Args;

use super::options::Threads;
use super::output::say;
use crate::files::prepare_folder;
use crate::study::{self, Design, DesignText, Selection, plan};
use crate::tasks::seeds::used_before;
use crate::tasks::shard::Shard;

/// Runs many configurations of the experiments on shared simulations, and says by which the paper's claims hold.
///
/// A design says which: a named list, one change at a time around a base, a grid, or configurations that are drawn evenly from all
/// combinations of options. The bundled designs are ablation, step, momentum, sensitivity, multiverse, multiverse-near and multiverse-held-out;
/// reproduce/NAME.toml explains each, and docs/reference.md the grammar.
///
/// Writes into DIR: study.md (the report), figures/*.svg, configurations.csv (a row for each configuration), study.csv (a row for
/// each configuration and claim), where the design asks for them measures.csv, shares.csv, variance.csv and ranking.csv, and
/// design.toml. A run that was stopped continues. On several machines: run each shard into one shared folder, then gather. Or run
/// ranges of drawn movements into folders of their own, and join what is finished.
#[derive(Args)]
pub(super) struct Study {
    /// Design: a file, or the name of a bundled design
    #[arg(value_name = "DESIGN")]
    design: PathBuf,
    /// Run only the I-th of N parts of the work, and write no tables
    #[arg(long, value_name = "I/N")]
    shard: Option<Shard>,
    /// Run nothing; write the tables from the results of all shards
    #[arg(long, conflicts_with_all = ["shard", "only"])]
    gather: bool,
    /// Run nothing; write the tables of all configurations whose tables are in the folders of PARTS
    #[arg(long, value_name = "PARTS", conflicts_with_all = ["shard", "only", "gather"])]
    join: Option<PathBuf>,
    /// Run only this configuration (a number or a name), those of these drawn movements (movements-1-8), or those of this factor
    #[arg(long, value_name = "K", conflicts_with = "shard")]
    only: Option<Selection>,
    /// Master seed, instead of the design's
    #[arg(long, value_name = "S")]
    seed: Option<u64>,
    #[command(flatten)]
    threads: Threads,
    /// Folder to write to
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

impl Study {
    /// Runs the subcommand.
    pub(super) fn run(self) -> Result<ExitCode> {
        self.threads.apply()?;
        let source = DesignText::read(&self.design, self.seed)?;
        let design = Design::parse(&source)?;
        // Before hours are spent on those that come first.
        let mut configurations = plan(&design)?;
        if let Some(only) = &self.only {
            configurations = only.select(&design, configurations)?;
        }
        let used = used_before(design.seeds());
        let out = &self.out;
        if study::is_finished(&source.text, &configurations, out)? {
            say(format!("All files are in {} already; remove it to run the study again.", out.display()))?;
            return Ok(ExitCode::SUCCESS);
        }
        prepare_folder(out)?;
        let done = |text: String| {
            if let Some(used) = used {
                say(used)?;
            }
            say(text)?;
            Ok(ExitCode::SUCCESS)
        };
        let all_files = || format!("All files are in {}; open study.md there.", out.display());
        if let Some(parts) = &self.join {
            study::join(design, &source.text, parts, out)?;
            return done(all_files());
        }
        if !self.gather {
            study::run(&source.text, &configurations, self.shard.unwrap_or(Shard::WHOLE), out)?;
        }
        if self.shard.is_some() {
            return done(format!(
                "This shard is finished, in {}. After all shards, run --gather.",
                out.display()
            ));
        }
        study::gather(design, &source.text, &configurations, self.only.is_none(), out)?;
        done(all_files())
    }
}
