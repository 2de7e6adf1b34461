//! Test that groups of sensors leave a cluster that they are in by mistake, and no other.

use faer::Mat;
use rand::RngExt;

use super::super::roots::product;
use super::super::testing::felt_of;
use super::*;
use crate::numerics::rng::stream;

/// Sensors of a cylinder: 24 on its side, and ten on one end.
const SIDE: usize = 24;
const SENSORS: usize = 34;

/// What two cylinders feel that move independently, the sensors of one after those of the other. The side feels the first four
/// components of a motion. The end feels the fifth, and how the cylinder rotates a third as much.
fn felt() -> Search {
    let mut rng = stream(5, 1, "moves", 0);
    let mut uniform = |rows, columns| Mat::from_fn(rows, columns, |_, _| rng.random_range(-1.0_f64..1.0));
    let velocities: Vec<Mat<f64>> = (0..2)
        .map(|_| {
            let mut own = uniform(5, SENSORS);
            for sensor in 0..SIDE {
                own[(4, sensor)] = 0.0;
            }
            for sensor in SIDE..SENSORS {
                (own[(0, sensor)], own[(1, sensor)]) = (0.0, 0.0);
                own[(2, sensor)] *= 0.3;
                own[(3, sensor)] *= 0.3;
                own[(4, sensor)] = 1.0;
            }
            product(uniform(600, 5).as_ref(), own.as_ref())
        })
        .collect();
    let velocities =
        Mat::from_fn(600, 2 * SENSORS, |t, sensor| velocities[sensor / SENSORS][(t, sensor % SENSORS)]);
    let (felt, affinities) = felt_of(&velocities);
    Search::new(felt, affinities)
}

fn side(part: usize) -> Vec<usize> {
    (part * SENSORS..part * SENSORS + SIDE).collect()
}

fn end(part: usize) -> Vec<usize> {
    (part * SENSORS + SIDE..(part + 1) * SENSORS).collect()
}

/// The sensors of clusters after groups were moved and clusters merged, as in a round of the search; the first ones first.
fn moved(search: &mut Search, clusters: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let clusters = clusters.iter().map(|own| Cluster::new(&search.felt, own.clone())).collect();
    let found = search.moved(clusters);
    let found = search.merged(found);
    let mut found: Vec<Vec<usize>> = found.into_iter().map(|own| own.sensors).collect();
    found.sort();
    found
}

#[test]
fn an_end_goes_to_the_side_of_its_own_cylinder() {
    let right: Vec<Vec<usize>> = (0..2).map(|part| [side(part), end(part)].concat()).collect();
    let search = &mut felt();
    assert_eq!(moved(search, &right), right);
    let exchanged = [[side(0), end(1)].concat(), [side(1), end(0)].concat()];
    assert_eq!(moved(search, &exchanged), right);
    let together = [[side(0), end(0), end(1)].concat(), side(1)];
    assert_eq!(moved(search, &together), right);
}

#[test]
fn a_group_that_shares_nothing_with_any_cluster_is_one_of_its_own() {
    let search = &mut felt();
    let mixed = [[side(0), end(1)].concat()];
    assert_eq!(moved(search, &mixed), [side(0), end(1)]);
}
