//! The subcommand view.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Result, ensure};
use clap::Args;

use super::options::SettingsFile;
use super::output::say;
use super::touch::{FormatOptions, say_guesses};
use crate::files::body::{NamedBody, read_body};
use crate::files::import::{Imported, Options, Surface, import};
use crate::files::{FileError, is_same_file, write_text};
use crate::report::viewer::at_rest::at_rest;
use crate::report::viewer::folder::{Sources, read};
use crate::report::viewer::page::page;

/// Writes an interactive page for a browser: a moving body, what its skin feels, its body map and its tree (not in the paper).
///
/// DIR is a folder of `simulate` or `estimate`, or one with data of your own: tactile.npy (or .csv), and, if available, parts.csv
/// (sensor,part) and tree.csv (child,parent,support). The body is shown if DIR has solids.csv, sensors.csv and poses.npy, as
/// `simulate` writes them. Without body-map.npy, a map of three dimensions is computed as by `distance` and `map`.
///
/// Of a file, a body (.toml) or what `body import` reads, it shows the body at rest with its sensors, before anything is simulated.
#[derive(Args)]
pub(super) struct View {
    /// Folder of a simulation, an estimate, or data of your own; or the file of a body
    #[arg(value_name = "PATH")]
    path: PathBuf,
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
    /// File for the page [default: view.html in DIR, or FILE.html beside a file]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// Writes a page that shows a body at rest, which was read from `path`, with the surfaces of its meshes.
pub(super) fn show_at_rest(path: &Path, body: &NamedBody, surfaces: Vec<Surface>, out: &Path) -> Result<()> {
    let scene = at_rest(body, surfaces);
    write_text(out, &page(&path.display().to_string(), &[scene.data()]))?;
    say(format!("{} sensors on {} solids, in {}", scene.sensors, body.agent.parts.len(), out.display()))
}

impl View {
    /// Runs the subcommand.
    pub(super) fn run(self) -> Result<ExitCode> {
        let page_of = |default: PathBuf| self.out.clone().unwrap_or(default);
        if self.path.is_file() {
            return self.at_rest(&page_of(self.path.with_extension("html")));
        }
        let settings = self.file.load(false)?;
        let format = self.format.format();
        let sources = Sources {
            folder: &self.path,
            tactile: self.tactile.as_deref(),
            format: &format,
            estimate: self.estimate.as_deref(),
        };
        let (scene, guesses) = read(&sources, &settings)?;
        say_guesses(&self.path.display().to_string(), &guesses);
        let out = page_of(self.path.join("view.html"));
        let title = format!("Body schema of {}", self.path.display());
        write_text(&out, &page(&title, &[scene.data()]))?;
        say(format!("{} sensors in {} frames, in {}", scene.sensors, scene.frames.count, out.display()))?;
        Ok(ExitCode::SUCCESS)
    }

    /// Shows a body that has not moved.
    fn at_rest(&self, out: &Path) -> Result<ExitCode> {
        let path = &self.path;
        ensure!(
            self.tactile.is_none() && self.estimate.is_none() && self.file.settings.is_none(),
            "{}: --tactile, --estimate and --settings are for a folder; leave them out for the file of a body",
            path.display()
        );
        ensure!(!is_same_file(path, out), "{}: is the input file; give another --out", out.display());
        let is_one_of = |names: &[&str]| {
            path.extension().is_some_and(|own| names.iter().any(|name| own.eq_ignore_ascii_case(name)))
        };
        ensure!(
            !is_one_of(&["npy", "npz", "csv"]),
            "{}: is a table or a recording, and not a body; give the folder that it is in",
            path.display()
        );
        let is_body = is_one_of(&["toml"]);
        let (body, surfaces, notes) = if is_body {
            (read_body(path)?, Vec::new(), Vec::new())
        } else {
            let Imported { file, notes, surfaces } = import(path, &Options::default())?;
            let body = file.body().map_err(|message| FileError::new(path, message))?;
            (body, surfaces, notes)
        };
        show_at_rest(path, &body, surfaces, out)?;
        notes.into_iter().try_for_each(|note| say(format!("note: {note}")))?;
        Ok(ExitCode::SUCCESS)
    }
}
