//! Move a body as it was recorded, for the subcommand simulate, and say what became of the recording.

use std::path::{Path, PathBuf};

use anyhow::{Result, anyhow, ensure};
use clap::Args;

use super::options::metres;
use crate::files::FileError;
use crate::files::body::{BodyFile, NamedBody, SkinEntry};
use crate::files::bvh::read_bvh;
use crate::files::import::{Bones, Imported, SKIN, body_of_skeleton, names};
use crate::settings::{MAX_PRESSURES, MAX_SAMPLES};
use crate::stages::agent::Freedom;
use crate::stages::simulate::Trajectory;
use crate::stages::simulate::recorded::{
    Attached, RecordedMovement, Stretch, longest_stretch, play, samples, still_on,
};

/// Share of frames that repeat the one before from which on a note says so.
const REPEATED: f64 = 0.1;
/// Distance by which joints come apart from which on a note says so, m.
const APART: f64 = 1e-3;

/// A movement that was recorded.
#[derive(Args)]
pub(super) struct Recorded {
    /// Recorded movement that the body makes, instead of one at random: a BVH file. Without --body, its skeleton is the body, as
    /// `body import` makes it
    #[arg(long, value_name = "FILE")]
    pub movement: Option<PathBuf>,
    /// Length of a unit of the recorded movement, m [default: as in the body; without --body, guessed]
    #[arg(long, value_name = "METRES", value_parser = metres, requires = "movement")]
    scale: Option<f64>,
    /// Play all frames of the recorded movement, and not the longest stretch without a jump
    #[arg(long, requires = "movement")]
    keep_jumps: bool,
}

/// A body and how it moved.
pub(super) struct Played {
    /// The body. Parts that never moved against each other are fixed to each other.
    pub body: NamedBody,
    /// Its poses.
    pub trajectory: Trajectory,
    /// Time between two of them, s.
    pub interval: f64,
    /// What is worth knowing, in a line each.
    pub notes: Vec<String>,
}

/// The body of a recorded skeleton.
pub(super) fn skeleton_body(
    path: &Path,
    movement: &RecordedMovement,
    skin: SkinEntry,
    bones: &Bones,
) -> Result<Imported> {
    Ok(body_of_skeleton(movement, skin, bones).map_err(|message| FileError::new(path, message))?)
}

impl Recorded {
    /// Moves a body, or else the skeleton's own, as `path` has it, sampled every `interval` (s), or else at its frames, for
    /// `duration` at most (s).
    pub(super) fn play(
        &self,
        path: &Path,
        body: Option<(&Path, NamedBody)>,
        interval: Option<f64>,
        duration: f64,
    ) -> Result<Played> {
        let movement = read_bvh(path)?;
        let mut notes = Vec::new();
        let (origin, mut body) = match body {
            Some(body) => body,
            None => {
                let bones = Bones { scale: self.scale, min_length: Bones::MIN_LENGTH };
                let imported = skeleton_body(path, &movement, SKIN, &bones)?;
                notes.extend(imported.notes);
                (path, named(path, &imported.file)?)
            }
        };
        let attached = Attached::new(&body.agent, &body.names, &movement, self.scale).map_err(|misfit| {
            anyhow!(
                "{}: cannot move as {}: {misfit} (bodyschema body import makes a body that can)",
                origin.display(),
                path.display()
            )
        })?;
        let stretch = if self.keep_jumps {
            Stretch::whole(&movement)
        } else {
            longest_stretch(&body.agent, &attached, &movement)
        };
        notes.extend(jumps(&stretch, movement.frames()));
        let interval = interval.unwrap_or(movement.frame_time());
        let there = samples(&movement, &stretch.frames, interval);
        let samples = there.min((duration / interval + 1e-6) as usize);
        ensure!(movement.frames() > 1, "{}: has one frame, but a movement needs two", path.display());
        ensure!(
            samples > 0,
            "{}: {} s are played, but a sample needs {interval} s{}",
            path.display(),
            duration.min((stretch.frames.len() - 1) as f64 * movement.frame_time()),
            if stretch.jumps.is_empty() { "" } else { "; with --keep-jumps, more are" }
        );
        let pressures = samples as f64 * body.agent.sites.len() as f64;
        ensure!(
            samples as f64 <= MAX_SAMPLES && pressures <= MAX_PRESSURES,
            "{}: {samples} samples of {} sensors are more than 20 million samples or 2 billion pressures; give a --duration, or a \
             longer sense.interval",
            path.display(),
            body.agent.sites.len()
        );
        let trajectory = play(&body.agent, &attached, &movement, &stretch.frames, interval, samples);
        if samples < there {
            notes.push(format!(
                "{} s of {} s are played (--duration)",
                samples as f64 * interval,
                there as f64 * interval
            ));
        }
        notes.extend(repeated(&movement));
        notes.extend(fix_still(&mut body, &trajectory));
        let apart = trajectory.resolution.anchor_separation;
        if apart > APART {
            notes.push(format!(
                "joints come apart by at most {:.1} mm, because the recording also moves them along",
                1e3 * apart
            ));
        }
        notes.push(format!(
            "a part turns by at most {:.3} revolutions between two samples",
            trajectory.resolution.turn
        ));
        Ok(Played { body, trajectory, interval, notes })
    }
}

fn named(path: &Path, file: &BodyFile) -> Result<NamedBody> {
    Ok(file.body().map_err(|message| FileError::new(path, message))?)
}

/// Says what is left out because of jumps. Frames are counted from 1.
fn jumps(stretch: &Stretch, frames: usize) -> Option<String> {
    let first = stretch.jumps.first()? + 1;
    let count = stretch.jumps.len();
    Some(format!(
        "frames {} to {} of {frames} are played, the longest stretch without a jump: there {} (a part faster than {} turns or {} m \
         a second), the first at frame {first}; --keep-jumps plays all",
        stretch.frames.start + 1,
        stretch.frames.end,
        if count == 1 { "is 1".to_owned() } else { format!("are {count}") },
        Stretch::TURNS,
        Stretch::SPEED,
    ))
}

/// Says if many frames repeat the one before: a recording of fewer frames was stretched.
fn repeated(movement: &RecordedMovement) -> Option<String> {
    let share = movement.repeated_frames() as f64 / movement.frames() as f64;
    (share > REPEATED)
        .then(|| format!("{:.0} % of the frames repeat the one before, where nothing is felt", 100.0 * share))
}

/// Fixes parts to each other that never move against each other, and says which.
fn fix_still(body: &mut NamedBody, trajectory: &Trajectory) -> Option<String> {
    let on = still_on(&body.agent, trajectory);
    let mut fixed = Vec::new();
    for (joint, on) in body.agent.joints.iter_mut().zip(on) {
        let Some(on) = on.filter(|_| joint.freedom != Freedom::Fixed) else { continue };
        (joint.parent, joint.freedom) = (on, Freedom::Fixed);
        fixed.push(format!("{} on {}", body.names[joint.child], body.names[on]));
    }
    let names = names(fixed.iter().map(String::as_str))?;
    Some(format!(
        "parts that never move against each other are one in truth, since touch cannot tell them apart {names}"
    ))
}
