//! The subcommands for finished results: plot, verify.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Result, ensure};
use clap::Args;

use super::output::say;
use crate::experiments::{bodies, reproduce};
use crate::files::manifest::Manifest;
use crate::files::verify::{Finding, Outcome, against_manifest, against_reference};
use crate::report::page::Page;
use crate::report::plot;
use crate::study;

/// Renders the figures of an experiment or study again from their tables, and writes its report again.
///
/// Of a finished experiment: judges its claims again from its samples.csv, with the accepted ranges of this program, and writes the
/// figures, claims.csv, claims.md and report.html. Of a study: study.md and its figures, from its tables. Of a study of bodies:
/// bodies.md and its figure. Of any other folder: an .svg beside each figures/*.csv.
#[derive(Args)]
pub(super) struct Plot {
    /// Folder of an experiment or study
    #[arg(value_name = "DIR")]
    folder: PathBuf,
}

impl Plot {
    /// Runs the subcommand.
    pub(super) fn run(self) -> Result<ExitCode> {
        let folder = &self.folder;
        if study::is_study(folder) {
            study::redraw(folder)?;
            say(format!("study.md and its figures in {}", folder.display()))?;
            return Ok(ExitCode::SUCCESS);
        }
        if bodies::is_study(folder) {
            bodies::redraw(folder)?;
            say(format!("bodies.md and its figure in {}", folder.display()))?;
            return Ok(ExitCode::SUCCESS);
        }
        let finished = Manifest::is_in(folder);
        let judged_again = if finished { reproduce::rejudge(folder)? } else { None };
        let figures = folder.join("figures");
        let pictures = match judged_again {
            Some(pictures) => pictures,
            None => plot::render(&figures)?,
        };
        ensure!(
            !pictures.is_empty(),
            "{}: has no table of a figure (fig04-agent.csv to fig11b-tree.csv)",
            figures.display()
        );
        if finished {
            Page::read(folder)?.write(folder)?;
        }
        say(format!("{} figures in {}", pictures.len(), figures.display()))?;
        if finished {
            say(format!("report in {}", folder.join("report.html").display()))?;
        }
        Ok(ExitCode::SUCCESS)
    }
}

/// Compares results with the hashes in their manifest, or with other results; exit status 0 if all agree, 1 if some do
/// not, 2 on an error.
///
/// With --against, compares every .csv and .npy file of REFERENCE with that of DIR. Two files agree if they have the same
/// bytes; or if all numbers differ by at most 1e-6 times the larger one or 1; or, for a samples.csv with scores, if the
/// rates (eligible samples, correct trees) are within 4 standard errors in each condition. Lists the files that are not
/// the same.
#[derive(Args)]
pub(super) struct Verify {
    /// Folder of results
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Folder of results to compare with
    #[arg(long, value_name = "REFERENCE")]
    against: Option<PathBuf>,
}

impl Verify {
    /// Runs the subcommand.
    pub(super) fn run(self) -> Result<ExitCode> {
        let folder = &self.folder;
        let mut agree = true;
        if self.against.is_none() || Manifest::is_in(folder) {
            agree &= self.tell(&against_manifest(folder)?, "the hashes in manifest.json")?;
        }
        if let Some(reference) = &self.against {
            let findings = against_reference(folder, reference)?;
            agree &= self.tell(&findings, &reference.display().to_string())?;
        }
        Ok(if agree { ExitCode::SUCCESS } else { ExitCode::FAILURE })
    }

    /// Lists the files that are not the same, and returns whether all agree.
    fn tell(&self, findings: &[Finding], with: &str) -> Result<bool> {
        for finding in findings.iter().filter(|finding| finding.outcome != Outcome::Same) {
            say(finding)?;
        }
        let same = findings.iter().filter(|finding| finding.outcome == Outcome::Same).count();
        let agreeing = findings.iter().filter(|finding| finding.outcome.agrees()).count();
        say(format!(
            "{}: {} compared with {with}: {same} the same, {} within tolerance, {} not",
            self.folder.display(),
            findings.len(),
            agreeing - same,
            findings.len() - agreeing
        ))?;
        Ok(agreeing == findings.len())
    }
}
