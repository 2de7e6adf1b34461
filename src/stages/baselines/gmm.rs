//! Cluster a body map by a Gaussian mixture model, fitted by expectation–maximisation from k-means (section 5.2).
//!
//! Dempster, Laird & Rubin (1977), "Maximum likelihood from incomplete data via the EM algorithm". Each
//! component has its own full covariance. Ours is scikit-learn's `GaussianMixture`, except for the ridge,
//! which is relative to the map, and for components that lose all their points, which are dropped.

use nalgebra::{DMatrix, DVector};

use crate::numerics::interrupt;
use crate::numerics::rng::Stream;
use crate::stages::body_map::BodyMap;
use crate::stages::mixture::assignments::log_densities;
use crate::stages::mixture::{Gaussian, Points, lloyd};

/// Added to the variances of every component, in units of the mean variance of the map's coordinates, so
/// that a component of few points has a density. scikit-learn's default is as large, but absolute: its
/// effect would depend on the unit of the distances.
const RIDGE: f64 = 1e-6;

/// Gain in log likelihood per point below which the iteration ends.
const TOLERANCE: f64 = 1e-8;

/// Maximum number of iterations.
const MAX_ITERATIONS: usize = 1000;

/// Minimum weight of a component, in points; a component of less weight is dropped.
const MIN_WEIGHT: f64 = 1e-12;

/// A fitted mixture, as far as it is used.
#[derive(Debug, Clone, PartialEq)]
pub struct MixtureFit {
    /// The component that each of the n points is most probably from.
    pub labels: Vec<usize>,
    /// log p(x), summed over all points; ∞ if all points coincide.
    pub log_likelihood: f64,
}

/// One component.
struct Component {
    /// log π.
    log_weight: f64,
    /// N(μ, Σ).
    gaussian: Gaussian,
}

/// Fits a Gaussian mixture to a body map (n × d): the fit of greatest likelihood from `restarts` starts, each by a k-means
/// of its own; the earliest of equal ones.
///
/// If all points coincide, or their spread is so large or small that its square is no number, the labels are
/// those of k-means.
pub fn gmm(map: &BodyMap, clusters: usize, restarts: usize, rng: &mut Stream) -> MixtureFit {
    let points = Points::new(map);
    let ridge = ridge(map);
    let mut best: Option<MixtureFit> = None;
    for _ in 0..restarts.max(1) {
        let start = lloyd(&points, clusters, rng).labels;
        let fit = expectation_maximisation(&points, ridge, &start)
            .unwrap_or(MixtureFit { labels: start, log_likelihood: f64::INFINITY });
        if best.as_ref().is_none_or(|best| fit.log_likelihood > best.log_likelihood) {
            best = Some(fit);
        }
    }
    best.expect("there is at least one start")
}

/// What is added to the diagonal of each covariance: a millionth of the mean variance of the coordinates,
/// with divisor n.
pub fn ridge(map: &BodyMap) -> f64 {
    let points = Points::new(map);
    let squares = (0..points.count).flat_map(|i| points.row(i)).fold(0.0, |sum, x| sum + x * x);
    RIDGE * squares / map.coordinates.len().max(1) as f64
}

/// Expectation–maximisation from the components that `labels` give; `None` if a covariance is singular even with its
/// ridge.
fn expectation_maximisation(points: &Points, ridge: f64, labels: &[usize]) -> Option<MixtureFit> {
    if !ridge.is_normal() {
        return None;
    }
    let clusters = labels.iter().max()? + 1;
    let member = |k: usize| labels.iter().map(|label| f64::from(u8::from(*label == k))).collect();
    let mut responsibilities: Vec<Vec<f64>> = (0..clusters).map(member).collect();
    let mut log_likelihood = f64::NEG_INFINITY;
    for _ in 0..MAX_ITERATIONS {
        interrupt::check();
        let components = maximisation(points, &responsibilities, ridge)?;
        let before = log_likelihood;
        (responsibilities, log_likelihood) = expectation(points, &components);
        if (log_likelihood - before).abs() < TOLERANCE * points.count as f64 {
            break;
        }
    }
    let most_probable = |i: usize| {
        let shares = responsibilities.iter().map(|shares: &Vec<f64>| shares[i]).enumerate();
        shares.fold((0, 0.0), |kept, next| if next.1 > kept.1 { next } else { kept }).0
    };
    Some(MixtureFit { labels: (0..points.count).map(most_probable).collect(), log_likelihood })
}

/// The maximisation step: the components of greatest likelihood, given the share of each in each point.
fn maximisation(points: &Points, responsibilities: &[Vec<f64>], ridge: f64) -> Option<Vec<Component>> {
    let weights = responsibilities.iter().map(|shares| shares.iter().sum::<f64>());
    responsibilities
        .iter()
        .zip(weights)
        .filter(|(_, weight)| *weight > MIN_WEIGHT)
        .map(|(shares, weight)| {
            let (mean, mut covariance) = moments(points, shares, weight);
            for k in 0..points.dims {
                covariance[(k, k)] += ridge;
            }
            // Σ = L Lᵀ has the precision Pᵀ P with P = L⁻¹.
            let identity = DMatrix::identity(points.dims, points.dims);
            let root = covariance.cholesky()?.l_dirty().solve_lower_triangular(&identity)?;
            Some(Component {
                log_weight: (weight / points.count as f64).ln(),
                gaussian: Gaussian::new(mean, root),
            })
        })
        .collect()
}

/// Weighted mean and covariance, of which only the lower triangle is made.
fn moments(points: &Points, shares: &[f64], weight: f64) -> (DVector<f64>, DMatrix<f64>) {
    let dims = points.dims;
    // Most shares of most components are exactly 0.
    let members = || (0..points.count).map(|i| (points.row(i), shares[i])).filter(|(_, share)| *share > 0.0);
    let mut mean = DVector::zeros(dims);
    for (x, share) in members() {
        mean.iter_mut().zip(x).for_each(|(sum, x)| *sum += share * x);
    }
    mean /= weight;
    let mut covariance = DMatrix::zeros(dims, dims);
    let mut offset = vec![0.0; dims];
    for (x, share) in members() {
        offset.iter_mut().zip(x.iter().zip(&mean)).for_each(|(offset, (x, mean))| *offset = x - mean);
        for (j, column) in covariance.as_mut_slice().chunks_exact_mut(dims).enumerate() {
            let scaled = share * offset[j];
            column[j..].iter_mut().zip(&offset[j..]).for_each(|(entry, other)| *entry += scaled * other);
        }
    }
    (mean, covariance / weight)
}

/// The expectation step: the share of each component in each point, and the log likelihood of all points.
fn expectation(points: &Points, components: &[Component]) -> (Vec<Vec<f64>>, f64) {
    let weighted = |component: &Component| -> Vec<f64> {
        let densities = log_densities(points, &component.gaussian).into_iter();
        densities.map(|density| density + component.log_weight).collect()
    };
    let mut shares: Vec<Vec<f64>> = components.iter().map(weighted).collect();
    let mut log_likelihood = 0.0;
    for i in 0..points.count {
        // Relative to the largest, which does not underflow.
        let peak = shares.iter().fold(f64::NEG_INFINITY, |kept, shares| kept.max(shares[i]));
        shares.iter_mut().for_each(|shares| shares[i] = (shares[i] - peak).exp());
        let total: f64 = shares.iter().map(|shares| shares[i]).sum();
        shares.iter_mut().for_each(|shares| shares[i] /= total);
        log_likelihood += peak + total.ln();
    }
    (shares, log_likelihood)
}
