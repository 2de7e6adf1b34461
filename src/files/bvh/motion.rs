//! Read the frames of a BVH file: how many there are, the time between them, and a line of numbers for each.

use super::{Wrong, number, quoted};

/// Longest time between two frames, s.
const LONGEST: f64 = 1e3;

/// The frame time, s, and the numbers of all frames, which have `width` numbers each. `lines` follow the line MOTION, of which
/// `line` is the number.
pub(super) fn frames<'a>(
    line: usize,
    mut lines: impl Iterator<Item = (usize, &'a str)>,
    width: usize,
) -> Result<(f64, Vec<f64>), Wrong> {
    let mut value = |key: &str| {
        let (at, text) = lines.next().unwrap_or((line, ""));
        let found = after_key(text, key).map(|value| (at, value));
        found.ok_or_else(|| format!("line {at}: `{key}:` must follow, but there is {}", quoted(text.trim())))
    };
    let (counted_at, count) = value("Frames")?;
    let declared: u64 = count
        .parse()
        .map_err(|_| format!("line {counted_at}: Frames is {}, but must be a whole number", quoted(count)))?;
    let (timed_at, time) = value("Frame Time")?;
    let frame_time = number(time).filter(|time| (1e-6..=LONGEST).contains(time)).ok_or_else(|| {
        format!("line {timed_at}: Frame Time is {}, but must be 0.000001 to 1000 (s)", quoted(time))
    })?;
    // What the file says of its length is not relied on.
    let (mut values, mut frames) = (Vec::new(), 0_u64);
    for (at, text) in lines {
        let before = values.len();
        for word in text.split_whitespace() {
            let number = number(word).ok_or_else(|| {
                let column = values.len() - before + 1;
                format!("line {at}: number {column} is {}, but must be a number up to 1e9", quoted(word))
            })?;
            values.push(number);
        }
        let found = values.len() - before;
        if found != width {
            return Err(format!("line {at}: {found} numbers, but a frame has {width}, one for each channel"));
        }
        frames += 1;
    }
    if frames == 0 {
        return Err(format!("line {counted_at}: no frame follows"));
    }
    if frames != declared {
        return Err(format!(
            "line {counted_at}: {declared} frames are declared, but {frames} follow; correct the number if none is missing"
        ));
    }
    Ok((frame_time, values))
}

/// What follows a key and its colon on a line.
fn after_key<'a>(text: &'a str, key: &str) -> Option<&'a str> {
    let (found, value) = text.split_once(':')?;
    let same = found.split_whitespace().flat_map(str::chars).map(|letter| letter.to_ascii_lowercase());
    let wanted = key.chars().filter(|letter| *letter != ' ').map(|letter| letter.to_ascii_lowercase());
    same.eq(wanted).then(|| value.trim())
}
