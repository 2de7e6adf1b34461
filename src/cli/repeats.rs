//! Write and say how often parts and joints were found again from resampled times.

use std::path::Path;

use anyhow::{Context, Result};
use serde::Serialize;

use super::output::say;
use crate::estimate::Repeats;
use crate::files::remove_if_there;
use crate::files::tables::write_rows_of;
use crate::stages::tree::Edge;

/// The table of parts and joints, in the folder of an estimate.
const FILE: &str = "repeats.csv";

#[derive(Serialize)]
struct Row {
    part: usize,
    /// The part that it is joined to; none in the row of a part.
    joined_to: Option<usize>,
    repeated: f64,
}

/// Writes the share of each part, and of each edge of `tree`, or removes what is left of an estimate with repeats.
pub(super) fn write(out: &Path, repeats: Option<&Repeats>, tree: &[Edge]) -> Result<()> {
    let file = out.join(FILE);
    let Some(repeats) = repeats else {
        return remove_if_there(&file).with_context(|| file.display().to_string());
    };
    let parts = repeats.parts.iter().map(|(&part, &repeated)| Row { part, joined_to: None, repeated });
    let joints = tree.iter().zip(&repeats.tree).map(|(edge, &repeated)| Row {
        part: edge.child,
        joined_to: Some(edge.parent),
        repeated,
    });
    Ok(write_rows_of(&file, &["part", "joined_to", "repeated"], parts.chain(joints))?)
}

/// Says which parts and joints were not found again each time.
pub(super) fn print(repeats: &Repeats, tree: &[Edge]) -> Result<()> {
    let times = |share: f64| (share * repeats.count as f64).round() as usize;
    let parts = repeats.parts.iter().map(|(part, share)| (format!("part {part}"), times(*share)));
    let joints = tree.iter().zip(&repeats.tree);
    let joints = joints.map(|(edge, share)| (format!("joint {}–{}", edge.child, edge.parent), times(*share)));
    let seldom: Vec<String> = parts
        .chain(joints)
        .filter(|(_, found)| *found < repeats.count)
        .map(|(name, found)| format!("{name} ({found} of {})", repeats.count))
        .collect();
    let found = match &seldom[..] {
        [] => "all parts and joints were found every time".to_owned(),
        _ => format!("all parts and joints were found every time, except {}", seldom.join(", ")),
    };
    say(format!("estimated again {} times from resampled times: {found}", repeats.count))
}
