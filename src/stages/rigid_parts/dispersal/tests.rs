//! Test that a cluster is dispersed if its sensors are alike on two parts, and that parts are not.

use faer::Mat;
use rand::RngExt;

use super::super::roots::product;
use super::super::testing::felt_of;
use super::*;
use crate::numerics::rng::stream;

/// Sensors of each of three parts. Those of the first two that come first are on a face along the hinge between them. Two faces have fewer
/// sensors than the rest of a part, so that they are tried first.
const SENSORS: usize = 32;
const FACE: usize = 10;
const SAMPLES: usize = 600;

/// What faces along a hinge feel of the motions of their parts.
#[derive(Clone, Copy, PartialEq)]
enum Faces {
    /// Not how the hinge turns, and so nothing else than the other sensors feel.
    AlikeOnBoth,
    /// How it turns, and a direction that no other sensor of their part feels.
    Only,
}

/// Two parts on a hinge move along five directions that both have in common, and the hinge turns each by itself. A third part moves with
/// neither.
fn search(faces: Faces) -> Search {
    search_with_errors(faces, 0.0)
}

/// The same, with errors of up to this size at the faces.
fn search_with_errors(faces: Faces, error: f64) -> Search {
    let mut rng = stream(9, 1, "dispersal", 0);
    let mut uniform = |rows, columns| Mat::from_fn(rows, columns, |_, _| rng.random_range(-1.0_f64..1.0));
    let (both, turns) = (uniform(SAMPLES, 5), uniform(SAMPLES, 2));
    let other = product(uniform(SAMPLES, 6).as_ref(), uniform(6, SENSORS).as_ref());
    let loadings = uniform(6, 2 * SENSORS);
    let errors = uniform(SAMPLES, 2 * SENSORS);
    let on_hinge = |t: usize, sensor: usize| {
        let is_on_face = sensor % SENSORS < FACE;
        let (share, directions) = match (faces, is_on_face) {
            (Faces::AlikeOnBoth, _) => (1.0, [0, 1, 2, 3, 4].as_slice()),
            // They mostly feel the turn, so that those of one part are alike.
            (Faces::Only, true) => (0.3, [0, 1, 4].as_slice()),
            (Faces::Only, false) => (1.0, [0, 1, 2, 3].as_slice()),
        };
        let common: f64 = directions.iter().map(|&k| share * both[(t, k)] * loadings[(k, sensor)]).sum();
        let turn = match (faces, is_on_face) {
            (_, false) => loadings[(5, sensor)],
            (Faces::Only, true) => 1.0,
            (Faces::AlikeOnBoth, true) => 0.0,
        };
        let error = if is_on_face { error * errors[(t, sensor)] } else { 0.0 };
        common + turns[(t, sensor / SENSORS)] * turn + error
    };
    search_of(&Mat::from_fn(SAMPLES, 3 * SENSORS, |t, sensor| {
        if sensor < 2 * SENSORS { on_hinge(t, sensor) } else { other[(t, sensor - 2 * SENSORS)] }
    }))
}

fn search_of(velocities: &Mat<f64>) -> Search {
    let (felt, affinities) = felt_of(velocities);
    Search::new(felt, affinities)
}

fn part(at: usize) -> Vec<usize> {
    (at * SENSORS..(at + 1) * SENSORS).collect()
}

/// The sensors of a part on its face, and its others.
fn face(at: usize) -> Vec<usize> {
    part(at)[..FACE].to_vec()
}

fn rest(at: usize) -> Vec<usize> {
    part(at).split_off(FACE)
}

fn dispersed(search: &mut Search, clusters: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let clusters = clusters.iter().map(|own| search.learned(own.clone())).collect();
    let mut found: Vec<Vec<usize>> = search.dispersed(clusters).into_iter().map(|own| own.sensors).collect();
    found.sort();
    found
}

/// How many of these sensors the motion of others explains.
fn explained(search: &Search, sensors: &[usize], others: &[usize]) -> usize {
    let residuals = search.learned(others.to_vec()).residuals(&search.felt);
    sensors.iter().filter(|&&sensor| residuals[sensor] <= search.felt.explained()).count()
}

