//! Test regressions against a solver of one at a time.

use rand::RngExt;

use super::*;
use crate::numerics::rng::stream;

/// Adds an observation to the regression of a lane: regressors x, response y.
fn add<const K: usize>(to: &mut Regressions<K>, lane: usize, x: [f64; K], y: f64) {
    for a in 0..K {
        to.products[a][lane] += x[a] * y;
        (0..=a).for_each(|b| to.squares[a][b][lane] += x[a] * x[b]);
    }
}

fn recovered<const K: usize>() {
    let mut rng = stream(1, 1, "regressions", K);
    let mut regressions = Regressions::<K>::new();
    let mut truth = [[0.0; K]; LANES];
    for (lane, truth) in truth.iter_mut().enumerate() {
        truth.fill_with(|| rng.random_range(-1.0..1.0));
        for _ in 0..20 {
            let x = truth.map(|_| rng.random_range(-1.0..1.0));
            let y = x.iter().zip(&*truth).map(|(x, c)| x * c).sum();
            add(&mut regressions, lane, x, y);
        }
    }
    regressions.solve();
    for (lane, truth) in truth.iter().enumerate() {
        (0..K).for_each(|a| assert!((regressions.products[a][lane] - truth[a]).abs() < 1e-4, "K = {K}"));
    }
}

#[test]
fn coefficients_are_recovered() {
    recovered::<1>();
    recovered::<3>();
    recovered::<6>();
}

#[test]
fn undetermined_coefficients_are_nearly_zero() {
    let mut regressions = Regressions::<2>::new();
    add(&mut regressions, 1, [1.0, 1.0], 2.0);
    regressions.solve();
    // Nothing is known of the first, and only the sum of both coefficients of the second.
    let [a, b] = regressions.products;
    assert_eq!((a[0], b[0]), (0.0, 0.0));
    assert!((a[1] - 1.0).abs() < 1e-5 && (b[1] - 1.0).abs() < 1e-5);
}
