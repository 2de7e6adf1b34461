//! Write where parts and joints are, for `estimate --sensors`.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use serde::Serialize;

use crate::estimate::Estimate;
use crate::files::sensor_sites::read_sites;
use crate::files::tables::write_rows_of;
use crate::files::urdf::{MARK, urdf};
use crate::files::write_text;
use crate::recording::Recording;
use crate::stages::agent::Site;
use crate::stages::placement::{JointPlace, place};

/// The files that [`write`] writes.
const FILES: [&str; 2] = ["body.urdf", "places.csv"];

/// A row of places.csv.
#[derive(Serialize)]
struct Row {
    child: usize,
    parent: usize,
    known: bool,
    parent_x_m: f64,
    parent_y_m: f64,
    parent_z_m: f64,
    child_x_m: f64,
    child_y_m: f64,
    child_z_m: f64,
    standard_error_m: Option<f64>,
    mismatch: Option<f64>,
}

impl Row {
    fn new(
        JointPlace { child, parent, in_parent, in_child, standard_error, mismatch, .. }: &JointPlace,
    ) -> Self {
        Self {
            child: *child,
            parent: *parent,
            known: standard_error.is_some(),
            parent_x_m: micrometres(in_parent.x),
            parent_y_m: micrometres(in_parent.y),
            parent_z_m: micrometres(in_parent.z),
            child_x_m: micrometres(in_child.x),
            child_y_m: micrometres(in_child.y),
            child_z_m: micrometres(in_child.z),
            standard_error_m: standard_error.map(micrometres),
            mismatch: *mismatch,
        }
    }
}

/// To whole micrometres, far below what is known.
fn micrometres(metres: f64) -> f64 {
    (metres * 1e6).round() / 1e6
}

/// The columns of places.csv.
const COLUMNS: [&str; 11] = [
    "child",
    "parent",
    "known",
    "parent_x_m",
    "parent_y_m",
    "parent_z_m",
    "child_x_m",
    "child_y_m",
    "child_z_m",
    "standard_error_m",
    "mismatch",
];

/// The sites of so many sensors.
pub(super) fn read(file: &Path, sensors: usize) -> Result<Vec<Site>> {
    let sites = read_sites(file)?;
    ensure!(
        sites.len() == sensors,
        "{}: has {} sensors, but the recording has {sensors}; give each sensor one row",
        file.display(),
        sites.len()
    );
    Ok(sites)
}

/// Whether a file is one that [`write`] wrote.
fn is_own(file: &Path) -> bool {
    let begins = |text: String| text.contains(MARK) || text.starts_with(&COLUMNS.join(","));
    fs::read_to_string(file).is_ok_and(begins)
}

/// Refuses a folder with files of these names that are someone else's, which would be lost.
pub(super) fn refuse_others(out: &Path) -> Result<()> {
    for file in FILES.map(|name| out.join(name)) {
        ensure!(
            !file.exists() || is_own(&file),
            "{}: is not one that `estimate` wrote, and would be overwritten; give another --out",
            file.display()
        );
    }
    Ok(())
}

/// Writes body.urdf and places.csv, and says what is to be known about them; without sites, those of before are removed.
pub(super) fn write(
    out: &Path,
    recording: &Recording,
    found: &Estimate,
    sites: Option<&[Site]>,
) -> Result<Vec<String>> {
    let Some(sites) = sites else {
        for file in FILES.map(|name| out.join(name)).into_iter().filter(|file| is_own(file)) {
            fs::remove_file(&file).with_context(|| file.display().to_string())?;
        }
        return Ok(Vec::new());
    };
    let Recording { tactile, signed, .. } = recording;
    let placement = place(tactile, *signed, &found.parts.labels, &found.joints.tree, sites);
    let notes = placement.notes(&recording.sensors);
    write_rows_of(&out.join("places.csv"), &COLUMNS, placement.joints.iter().map(Row::new))?;
    write_text(&out.join("body.urdf"), &urdf(&placement, &notes))?;
    let known = placement.joints.iter().filter(|joint| joint.standard_error.is_some()).count();
    let summary = format!(
        "body.urdf: {} boxes; the place of {known} of {} joints is known from touch (places.csv)",
        placement.parts.len(),
        placement.joints.len()
    );
    Ok([vec![summary], notes].concat())
}
