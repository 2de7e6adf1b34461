//! Test that each update solves its regressions.

use rand::RngExt;

use super::*;
use crate::numerics::rng::stream;

/// Random roots, thresholds of samples, loadings and motion.
fn example(samples: usize, k: usize, signed: bool) -> (Mat<f64>, Vec<f64>, Mat<f64>, Mat<f64>) {
    let mut rng = stream(1, 1, "als", samples * 10 + k);
    let mut random = |rows, columns| Mat::from_fn(rows, columns, |_, _| rng.random_range(-1.0_f64..1.0));
    let (values, loadings, motion) = (random(samples, 9), random(9, k), random(samples, k));
    if signed {
        return (values, vec![f64::NEG_INFINITY; samples], loadings, motion);
    }
    let values = Mat::from_fn(samples, 9, |t, sensor| f64::max(0.0, values[(t, sensor)]));
    (values, vec![0.1; samples], loadings, motion)
}

/// Adds an informative root, and its regressors x, to the sums of squares and products.
fn add(sums: &mut (Mat<f64>, Mat<f64>), x: &[f64], is_informative: bool, root: f64) {
    for (a, own) in x.iter().enumerate().filter(|_| is_informative) {
        x.iter().enumerate().for_each(|(b, other)| sums.0[(a, b)] += own * other);
        sums.1[(a, 0)] += own * root;
    }
}

#[test]
fn an_update_solves_the_plain_sums_at_any_number_of_samples() {
    for (samples, signed) in
        [(1, false), (31, false), (33, true), (37, false), (70, true), (257, false), (519, true)]
    {
        for k in 1..=6 {
            let (values, thresholds, loadings, motion) = example(samples, k, signed);
            let als = Als::new(values.as_ref(), &thresholds);
            let row = |of: &Mat<f64>, at: usize| -> Vec<f64> { (0..k).map(|a| of[(at, a)]).collect() };
            let predicted = |t: usize, sensor: usize| -> f64 {
                row(&loadings, sensor).iter().zip(row(&motion, t)).map(|(c, w)| c * w).sum()
            };
            let informative = |t: usize, sensor: usize| {
                values[(t, sensor)] >= thresholds[t] || predicted(t, sensor) > values[(t, sensor)]
            };
            let is_solved = |(squares, products): &(Mat<f64>, Mat<f64>), found: Vec<f64>| {
                let found = Mat::from_fn(k, 1, |a, _| found[a]);
                let error = squares * &found - products;
                // The ridge takes a little.
                assert!(error.norm_max() < 1e-4 * (1.0 + found.norm_max()) * (1.0 + squares.norm_max()));
            };
            let mut moved = motion.clone();
            als.update_motion(loadings.as_ref(), &mut moved);
            for t in 0..samples {
                let mut sums = (Mat::zeros(k, k), Mat::zeros(k, 1));
                (0..9).for_each(|sensor| {
                    add(&mut sums, &row(&loadings, sensor), informative(t, sensor), values[(t, sensor)]);
                });
                is_solved(&sums, row(&moved, t));
            }
            let mut loaded = loadings.clone();
            als.update_loadings(loaded.as_mut(), &motion);
            let mut sums_of_all = [0.0; 2];
            for sensor in 0..9 {
                let mut sums = (Mat::zeros(k, k), Mat::zeros(k, 1));
                (0..samples).for_each(|t| {
                    add(&mut sums, &row(&motion, t), informative(t, sensor), values[(t, sensor)]);
                });
                is_solved(&sums, row(&loaded, sensor));
            }
            for t in 0..samples {
                let own: Vec<usize> = (0..9).filter(|sensor| informative(t, *sensor)).collect();
                sums_of_all[0] +=
                    own.iter().map(|&at| (values[(t, at)] - predicted(t, at)).powi(2)).sum::<f64>();
                sums_of_all[1] += f64::max(0.0, own.len() as f64 - k as f64);
            }
            let found = als.residual(loadings.as_ref(), &motion);
            let is_near = |a: f64, b: f64| (a - b / samples as f64).abs() < 1e-12 * (1.0 + b);
            assert!(
                is_near(found[0], sums_of_all[0]) && is_near(found[1], sums_of_all[1]),
                "{samples} {k} {signed}"
            );
        }
    }
}

#[test]
fn what_is_not_felt_is_completed_by_what_is_predicted_and_no_more_than_the_root() {
    for samples in [1, 31, 33, 257] {
        for k in 1..=6 {
            let (mut values, thresholds, loadings, motion) = example(samples, k, false);
            values[(0, 0)] = f64::NAN;
            let before = Mat::from_fn(samples, 9, |t, sensor| 7.0 + (t + sensor) as f64);
            let mut completed = before.clone();
            Als::new(values.as_ref(), &thresholds).complete(loadings.as_ref(), &motion, &mut completed);
            for t in 0..samples {
                for sensor in 0..9 {
                    let root = values[(t, sensor)];
                    let predicted: f64 = (0..k).map(|a| loadings[(sensor, a)] * motion[(t, a)]).sum();
                    let expected =
                        if root >= thresholds[t] { before[(t, sensor)] } else { predicted.min(root) };
                    assert!((completed[(t, sensor)] - expected).abs() < 1e-12, "{samples} {k} {t} {sensor}");
                }
            }
        }
    }
}

#[test]
fn a_root_that_is_not_informative_counts_as_the_completed_one_with_its_weight() {
    const WEIGHT: f64 = 0.1;
    let (values, thresholds, loadings, motion) = example(33, 2, false);
    let completed = Mat::from_fn(33, 9, |t, sensor| -((t * sensor) as f64).sin().abs());
    let als = Als::new(values.as_ref(), &thresholds).with_completed(completed.as_ref(), WEIGHT);
    let mut found = loadings.clone();
    als.update_loadings(found.as_mut(), &motion);
    for sensor in 0..9 {
        let mut gradient = [0.0; 2];
        for t in 0..33 {
            let product = |c: &Mat<f64>| (0..2).map(|a| c[(sensor, a)] * motion[(t, a)]).sum::<f64>();
            let root = values[(t, sensor)];
            let (weight, response) = if root >= thresholds[t] || product(&loadings) > root {
                (1.0, root)
            } else {
                (WEIGHT, completed[(t, sensor)])
            };
            (0..2).for_each(|a| gradient[a] += weight * (response - product(&found)) * motion[(t, a)]);
        }
        // The ridge takes a little.
        assert!(gradient.iter().all(|slope| slope.abs() < 1e-5), "{sensor}: {gradient:?}");
    }
}
