//! Test which unit is guessed.

use super::*;
use crate::stages::simulate::recorded::{Channel, RecordedJoint};

#[test]
fn the_longest_way_goes_over_a_fork_and_ends_at_what_travels() {
    let joint = |parent, offset: f64, channel, ends: &[f64]| RecordedJoint {
        name: String::new(),
        parent,
        offset: [0.0, offset, 0.0],
        channels: vec![channel],
        ends: ends.iter().map(|end| [*end, 0.0, 0.0]).collect(),
    };
    let (turn, place) = (Channel::Rotation(0), Channel::Position(1));
    let joints = vec![
        joint(None, 50.0, place, &[]),
        joint(Some(0), 3.0, turn, &[4.0, 1.0]),
        joint(Some(0), 2.0, turn, &[]),
        joint(Some(2), -8.0, turn, &[1.0]),
        joint(Some(1), 100.0, place, &[30.0]),
    ];
    let movement =
        RecordedMovement::new(joints, 1.0, vec![0.0, 0.0, 0.0, 0.0, 100.0, 9.0, 0.0, 0.0, 0.0, 300.0]);
    // From the end of 4 over the root to that of 1.
    assert_eq!(longest_way(&movement), 30.0_f64.max(4.0 + 3.0 + 2.0 + 8.0 + 1.0));
}

#[test]
fn a_person_is_told_in_every_unit_and_an_animal_stays_near_its_size() {
    for (way, scale) in [
        (2.2, 1.0),
        (1.7, 1.0),
        (6.1, 1.0),
        (39.1, 0.0254 / 0.45),
        (41.6, 0.0254 / 0.45),
        (94.0, 0.0254),
        (261.0, 0.01),
        (2400.0, 0.001),
    ] {
        assert!((unit(way).0 - scale).abs() < 1e-12, "{way}: {:?}", unit(way));
    }
    assert_eq!(unit(0.0), UNITS[0]);
}
