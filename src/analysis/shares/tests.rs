use super::*;
use crate::numerics::rng::stream;

#[test]
fn a_share_has_the_interval_of_its_movements_not_of_its_specifications() {
    // Ten movements of a hundred specifications that all agree: as much as ten coin throws say.
    let held: Vec<Held> = (0..1000).map(|at| Held { movement: at / 100, holds: at / 100 % 2 == 0 }).collect();
    let found = share(&held, &mut stream(1, 0, "shares", 0));
    assert_eq!((found.value, found.simulations), (Some(0.5), 10));
    let (low, high) = found.interval.unwrap();
    assert!((0.1..=0.3).contains(&low) && (0.7..=0.9).contains(&high), "{low} to {high}");
    // What holds nowhere may hold somewhere: the upper end of Wilson's interval for 0 of 10 is 0.278.
    let never: Vec<Held> = held.iter().map(|one| Held { holds: false, ..*one }).collect();
    let (low, high) = share(&never, &mut stream(1, 0, "shares", 0)).interval.unwrap();
    assert!(low == 0.0 && (high - 0.2775).abs() < 0.001, "{low} to {high}");
}

/// 200 specifications of 50 movements, with two bodies of ten posterior samples each.
fn rates(right: impl FnMut(usize) -> [usize; 2]) -> Vec<Rate> {
    let bodies = (0..200).map(right).map(|[one, other]| vec![(one, 10), (other, 10)]);
    bodies.enumerate().map(|(at, bodies)| Rate { movement: at / 4, bodies }).collect()
}

fn inference(rates: &[Rate]) -> JointInference {
    joint_inference(rates, 0.85, (0.75, 0.95), &mut stream(1, 0, "joint", 0)).unwrap()
}

#[test]
fn a_multiverse_drawn_from_the_rate_looks_like_it_and_another_does_not() {
    let mut rng = stream(2, 0, "joint", 0);
    let binomial = Binomial::new(10, 0.85).unwrap();
    let drawn = rates(|_| [0; 2].map(|_| binomial.sample(&mut rng) as usize));
    let found = inference(&drawn);
    // Of 20 posterior samples at 0.85 between 15 and 19 are right with probability 0.894 (binomial distribution).
    assert!((found.expected - 0.894).abs() < 0.03 && found.correlation < 0.05, "{found:?}");
    // At the level that all statistical tests here have.
    assert!((0.001..0.999).contains(&found.as_low), "{found:?}");
    let other = inference(&rates(|at| if at % 2 == 0 { [10, 10] } else { [9, 8] }));
    assert!(other.as_low < 0.001 && other.share == 0.5, "{other:?}");
}

#[test]
fn bodies_that_differ_make_fewer_rates_likely_to_be_in_the_range() {
    let alike = inference(&rates(|_| [9, 8]));
    let apart = inference(&rates(|at| if at % 2 == 0 { [10, 7] } else { [6, 10] }));
    assert!(alike.correlation == 0.0 && apart.correlation > 0.1, "{apart:?}");
    assert!(apart.expected < alike.expected && apart.expected_low < alike.expected_low, "{apart:?}");
    assert!(joint_inference(&[], 0.85, (0.75, 0.95), &mut stream(1, 0, "joint", 0)).is_none());
}

#[test]
fn the_correlation_is_that_of_the_beta_distribution_however_uneven_the_draws() {
    let mut rng = stream(3, 0, "joint", 0);
    // Var of Beta(3, 1) over 0.75 × 0.25 is 1 / (3 + 1 + 1).
    let beta = Beta::new(3.0, 1.0).unwrap();
    let mut body = |samples: u64| {
        (Binomial::new(samples, beta.sample(&mut rng)).unwrap().sample(&mut rng) as usize, samples as usize)
    };
    let rates: Vec<Rate> =
        (0..4000).map(|at| Rate { movement: at, bodies: vec![body(16), body(3), body(1)] }).collect();
    assert!((correlation(&rates) - 0.2).abs() < 0.02, "{}", correlation(&rates));
}
