//! Move a body as a file has recorded it, and say what became of the recording.

use std::path::Path;

use crate::files::body::NamedBody;
use crate::files::bvh::read_bvh;
use crate::files::import::{Options, body_of_skeleton, names};
use crate::files::{FileError, FrontEnd};
use crate::settings::{MAX_PRESSURES, MAX_SAMPLES};
use crate::stages::agent::Freedom;
use crate::stages::simulate::Trajectory;
use crate::stages::simulate::recorded::{
    Attached, Misfit, RecordedMovement, Stretch, longest_stretch, play, samples, still_on,
};

/// Share of frames that repeat the one before from which on a note says so.
const REPEATED: f64 = 0.1;
/// Distance by which joints come apart from which on a note says so, m.
const APART: f64 = 1e-3;

/// How a recorded movement is played.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Playing {
    /// Length of a unit of the recording, m; as in the body, or guessed without one.
    pub scale: Option<f64>,
    /// Whether all frames are played, and not the longest stretch without a jump.
    pub keep_jumps: bool,
    /// Time between two samples, s; that between two frames if it is not given.
    pub interval: Option<f64>,
    /// Most time that is played, s.
    pub duration: f64,
    /// Whose words messages use.
    pub front_end: FrontEnd,
}

/// A body and how it moved.
#[derive(Debug)]
pub struct Played {
    /// The body. Parts that never moved against each other are fixed to each other.
    pub body: NamedBody,
    /// Its poses.
    pub trajectory: Trajectory,
    /// Time between two of them, s.
    pub interval: f64,
    /// What body and movement have in another way than the recording, in a line each.
    pub notes: Vec<String>,
    /// What says so if only a part is played, for the duration.
    pub cut: Option<String>,
}

/// Moves a body, or else the skeleton's own, as the BVH file at `path` has it.
///
/// # Errors
/// If the file cannot be read, does not fit the body, or is too short or too long: the message says what to do.
pub fn move_as_recorded(
    path: &Path,
    body: Option<(&Path, NamedBody)>,
    playing: &Playing,
) -> Result<Played, FileError> {
    let Playing { scale, keep_jumps, interval, duration, front_end } = *playing;
    let wrong = |message: String| Err(FileError::new(path, message));
    let movement = read_bvh(path)?;
    let mut notes = Vec::new();
    let (origin, mut body) = match body {
        Some(body) => body,
        None => {
            let options = Options { scale, front_end, ..Options::default() };
            let made = body_of_skeleton(&movement, &options)
                .and_then(|imported| Ok((imported.file.body()?, imported.notes)));
            let (body, more) = made.map_err(|message| FileError::new(path, message))?;
            notes.extend(more);
            (path, body)
        }
    };
    let attached = Attached::new(&body.agent, &body.names, &movement, scale).map_err(|misfit| {
        let help = match misfit {
            Misfit::NoScale => format!("; give {}", front_end.name("scale")),
            _ => String::new(),
        };
        let import = front_end.either(["bodyschema body import", "bodyschema.import_body"]);
        let message =
            format!("cannot move as {}: {misfit}{help} ({import} makes a body that can)", path.display());
        FileError::new(origin, message)
    })?;
    let stretch = if keep_jumps {
        Stretch::whole(&movement)
    } else {
        longest_stretch(&body.agent, &attached, &movement)
    };
    let keeps_jumps = front_end.either(["--keep-jumps", "keep_jumps=True"]);
    notes.extend(jumps(&stretch, movement.frames(), keeps_jumps));
    let interval = interval.unwrap_or(movement.frame_time());
    let there = samples(&movement, &stretch.frames, interval);
    let samples = there.min((duration / interval + 1e-6) as usize);
    if movement.frames() < 2 {
        return wrong("has one frame, but a movement needs two".to_owned());
    }
    if samples == 0 {
        let seconds = duration.min((stretch.frames.len() - 1) as f64 * movement.frame_time());
        let more = match stretch.jumps[..] {
            [] => String::new(),
            _ => format!("; with {}, more are", keeps_jumps),
        };
        return wrong(format!("{seconds} s are played, but a sample needs {interval} s{more}"));
    }
    let sensors = body.agent.sites.len();
    if samples as f64 > MAX_SAMPLES || samples as f64 * sensors as f64 > MAX_PRESSURES {
        return wrong(format!(
            "{samples} samples of {sensors} sensors are more than 20 million samples or 2 billion pressures; give a {}, or a longer \
             sense.interval",
            front_end.name("duration")
        ));
    }
    let trajectory = play(&body.agent, &attached, &movement, &stretch.frames, interval, samples);
    let cut = (samples < there).then(|| {
        let [played, all] = [samples, there].map(|samples| samples as f64 * interval);
        format!("{played} s of {all} s are played ({})", front_end.name("duration"))
    });
    notes.extend(repeated(&movement));
    notes.extend(fix_still(&mut body, &trajectory));
    let apart = trajectory.resolution.anchor_separation;
    if apart > APART {
        notes.push(format!(
            "joints come apart by at most {:.1} mm, because the recording also moves them along",
            1e3 * apart
        ));
    }
    Ok(Played { body, trajectory, interval, notes, cut })
}

/// Says what is left out because of jumps. Frames are counted from 1.
fn jumps(stretch: &Stretch, frames: usize, keeps_jumps: &str) -> Option<String> {
    let first = stretch.jumps.first()? + 1;
    let count = stretch.jumps.len();
    Some(format!(
        "frames {} to {} of {frames} are played, the longest stretch without a jump: there {} (a part faster than {} turns or {} m \
         a second), the first at frame {first}; {keeps_jumps} plays all",
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
