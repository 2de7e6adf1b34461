//! Divide sensors into faces: sets that are linked by what they feel alike.
//!
//! Along a curved side each sensor feels much like its neighbours, so that a chain of likeness links them all. The flat ends of
//! a cylinder alone feel its motion along its axis, so that nothing links them to its side, and nothing in their motion says
//! which part they are on.
//!
//! In: [`Roots`] of pressures. Out: sets of sensors.

use faer::Mat;

use super::censored::Roots;

/// Correlation of roots, of either sign, from which on two sensors of a part are on one face, or on opposite ones.
const LINKED: f64 = 0.5;
/// Correlation of roots from which on two sensors feel the same.
const SAME: f64 = 0.8;
/// Correlation, and cosine, of the roots of two sets below which they are opposite: one rests while the other feels.
const OPPOSITE: (f64, f64) = (-0.2, 0.1);
/// Share of the mean square below which a variance is rounding.
const ROUNDING: f64 = 1e-10;

/// The faces that these sensors are on, each with those that are opposite to it. Each is rising, in the order of their first.
pub fn faces(roots: &Roots, sensors: &[usize]) -> Vec<Vec<usize>> {
    linked(roots, sensors, |correlation| correlation.abs() > LINKED)
}

/// The sets of these sensors that feel the same.
pub fn alike(roots: &Roots, sensors: &[usize]) -> Vec<Vec<usize>> {
    linked(roots, sensors, |correlation| correlation > SAME)
}

/// The pairs of sets of which one rests while the other feels, as the two ends of a cylinder do.
pub fn opposites(roots: &Roots, sets: &[&[usize]]) -> Vec<(usize, usize)> {
    let all = sets.concat();
    let likeness = Likeness::new(&roots.select(&all));
    let mut first = 0;
    let places: Vec<Vec<usize>> = sets
        .iter()
        .map(|set| {
            first += set.len();
            (first - set.len()..first).collect()
        })
        .collect();
    let are_opposite = |&(a, b): &(usize, usize)| {
        let (correlation, cosine) = likeness.of(&places[a], &places[b]);
        correlation < OPPOSITE.0 && cosine < OPPOSITE.1
    };
    (0..sets.len()).flat_map(|a| (a + 1..sets.len()).map(move |b| (a, b))).filter(are_opposite).collect()
}

/// The sets of these sensors that links connect, by the correlation of two.
fn linked(roots: &Roots, sensors: &[usize], is_linked: impl Fn(f64) -> bool) -> Vec<Vec<usize>> {
    if sensors.is_empty() {
        return Vec::new();
    }
    let likeness = Likeness::new(&roots.select(sensors));
    let found = connected(sensors.len(), |a, b| is_linked(likeness.of(&[a], &[b]).0));
    found.into_iter().map(|set| set.into_iter().map(|at| sensors[at]).collect()).collect()
}

/// The sets of 0, …, n − 1 that links connect, each rising, in the order of their first.
pub fn connected(n: usize, is_linked: impl Fn(usize, usize) -> bool) -> Vec<Vec<usize>> {
    let mut left: Vec<usize> = (0..n).collect();
    let mut found = Vec::new();
    while !left.is_empty() {
        let mut own = vec![left.remove(0)];
        let mut at = 0;
        while at < own.len() {
            let (near, far): (Vec<usize>, Vec<usize>) =
                left.into_iter().partition(|other| is_linked(own[at], *other));
            left = far;
            own.extend(near);
            at += 1;
        }
        own.sort_unstable();
        found.push(own);
    }
    found
}

/// How much alike sensors feel.
struct Likeness {
    /// Means over times of the products of two sensors' roots.
    products: Mat<f64>,
    /// Means over times of roots.
    means: Vec<f64>,
}

impl Likeness {
    fn new(roots: &Roots) -> Self {
        let (products, means) = roots.moments();
        Self { products, means }
    }

    /// Correlation, and cosine, of the sums of the roots of two sets; 0 where either feels nothing.
    fn of(&self, a: &[usize], b: &[usize]) -> (f64, f64) {
        let product = |a: &[usize], b: &[usize]| -> f64 {
            a.iter().flat_map(|&i| b.iter().map(move |&j| self.products[(i, j)])).sum()
        };
        let mean = |set: &[usize]| -> f64 { set.iter().map(|&sensor| self.means[sensor]).sum() };
        let (both, first, second) = (product(a, b), product(a, a), product(b, b));
        let (mean_a, mean_b) = (mean(a), mean(b));
        // What is left of a constant is rounding.
        let variance = |square: f64, mean: f64| {
            let variance = square - mean * mean;
            if variance > ROUNDING * square { variance } else { 0.0 }
        };
        let variances = variance(first, mean_a) * variance(second, mean_b);
        let ratio = |over: f64, under: f64| if under > 0.0 { over / under.sqrt() } else { 0.0 };
        (ratio(both - mean_a * mean_b, variances), ratio(both, first * second))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_connect_chains() {
        let next = |a: usize, b: usize| a.abs_diff(b) == 2 && a.max(b) < 6;
        assert_eq!(connected(7, next), [vec![0, 2, 4], vec![1, 3, 5], vec![6]]);
    }
}
