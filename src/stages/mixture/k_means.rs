//! Cluster points by k-means: Lloyd's algorithm from the best of several k-means++ starts (section 5.2).
//!
//! Lloyd (1982), "Least squares quantization in PCM"; Arthur & Vassilvitskii (2007), "k-means++: the
//! advantages of careful seeding". Ours is scikit-learn's with `tol=0`, except that it sums the squares of
//! differences, which loses no digits.

use rand::distr::Distribution;
use rand::distr::weighted::WeightedIndex;
use rand::{Rng, RngExt};

use super::points::Points;
use crate::numerics::interrupt;
use crate::numerics::rng::Stream;
use crate::stages::body_map::BodyMap;

/// Maximum number of iterations of Lloyd's algorithm.
const MAX_ITERATIONS: usize = 1000;

/// Points in clusters, each point in that of the nearest mean.
#[derive(Debug, Clone, PartialEq)]
pub struct Partition {
    /// The cluster of each of the n points.
    pub labels: Vec<usize>,
    /// Inertia: the sum of squared distances of the points from the means of their clusters.
    pub inertia: f64,
}

/// The partition of least inertia from `restarts` starts; the earliest of equal ones.
pub fn k_means(map: &BodyMap, clusters: usize, restarts: usize, rng: &mut Stream) -> Partition {
    let points = Points::new(map);
    (0..restarts.max(1))
        .map(|_| lloyd(&points, clusters, rng))
        .min_by(|a, b| a.inertia.total_cmp(&b.inertia))
        .expect("there is at least one start")
}

/// Lloyd's algorithm from one start: assigns points to the nearest centre and moves centres to the means of
/// their points until no label changes.
pub(crate) fn lloyd(points: &Points, clusters: usize, rng: &mut impl Rng) -> Partition {
    let mut centres = starts(points, clusters, rng);
    let mut labels = Vec::new();
    let mut inertia = 0.0;
    for _ in 0..MAX_ITERATIONS {
        interrupt::check();
        let nearest = (0..points.count).map(|i| nearest(points.row(i), &centres));
        let (assigned, squares): (Vec<usize>, Vec<f64>) = nearest.unzip();
        inertia = squares.iter().fold(0.0, |sum, square| sum + square);
        if assigned == labels {
            break;
        }
        labels = assigned;
        move_to_means(&mut centres, points, &labels);
    }
    Partition { labels, inertia }
}

/// k-means++: the first centre is any point, each further one a point drawn in proportion to its squared
/// distance from the nearest centre so far. Of 2 + ⌊ln K⌋ such draws the one that leaves the least sum of
/// squares is taken, the variant at the end of Arthur & Vassilvitskii's paper.
///
/// There are fewer than K centres if all points coincide with one of fewer.
fn starts(points: &Points, clusters: usize, rng: &mut impl Rng) -> Vec<Vec<f64>> {
    if points.count == 0 {
        return Vec::new();
    }
    let candidates = 2 + (clusters.max(1) as f64).ln() as usize;
    let first = points.row(rng.random_range(0..points.count));
    let mut centres = vec![first.to_vec()];
    let mut squares: Vec<f64> = (0..points.count).map(|i| square(points.row(i), first)).collect();
    while centres.len() < clusters
        && let Ok(weights) = WeightedIndex::new(&squares)
    {
        let draws = (0..candidates).map(|_| {
            let centre = points.row(weights.sample(rng));
            let left: Vec<f64> =
                squares.iter().enumerate().map(|(i, old)| old.min(square(points.row(i), centre))).collect();
            (left.iter().sum::<f64>(), centre, left)
        });
        let (_, centre, left) =
            draws.min_by(|a, b| a.0.total_cmp(&b.0)).expect("there are at least two candidates");
        centres.push(centre.to_vec());
        squares = left;
    }
    centres
}

/// Moves each centre to the mean of its points. A centre that has none left starts again at the point that
/// is farthest from all other centres.
fn move_to_means(centres: &mut [Vec<f64>], points: &Points, labels: &[usize]) {
    let mut sums = vec![vec![0.0; points.dims]; centres.len()];
    let mut counts = vec![0.0; centres.len()];
    for (i, &label) in labels.iter().enumerate() {
        counts[label] += 1.0;
        sums[label].iter_mut().zip(points.row(i)).for_each(|(sum, x)| *sum += x);
    }
    for ((centre, sum), &count) in centres.iter_mut().zip(&sums).zip(&counts) {
        if count > 0.0 {
            centre.iter_mut().zip(sum).for_each(|(mean, sum)| *mean = sum / count);
        }
    }
    for empty in (0..centres.len()).filter(|&k| counts[k] == 0.0) {
        let others: Vec<&Vec<f64>> = centres
            .iter()
            .enumerate()
            .filter(|&(k, _)| k < empty || counts[k] > 0.0)
            .map(|(_, c)| c)
            .collect();
        let distance = |i: &usize| nearest(points.row(*i), &others).1;
        let farthest = (0..points.count).max_by(|i, j| distance(i).total_cmp(&distance(j)));
        let farthest = farthest.expect("a centre is that of a point at first");
        centres[empty] = points.row(farthest).to_vec();
    }
}

/// The nearest centre, the first of equally near ones, and its squared distance.
fn nearest(x: &[f64], centres: &[impl AsRef<[f64]>]) -> (usize, f64) {
    let squares = centres.iter().map(|centre| square(x, centre.as_ref()));
    squares.enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).expect("there is at least one centre")
}

/// Squared distance.
fn square(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| (x - y).powi(2)).sum()
}

#[cfg(test)]
mod tests;
