//! Write where parts and joints are, for `estimate --sensors`.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use serde::Serialize;

use crate::estimate::Estimate;
use crate::files::sensor_sites::read_sites;
use crate::files::tables::write_rows_of;
use crate::files::urdf::urdf;
use crate::files::write_text;
use crate::recording::Recording;
use crate::stages::agent::Site;
use crate::stages::placement::{JointPlace, Placement, place};

/// Share that a rigid motion of the given sites must explain of what a part feels: otherwise the sites are likely to be wrong.
const EXPLAINED: f64 = 0.9;
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
    fn new(JointPlace { child, parent, in_parent, in_child, fit, .. }: &JointPlace) -> Self {
        Self {
            child: *child,
            parent: *parent,
            known: fit.is_some(),
            parent_x_m: micrometres(in_parent.x),
            parent_y_m: micrometres(in_parent.y),
            parent_z_m: micrometres(in_parent.z),
            child_x_m: micrometres(in_child.x),
            child_y_m: micrometres(in_child.y),
            child_z_m: micrometres(in_child.z),
            standard_error_m: fit.map(|fit| micrometres(fit.standard_error)),
            mismatch: fit.map(|fit| fit.mismatch),
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

/// Writes body.urdf and places.csv, and says what is to be known about them; without sites, those of before are removed.
pub(super) fn write(
    out: &Path,
    recording: &Recording,
    found: &Estimate,
    sites: Option<&[Site]>,
) -> Result<Vec<String>> {
    let Some(sites) = sites else {
        for file in FILES.map(|name| out.join(name)).into_iter().filter(|file| file.exists()) {
            fs::remove_file(&file).with_context(|| file.display().to_string())?;
        }
        return Ok(Vec::new());
    };
    let Recording { tactile, signed, .. } = recording;
    let placement = place(tactile, *signed, &found.parts.labels, &found.joints.tree, sites);
    let notes = notes(&placement, recording);
    write_rows_of(&out.join("places.csv"), &COLUMNS, placement.joints.iter().map(Row::new))?;
    let head =
        ["Estimated by bodyschema. A box holds the sensors of a part; masses are not known.".to_owned()];
    write_text(&out.join("body.urdf"), &urdf(&placement, &[&head[..], &notes].concat()))?;
    let known = placement.joints.iter().filter(|joint| joint.fit.is_some()).count();
    let summary = format!(
        "body.urdf: {} boxes; the place of {known} of {} joints is known from touch (places.csv)",
        placement.parts.len(),
        placement.joints.len()
    );
    Ok([vec![summary], notes].concat())
}

/// What is to be known about the places, a line each.
fn notes(placement: &Placement, recording: &Recording) -> Vec<String> {
    let mut notes = Vec::new();
    for part in &placement.parts {
        if part.explained < EXPLAINED {
            notes.push(format!(
                "part {}: a rigid motion of the given positions and normals explains {:.0} % of what its sensors feel; are rows in the \
                 order of the sensors, and do all normals point out of the surface?",
                part.part,
                100.0 * part.explained.max(0.0)
            ));
        }
        if !part.left_out.is_empty() {
            let first = recording.sensors[part.left_out[0]];
            notes.push(format!(
                "part {}: {} of its sensors are left out, for they are on another solid than most of it (the first, {first})",
                part.part,
                part.left_out.len()
            ));
        }
    }
    for joint in placement.joints.iter().filter(|joint| joint.fit.is_none()) {
        notes.push(format!(
            "parts {} and {}: touch does not tell the place of their joint, since no point has the same speed in both; \
             places.csv has a guess",
            joint.child, joint.parent
        ));
    }
    notes
}
