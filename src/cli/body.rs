//! The subcommand body, and within it import.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Result, ensure};
use clap::{Args, Subcommand};

use super::options::metres;
use super::output::say;
use super::view::show_at_rest;
use crate::files::body::{BodyFile, JointName};
use crate::files::import::{Imported, MIN_LENGTH, Options, SKIN, import_into};
use crate::files::{FileError, is_same_file};

/// Makes files that describe a body, for simulate --body (not in the paper).
#[derive(Args)]
pub(super) struct Body {
    #[command(subcommand)]
    action: Action,
}

#[derive(Subcommand)]
enum Action {
    Import(Import),
}

/// Reads the description of a robot, MJCF (MuJoCo) or URDF (ROS), or the skeleton of a recorded movement (.bvh), and writes it
/// as a body.
///
/// A part is a box, sphere, cylinder or capsule; the tree of parts is that of the bodies or links. A mesh becomes a box, with
/// sensors on the mesh itself. Hinges, ball joints and fixed joints are imported, in the rest pose. Limits, friction and damping of
/// joints, motors and contacts are ignored; masses become densities, and inertias are kept. See docs/reference.md.
///
/// Of a skeleton, each bone becomes a capsule from its joint to the next one, with a radius of 0.15 of its length. `simulate
/// --movement` moves the body as it was recorded. Which axis points up does not matter for touch.
#[derive(Args)]
struct Import {
    /// Description of a robot, as MJCF or URDF, or a recorded movement, as BVH (a name that ends in .bvh)
    #[arg(value_name = "FILE")]
    robot: PathBuf,
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..), conflicts_with = "per_area",
          help = format!("Sensors on each part [default: {}]", SKIN.sensors.unwrap_or_default()))]
    sensors_per_part: Option<u64>,
    /// Sensors per square metre of each part
    #[arg(long, value_name = "D")]
    per_area: Option<f64>,
    /// BVH: length of a unit of the file, m, such as 0.01 or 0.0254 [default: guessed from the size of the skeleton]
    #[arg(long, value_name = "METRES", value_parser = metres)]
    scale: Option<f64>,
    #[arg(long, value_name = "METRES", value_parser = metres,
          help = format!("BVH: length of a bone from which on it carries skin, m [default: {}]", MIN_LENGTH))]
    min_length: Option<f64>,
    /// Robots: the body or link whose tree is imported [default: that of the largest tree]
    #[arg(long, value_name = "NAME")]
    root: Option<String>,
    /// Robots: refuse what a body cannot have, such as sliding joints, instead of changing it with a note
    #[arg(long)]
    strict: bool,
    /// File for the body (.toml)
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// File for a page for a browser (.html): the body at rest with its sensors and meshes, as `view` shows it
    #[arg(long, value_name = "FILE")]
    view: Option<PathBuf>,
}

impl Body {
    /// Runs the subcommand.
    pub(super) fn run(self) -> Result<ExitCode> {
        match self.action {
            Action::Import(command) => command.run(),
        }
    }
}

impl Import {
    fn run(self) -> Result<ExitCode> {
        let Self { robot, sensors_per_part, per_area, scale, min_length, root, strict, out, view } = self;
        let options = Options { strict, root, scale, min_length, ..Options::default() }
            .with_skin(sensors_per_part.map(|count| count as usize), per_area);
        if let Some(view) = &view {
            ensure!(
                !is_same_file(&robot, view) && *view != out,
                "{}: is the description or the body; write the page (--view) to another file",
                view.display()
            );
        }
        let Imported { file, notes, surfaces } = import_into(&robot, &out, &options)?;
        // Now that the body is there, whatever its name.
        ensure!(
            view.as_ref().is_none_or(|view| !is_same_file(&out, view)),
            "{}: is the body; write the page (--view) to another file",
            out.display()
        );
        say(format!("{} parts, in {}", file.parts.len(), out.display()))?;
        say(format!("joints: {}", joints(&file)))?;
        if let Some(view) = &view {
            let body = file.body().map_err(|message| FileError::new(&robot, message))?;
            show_at_rest(&robot, &body, surfaces, view)?;
        }
        notes.into_iter().try_for_each(|note| say(format!("note: {note}")))?;
        Ok(ExitCode::SUCCESS)
    }
}

/// How many joints of each kind a body has.
fn joints(file: &BodyFile) -> String {
    let kinds = [
        (JointName::Universal, "universal"),
        (JointName::Hinge, "hinge"),
        (JointName::Ball, "ball"),
        (JointName::Fixed, "fixed"),
    ];
    let count = |kind| file.parts.iter().filter(|part| part.joint == Some(kind)).count();
    kinds.map(|(kind, word)| format!("{} {word}", count(kind))).join(", ")
}
