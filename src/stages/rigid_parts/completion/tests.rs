//! Test that completion finds what is not felt.

use rand::RngExt;

use super::*;
use crate::numerics::rng::stream;
use crate::stages::parameters::Parameters;

/// Normal velocities, samples × sensors, of three parts of so many sensors, each of a motion of rank four.
fn velocities(sensors: usize) -> Mat<f64> {
    let mut rng = stream(1, 1, "completion", 0);
    let mut uniform = |rows, columns| Mat::from_fn(rows, columns, |_, _| rng.random_range(-1.0_f64..1.0));
    let parts = [0; 3].map(|_| uniform(600, 4) * uniform(4, sensors));
    Mat::from_fn(600, 3 * sensors, |t, sensor| parts[sensor / sensors][(t, sensor % sensors)])
}

fn roots(velocities: &Mat<f64>, signed: bool) -> Roots {
    let felt = |t, sensor| velocities[(t, sensor)].max(if signed { f64::NEG_INFINITY } else { 0.0 });
    let values = Mat::from_fn(velocities.nrows(), velocities.ncols(), felt);
    let sizes = vec![1.0; velocities.nrows()];
    Roots { values, thresholds: sizes.clone(), signed }.equalised(&sizes, 0.0)
}

#[test]
fn what_is_not_felt_is_completed_and_parts_show() {
    let velocities = velocities(30);
    for signed in [false, true] {
        let found = Completion::new(&roots(&velocities, signed), Parameters::default().completion_ridge);
        let error = (&found.velocities - &velocities).squared_norm_l2() / velocities.squared_norm_l2();
        assert!(error < 0.01, "signed {signed}: {error}");
        let affinities = |same: bool| {
            let all = (0..90).flat_map(|i| (0..i).map(move |j| (i, j)));
            let some: Vec<f64> = all
                .filter(|(i, j)| (i / 30 == j / 30) == same)
                .map(|(i, j)| found.affinities[(i, j)])
                .collect();
            some.iter().sum::<f64>() / some.len() as f64
        };
        assert!(affinities(true) > 5.0 * affinities(false), "{} {}", affinities(true), affinities(false));
    }
}

#[test]
fn the_number_of_threads_changes_no_bit_and_no_touch_is_no_failure() {
    let roots = roots(&velocities(10), false);
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| Completion::new(&roots, Parameters::default().completion_ridge).velocities)
    };
    assert_eq!(on(1), on(3));
    let nothing = Roots { values: Mat::zeros(600, 30), thresholds: roots.thresholds.clone(), signed: false };
    let found = Completion::new(&nothing, Parameters::default().completion_ridge);
    assert!(found.affinities.norm_max() <= 1.0 && found.velocities.norm_max().is_finite());
}
