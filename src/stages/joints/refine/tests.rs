//! Test how joints refine the parts.

use std::f64::consts::PI;

use rand::RngExt;

use super::super::fixtures::row;
use super::*;
use crate::numerics::rng::stream;
use crate::stages::rigid_parts::fixtures::sensor_series;

/// T, the samples of planar parts.
const SAMPLES: usize = 4000;

/// Two parts of sensors that feel four components of their own, and more single sensors than are tried on parts.
fn many_singles() -> (Tactile, RigidParts) {
    let (samples, singles) = (400, MAX_CLUSTERS + 5);
    let mut rng = stream(1, 1, "refine", 0);
    let mut uniform =
        |count: usize| -> Vec<f64> { (0..count).map(|_| rng.random_range(-1.0..1.0)).collect() };
    let mut pressures = Vec::new();
    for _ in 0..2 {
        let w = uniform(4 * samples);
        uniform(4 * 30).chunks(4).for_each(|c| pressures.extend(sensor_series(&w, c)));
    }
    pressures.extend(uniform(singles * samples).into_iter().map(|value| value.max(0.0) as f32));
    let labels: Vec<usize> = (0..60).map(|at| at / 30).chain(2..2 + singles).collect();
    let others = |at: usize| if at.is_multiple_of(2) { vec![(1, 0.5)] } else { Vec::new() };
    let parts = RigidParts {
        residuals: vec![0.0; labels.len()],
        alternatives: (0..labels.len()).map(others).collect(),
        unassigned: (2..2 + singles).collect(),
        motions: BTreeMap::new(),
        labels,
    };
    (Tactile { samples, pressures }, parts)
}

#[test]
fn every_sensor_is_on_a_part_of_the_tree() {
    let (tactile, parts) = many_singles();
    let (refined, joints) =
        refine(&tactile, false, parts.clone(), &Parameters::default(), &mut stream(1, 1, "co-motion", 0));
    assert_eq!(joints.ranks.keys().copied().collect::<Vec<_>>(), [0, 1]);
    assert!(refined.labels.iter().all(|label| *label < 2) && refined.unassigned.is_empty());
    assert_eq!(refined.labels[..60], parts.labels[..60]);
    assert!(refined.alternatives.iter().flatten().all(|(part, residual)| *part < 2 && residual.is_finite()));
}

/// Parts of 20 sensors each that feel these motions, and a small one of sensors with these loadings of another.
fn with_small_part(
    motions: &[&MotionSubspace],
    small: &MotionSubspace,
    loadings: &[Vec<f64>],
) -> (Tactile, RigidParts) {
    let mut rng = stream(2, 1, "refine", 0);
    let mut pressures = Vec::new();
    for motion in motions {
        for _ in 0..20 {
            let c: Vec<f64> = (0..motion.rank).map(|_| rng.random_range(-1.0..1.0)).collect();
            pressures.extend(sensor_series(&motion.basis, &c));
        }
    }
    loadings.iter().for_each(|c| pressures.extend(sensor_series(&small.basis, c)));
    let labels: Vec<usize> = (0..20 * motions.len() + loadings.len()).map(|sensor| sensor / 20).collect();
    let (residuals, alternatives) = (vec![0.0; labels.len()], vec![vec![(0, 0.5)]; labels.len()]);
    (
        Tactile { samples: SAMPLES, pressures },
        RigidParts { labels, residuals, alternatives, unassigned: Vec::new(), motions: BTreeMap::new() },
    )
}

/// Three planar parts in a row of 20 sensors on their sides, and a fourth of six, with loadings `c` of the motion of the last
/// part and of the ends of the middle one.
fn small_part(c: impl Fn(usize) -> [f64; 3]) -> (Tactile, RigidParts) {
    let (sides, ends) = row(4, SAMPLES);
    let loadings: Vec<Vec<f64>> = (0..6).map(|sensor| c(sensor).to_vec()).collect();
    with_small_part(&sides[..3].iter().collect::<Vec<_>>(), &sides[3].with(&ends[1]), &loadings)
}

