//! Test that faces of two boxes on a hinge come to their own boxes, and that right clusters stay.

use faer::Mat;
use rand::RngExt;

use super::super::roots::product;
use super::super::testing::felt_of;
use super::*;
use crate::numerics::rng::stream;

/// Sensors of each pair of opposite faces.
const SENSORS: usize = 10;
/// Pairs of opposite faces of a box.
const PAIRS: usize = 3;

/// The sensors of the faces of a box whose normals lie along an axis. The hinge lies along axis 0.
fn pair(part: usize, axis: usize) -> Vec<usize> {
    let first = (part * PAIRS + axis) * SENSORS;
    (first..first + SENSORS).collect()
}

/// The sensors of some pairs of faces.
fn pairs(of: &[(usize, usize)]) -> Vec<usize> {
    of.iter().flat_map(|&(part, axis)| pair(part, axis)).collect()
}

/// What two boxes feel that a hinge joins. They move independently, but for the velocity along the hinge. Places are measured from it.
fn felt() -> Search {
    let mut rng = stream(5, 1, "regrouping", 0);
    let mut uniform = |rows, columns| Mat::from_fn(rows, columns, |_, _| rng.random_range(-1.0_f64..1.0));
    let (first, mut second) = (uniform(600, 6), uniform(600, 6));
    second.col_mut(0).copy_from(first.col(0));
    let velocities: Vec<Mat<f64>> = [first, second]
        .iter()
        .map(|motion| {
            let places = uniform(3, PAIRS * SENSORS);
            // Velocity along the normal n at the place r: n · v + (r × n) · ω.
            let own = Mat::from_fn(6, PAIRS * SENSORS, |at, sensor| {
                let axis = sensor / SENSORS;
                let [next, last] = [(axis + 1) % 3, (axis + 2) % 3];
                let side = if sensor % 2 == 0 { 1.0 } else { -1.0 };
                let value = match at {
                    at if at == axis => 1.0,
                    at if at == 3 + next => places[(last, sensor)],
                    at if at == 3 + last => -places[(next, sensor)],
                    _ => 0.0,
                };
                side * value
            });
            product(motion.as_ref(), own.as_ref())
        })
        .collect();
    let count = PAIRS * SENSORS;
    let (felt, affinities) =
        felt_of(&Mat::from_fn(600, 2 * count, |t, sensor| velocities[sensor / count][(t, sensor % count)]));
    Search::new(felt, affinities)
}

/// The sensors of clusters after they were regrouped, if they were.
fn regrouped(clusters: &[&[(usize, usize)]]) -> Option<Vec<Vec<usize>>> {
    let mut search = felt();
    let clusters: Vec<Cluster> = clusters.iter().map(|own| Cluster::new(&search.felt, pairs(own))).collect();
    let found = search.regrouped(&clusters)?;
    let mut found: Vec<Vec<usize>> = found.into_iter().map(|own| own.sensors).collect();
    found.sort();
    Some(found)
}

#[test]
fn faces_along_a_hinge_come_to_their_own_boxes() {
    let boxes = vec![pairs(&[(0, 0), (0, 1), (0, 2)]), pairs(&[(1, 0), (1, 1), (1, 2)])];
    // The faces along the hinge were merged first, since they feel one velocity.
    let found = regrouped(&[&[(0, 0), (1, 0)], &[(0, 1), (0, 2)], &[(1, 1), (1, 2)]]);
    assert_eq!(found, Some(boxes.clone()));
    // Or each is with a face of its own box, and the others are alone.
    let found = regrouped(&[&[(0, 0), (1, 0)], &[(0, 1)], &[(0, 2)], &[(1, 1), (1, 2)]]);
    assert_eq!(found, Some(boxes));
}

#[test]
fn boxes_stay() {
    assert_eq!(regrouped(&[&[(0, 0), (0, 1), (0, 2)], &[(1, 0), (1, 1), (1, 2)]]), None);
}

#[test]
fn a_cluster_of_two_boxes_is_divided_into_its_flat_faces() {
    let search = felt();
    let cluster = Cluster::new(&search.felt, pairs(&[(0, 0), (1, 0)]));
    let mut found = search.flat_faces(&cluster);
    found.sort();
    assert_eq!(found, [pair(0, 0), pair(1, 0)]);
}

#[test]
fn vectors_of_one_subspace_are_a_group_and_few_are_none() {
    let mut rng = stream(5, 1, "regrouping", 1);
    let mut vectors = |count: usize, places: [usize; 3]| -> Vec<Vec<f64>> {
        let mut vector = || {
            let mut own = vec![0.0; 6];
            places.iter().for_each(|&at| own[at] = rng.random_range(-1.0..1.0));
            own
        };
        (0..count).map(|_| vector()).collect()
    };
    let all = [vectors(6, [0, 1, 2]), vectors(9, [2, 3, 4]), vectors(4, [0, 4, 5])].concat();
    assert_eq!(flats(&all, 1e-3), [(6..15).collect::<Vec<_>>(), (0..6).collect()]);
    assert!(flats(&[], 1e-3).is_empty() && flats(&vec![vec![0.0; 6]; 9], 1e-3).is_empty());
}
