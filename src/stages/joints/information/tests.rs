//! Test what motions share.

use rand::RngExt;

use super::*;
use crate::numerics::rng::stream;

/// The information between two variables, samples × components.
fn between(x: &DMatrix<f64>, y: &DMatrix<f64>) -> f64 {
    let own = |values: &DMatrix<f64>| {
        Gaussian::new(values.transpose() * values, Parameters::default().component_ridge)
    };
    mutual_information(&own(x), &own(y), &(x.transpose() * y))
}

/// Independent values about 0, of one variance.
fn noise(number: usize, components: usize) -> DMatrix<f64> {
    let mut rng = stream(1, 1, "information", number);
    DMatrix::from_fn(20_000, components, |_, _| rng.random_range(-1.0..1.0))
}

#[test]
fn information_is_that_of_the_canonical_correlations() {
    let (x, e) = (noise(0, 2), noise(1, 2));
    // The first components correlate at 0.6, and the second do not.
    let mixed =
        DMatrix::from_fn(
            20_000,
            2,
            |t, at| {
                if at == 0 { 0.6 * x[(t, 0)] + 0.8 * e[(t, 0)] } else { e[(t, 1)] }
            },
        );
    let expected = -0.5 * (1.0_f64 - 0.36).ln();
    assert!((between(&x, &mixed) - expected).abs() < 0.01, "{}", between(&x, &mixed));
    // No linear map of a motion changes it, but for the ridge.
    let map = DMatrix::from_row_slice(2, 2, &[2.0, 0.3, -1.0, 1.5]);
    assert!((between(&(&x * map), &mixed) - expected).abs() < 0.01);
}

#[test]
fn a_neighbour_tells_more_than_its_neighbour() {
    let first = noise(0, 3);
    let second = &first + noise(1, 3) * 0.4;
    let third = &second + noise(2, 3) * 0.4;
    assert!(between(&first, &second) > 1.2 * between(&first, &third));
    assert!(between(&second, &third) > 1.2 * between(&first, &third));
}

#[test]
fn equal_motions_tell_a_finite_amount_and_no_motion_tells_nothing() {
    let x = noise(0, 3);
    assert!((3.0..20.0).contains(&between(&x, &x)), "{}", between(&x, &x));
    assert_eq!(between(&x, &DMatrix::zeros(20_000, 2)), 0.0);
    assert_eq!(between(&x, &DMatrix::zeros(20_000, 0)), 0.0);
}

#[test]
fn more_of_a_joints_speed_tells_more() {
    let found: Vec<f64> = [0.0, 0.5, 0.99, 1.0].map(|correlation| of_correlation(correlation, 1e-3)).to_vec();
    assert!(found.is_sorted() && found[0] == 0.0 && found[3] < 3.5, "{found:?}");
}
