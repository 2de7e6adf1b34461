//! Say what an estimate leaves open, and what recording would tell.

use std::fmt;

use crate::numerics::partition::sizes;
use crate::stages::joints::{Joints, Rival};
use crate::stages::parameters::Parameters;
use crate::stages::rigid_parts::RigidParts;
use crate::stages::tree::Edge;

/// Sensors that a part should have, of which about half feel something at a time (docs/own-data.md). None of 49 calibration recordings whose
/// trees were right had a part of fewer (revision 32a953b).
const ENOUGH_SENSORS: usize = 16;
/// Bootstrap support from which on a joint counts as certain, given the parts.
pub(crate) const SURE: f64 = 0.95;
/// If the only part has a larger mean residual, one rigid motion does not explain it.
const ONE_MOTION: f64 = 0.05;

/// Something that an estimate leaves open; as text, what it is and what recording would tell.
#[derive(Debug, Clone, PartialEq)]
pub enum Doubt {
    /// There is one part, so that there is no joint. Its mean residual, 0 to 1.
    OnePart(f64),
    /// Parts of fewer than 16 sensors.
    SmallParts {
        /// The first of them.
        part: usize,
        /// Its sensors.
        sensors: usize,
        /// How many such parts there are.
        count: usize,
    },
    /// A joint whose bootstrap support is below 95 %.
    Joint {
        /// The parts that it joins.
        joint: Edge,
        /// Its bootstrap support, 0 to 1.
        support: f64,
        /// What other times join most often in its place.
        instead: Option<Rival>,
    },
    /// Three parts or more, rising, any two of which feel one joint.
    OnePlace(Vec<usize>),
    /// Sensors whose next best part leaves little more than their own, or less.
    Sensors {
        /// How many there are.
        count: usize,
        /// How many times as much the next best part leaves at most.
        times: f64,
    },
    /// So many sensors are on their part only because of joints: no motion explains them.
    OnlyByJoints(usize),
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OnePart(residual) => {
                let share = 100.0 * residual;
                write!(
                    f,
                    "no two parts can be distinguished: the residual variance of a single rigid motion is {share:.1} %"
                )?;
                let still = "; no joint seems to move, so record each joint moving by itself";
                f.write_str(if *residual < ONE_MOTION { still } else { "" })
            }
            Self::SmallParts { part, sensors, count } => {
                write!(f, "part {part}")?;
                if *count > 1 {
                    write!(f, ", the first of {count} such parts,")?;
                }
                write!(f, " has {sensors} sensors; {ENOUGH_SENSORS} and more are needed to rely on a part")
            }
            Self::Joint { joint, support, instead } => {
                let Edge { child, parent } = joint;
                // With a decimal, so that it is below the limit.
                write!(f, "joint {child}–{parent} is uncertain (support {:.1} %)", 100.0 * support)?;
                match instead {
                    Some(Rival { part, other, support }) => write!(
                        f,
                        ": it may be {part}–{other} instead ({:.1} %); record longer, with these parts moving against each other",
                        100.0 * support
                    ),
                    None => f.write_str("; record longer"),
                }
            }
            Self::OnePlace(parts) => {
                let names: Vec<String> = parts.iter().map(usize::to_string).collect();
                write!(
                    f,
                    "parts {} feel one joint: if they turn about one place, no recording tells which of them carries the others; if not, \
                     record longer",
                    names.join(", ")
                )
            }
            Self::Sensors { count, times } => write!(
                f,
                "sensors that may be on another part: {count}; the next best one leaves at most {times:.0} times as much"
            ),
            Self::OnlyByJoints(count) => {
                write!(f, "sensors that are on a part only because of its joints (residual 0): {count}")
            }
        }
    }
}

/// What parts and joints leave open.
pub(super) fn doubts(parts: &RigidParts, joints: &Joints, parameters: &Parameters) -> Vec<Doubt> {
    if joints.ranks.len() < 2 {
        let sum: f64 = parts.residuals.iter().sum();
        return vec![Doubt::OnePart(sum / parts.residuals.len().max(1) as f64)];
    }
    let mut found = Vec::new();
    let small: Vec<(usize, usize)> =
        sizes(&parts.labels).into_iter().filter(|(_, sensors)| *sensors < ENOUGH_SENSORS).collect();
    if let Some(&(part, sensors)) = small.first() {
        found.push(Doubt::SmallParts { part, sensors, count: small.len() });
    }
    for (joint, instead) in joints.tree.iter().zip(&joints.rivals) {
        let support = joints.support(joint);
        if support < SURE {
            found.push(Doubt::Joint { joint: *joint, support, instead: *instead });
        }
    }
    found.extend(at_one_place(joints, parameters.min_unexplained).into_iter().map(Doubt::OnePlace));
    let own = parts.residuals.iter().zip(&parts.alternatives);
    let is_open = |(own, others): &(&f64, &Vec<(usize, f64)>)| {
        others.first().is_some_and(|(_, left)| **own > parameters.max_residual_share * left)
    };
    let count = own.filter(is_open).count();
    if count > 0 {
        found.push(Doubt::Sensors { count, times: 1.0 / parameters.max_residual_share });
    }
    let by_joints = parts.residuals.iter().filter(|residual| **residual == 0.0).count();
    if by_joints > 0 {
        found.push(Doubt::OnlyByJoints(by_joints));
    }
    found
}

/// Groups of three parts or more of which any two feel one joint, as if they turned about one place. `unexplained` is the share of a joint's
/// squared speed below which it tells hardly any more.
fn at_one_place(joints: &Joints, unexplained: f64) -> Vec<Vec<usize>> {
    let pairs: Vec<(usize, usize)> = joints
        .pairs
        .iter()
        .filter(|pair| 1.0 - pair.correlation.powi(2) <= unexplained)
        .map(|pair| (pair.part, pair.other))
        .collect();
    let feel_one = |a: usize, b: usize| pairs.contains(&(a.min(b), a.max(b)));
    let mut places: Vec<Vec<usize>> = Vec::new();
    for &(a, b) in &pairs {
        if places.iter().any(|place| place.contains(&a) && place.contains(&b)) {
            continue;
        }
        let mut place = vec![a, b];
        for &part in joints.ranks.keys() {
            if !place.contains(&part) && place.iter().all(|&other| feel_one(part, other)) {
                place.push(part);
            }
        }
        if place.len() > 2 {
            place.sort_unstable();
            places.push(place);
        }
    }
    places
}

#[cfg(test)]
mod tests;
