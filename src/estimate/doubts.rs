//! Say what an estimate leaves open, and what recording would tell.

use std::fmt;

use crate::numerics::partition::sizes;
use crate::stages::joints::{Joints, Pair};
use crate::stages::parameters::Parameters;
use crate::stages::rigid_parts::RigidParts;
use crate::stages::tree::Edge;

/// Sensors that a part should have, of which about half feel something at a time (docs/own-data.md). Of 49 calibration recordings whose trees
/// were right, none had a part of fewer.
pub(super) const ENOUGH_SENSORS: usize = 16;
/// Bootstrap support from which on a joint counts as certain, given the parts.
pub const SURE: f64 = 0.95;
/// Residual of the only part above which it is none: one motion does not explain all sensors.
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
        /// The two parts that other times join most often in its place, and how often, 0 to 1.
        instead: Option<(usize, usize, f64)>,
    },
    /// Three parts or more, rising, any two of which feel one joint speed.
    OnePlace(Vec<usize>),
    /// So many sensors that their next best part explains nearly as well as their own.
    Sensors(usize),
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
                write!(f, "joint {child}–{parent} is uncertain (support {:.0} %)", 100.0 * support)?;
                match instead {
                    Some((part, other, support)) => write!(
                        f,
                        ": it may be {part}–{other} instead ({:.0} %); record longer, with these parts moving against each other",
                        100.0 * support
                    ),
                    None => f.write_str("; record longer"),
                }
            }
            Self::OnePlace(parts) => {
                let names: Vec<String> = parts.iter().map(usize::to_string).collect();
                write!(
                    f,
                    "parts {} feel one joint: if they turn about one place, no recording tells which of them carries the others",
                    names.join(", ")
                )
            }
            Self::Sensors(count) => {
                let whose = if *count == 1 { "sensor that its" } else { "sensors that their" };
                write!(f, "{count} {whose} next best part explains nearly as well: their part is uncertain")
            }
        }
    }
}

/// What parts and joints leave open.
pub(super) fn doubts(parts: &RigidParts, joints: &Joints, parameters: &Parameters) -> Vec<Doubt> {
    let mut found = Vec::new();
    if joints.ranks.len() < 2 {
        let sum: f64 = parts.residuals.iter().sum();
        return vec![Doubt::OnePart(sum / parts.residuals.len().max(1) as f64)];
    }
    let small: Vec<(usize, usize)> =
        sizes(&parts.labels).into_iter().filter(|(_, sensors)| *sensors < ENOUGH_SENSORS).collect();
    if let Some(&(part, sensors)) = small.first() {
        found.push(Doubt::SmallParts { part, sensors, count: small.len() });
    }
    for joint in &joints.tree {
        let support = joints.support(joint);
        if support < SURE {
            found.push(Doubt::Joint { joint: *joint, support, instead: instead(joints, joint) });
        }
    }
    found.extend(at_one_place(joints, parameters.min_unexplained).into_iter().map(Doubt::OnePlace));
    let is_open = |at: &usize| {
        let next = parts.alternatives[*at].first();
        next.is_some_and(|(_, left)| parts.residuals[*at] > parameters.max_residual_share * left)
    };
    let open = (0..parts.labels.len()).filter(is_open).count();
    if open > 0 {
        found.push(Doubt::Sensors(open));
    }
    found
}

/// The two parts that other times join most often in the place of a joint, if any do.
fn instead(joints: &Joints, joint: &Edge) -> Option<(usize, usize, f64)> {
    let others: Vec<Edge> = joints.tree.iter().copied().filter(|edge| edge != joint).collect();
    let side = reached(&others, joint.child);
    let crosses = |pair: &&Pair| !pair.in_tree && side.contains(&pair.part) != side.contains(&pair.other);
    let best = joints.pairs.iter().filter(crosses).max_by(|a, b| a.support.total_cmp(&b.support))?;
    (best.support > 0.0).then_some((best.part, best.other, best.support))
}

/// The parts that some joints connect with this one, itself included.
fn reached(joints: &[Edge], part: usize) -> Vec<usize> {
    let mut found = vec![part];
    let mut at = 0;
    while let Some(&own) = found.get(at) {
        for &Edge { child, parent } in joints {
            let next = if child == own { parent } else { child };
            if [child, parent].contains(&own) && !found.contains(&next) {
                found.push(next);
            }
        }
        at += 1;
    }
    found
}

/// Parts that feel one joint although the tree does not join any two of them: of two such parts, and the one between them. `unexplained` is
/// the share of a joint's squared speed below which it tells hardly any more.
fn at_one_place(joints: &Joints, unexplained: f64) -> Vec<Vec<usize>> {
    let feel_one = |pair: &Pair| 1.0 - pair.correlation.powi(2) <= unexplained;
    let joined = |a: usize, b: usize| {
        joints
            .pairs
            .iter()
            .any(|pair| pair.in_tree && feel_one(pair) && [(a, b), (b, a)].contains(&(pair.part, pair.other)))
    };
    let mut places: Vec<Vec<usize>> = Vec::new();
    for pair in joints.pairs.iter().filter(|pair| !pair.in_tree && feel_one(pair)) {
        let between = joints.ranks.keys().find(|&&part| joined(part, pair.part) && joined(part, pair.other));
        let Some(&between) = between else { continue };
        let mut place = vec![between, pair.part, pair.other];
        // Two places that have two parts in common are one.
        places.retain(|other| {
            let is_one = other.iter().filter(|part| place.contains(part)).count() > 1;
            place.extend(other.iter().filter(|_| is_one));
            !is_one
        });
        place.sort_unstable();
        place.dedup();
        places.push(place);
    }
    places
}

#[cfg(test)]
mod tests;
