//! Group sensors by what they feel: those of one flat face feel the same, and those of opposite faces rest in turn.
//!
//! Along a curved side each sensor feels much like its neighbours, so that a chain of correlations links them all. The flat
//! ends of a cylinder alone feel its motion along its axis. Nothing links them to its side, and nothing in their motion says
//! which part they are on.
//!
//! In: [`Roots`] of pressures. Out: groups of sensors.

use faer::Mat;

use super::roots::Roots;

/// Correlation of roots from which on two sensors feel the same.
const SIMILAR: f64 = 0.8;
/// Correlation and cosine of the roots of two groups below which they are opposite: one rests while the other feels.
const OPPOSITE: (f64, f64) = (-0.2, 0.1);
/// Share of the mean square below which a variance is rounding error.
const ROUNDING: f64 = 1e-10;

/// The groups of these sensors that feel the same: connected components of the graph that links sensors of correlated roots. Each is rising,
/// in the order of their first sensors.
pub(crate) fn similar(roots: &Roots, sensors: &[usize]) -> Vec<Vec<usize>> {
    if sensors.is_empty() {
        return Vec::new();
    }
    let similarity = Similarity::new(&roots.select(sensors));
    let found = connected_components(sensors.len(), |a, b| similarity.of(&[a], &[b]).0 > SIMILAR);
    found.into_iter().map(|group| group.into_iter().map(|at| sensors[at]).collect()).collect()
}

/// The pairs of groups of which one rests while the other feels, as the two ends of a cylinder do.
pub(crate) fn opposite_pairs(roots: &Roots, groups: &[&[usize]]) -> Vec<(usize, usize)> {
    let all = groups.concat();
    let similarity = Similarity::new(&roots.select(&all));
    let mut first = 0;
    let places: Vec<Vec<usize>> = groups
        .iter()
        .map(|group| {
            first += group.len();
            (first - group.len()..first).collect()
        })
        .collect();
    let are_opposite = |&(a, b): &(usize, usize)| {
        let (correlation, cosine) = similarity.of(&places[a], &places[b]);
        correlation < OPPOSITE.0 && cosine < OPPOSITE.1
    };
    (0..groups.len()).flat_map(|a| (a + 1..groups.len()).map(move |b| (a, b))).filter(are_opposite).collect()
}

/// The connected components of 0, …, n − 1, each rising, in the order of their first.
fn connected_components(n: usize, is_linked: impl Fn(usize, usize) -> bool) -> Vec<Vec<usize>> {
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

/// How similar the roots of sensors are.
struct Similarity {
    /// Averages over samples of the products of two sensors' roots.
    products: Mat<f64>,
    /// Averages over samples of roots.
    means: Vec<f64>,
}

impl Similarity {
    fn new(roots: &Roots) -> Self {
        let (products, means) = roots.moments();
        Self { products, means }
    }

    /// Correlation and cosine of the summed roots of two groups; 0 where either feels nothing.
    fn of(&self, a: &[usize], b: &[usize]) -> (f64, f64) {
        let product = |a: &[usize], b: &[usize]| -> f64 {
            a.iter().flat_map(|&i| b.iter().map(move |&j| self.products[(i, j)])).sum()
        };
        let mean = |group: &[usize]| -> f64 { group.iter().map(|&sensor| self.means[sensor]).sum() };
        let (both, first, second) = (product(a, b), product(a, a), product(b, b));
        let (mean_a, mean_b) = (mean(a), mean(b));
        // The variance of a constant is rounding error.
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
        assert_eq!(connected_components(7, next), [vec![0, 2, 4], vec![1, 3, 5], vec![6]]);
    }
}
