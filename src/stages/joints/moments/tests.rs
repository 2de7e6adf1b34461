use rand::RngExt;

use super::*;
use crate::numerics::rng::stream;

/// Two planar parts whose frames rotate against each other at random, and which share the velocity of a joint; and a third
/// that shares nothing. Each feels two components of its velocity, and its angular velocity.
fn motions(samples: usize) -> Vec<MotionSubspace> {
    let mut rng = stream(1, 1, "moments", 0);
    let mut bases = vec![Vec::new(); 3];
    for _ in 0..samples {
        let mut uniform = || rng.random_range(-1.0..1.0);
        let (joint, angle, rates) = ([uniform(), uniform()], 3.0 * uniform(), [uniform(), uniform()]);
        let (sine, cosine) = f64::sin_cos(angle);
        let turned = [cosine * joint[0] - sine * joint[1], sine * joint[0] + cosine * joint[1]];
        // v = the joint's velocity − ω × l, with l along x.
        bases[0].extend([joint[0], joint[1] - 0.7 * rates[0], rates[0]]);
        bases[1].extend([turned[0], turned[1] + 0.4 * rates[1], rates[1]]);
        bases[2].extend([uniform(), uniform(), uniform()]);
    }
    bases.into_iter().map(|basis| MotionSubspace { rank: 3, basis }).collect()
}

#[test]
fn parts_that_share_a_joint_feel_its_speed() {
    let motions = motions(5000);
    let moments = Moments::new(&motions, 5000, 7, &Parameters::default());
    let found = moments.dependence().correlations;
    // The ridge takes some thousandths.
    assert!(found[(0, 1)] > 0.995, "{found}");
    assert!(found[(0, 2)] < 0.95 && found[(1, 2)] < 0.95, "{found}");
    assert!(found == found.transpose());
    // No linear form of the one is one of the other: the joint bends.
    let column = |part: usize, at: usize| motions[part].basis.iter().skip(at).step_by(3).copied();
    let product = |a: usize, b: usize| column(0, a).zip(column(1, b)).map(|(x, y)| x * y).sum::<f64>();
    assert!((0..3).all(|a| (0..3).all(|b| product(a, b).abs() < 0.15 * 5000.0 / 3.0)));
}

#[test]
fn a_speed_is_not_the_difference_of_two_squares() {
    // The first part lacks a component of its motion, and the second one has it instead: only a difference of two squares
    // agrees.
    let motions = motions(5000);
    let components = |part: usize, at: &[usize]| -> Vec<Vec<f64>> {
        at.iter().map(|at| motions[part].basis.iter().skip(*at).step_by(3).copied().collect()).collect()
    };
    let together = |columns: Vec<Vec<f64>>| MotionSubspace {
        rank: columns.len(),
        basis: (0..5000)
            .flat_map(|t| columns.iter().map(move |column| column[t]).collect::<Vec<_>>())
            .collect(),
    };
    let lacks = together(components(0, &[1, 2]));
    let has = together([components(1, &[0, 1, 2]), components(0, &[0])].concat());
    let correlation = |a: MotionSubspace, b: MotionSubspace| {
        Moments::new(&[a, b], 5000, 1, &Parameters::default()).dependence().correlations[(0, 1)]
    };
    let right = correlation(motions[0].clone(), motions[1].clone());
    let wrong = correlation(lacks, has);
    assert!(wrong < right - 0.02, "{wrong} {right}");
}

#[test]
fn a_part_that_feels_nothing_correlates_with_none() {
    let mut motions = motions(100);
    motions.push(MotionSubspace { rank: 0, basis: Vec::new() });
    motions[1].basis.fill(0.0);
    let found = Moments::new(&motions, 100, 2, &Parameters::default()).dependence().correlations;
    assert_eq!((found[(0, 3)], found[(0, 1)]), (0.0, 0.0));
    assert!(found.iter().all(|cosine| (0.0..=1.0).contains(cosine)));
}
