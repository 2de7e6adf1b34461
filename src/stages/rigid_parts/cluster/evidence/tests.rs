//! Test that the evidence gives sensors of few samples to their part.

use faer::Mat;
use rand::RngExt;

use super::super::super::testing::felt_of;
use super::*;
use crate::numerics::rng::stream;
use crate::stages::parameters::Parameters;
use crate::stages::rigid_parts::roots::{columns, product};

/// What these roots are above 0, and how often.
fn roots(velocities: &[f64]) -> (Vec<f64>, usize) {
    let roots: Vec<f64> = velocities.iter().map(|velocity| velocity.max(0.0)).collect();
    let felt = roots.iter().filter(|root| **root > 0.0).count();
    (roots, felt)
}

/// Two parts with 30 sensors each, and what 40 more sensors of each feel at one to four of 300 samples.
fn two_parts() -> ([Evidence; 2], [Vec<Vec<f64>>; 2]) {
    let mut rng = stream(17, 1, "evidence", 0);
    let mut uniform = |rows, columns| Mat::from_fn(rows, columns, |_, _| rng.random_range(-1.0_f64..1.0));
    let parts = [0, 1].map(|_| {
        // It travels, so that some sensors hardly ever move outward.
        let motion = uniform(300, 5);
        let travels = Mat::from_fn(300, 5, |t, at| motion[(t, at)] + if at == 0 { 1.5 } else { 0.0 });
        let velocities = product(travels.as_ref(), uniform(5, 8000).as_ref());
        let feels = |sensor: &usize, range: std::ops::Range<usize>| {
            range.contains(&roots(velocities.col_as_slice(*sensor)).1)
        };
        let own: Vec<usize> = (0..8000).filter(|sensor| feels(sensor, 30..300)).take(30).collect();
        let few: Vec<usize> = (0..8000).filter(|sensor| feels(sensor, 1..5)).take(40).collect();
        assert_eq!((own.len(), few.len()), (30, 40));
        let own = columns(&velocities, &own);
        let (felt, _) = felt_of(&own);
        let mut part = Cluster::new(&felt, (0..30).collect());
        part.learn_longer(&felt);
        let scale = |sensor: usize| {
            let squares = roots(own.col_as_slice(sensor)).0.iter().map(|root| root * root).sum::<f64>();
            (squares / 300.0).sqrt()
        };
        let evidence = part
            .evidence(&(0..30).map(scale).collect::<Vec<_>>(), Parameters::default().min_tolerance)
            .unwrap();
        (evidence, few.iter().map(|&sensor| roots(velocities.col_as_slice(sensor)).0).collect())
    });
    let [(a, of_a), (b, of_b)] = parts;
    ([a, b], [of_a, of_b])
}

#[test]
fn a_sensor_that_feels_something_at_few_samples_is_on_the_part_that_makes_it_likely() {
    let (parts, sensors) = two_parts();
    let surprise = |part: usize, roots: &[f64]| parts[part].surprise(roots, &[1e-12; 300]).unwrap();
    let right = |own: usize| {
        let is_right = |roots: &&Vec<f64>| surprise(own, roots) < surprise(1 - own, roots);
        sensors[own].iter().filter(is_right).count()
    };
    // Of 80, by chance 40: with one to four samples, the motion of each part leaves nothing.
    let right = right(0) + right(1);
    assert!(right >= 68, "{right} of 80");
}

#[test]
fn missing_values_and_nothing_felt_have_an_evidence() {
    let (parts, _) = two_parts();
    for roots in [[0.0; 300], [f64::NAN; 300]] {
        assert!(parts[0].surprise(&roots, &[1e-12; 300]).unwrap().is_finite());
    }
}
