//! Test that parts are recovered from touch.

use rand::RngExt;

use super::super::cluster::Cluster;
use super::super::fixtures::sensor_series;
use super::super::search::MIN_SAVING;
use super::*;
use crate::numerics::partition::adjusted_rand_index;
use crate::numerics::rng::stream;
use crate::stages::agent::{Agent, Skin};
use crate::stages::distance::information_metric;
use crate::stages::quantise::{Quantise, Scheme, quantise};
use crate::stages::sense::{Sense, sense};
use crate::stages::simulate::fixtures::{INTERVAL, Scene};
use crate::stages::simulate::simulate;

fn tactile() -> (Tactile, Vec<usize>) {
    let mut scene = Scene::new();
    (scene.motion.coordination, scene.physics.duration) = (0.5, 1000.0);
    let agent = Agent::new(&scene.geometry, &Skin { around: 8, along: 4, caps: 0 });
    let rng = &mut stream(3, 1, "motion", 0);
    let trajectory = simulate(&agent, &scene.motion, &scene.physics, INTERVAL, rng, &|| ()).unwrap();
    (
        sense(&agent, &trajectory, &Sense { interval: INTERVAL, fluid_density: 1010.0, threshold: 0.0 }),
        agent.labels(),
    )
}

fn distances(tactile: &Tactile) -> Distances {
    information_metric(&quantise(tactile, &Quantise { levels: 8, scheme: Scheme::PerSensor }))
}

#[test]
fn parts_and_their_number_are_recovered_from_seed_clusters() {
    let (tactile, truth) = tactile();
    let all: Vec<usize> = (0..truth.len()).collect();
    let found = rigid_parts(&tactile, &all, &distances(&tactile));
    assert_eq!(found.labels, truth);
    assert!(found.residuals.iter().all(|residual| *residual < 0.1));
    for ((label, residual), others) in found.labels.iter().zip(&found.residuals).zip(&found.alternatives) {
        assert!(others[0].1 > *residual && others.is_sorted_by(|one, other| one.1 <= other.1));
        let mut parts: Vec<usize> = others.iter().map(|other| other.0).chain([*label]).collect();
        parts.sort_unstable();
        assert!(parts.into_iter().eq(0..=*truth.iter().max().unwrap()));
    }
}

#[test]
fn sensors_without_distances_go_to_the_part_that_explains_them() {
    let (tactile, truth) = tactile();
    let some: Vec<usize> = (0..truth.len()).filter(|sensor| sensor % 3 != 0).collect();
    let series: Vec<&[f32]> = tactile.series().collect();
    let pressures = some.iter().flat_map(|&sensor| series[sensor]).copied().collect();
    let found = rigid_parts(&tactile, &some, &distances(&Tactile { samples: tactile.samples, pressures }));
    assert!(adjusted_rand_index(&found.labels, &truth) > 0.99);
}

#[test]
fn a_cluster_of_two_parts_has_a_longer_description_than_both() {
    let (tactile, truth) = tactile();
    let series: Vec<&[f32]> = tactile.series().collect();
    let observations =
        Observations { series, signed: false, distances: &Distances { sensors: 0, values: Vec::new() } };
    let every: Vec<usize> = (0..truth.len()).collect();
    let roots = observations.roots(&every, &observations.informative_samples(&every)[0]);
    let own = |parts: &[usize]| {
        (0..truth.len()).filter(|sensor| parts.contains(&truth[*sensor])).collect::<Vec<_>>()
    };
    let length =
        |sensors: &[usize]| Cluster::new(&roots, sensors.to_vec(), 1, ITERATIONS[0]).description_length;
    assert!(length(&own(&[1, 2])) > length(&own(&[1])) + length(&own(&[2])) + MIN_SAVING);
    // The halves of one part have a longer description than the whole.
    let (first, second): (Vec<usize>, Vec<usize>) = own(&[2]).into_iter().partition(|sensor| sensor % 2 == 0);
    assert!(length(&own(&[2])) + MIN_SAVING < length(&first) + length(&second));
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
    let series = series.iter().map(Vec::as_slice).collect();
    let distances = &Distances { sensors: 0, values: Vec::new() };
    let observations = Observations { series, signed: false, distances };
    let [every, samples] = [120, SAMPLES].map(|count| (0..count).collect::<Vec<usize>>());
    let search = Search { roots: observations.roots(&every, &samples), distances, iterations: ITERATIONS[1] };
    let thirds = [0, 40, 80].map(|first| (first..first + 40).collect::<Vec<usize>>());
    let (parts, unassigned) = search.parts_and_unassigned(search.clusters(thirds.to_vec(), Vec::new()));
    let mut found: Vec<Vec<usize>> = parts.into_iter().map(|part| part.sensors).collect();
    found.sort();
    assert_eq!(found, [(0..80).collect::<Vec<usize>>(), (80..120).collect()]);
    assert!(unassigned.is_empty());
}
