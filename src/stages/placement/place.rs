//! Place all parts and joints of an estimated tree, by the sites of the sensors.

use std::collections::BTreeMap;

use nalgebra::{Rotation3, Vector3};
use rayon::prelude::*;

use super::boxes::OrientedBox;
use super::joint::{Best, JointPlace, Pair};
use super::motion::Motion;
use crate::numerics::partition::sizes;
use crate::stages::agent::Site;
use crate::stages::rigid_parts::{Roots, stratified};
use crate::stages::sense::Tactile;
use crate::stages::tree::Edge;

/// Samples that places are computed from, spread over all.
const MAX_SAMPLES: usize = 5000;
/// Mismatch of the two speeds up to which a place is known. It is below 0.002 where sensors feel the whole motion, and above 0.03 at
/// the joints of cylinders without sensors on their ends, which feel no motion along their axis.
const MAX_MISMATCH: f64 = 0.01;

/// Where a part is, and how well the given sites explain what it feels.
#[derive(Debug, Clone, PartialEq)]
pub struct PartPlace {
    /// Its label.
    pub part: usize,
    /// The frame of most of its sensors: [`Site::part`].
    pub frame: usize,
    /// Its sensors in that frame.
    pub sensors: Vec<usize>,
    /// Its sensors in other frames, which are left out.
    pub left_out: Vec<usize>,
    /// A box around its sensors.
    pub solid: OrientedBox,
    /// How many of the six directions of motion its sensors feel.
    pub rank: usize,
    /// The share of what its sensors feel that a rigid motion of the given sites explains, at most 1.
    pub explained: f64,
}

/// Where parts and joints are.
#[derive(Debug, Clone, PartialEq)]
pub struct Placement {
    /// The parts, by label.
    pub parts: Vec<PartPlace>,
    /// The joints, as in the tree.
    pub joints: Vec<JointPlace>,
}

/// Places parts and joints. In: M × T pressures, of any sign, the part of each of the M sensors, the tree over the parts, and the site
/// of each sensor: sites with the same `part` are in one frame, which moves with the body.
pub fn place(tactile: &Tactile, signed: bool, labels: &[usize], tree: &[Edge], sites: &[Site]) -> Placement {
    let series: Vec<&[f32]> = tactile.series().collect();
    let samples: Vec<usize> = stratified(tactile.samples, MAX_SAMPLES).collect();
    let mut members: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    labels.iter().enumerate().for_each(|(sensor, part)| members.entry(*part).or_default().push(sensor));
    let placed = |(part, sensors): (usize, Vec<usize>)| {
        let frames: Vec<usize> = sensors.iter().map(|sensor| sites[*sensor].part).collect();
        // Of several that are as common, the smallest.
        let most_common = sizes(&frames).into_iter().rev().max_by_key(|(_, count)| *count);
        let frame = most_common.expect("a part has sensors").0;
        let (sensors, left_out): (Vec<usize>, Vec<usize>) =
            sensors.into_iter().partition(|sensor| sites[*sensor].part == frame);
        let own: Vec<&Site> = sensors.iter().map(|sensor| &sites[*sensor]).collect();
        let felt: Vec<&[f32]> = sensors.iter().map(|sensor| series[*sensor]).collect();
        let motion = Motion::new(&own, &Roots::at(&felt, &samples, signed));
        let points: Vec<Vector3<f64>> = own.iter().map(|site| Vector3::from(site.position)).collect();
        let solid = OrientedBox::around(&points);
        let (rank, explained) = (motion.rank, motion.explained);
        (PartPlace { part, frame, sensors, left_out, solid, rank, explained }, motion)
    };
    let (parts, motions): (Vec<PartPlace>, Vec<Motion>) =
        members.into_iter().collect::<Vec<_>>().into_par_iter().map(placed).unzip();
    let find = |label: usize| {
        parts.binary_search_by_key(&label, |own| own.part).expect("a part of the tree has sensors")
    };
    let joint = |edge: &Edge| {
        let (parent, child) = (find(edge.parent), find(edge.child));
        joint([&parts[parent], &parts[child]], [&motions[parent], &motions[child]], sites)
    };
    let joints = tree.par_iter().map(joint).collect();
    Placement { parts, joints }
}

/// The joint between a parent and a child.
fn joint([parent, child]: [&PartPlace; 2], motions: [&Motion; 2], sites: &[Site]) -> JointPlace {
    let shares_frame = parent.frame == child.frame;
    let starts: Vec<[Vector3<f64>; 2]> = if shares_frame {
        let near = between(parent, child, sites);
        let others = parent.solid.points().chain(child.solid.points());
        std::iter::once(near).chain(others).map(|place| [place, place]).collect()
    } else {
        let of_child: Vec<Vector3<f64>> = child.solid.points().collect();
        let pairs = |place| of_child.iter().map(move |other| [place, *other]);
        parent.solid.points().flat_map(pairs).collect()
    };
    let pair = Pair::new(motions, shares_frame);
    let best = pair.as_ref().map(|pair| pair.place(&starts));
    let reach = f64::max(motions[0].radius, motions[1].radius);
    // Along the axis of a hinge, or where a motion is not felt, both speeds may agree best far outside of both parts.
    let is_near = |best: &Best| {
        [parent, child].iter().zip(&best.place).all(|(part, at)| part.solid.distance(at) <= reach)
    };
    let known = best.as_ref().filter(|best| best.mismatch <= MAX_MISMATCH && is_near(best));
    let place = known.map_or(starts[0], |best| best.place);
    let rotation = match &pair {
        Some(pair) if !shares_frame => pair.rotation(&place),
        _ => Rotation3::identity(),
    };
    let [in_parent, in_child] = place;
    JointPlace {
        child: child.part,
        parent: parent.part,
        in_parent,
        in_child,
        rotation,
        standard_error: known.map(|best| best.standard_error),
        mismatch: best.as_ref().map(|best| best.mismatch),
    }
}

/// The middle between the two sensors of both parts that are nearest to each other.
fn between(parent: &PartPlace, child: &PartPlace, sites: &[Site]) -> Vector3<f64> {
    let position = |sensor: usize| Vector3::from(sites[sensor].position);
    let pairs =
        parent.sensors.iter().flat_map(|a| child.sensors.iter().map(move |b| [position(*a), position(*b)]));
    let nearest = pairs.min_by(|[a, b], [c, d]| (a - b).norm_squared().total_cmp(&(c - d).norm_squared()));
    nearest.map_or_else(Vector3::zeros, |[a, b]| (a + b) / 2.0)
}

#[cfg(test)]
mod tests;
