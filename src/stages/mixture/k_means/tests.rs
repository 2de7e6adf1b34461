use super::*;
use crate::numerics::rng::stream;

#[test]
fn an_emptied_centre_starts_again_at_the_point_farthest_from_the_others() {
    let points = Points::from_rows(1, vec![0.0, 1.0, 10.0, 14.0, 30.0]);
    let mut centres = vec![vec![0.0], vec![100.0], vec![10.0], vec![200.0]];
    move_to_means(&mut centres, &points, &[0, 0, 2, 2, 2]);
    // The means are 0.5 and 18; 30 is 12 from them, and then 10 is 8.
    assert_eq!(centres, [[0.5], [30.0], [18.0], [10.0]]);
}

#[test]
fn the_inertia_is_that_of_the_labels() {
    let points = Points::from_rows(1, vec![0.0, 1.0, 10.0, 14.0]);
    let found = lloyd(&points, 2, &mut stream(1, 1, "k-means", 0));
    assert_eq!(found.inertia, 0.5 + 8.0);
    assert_eq!(found.labels[0], found.labels[1]);
    assert_eq!(found.labels[2], found.labels[3]);
}

#[test]
fn starts_are_different_points_and_far_ones_more_often() {
    let points = Points::from_rows(1, vec![0.0, 0.0, 1.0, 100.0]);
    let count = |k: usize, seed| starts(&points, k, &mut stream(seed, 1, "starts", 0)).len();
    assert_eq!((count(3, 1), count(4, 1), count(9, 1)), (3, 3, 3), "two of the four points coincide");
    let far =
        (0..50).filter(|&seed| starts(&points, 2, &mut stream(seed, 1, "starts", 0)).contains(&vec![100.0]));
    assert!(far.count() >= 49);
}
