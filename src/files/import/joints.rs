//! The joints of a part: in how many places and about which axes it turns on its parent.

use nalgebra::{Isometry3, Translation3, Vector3 as Column};

use super::document::Wrong;
use super::options::Options;
use super::placed::{Solid, Turn};
use super::rounding::rounded;
use crate::files::body::{JointName, PartEntry};
use crate::stages::agent::{Shape, Vector3};

/// Distance, m, within which two hinges count as at the same place.
const SAME_PLACE: f64 = 1e-6;
/// Distance of each from their mean, m, within which hinges become one joint at that place, with a note: that of the hinges which
/// stand for a ball joint of a person in public models.
const NEAR: f64 = 0.05;
/// Radius of a ball without skin that stands for a body without shape, m.
pub(super) const STAND_IN: f64 = 0.01;
/// Mass of a ball between two places about which a part turns, as a share of the part's.
pub(super) const BETWEEN: f64 = 0.005;
/// Sine below which two axes are the same.
const SAME_AXIS: f64 = 1e-6;
/// Cosine above which a note says so: below, it is the rounding of a description that writes 1.57 for a right angle.
const NOTED: f64 = 5e-3;

/// A joint as a body file has it.
pub(super) struct Joint {
    pub name: JointName,
    pub anchor: Column<f64>,
    pub axes: Option<Vec<Vector3>>,
}

/// The joints that let a part turn in all these ways, one after the other, and notes on what is another way than they are together.
pub(super) fn joints(turns: &[&Turn], strict: bool) -> Result<(Vec<Joint>, Vec<String>), Wrong> {
    let anchors: Vec<Column<f64>> = turns.iter().filter_map(|turn| turn.anchor()).collect();
    let mean = anchors.iter().sum::<Column<f64>>() / anchors.len().max(1) as f64;
    let off = anchors.iter().map(|anchor| (anchor - mean).norm()).fold(0.0, f64::max);
    if strict && off > SAME_PLACE {
        let count = anchors.len();
        return Err(format!(
            "it rotates about {count} points of its parent; give what is between them a shape, or let them coincide"
        ));
    }
    let mut notes = Vec::new();
    let mut groups: Vec<(Vec<&Turn>, Column<f64>)> = Vec::new();
    if off <= NEAR {
        // Not the mean of equals, which is rounded.
        let place = if off <= SAME_PLACE { anchors.first().copied().unwrap_or_default() } else { mean };
        groups.push((turns.to_vec(), place));
        if off > SAME_PLACE {
            notes.push(format!(
                "its {} joints, up to {:.1} cm from their mean place, became one joint there",
                anchors.len(),
                100.0 * off
            ));
        }
    } else {
        for (turn, anchor) in turns.iter().zip(&anchors) {
            match groups.last_mut().filter(|(_, place)| (anchor - *place).norm() <= NEAR) {
                Some((group, _)) => group.push(turn),
                None => groups.push((vec![turn], *anchor)),
            }
        }
        notes.push(format!(
            "it rotates about {} places of its parent; a small ball without skin is between each two",
            groups.len()
        ));
    }
    let mut joints = Vec::new();
    for (turns, place) in groups {
        let (joint, note) = Joint::new(&turns, place);
        joints.push(joint);
        notes.extend(note);
    }
    Ok((joints, notes))
}

/// Joins a part of this mass to its parent by these joints. The parts between two of them are balls without skin.
pub(super) fn chain(
    parent: String,
    joints: Vec<Joint>,
    mass: f64,
    part: &mut PartEntry,
    options: &Options,
) -> Result<Vec<PartEntry>, Wrong> {
    let (mut between, mut parent) = (Vec::new(), parent);
    let places: Vec<Column<f64>> = joints.iter().map(|joint| joint.anchor).collect();
    for (at, joint) in joints.into_iter().enumerate() {
        if at + 1 == places.len() {
            joint.write(part, parent);
            break;
        }
        let way = places[at + 1] - places[at];
        let pose = Isometry3::from_parts(Translation3::from(places[at] + way / 2.0), Default::default());
        let ball = Solid::new(Shape::Sphere { radius: (way.norm() / 4.0).clamp(STAND_IN, NEAR) }, pose);
        let ball = Solid { mass: Some(BETWEEN * mass), is_bare: true, ..ball };
        let name = format!("{}/joint-{}", part.name, at + 1);
        let mut ball = ball.part(name.clone(), options.skin)?;
        joint.write(&mut ball, parent);
        between.push(ball);
        parent = name;
    }
    Ok(between)
}

impl Joint {
    /// The joint at `anchor` that lets a part turn in all these ways, and a note if it is another one than they are together.
    fn new(turns: &[&Turn], anchor: Column<f64>) -> (Self, Option<String>) {
        let axes: Vec<Column<f64>> = turns
            .iter()
            .filter_map(|turn| match turn {
                Turn::Hinge { axis, .. } => Some(*axis),
                Turn::Ball { .. } | Turn::Other(_) => None,
            })
            .collect();
        let balls = turns.len() - axes.len();
        let joint = |name, axes: Option<Vec<Column<f64>>>| Self {
            name,
            anchor,
            axes: axes.map(|axes| axes.into_iter().map(rounded).collect()),
        };
        match axes[..] {
            [] if balls == 0 => (joint(JointName::Fixed, None), None),
            [] if balls == 1 => (joint(JointName::Ball, None), None),
            [axis] if balls == 0 => (joint(JointName::Hinge, Some(vec![axis])), None),
            [first, ref others @ ..]
                if balls == 0 && others.iter().all(|axis| first.cross(axis).norm() < SAME_AXIS) =>
            {
                let note = format!("its {} hinges have the same axis and became one hinge", axes.len());
                (joint(JointName::Hinge, Some(vec![first])), Some(note))
            }
            [first, second] if balls == 0 => {
                let cosine = first.dot(&second);
                let note = || {
                    format!(
                        "its two hinges are at {:.1} degrees and became a universal joint, whose second axis was rotated to \
                         a right angle",
                        cosine.acos().to_degrees()
                    )
                };
                let axes = vec![first, (second - first * cosine).normalize()];
                (joint(JointName::Universal, Some(axes)), (cosine.abs() > NOTED).then(note))
            }
            _ => {
                let note = format!("its {} joints at one place became a ball joint", turns.len());
                (joint(JointName::Ball, None), Some(note))
            }
        }
    }

    pub(super) fn write(self, part: &mut PartEntry, parent: String) {
        part.parent = Some(parent);
        part.joint = Some(self.name);
        part.anchor = Some(rounded(self.anchor));
        part.axes = self.axes;
    }
}
