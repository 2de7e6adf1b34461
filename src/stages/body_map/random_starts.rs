//! Make a body map by metric majorisation (SMACOF) from random starts, step by step as scikit-learn 0.17 to 0.19 does it.
//!
//! Those versions of 2016 to 2017 are what a program of the paper's time ran; later ones stop by another rule. Each start
//! is uniform in [0, 1)ᵈ; a step is the [Guttman transform](Guttman); the last step is that whose raw stress over Σ ‖x_i‖
//! is hardly less than that of the step before. Nothing is rescaled. Of all starts, the map of least raw stress is kept.

use rand::{Rng, RngExt};

use super::coordinates::BodyMap;
use super::guttman::Guttman;
use crate::stages::distance::Distances;

/// Where a descent ended.
#[derive(Debug)]
pub struct Descended {
    /// The map after the last step.
    pub map: BodyMap,
    /// Raw stress before the last step, which decides between starts.
    pub stress: f64,
    /// Steps taken.
    pub steps: usize,
}

/// A map (n × d) that is uniform in [0, 1)ᵈ.
pub fn random_map(points: usize, dims: usize, rng: &mut impl Rng) -> BodyMap {
    BodyMap { dims, coordinates: (0..points * dims).map(|_| rng.random()).collect() }
}

/// Steps down from `start` until a step of at most `steps` lowers raw stress over Σ ‖x_i‖ by less than `tolerance`.
pub fn descend(distances: &Distances, start: &BodyMap, steps: usize, tolerance: f64) -> Descended {
    let mut state = Guttman::new(distances, start);
    let (mut taken, mut stress, mut before) = (0, 0.0, f64::INFINITY);
    while taken < steps {
        stress = state.step();
        taken += 1;
        let relative = stress / state.norms();
        if before - relative < tolerance {
            break;
        }
        before = relative;
    }
    Descended { map: state.map(), stress, steps: taken }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::rng::stream;

    #[test]
    fn a_descent_ends_with_the_first_step_that_gains_too_little() {
        let mut rng = stream(1, 1, "start", 0);
        let points: Vec<f64> = (0..30).map(|_| rng.random()).collect();
        // Not Euclidean in three dimensions.
        let between = |at: usize| (points[at / 30] - points[at % 30]).abs().sqrt();
        let distances = Distances { sensors: 30, values: (0..900).map(between).collect() };
        let start = random_map(30, 3, &mut rng);
        let mut state = Guttman::new(&distances, &start);
        let relative: Vec<f64> = (0..60).map(|_| state.step() / state.norms()).collect();
        for tolerance in [1e-2, 1e-3] {
            let last = 1 + relative.windows(2).position(|pair| pair[0] - pair[1] < tolerance).unwrap();
            assert_eq!(descend(&distances, &start, 300, tolerance).steps, last + 1);
            assert!(last > 2);
        }
        assert_eq!(descend(&distances, &start, 2, 1e-3).steps, 2);
    }
}
