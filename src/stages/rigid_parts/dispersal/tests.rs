//! Test that a cluster is dispersed if its sensors are alike on two parts, and that parts are not.

use faer::Mat;
use rand::RngExt;

use super::super::roots::product;
use super::super::testing::felt_of;
use super::*;
use crate::numerics::rng::stream;

/// Sensors of each of two parts on a hinge; the first seven do not feel how it turns.
const SENSORS: usize = 24;
const EITHER: usize = 7;

/// What they feel: five components are those of both parts, and the sixth of each is its own. Then come as many of a third part,
/// which moves with neither. The fifth component is felt by all, or only by sensors that do not feel how the hinge turns.
fn search(all_feel_fifth: bool) -> Search {
    let mut rng = stream(9, 1, "dispersal", 0);
    let mut uniform = |rows, columns| Mat::from_fn(rows, columns, |_, _| rng.random_range(-1.0_f64..1.0));
    let (both, own) = (uniform(600, 5), uniform(600, 2));
    let other = product(uniform(600, 6).as_ref(), uniform(6, SENSORS).as_ref());
    let loadings = uniform(6, 2 * SENSORS);
    let of_hinge = |t: usize, sensor: usize| {
        let feels = sensor % SENSORS >= EITHER;
        let felt = if feels && !all_feel_fifth { 4 } else { 5 };
        let common: f64 = (0..felt).map(|k| both[(t, k)] * loadings[(k, sensor)]).sum();
        common + if feels { own[(t, sensor / SENSORS)] * loadings[(5, sensor)] } else { 0.0 }
    };
    let (felt, affinities) = felt_of(&Mat::from_fn(600, 3 * SENSORS, |t, sensor| {
        if sensor < 2 * SENSORS { of_hinge(t, sensor) } else { other[(t, sensor - 2 * SENSORS)] }
    }));
    Search::new(felt, affinities)
}

fn part(at: usize) -> Vec<usize> {
    (at * SENSORS..(at + 1) * SENSORS).collect()
}

fn dispersed(search: &mut Search, clusters: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let clusters = clusters.iter().map(|own| search.learned(own.clone())).collect();
    let mut found: Vec<Vec<usize>> = search.dispersed(clusters).into_iter().map(|own| own.sensors).collect();
    found.sort();
    found
}

#[test]
fn sensors_that_feel_the_same_on_both_parts_of_a_hinge_make_no_part() {
    // With them are some of the second part that feel the hinge, so that the first does not explain all.
    let either = (0..EITHER).chain(SENSORS..SENSORS + EITHER + 4).collect::<Vec<_>>();
    let rest = |at: usize| part(at).into_iter().filter(|sensor| !either.contains(sensor)).collect();
    are_both_parts(&dispersed(&mut search(true), &[rest(0), rest(1), either.clone(), part(2)]));
}

#[test]
fn sensors_that_alone_feel_a_direction_go_to_the_parts_in_groups() {
    // Neither part explains any of them, as long as it has none: no other of its sensors feels the fifth component.
    let either = [part(0)[..EITHER].to_vec(), part(1)[..EITHER].to_vec()].concat();
    let rest = |at: usize| part(at).split_off(EITHER);
    let mut search = search(false);
    for at in 0..2 {
        let residuals = search.learned(rest(at)).residuals(&search.felt);
        assert!(either.iter().all(|&sensor| residuals[sensor] > EXPLAINED * search.felt.tolerance));
    }
    are_both_parts(&dispersed(&mut search, &[rest(0), rest(1), either, part(2)]));
}

/// There are three clusters: the third part, and one with all sensors of each of the first two that feel how the hinge turns. The others
/// of these two may be in either.
fn are_both_parts(found: &[Vec<usize>]) {
    assert_eq!(found.len(), 3, "{found:?}");
    assert!(found.contains(&part(2)));
    for at in 0..2 {
        let feels = part(at).split_off(EITHER);
        assert!(found.iter().any(|own| feels.iter().all(|sensor| own.contains(sensor))), "{found:?}");
    }
}

#[test]
fn what_one_motion_does_not_explain_is_dispersed_even_if_others_explain_few_of_it() {
    // Of the second part, the sensors that feel how the hinge turns are with some of the third. Only these are explained by others.
    let feels = part(1).split_off(EITHER);
    let of_third = part(2)[..EITHER].to_vec();
    assert!(2 * of_third.len() <= feels.len());
    let mixed = [feels, of_third.clone()].concat();
    let rest: Vec<usize> = part(2).split_off(of_third.len());
    let found = dispersed(&mut search(true), &[part(1)[..EITHER].to_vec(), mixed, rest]);
    assert_eq!(found, [part(1), part(2)]);
}

#[test]
fn parts_stay() {
    let parts: Vec<Vec<usize>> = (0..3).map(part).collect();
    assert_eq!(dispersed(&mut search(true), &parts), parts);
    // Also a small one.
    let few = [part(0), part(1), part(2).split_off(SENSORS - 6)];
    assert_eq!(dispersed(&mut search(true), &few), few);
}
