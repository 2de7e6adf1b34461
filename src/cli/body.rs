//! The subcommand body, and within it import.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Result, ensure};
use clap::{Args, Subcommand};

use super::output::say;
use crate::files::body::{BodyFile, JointName, SkinEntry, write_body};
use crate::files::import::{Imported, import};

/// Sensors of each part of an imported body, if the user says nothing.
const SENSORS: usize = 40;

/// Makes files that describe a body, for simulate --body (not in the paper).
#[derive(Args)]
pub struct Body {
    #[command(subcommand)]
    action: Action,
}

#[derive(Subcommand)]
enum Action {
    Import(Import),
}

/// Reads the description of a robot, MJCF (MuJoCo) or URDF (ROS), and writes it as a body.
///
/// A part is a box, sphere, cylinder or capsule; the tree of parts is that of the bodies or links. Hinges, ball joints and
/// fixed joints are imported, in the rest pose. Limits, friction and damping of joints, motors, contacts and inertias are
/// ignored; masses become densities. See docs/reference.md.
#[derive(Args)]
struct Import {
    /// Description of a robot, as MJCF or URDF
    robot: PathBuf,
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..), conflicts_with = "per_area",
          help = format!("Sensors on each part [default: {SENSORS}]"))]
    sensors_per_part: Option<u64>,
    /// Sensors per square metre of each part
    #[arg(long, value_name = "D")]
    per_area: Option<f64>,
    /// File for the body (.toml)
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
}

impl Body {
    /// Runs the subcommand.
    pub fn run(self) -> Result<ExitCode> {
        match self.action {
            Action::Import(command) => command.run(),
        }
    }
}

impl Import {
    fn run(self) -> Result<ExitCode> {
        let (robot, out) = (&self.robot, &self.out);
        let skin = match (self.per_area, self.sensors_per_part) {
            (Some(density), _) => SkinEntry { sensors: None, per_area: Some(density) },
            (None, count) => {
                SkinEntry { sensors: Some(count.map_or(SENSORS, |count| count as usize)), per_area: None }
            }
        };
        let same =
            |a: &Path, b: &Path| matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b);
        ensure!(!same(robot, out), "{}: is the input file; give another --out", out.display());
        let Imported { file, notes } = import(robot, skin)?;
        let name = robot.file_name().unwrap_or_default();
        write_body(out, &format!("Imported from {name:?}."), &file)?;
        say(format!("{} parts, in {}", file.parts.len(), out.display()))?;
        say(format!("joints: {}", joints(&file)))?;
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
