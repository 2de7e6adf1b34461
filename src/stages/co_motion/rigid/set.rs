//! A set of sensors that may be on one part, with their motion, and what it costs.
//!
//! The cost of a set is what it takes to tell what its sensors feel up to a tolerance: for each component of its motion half
//! the logarithm of 1 and its variance, and for each root beyond these half that of 1 and what is left of it, both over the tolerance
//! (the likelihood of probabilistic principal components, Tipping and Bishop 1999; here over roots that tell something), and
//! half a logarithm of the number of times for each c. Two sets of one part share components, so that one of both costs less.

use super::super::censored::{Fit, Roots};
use super::super::motion::spread;
use crate::numerics::eigen::largest;

/// Sensors of a set that its motion is found from, spread over all.
pub const MAX_SENSORS: usize = 64;
/// What is told of a sensor's squares, as a share of them: what is left beyond costs as noise does, and what is less costs little.
pub const TOLERANCE: f64 = 0.01;

/// A set of sensors.
pub struct Set {
    /// In ascending order.
    pub sensors: Vec<usize>,
    /// Those that the motion is found from.
    pub sample: Vec<usize>,
    /// Their motion.
    pub fit: Fit,
    /// What it takes to tell what they simulate_and_sense, for each time, in nats; see the head of this file.
    pub cost: f64,
}

/// A set of two.
pub fn union(roots: &Roots, a: &Set, b: &Set, rounds: usize) -> Set {
    let mut sensors = [a.sensors.as_slice(), &b.sensors].concat();
    sensors.sort_unstable();
    // Turns that begin with the motions of both would end where these are, which is no better than from the start, and takes
    // pieces of different parts for one.
    set(roots, sensors, a.fit.components().max(b.fit.components()), rounds)
}

/// A set whose motion is found from its sensors in so many turns, with the number of components, of `least` and more, that makes it
/// cost least.
pub fn set(roots: &Roots, sensors: Vec<usize>, least: usize, rounds: usize) -> Set {
    let sample: Vec<usize> = spread(sensors.len(), MAX_SENSORS).map(|at| sensors[at]).collect();
    let own = roots.select(&sample);
    let start = own.start();
    let most = start.components();
    let try_with = |k: usize| {
        let fit = own.fit(&start, k, rounds);
        (cost(&fit, sensors.len()), fit)
    };
    // Costs fall with the number of components, and then rise; one step up may be a start that was not good.
    let mut best = try_with(least.min(most));
    let mut worse = 0;
    for k in best.1.components() + 1..=most {
        let next = try_with(k);
        if next.0 < best.0 {
            (best, worse) = (next, 0);
        } else {
            worse += 1;
        }
        if worse == 2 {
            break;
        }
    }
    let (cost, fit) = best;
    Set { sensors, sample, fit, cost }
}

/// What it takes to tell what a set of sensors feels, for each time, in nats; see the head of this file.
fn cost(fit: &Fit, sensors: usize) -> f64 {
    let times = fit.times() as f64;
    let k = fit.components() as f64;
    // The fit may be of a share of the sensors only.
    let ratio = sensors as f64 / fit.sensors() as f64;
    // Half of the sensors feel a motion, the others its opposite; with signs, all feel it, which adds a constant.
    let scale = ratio / (2.0 * times * TOLERANCE);
    let variances =
        largest(fit.scatter().as_ref(), fit.components()).map_or_else(|_| Vec::new(), |eigen| eigen.values);
    let components: f64 = variances.iter().map(|variance| (scale * variance).max(0.0).ln_1p()).sum();
    let excess = if fit.spare > 0.0 { (fit.residual / fit.spare / TOLERANCE).ln_1p() } else { 0.0 };
    0.5 * (components + ratio * fit.spare * excess + sensors as f64 * k * times.ln() / times)
}