#[test]
fn sensors_that_feel_the_same_on_both_parts_of_a_hinge_make_no_part() {
    // With them are some of the second part that feel the hinge, so that the first does not explain all.
    let feel = rest(1)[..4].to_vec();
    let either = [face(0), face(1), feel.clone()].concat();
    let others = rest(1).into_iter().filter(|sensor| !feel.contains(sensor)).collect();
    let found = dispersed(&mut search(Faces::AlikeOnBoth), &[rest(0), others, either, part(2)]);
    assert_eq!(found.len(), 3, "{found:?}");
    assert!(found.contains(&part(2)));
    for at in 0..2 {
        // Those that feel the same on both may be on either.
        assert!(found.iter().any(|own| rest(at).iter().all(|sensor| own.contains(sensor))), "{found:?}");
    }
}

#[test]
fn faces_that_alone_feel_a_direction_go_each_to_its_part() {
    let mut search = search(Faces::Only);
    let both = [face(0), face(1)].concat();
    // One motion explains both, and their parts at most half of them, as long as they have none.
    let cluster = search.learned(both.clone());
    assert!(search.explains(&cluster));
    let all = [rest(0), rest(1)].map(|rest| explained(&search, &both, &rest));
    assert!(2 * all.iter().sum::<usize>() <= both.len(), "{all:?}");
    assert_eq!(dispersed(&mut search, &[rest(0), rest(1), both, part(2)]), [part(0), part(1), part(2)]);
}

#[test]
fn what_one_motion_explains_with_errors_stays() {
    let mut search = search_with_errors(Faces::Only, 0.02);
    let both = [face(0), face(1)].concat();
    let cluster = search.learned(both.clone());
    assert!(
        search.explains(&cluster) && cluster.variance() > search.felt.tolerance,
        "{}",
        cluster.variance()
    );
    let clusters = [rest(0), rest(1), both, part(2)];
    let mut found = dispersed(&mut search, &clusters);
    found.sort();
    let mut expected = clusters.to_vec();
    expected.sort();
    assert_eq!(found, expected);
}

#[test]
fn what_one_motion_does_not_explain_is_dispersed_even_if_others_explain_few_of_it() {
    // Of the second part, the sensors that feel how the hinge turns are with some of the third. Only these are explained by others.
    let mut search = search(Faces::AlikeOnBoth);
    let of_third = part(2)[..FACE].to_vec();
    let of_third_left = part(2).split_off(FACE);
    let mixed = [rest(1), of_third.clone()].concat();
    let cluster = search.learned(mixed.clone());
    assert!(!search.explains(&cluster));
    assert!(2 * explained(&search, &mixed, &of_third_left) <= mixed.len());
    assert_eq!(dispersed(&mut search, &[face(1), mixed, of_third_left]), [part(1), part(2)]);
}

#[test]
fn parts_stay() {
    let parts: Vec<Vec<usize>> = (0..3).map(part).collect();
    let mut search = search(Faces::AlikeOnBoth);
    assert_eq!(dispersed(&mut search, &parts), parts);
    // Also a small one.
    let few = [part(0), part(1), part(2).split_off(SENSORS - 6)];
    assert_eq!(dispersed(&mut search, &few), few);
}

#[test]
fn parts_of_low_rank_stay_though_one_motion_explains_both() {
    let mut rng = stream(9, 1, "dispersal", 1);
    let mut uniform = |rows, columns| Mat::from_fn(rows, columns, |_, _| rng.random_range(-1.0_f64..1.0));
    let mut flat = || product(uniform(SAMPLES, 3).as_ref(), uniform(3, SENSORS).as_ref());
    let (first, second) = (flat(), flat());
    let mut search = search_of(&Mat::from_fn(SAMPLES, 2 * SENSORS, |t, sensor| {
        if sensor < SENSORS { first[(t, sensor)] } else { second[(t, sensor - SENSORS)] }
    }));
    let union = search.learned([part(0), part(1)].concat());
    assert!(search.explains(&union));
    assert_eq!(dispersed(&mut search, &[part(0), part(1)]), [part(0), part(1)]);
}
