//! The subcommand view.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Result;
use clap::Args;

use super::options::SettingsFile;
use super::output::say;
use super::touch::{FormatOptions, say_guesses};
use crate::files::write_text;
use crate::report::viewer::folder::{Sources, read};
use crate::report::viewer::page::page;

/// Writes an interactive page for a browser: a moving body, what its skin feels, its body map and its tree (not in the paper).
///
/// DIR is a folder of `simulate` or `estimate`, or one with data of your own: tactile.npy (or .csv), and, if available, parts.csv
/// (sensor,part) and tree.csv (child,parent,support). The body is shown if DIR has solids.csv, sensors.csv and poses.npy, as
/// `simulate` writes them. Without body-map.npy, a map of three dimensions is computed as by `distance` and `map`.
#[derive(Args)]
pub(super) struct View {
    /// Folder of a simulation, an estimate, or data of your own
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Pressures, if they are not in DIR, as `estimate` reads them
    #[arg(long, value_name = "FILE")]
    tactile: Option<PathBuf>,
    #[command(flatten)]
    format: FormatOptions,
    /// Folder of an estimate of this body, as `estimate` or `infer` wrote it: parts.csv and tree.csv, or posterior samples, of which
    /// the most probable one is shown
    #[arg(long, value_name = "DIR")]
    estimate: Option<PathBuf>,
    #[command(flatten)]
    file: SettingsFile,
    /// File for the page [default: view.html in DIR]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

impl View {
    /// Runs the subcommand.
    pub(super) fn run(self) -> Result<ExitCode> {
        let settings = self.file.load(false)?;
        let format = self.format.format();
        let sources = Sources {
            folder: &self.folder,
            tactile: self.tactile.as_deref(),
            format: &format,
            estimate: self.estimate.as_deref(),
        };
        let (scene, guesses) = read(&sources, &settings)?;
        say_guesses(&self.folder.display().to_string(), &guesses);
        let out = self.out.unwrap_or_else(|| self.folder.join("view.html"));
        let title = format!("Body schema of {}", self.folder.display());
        write_text(&out, &page(&title, &[scene.data()]))?;
        say(format!("{} sensors in {} frames, in {}", scene.sensors, scene.frames.count, out.display()))?;
        Ok(ExitCode::SUCCESS)
    }
}
