//! Test that parts that hardly move against each other are told apart, and nothing else is.

use faer::Mat;
use rand::RngExt;

use super::super::roots::product;
use super::super::testing::felt_of;
use super::*;
use crate::numerics::rng::stream;

const SAMPLES: usize = 600;
/// Sensors of each part.
const SENSORS: usize = 24;

/// What four parts feel, whose motions have this rank. The first two differ by a tenth, and the other two move on their own. Each velocity has
/// a term of second order of this size, which is another one for each sensor; and noise of such a size. All are divided by the speed at
/// the sample, which is slow at most times, and fast at some.
fn search(rank: usize, second_order: f64, noise: f64) -> Search {
    search_at_speeds(rank, [second_order; 4], noise, 2.5)
}

/// The same with terms of second order of a size for each part. Speeds spread over so many powers of e below and above 1.
fn search_at_speeds(rank: usize, second_order: [f64; 4], noise: f64, spread: f64) -> Search {
    let mut rng = stream(2, 1, "separation", 0);
    let mut uniform = |rows, columns| Mat::from_fn(rows, columns, |_, _| rng.random_range(-1.0_f64..1.0));
    let motion = uniform(SAMPLES, rank);
    let other = &motion + uniform(SAMPLES, rank) * faer::Scale(0.1);
    let motions = [motion, other, uniform(SAMPLES, rank), uniform(SAMPLES, rank)];
    let speeds: Vec<f64> =
        uniform(SAMPLES, 1).col_as_slice(0).iter().map(|speed| (spread * speed).exp()).collect();
    let linear: Vec<Mat<f64>> =
        motions.iter().map(|motion| product(motion.as_ref(), uniform(rank, SENSORS).as_ref())).collect();
    let quadratic: Vec<[Mat<f64>; 2]> = motions
        .iter()
        .map(|motion| [0; 2].map(|_| product(motion.as_ref(), uniform(rank, SENSORS).as_ref())))
        .collect();
    let errors = uniform(SAMPLES, 4 * SENSORS);
    let velocities = Mat::from_fn(SAMPLES, 4 * SENSORS, |t, sensor| {
        let (part, at, speed) = (sensor / SENSORS, sensor % SENSORS, speeds[t]);
        let [one, another] = &quadratic[part];
        let quadratic = one[(t, at)] * another[(t, at)];
        linear[part][(t, at)] + second_order[part] * speed * quadratic + noise * errors[(t, sensor)]
    });
    let (mut felt, affinities) = felt_of(&velocities);
    felt.sizes = speeds;
    Search::new(felt, affinities)
}

fn part(at: usize) -> Vec<usize> {
    (at * SENSORS..(at + 1) * SENSORS).collect()
}

/// The first two parts as one cluster, and the others.
fn together() -> [Vec<usize>; 3] {
    [[part(0), part(1)].concat(), part(2), part(3)]
}

/// The clusters that these are separated into.
fn separated(search: &mut Search, clusters: &[Vec<usize>]) -> Option<Vec<Vec<usize>>> {
    let clusters: Vec<Cluster> = clusters.iter().map(|own| Cluster::new(&search.felt, own.clone())).collect();
    let found = search.separated(&clusters)?;
    let mut sensors: Vec<Vec<usize>> = found.into_iter().map(|own| own.sensors).collect();
    sensors.sort();
    Some(sensors)
}

#[test]
fn parts_that_hardly_move_against_each_other_are_separated_without_and_with_an_error_of_second_order() {
    let parts: Vec<Vec<usize>> = (0..4).map(part).collect();
    for (second_order, is_exact) in [(0.0, true), (0.002, false)] {
        let mut search = search(4, second_order, 0.0);
        assert_eq!(separated(&mut search, &together()), Some(parts.clone()));
        assert_eq!(search.has_exact_model, is_exact);
    }
    for second_order in [0.0, 0.002, 0.01] {
        assert_eq!(separated(&mut search(4, second_order, 0.0), &parts), None, "{second_order}");
    }
}

#[test]
fn an_error_of_second_order_settles_a_part_and_not_two() {
    // Of the largest rank, so that no component is left for the error.
    let mut search = search(6, 0.01, 0.0);
    assert_eq!(separated(&mut search, &[part(0), part(2), part(3)]), None);
    (search.felt.tolerance, search.felt.iterations) = (2e-5, ITERATIONS[0]);
    let learned = |own: Vec<usize>| Cluster::learned_longer(&search.felt, own);
    for own in [part(0), part(1)].map(learned) {
        assert!(
            !search.is_exact(&own) && search.is_settled(&own),
            "{} {}",
            own.variance(),
            calm_share(&search.felt, &own)
        );
    }
    assert!(!search.is_settled(&learned([part(0), part(1)].concat())));
}

#[test]
fn parts_are_separated_where_no_cluster_is_settled_but_one_leaves_much_at_all_speeds() {
    // The error of the last two grows with the speed, but is too even over time to be told from the motion of two parts.
    let new = || search_at_speeds(6, [0.0, 0.0, 0.01, 0.01], 0.0, 0.8);
    let mut search = new();
    (search.felt.tolerance, search.felt.iterations) = (2e-5, ITERATIONS[0]);
    let clusters = together().map(|own| Cluster::learned_longer(&search.felt, own));
    assert!(!clusters.iter().any(|own| search.is_settled(own)));
    assert_eq!(search.left_by(&clusters), [0, 1, 3]);
    let mut search = new();
    assert_eq!(separated(&mut search, &together()), Some((0..4).map(part).collect()));
    assert!(!search.has_exact_model);
    // Where none leaves much, nothing shows what a part leaves.
    assert_eq!(separated(&mut new(), &[part(2), part(3)]), None);
}

#[test]
fn with_noise_nothing_is_separated() {
    assert_eq!(separated(&mut search(4, 0.0, 0.05), &together()), None);
}
