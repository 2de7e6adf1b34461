//! A movement that motion capture recorded (tests/data/person): its parts and joints are found from what a skin would feel.

use std::path::Path;

use bodyschema::estimate::Verdict;
use bodyschema::files::touch::read_touch;
use bodyschema::recording::Recording;
use bodyschema::stages::evaluate::score;
use bodyschema::stages::sense::Tactile;
use bodyschema::stages::tree::Truth;

use crate::support::estimated::estimated;

/// Bones, and sensors on each.
const BONES: usize = 13;
const SENSORS: usize = 40;
/// Density of the fluid, kg/m³.
const DENSITY: f32 = 1010.0;
/// The bones that carry each other: trunk, head, arms, legs.
const TREE: [(usize, usize); BONES - 1] =
    [(1, 0), (2, 1), (3, 1), (4, 3), (5, 1), (6, 5), (7, 0), (8, 7), (9, 8), (10, 0), (11, 10), (12, 11)];

/// The numbers in a file of the recording, a series for each column.
fn numbers(name: &str) -> Tactile {
    read_touch(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/person").join(name)).unwrap()
}

/// What the sensors feel, read `delay(sensor)` samples later.
fn touch(delay: impl Fn(usize) -> usize) -> Tactile {
    let (motion, skin) = (numbers("motion.npy"), numbers("skin.npy"));
    let motion: Vec<&[f32]> = motion.series().collect();
    let skin: Vec<&[f32]> = skin.series().collect();
    let samples = motion[0].len();
    let pressure = |sensor: usize, t: usize| {
        let vector = |from: usize| [0, 1, 2].map(|axis| motion[from + 3 * (sensor / SENSORS) + axis][t]);
        let ([x, y, z], [i, j, k]) = (vector(0), vector(3 * BONES));
        let [a, b, c, n @ ..] = [0, 1, 2, 3, 4, 5].map(|column| skin[column][sensor]);
        // v + ω × l, along n.
        let speed = (x + j * c - k * b) * n[0] + (y + k * a - i * c) * n[1] + (z + i * b - j * a) * n[2];
        DENSITY * speed.max(0.0).powi(2)
    };
    let series = |sensor: usize| {
        let delay = delay(sensor);
        (0..samples).map(move |t| (sensor, (t + delay) % samples)).collect::<Vec<_>>()
    };
    let places = (0..BONES * SENSORS).flat_map(series);
    Tactile { samples, pressures: places.map(|(sensor, t)| pressure(sensor, t)).collect() }
}

/// Every `step`-th sensor.
fn one_in(step: usize, Tactile { samples, pressures }: Tactile) -> Tactile {
    Tactile { samples, pressures: pressures.chunks(samples).step_by(step).flatten().copied().collect() }
}

#[test]
fn bones_and_joints_of_a_recorded_person_are_found() {
    // Half of the sensors, 20 on each bone, take half the time.
    let found = estimated(&Recording::new(one_in(2, touch(|_| 0))));
    let labels = (0..BONES * SENSORS).step_by(2).map(|sensor| sensor / SENSORS).collect();
    let truth = Truth::new(labels, TREE.to_vec());
    assert_eq!(found.fit.verdict, Verdict::Good);
    let (labels, tree) = (&found.parts.labels, &found.joints.tree);
    let score = score(labels, tree, &truth, 1.0);
    assert!(score.ari == 1.0 && score.tree_correct, "{score:?}");
}

#[test]
fn sensors_that_are_not_read_at_the_same_time_do_not_fit() {
    // A fourth of the sensors is enough to tell, and takes much less time.
    let found = estimated(&Recording::new(one_in(4, touch(|sensor| 7 * sensor))));
    assert_eq!(found.fit.verdict, Verdict::DoesNotFit, "{}", found.fit);
}
