//! Attach the parts of a body to the joints that turn them, by their names.

use nalgebra::Vector3 as Column;

use super::skeleton::RecordedMovement;
use crate::numerics::range::is_moderate;
use crate::stages::agent::Agent;

/// Share of the size of a body by which its joints may be elsewhere than in the recording.
const FIT: f64 = 0.005;

/// Parts of a body and the joints that move them.
#[derive(Debug, Clone, PartialEq)]
pub struct Attached {
    /// The joint of each part.
    pub(super) joints: Vec<usize>,
    /// Where that joint is in the rest pose of the body, m.
    pub(super) rest: Vec<Column<f64>>,
    /// Length of a unit of the recording, m.
    pub(super) scale: f64,
}

/// Why a body cannot be moved as a skeleton was.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Misfit {
    /// A part has no joint.
    #[error("its part `{0}` is not named after a joint of the recording")]
    NoJoint(String),
    /// A joint is not where it should be.
    #[error(
        "the joint of its part `{part}` is {distance:.3} m from where the recording has it: the skeletons or their units differ"
    )]
    Elsewhere {
        /// The part.
        part: String,
        /// How far the joint is from its place, m.
        distance: f64,
    },
    /// All joints are at one place, so that nothing says how long a unit is.
    #[error("its joints do not say how long a unit of the recording is")]
    NoScale,
}

impl Attached {
    /// Attaches each part to the joint that has its name, or that has it but for a number: `Hips/2` to `Hips`.
    ///
    /// The first part's joint is the origin of the body, and all places are those of the recording times `scale`, m. Without a
    /// scale, it is what the places of the body's joints say.
    ///
    /// # Errors
    /// If a part has no joint, or a joint is elsewhere in the recording.
    pub fn new(
        agent: &Agent,
        names: &[String],
        movement: &RecordedMovement,
        scale: Option<f64>,
    ) -> Result<Self, Misfit> {
        let joint = |name: &String| joint(movement, name).ok_or_else(|| Misfit::NoJoint(name.clone()));
        let joints = names.iter().map(joint).collect::<Result<Vec<usize>, _>>()?;
        let rest = movement.rest();
        let units = |part: usize| rest[joints[part]] - rest[joints[0]];
        let anchors = || agent.joints.iter().map(|joint| (joint.child, Column::from(joint.anchor)));
        let scale = match scale {
            Some(scale) => Some(scale),
            None => {
                let (along, square) = anchors().fold((0.0, 0.0), |(along, square), (part, anchor)| {
                    (along + units(part).dot(&anchor), square + units(part).norm_squared())
                });
                Some(along / square)
            }
        };
        let scale = scale.filter(|scale| is_moderate(*scale)).ok_or(Misfit::NoScale)?;
        let size = anchors().map(|(_, anchor)| anchor.norm()).fold(0.0, f64::max);
        let distances = anchors().map(|(part, anchor)| (part, (anchor - scale * units(part)).norm()));
        let farthest = distances.reduce(|most, next| if next.1 > most.1 { next } else { most });
        if let Some((part, distance)) = farthest.filter(|(_, distance)| *distance > FIT * size) {
            return Err(Misfit::Elsewhere { part: names[part].clone(), distance });
        }
        let rest = (0..names.len()).map(|part| scale * units(part)).collect();
        Ok(Self { joints, rest, scale })
    }

    /// Length of a unit of the recording, m.
    pub fn scale(&self) -> f64 {
        self.scale
    }
}

/// The joint that a part is named after.
fn joint(movement: &RecordedMovement, name: &str) -> Option<usize> {
    let named = |name: &str| movement.joints().iter().position(|joint| joint.name == name);
    named(name).or_else(|| {
        let (name, number) = name.rsplit_once('/')?;
        number.parse::<u32>().ok().and_then(|_| named(name))
    })
}
