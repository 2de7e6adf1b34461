//! Place estimated joints on the body, as `bodyschema estimate --sensors` does.

use bodyschema::files::urdf::urdf;
use bodyschema::recording::{Cleaning, Recording};
use bodyschema::stages::agent::Site;
use bodyschema::stages::placement::{JointPlace, Placement, place as placed};
use bodyschema::stages::tree::Edge;
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{self, by_rows, edges, value_error, whole};
use crate::run::{Steps, Threads};

/// Places parts and joints. In: pressures, the part of each sensor (−1 for none), the tree as (child, parent), and position and normal of
/// each sensor, checked before, with the frame that it is in.
#[pyfunction]
#[pyo3(signature = (touch, parts, tree, sites, frames, signed, keep_saturated, jobs))]
#[expect(clippy::too_many_arguments, reason = "one for each argument of the function in Python")]
pub(crate) fn place<'py>(
    py: Python<'py>,
    touch: &Bound<'py, PyAny>,
    parts: Vec<i64>,
    tree: Vec<(usize, usize)>,
    sites: Vec<([f64; 3], [f64; 3])>,
    frames: Vec<usize>,
    signed: Option<bool>,
    keep_saturated: bool,
    jobs: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let threads = Threads::start(jobs)?;
    let tactile = arrays::touch(&threads, touch)?;
    let sensors = tactile.sensors();
    if parts.len() != sensors || sites.len() != sensors || frames.len() != sensors {
        return Err(value_error(format!(
            "touch has {sensors} sensors, but there are {} parts, {} positions and {} frames",
            parts.len(),
            sites.len(),
            frames.len()
        )));
    }
    let site = |(at, ((position, normal), part))| {
        Site::facing(part, position, normal).ok_or_else(|| {
            value_error(format!("normals[{at}] has no direction; it must point out of the surface"))
        })
    };
    let sites: Vec<Site> = sites.into_iter().zip(frames).enumerate().map(site).collect::<PyResult<_>>()?;
    let work = move |_: &Steps| {
        let cleaning = Cleaning { signed, keep_saturated };
        let mut recording = Recording::cleaned(tactile, cleaning);
        let labels: Vec<Option<usize>> =
            recording.of_sensors(&parts).into_iter().map(|part| usize::try_from(part).ok()).collect();
        let kept: Vec<usize> = (0..labels.len()).filter(|at| labels[*at].is_some()).collect();
        let series: Vec<&[f32]> = recording.tactile.series().collect();
        recording.tactile.pressures = kept.iter().flat_map(|at| series[*at]).copied().collect();
        recording.sensors = kept.iter().map(|at| recording.sensors[*at]).collect();
        let labels: Vec<usize> = labels.into_iter().flatten().collect();
        let tree: Vec<Edge> = tree.into_iter().map(|(child, parent)| Edge { child, parent }).collect();
        let has_sensors = |part: &usize| labels.contains(part);
        let is_known = tree.iter().all(|edge| has_sensors(&edge.child) && has_sensors(&edge.parent));
        let sites = recording.of_sensors(&sites);
        let found = is_known.then(|| placed(&recording.tactile, recording.signed, &labels, &tree, &sites));
        found.map(|found| (found, recording.sensors))
    };
    let found = threads.run(py, None, work)?;
    let (placement, sensors) =
        found.ok_or_else(|| value_error("a part of the tree has no sensor that feels anything"))?;
    facts(py, &placement, &placement.notes(&sensors))
}

fn facts<'py>(py: Python<'py>, placement: &Placement, notes: &[String]) -> PyResult<Bound<'py, PyDict>> {
    let Placement { parts, joints } = placement;
    let facts = PyDict::new(py);
    facts.set_item("labels", whole(parts.iter().map(|part| part.part)).into_pyarray(py))?;
    let explained: Vec<f64> = parts.iter().map(|part| part.explained).collect();
    facts.set_item("explained", explained.into_pyarray(py))?;
    let centres = parts.iter().flat_map(|part| part.solid.centre.iter().copied()).collect();
    facts.set_item("centres", by_rows(py, 3, centres)?)?;
    let sides = parts.iter().flat_map(|part| part.solid.sides.iter().copied()).collect();
    facts.set_item("sides", by_rows(py, 3, sides)?)?;
    // By rows; a matrix of nalgebra is by columns.
    let rows = |columns: &[f64]| [0, 3, 6, 1, 4, 7, 2, 5, 8].map(|at| columns[at]);
    let turns = parts.iter().flat_map(|part| rows(part.solid.rotation.matrix().as_slice())).collect();
    facts.set_item("rotations", by_rows(py, 9, turns)?)?;
    facts.set_item("tree", edges(py, joints.iter().map(|joint| (joint.child, joint.parent)))?)?;
    facts.set_item(
        "known",
        joints.iter().map(|joint| joint.standard_error.is_some()).collect::<Vec<bool>>().into_pyarray(py),
    )?;
    let place = |of: fn(&JointPlace) -> [f64; 3]| by_rows(py, 3, joints.iter().flat_map(of).collect());
    facts.set_item("in_parent", place(|joint| joint.in_parent.into())?)?;
    facts.set_item("in_child", place(|joint| joint.in_child.into())?)?;
    let turns = joints.iter().flat_map(|joint| rows(joint.rotation.matrix().as_slice())).collect();
    facts.set_item("joint_rotations", by_rows(py, 9, turns)?)?;
    let error = |joint: &JointPlace| joint.standard_error.unwrap_or(f64::NAN);
    facts.set_item("standard_error", joints.iter().map(error).collect::<Vec<f64>>().into_pyarray(py))?;
    let mismatch = |joint: &JointPlace| joint.mismatch.unwrap_or(f64::NAN);
    facts.set_item("mismatch", joints.iter().map(mismatch).collect::<Vec<f64>>().into_pyarray(py))?;
    facts.set_item("notes", notes.to_vec())?;
    facts.set_item("urdf", urdf(placement, notes))?;
    Ok(facts)
}
