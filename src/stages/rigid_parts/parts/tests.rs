//! Test that parts are recovered from touch.

use rand::RngExt;

use super::super::fixtures::sensor_series;
use super::*;
use crate::numerics::partition::adjusted_rand_index;
use crate::numerics::rng::stream;
use crate::stages::agent::{Agent, Skin};
use crate::stages::sense::{Sense, sense};
use crate::stages::simulate::fixtures::{INTERVAL, Scene};
use crate::stages::simulate::{Controller, simulate};

fn tactile() -> (Tactile, Vec<usize>) {
    let mut scene = Scene::new();
    (scene.motion.coordination, scene.physics.duration) = (0.5, 1000.0);
    // A movement that is resolved: the joints of the scene's strong gains turn more than once in a step.
    (scene.motion.controller, scene.motion.servo_gain) = (Controller::Servo, 0.3);
    scene.physics.fluid_density = 1010.0;
    let agent = Agent::new(&scene.geometry, &Skin { around: 8, along: 4, caps: 0 });
    let rng = &mut stream(3, 1, "motion", 0);
    let trajectory = simulate(&agent, &scene.motion, &scene.physics, INTERVAL, rng, &|| ()).unwrap();
    (
        sense(&agent, &trajectory, &Sense { interval: INTERVAL, fluid_density: 1010.0, threshold: 0.0 }),
        agent.labels(),
    )
}

#[test]
fn parts_and_their_number_are_recovered() {
    let (tactile, truth) = tactile();
    let all: Vec<usize> = (0..truth.len()).collect();
    let found = rigid_parts(&tactile, false, &all, &Parameters::default());
    assert_eq!(found.labels, truth);
    assert!(found.residuals.iter().all(|residual| *residual < 0.01));
    for ((label, residual), others) in found.labels.iter().zip(&found.residuals).zip(&found.alternatives) {
        assert!(others[0].1 > *residual && others.is_sorted_by(|one, other| one.1 <= other.1));
        let mut parts: Vec<usize> = others.iter().map(|other| other.0).chain([*label]).collect();
        parts.sort_unstable();
        assert!(parts.into_iter().eq(0..=*truth.iter().max().unwrap()));
    }
    assert_eq!(found.motions.len(), 5);
}

#[test]
fn other_sensors_go_to_the_part_that_explains_them() {
    let (tactile, truth) = tactile();
    let some: Vec<usize> = (0..truth.len()).filter(|sensor| sensor % 3 != 0).collect();
    let found = rigid_parts(&tactile, false, &some, &Parameters::default());
    assert!(adjusted_rand_index(&found.labels, &truth) > 0.99);
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let (tactile, _) = tactile();
    let some: Vec<usize> = (0..tactile.sensors()).step_by(2).collect();
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| rigid_parts(&tactile, false, &some, &Parameters::default()))
    };
    assert_eq!(on(1), on(3));
}

#[test]
fn what_no_motion_explains_is_one_part() {
    let mut rng = stream(5, 1, "rigid", 0);
    let pressures = (0..40 * 500).map(|_| rng.random_range(-1.0_f32..1.0).max(0.0)).collect();
    let found = rigid_parts(
        &Tactile { samples: 500, pressures },
        false,
        &(0..40).collect::<Vec<usize>>(),
        &Parameters::default(),
    );
    assert_eq!(found.labels, [0; 40]);
    assert!(found.residuals.iter().sum::<f64>() > 40.0 * 0.1, "{:?}", found.residuals);
}

#[test]
fn the_union_of_two_parts_has_a_longer_description_than_both() {
    let (tactile, truth) = tactile();
    let every: Vec<usize> = (0..truth.len()).collect();
    let mut felt = Prepared::new(&tactile, false, &every, &Parameters::default()).search(&every).felt;
    felt.tolerance = 3e-4;
    let own = |parts: &[usize]| {
        (0..truth.len()).filter(|sensor| parts.contains(&truth[*sensor])).collect::<Vec<_>>()
    };
    let length = |sensors: &[usize]| Cluster::new(&felt, sensors.to_vec()).description_length;
    assert!(length(&own(&[1, 2])) > length(&own(&[1])) + length(&own(&[2])) + 1.0);
    // The halves of one part have a longer description than the whole.
    let (first, second): (Vec<usize>, Vec<usize>) = own(&[2]).into_iter().partition(|sensor| sensor % 2 == 0);
    assert!(length(&own(&[2])) + 1.0 < length(&first) + length(&second));
}

#[test]
fn a_large_face_joins_the_part_that_it_shares_components_with() {
    // Sides of two cylinders that feel four components of their motion each; and both ends of the first, as many sensors, that
    // feel two of these and one of their own.
    const SAMPLES: usize = 600;
    let mut rng = stream(4, 1, "rigid", 0);
    let mut uniform =
        |count: usize| -> Vec<f64> { (0..count).map(|_| rng.random_range(-1.0..1.0)).collect() };
    let motions = [uniform(5 * SAMPLES), uniform(5 * SAMPLES)];
    let sensor = |sensor: usize| {
        let [a, b, c, d] = [0; 4].map(|_| uniform(1)[0]);
        let end = if sensor.is_multiple_of(2) { 1.0 } else { -1.0 };
        let c =
            if (40..80).contains(&sensor) { [0.0, 0.0, 0.4 * c, 0.4 * d, end] } else { [a, b, c, d, 0.0] };
        sensor_series(&motions[sensor / 80], &c).collect::<Vec<f32>>()
    };
    let series: Vec<Vec<f32>> = (0..120).map(sensor).collect();
    let pressures = series.concat();
    let found = rigid_parts(
        &Tactile { samples: SAMPLES, pressures },
        false,
        &(0..120).collect::<Vec<usize>>(),
        &Parameters::default(),
    );
    assert_eq!(found.labels, (0..120).map(|sensor| sensor / 80).collect::<Vec<usize>>());
    assert!(found.unassigned.is_empty());
}

#[test]
fn a_sensor_that_feels_something_at_few_samples_makes_no_part() {
    let (Tactile { samples, pressures }, truth) = tactile();
    let mut rng = stream(7, 1, "few", 0);
    // Of the first part, but felt at three samples only.
    let few: Vec<f32> = (0..8)
        .flat_map(|_| {
            let mut series = vec![0.0; samples];
            let first = rng.random_range(0..samples - 3);
            series[first..first + 3].copy_from_slice(&pressures[first..first + 3]);
            series[first] += 1.0;
            series
        })
        .collect();
    let tactile = Tactile { samples, pressures: [pressures, few].concat() };
    let found =
        rigid_parts(&tactile, false, &(0..tactile.sensors()).collect::<Vec<_>>(), &Parameters::default());
    assert_eq!(found.labels[..truth.len()], truth);
    assert_eq!((found.motions.len(), &found.unassigned[..]), (5, &[][..]));
}