#[test]
fn a_small_cluster_is_a_part_unless_the_joints_need_it_elsewhere() {
    let refined = |(tactile, parts): (Tactile, RigidParts)| {
        refine(&tactile, false, parts, &Parameters::default(), &mut stream(1, 1, "co-motion", 0)).0.labels
    };
    let sign = |sensor: usize| if sensor.is_multiple_of(2) { 1.0 } else { -1.0 };
    let foot = refined(small_part(|sensor| [sign(sensor), sensor as f64 / 6.0 - 0.4, 0.0]));
    assert_eq!(foot[60..], [3; 6]);
    let ends = refined(small_part(|sensor| [0.0, 0.0, sign(sensor)]));
    assert_eq!(ends[60..], [1; 6]);
}

#[test]
fn what_a_part_feels_only_together_comes_to_it_as_a_whole() {
    let (sides, ends) = row(3, SAMPLES);
    // The outer parts are whole. The middle one has its ends in one cluster, and its sides in a small one, of which no two sensors feel the
    // same.
    let [first, last] = [0, 2].map(|part| sides[part].with(&ends[part]));
    let loadings: Vec<Vec<f64>> =
        (0..6).map(|sensor| (f64::from(sensor) * PI / 3.0).sin_cos()).map(|(a, b)| vec![a, b]).collect();
    let (tactile, parts) = with_small_part(&[&first, &ends[1], &last], &sides[1], &loadings);
    let (refined, _) =
        refine(&tactile, false, parts, &Parameters::default(), &mut stream(1, 1, "co-motion", 0));
    assert_eq!(refined.labels[60..], [1; 6]);
}

#[test]
fn pieces_of_several_parts_come_to_their_own() {
    let (sides, ends) = row(4, SAMPLES);
    let loadings: Vec<Vec<f64>> =
        [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]].map(|c| c.to_vec()).to_vec();
    let both = ends[1].with(&ends[2]);
    let (tactile, parts) = with_small_part(&sides.iter().collect::<Vec<_>>(), &both, &loadings);
    let (refined, _) =
        refine(&tactile, false, parts, &Parameters::default(), &mut stream(1, 1, "co-motion", 0));
    assert_eq!(refined.labels[80..], [1, 2, 1, 2]);
}

#[test]
fn a_sensor_whose_next_part_is_spurious_is_assigned_to_the_one_after() {
    let sign = |sensor: usize| if sensor.is_multiple_of(2) { 1.0 } else { -1.0 };
    let (mut tactile, mut parts) = small_part(|sensor| [0.0, 0.0, sign(sensor)]);
    // An unassigned sensor that feels something at a single sample: no joint needs it.
    tactile.pressures.extend((0..tactile.samples).map(|t| f32::from(t == 7)));
    parts.labels.push(4);
    parts.residuals.push(0.0);
    parts.alternatives.push(vec![(3, 0.1), (2, 0.12), (0, 0.9)]);
    parts.unassigned.push(4);
    let (refined, _) =
        refine(&tactile, false, parts, &Parameters::default(), &mut stream(1, 1, "co-motion", 0));
    assert_eq!((refined.labels[60..].to_vec(), refined.residuals[66]), (vec![1, 1, 1, 1, 1, 1, 2], 0.12));
}

#[test]
fn unassigned_clusters_alone_are_parts() {
    let (tactile, mut parts) = many_singles();
    parts.unassigned = (0..=*parts.labels.iter().max().unwrap()).collect();
    let (refined, joints) =
        refine(&tactile, false, parts, &Parameters::default(), &mut stream(1, 1, "co-motion", 0));
    assert_eq!(joints.tree.len() + 1, joints.ranks.len());
    assert!(refined.labels.iter().all(|label| joints.ranks.contains_key(label)));
}
