//! Read BVH, the format in which motion capture is shared: a skeleton (HIERARCHY) and its numbers at each frame (MOTION).
//!
//! Names may have any bytes: a file that is not UTF-8 is taken for Latin-1. `docs/reference.md` says what is read.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::error::FileError;
use crate::stages::simulate::recorded::RecordedMovement;

mod hierarchy;
mod motion;

/// What is wrong with a file, with its line.
type Wrong = String;

/// Largest file that is read, in bytes: far above any recording, and far below what a device has.
const MAX_BYTES: u64 = 1 << 29;
/// Largest number that is read: sums and products of such numbers are numbers still.
const LARGEST: f64 = 1e9;

/// Reads a recorded movement.
///
/// # Errors
/// If the file cannot be read, or is no BVH file: the message says in which line and what to do.
pub fn read_bvh(path: &Path) -> Result<RecordedMovement, FileError> {
    let mut bytes = Vec::new();
    let read = File::open(path).and_then(|file| file.take(MAX_BYTES + 1).read_to_end(&mut bytes));
    let length = read.map_err(|error| FileError::new(path, format!("cannot be read: {error}")))?;
    if length as u64 > MAX_BYTES {
        return Err(FileError::new(
            path,
            format!("is longer than {MAX_BYTES} bytes, the maximum for a BVH file"),
        ));
    }
    movement(&text(bytes)).map_err(|message| FileError::new(path, message))
}

/// The text of a file in UTF-8, with or without its mark, or else in Latin-1; lines end as on any system.
fn text(bytes: Vec<u8>) -> String {
    let text = String::from_utf8(bytes)
        .unwrap_or_else(|error| error.into_bytes().into_iter().map(char::from).collect());
    let text = text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text);
    if text.contains('\n') { text } else { text.replace('\r', "\n") }
}

fn movement(text: &str) -> Result<RecordedMovement, Wrong> {
    // The number and the words of each line that is not blank.
    let mut lines =
        text.lines().enumerate().map(|(at, line)| (at + 1, line)).filter(|(_, line)| !line.trim().is_empty());
    let is_motion = |line: &str| line.trim().eq_ignore_ascii_case("MOTION");
    let mut head = Vec::new();
    let motion = lines.by_ref().find(|(number, line)| {
        let ends = is_motion(line);
        if !ends {
            head.push((*number, *line));
        }
        ends
    });
    let joints = hierarchy::joints(&head)?;
    let Some((line, _)) = motion else {
        return Err("has no line MOTION after the skeleton; without frames nothing moves".to_owned());
    };
    let width = joints.iter().map(|joint| joint.channels.len()).sum();
    let (frame_time, values) = motion::frames(line, lines, width)?;
    Ok(RecordedMovement::new(joints, frame_time, values))
}

/// A number that is not too large.
fn number(word: &str) -> Option<f64> {
    word.parse().ok().filter(|number: &f64| number.abs() <= LARGEST)
}

/// A word of a file as a message may quote it.
fn quoted(word: &str) -> String {
    const MOST: usize = 40;
    let shown: String = word.chars().take(MOST).flat_map(char::escape_debug).collect();
    if word.chars().nth(MOST).is_some() { format!("`{shown}…`") } else { format!("`{shown}`") }
}

#[cfg(test)]
mod tests;
