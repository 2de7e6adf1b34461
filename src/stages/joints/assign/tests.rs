//! Test that joints assign what they need, and nothing else.

use rand::RngExt;

use super::super::fixtures::row;
use super::*;
use crate::numerics::rng::stream;

#[test]
fn ends_are_on_the_part_whose_joints_need_them() {
    let (parts, ends) = row(3, 4000);
    assert_eq!(assign(&parts, &ends, &[], 4000, &Parameters::default()).0, [Some(0), Some(1), Some(2)]);
    // In two halves, of which one rests while the other feels.
    let half = |end: &MotionSubspace, sign: f64| MotionSubspace {
        rank: 1,
        basis: end.basis.iter().map(|value| (sign * value).max(0.0)).collect(),
    };
    let halves: Vec<MotionSubspace> = ends.iter().flat_map(|end| [half(end, 1.0), half(end, -1.0)]).collect();
    let pairs = [(0, 1), (2, 3), (4, 5)];
    let found: Vec<_> = [0, 0, 1, 1, 2, 2].map(Some).to_vec();
    assert_eq!(assign(&parts, &halves, &pairs, 4000, &Parameters::default()).0, found);
}

#[test]
fn what_no_joint_needs_stays_unassigned() {
    let (parts, ends) = row(3, 4000);
    let parts: Vec<MotionSubspace> = parts.iter().zip(&ends).map(|(part, end)| part.with(end)).collect();
    let mut rng = stream(1, 1, "assign", 1);
    let other = MotionSubspace { rank: 1, basis: (0..4000).map(|_| rng.random_range(-1.0..1.0)).collect() };
    assert_eq!(assign(&parts, std::slice::from_ref(&other), &[], 4000, &Parameters::default()).0, [None]);
    assert_eq!(assign(&parts[..1], &[other], &[], 4000, &Parameters::default()).0, [None]);
    assert_eq!(assign(&parts, &[], &[], 4000, &Parameters::default()).0, []);
}
