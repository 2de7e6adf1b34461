//! Sample the component of each point given all components and their weights (equation 15).
//!
//! Most components are far from most points. The squared distance of a point to a component is a sum of
//! squares, so it is left as soon as it is known to be too large to matter. Where neighbours in the list of
//! points are neighbours on the body, that takes 40 % off a sweep.

use rand::distr::weighted::WeightedIndex;
use rand::{Rng, RngExt};

use super::gaussian::Gaussian;
use super::points::{BLOCK, Points};
use crate::numerics::simd::vectorised;

/// A number for each point of a block.
type Block = [f64; BLOCK];

/// A weight of this logarithm or less, in a sum that holds a 1, is below the resolution of a uniform random
/// number (2⁻⁵³) even 3000 times over.
const NEGLIGIBLE: f64 = -45.0;

/// A weight of this logarithm or less may be of densities that underflow.
const MAY_UNDERFLOW: f64 = -700.0;

/// Draws z_i ~ Categorical ∝ π_k N(x_i; μ_k, Σ_k) for each point, and overwrites `labels` with it.
///
/// With `underflow`, weights are products of densities, not sums of their logarithms: a point at which all of them are 0
/// in floating point keeps its label.
pub fn draw_labels(
    points: &Points,
    gaussians: &[Gaussian],
    log_weights: &[f64],
    underflow: bool,
    labels: &mut [usize],
    rng: &mut impl Rng,
) {
    let mut far = Vec::new();
    vectorised(
        #[inline(always)]
        || draw_labels_in_lanes(points, gaussians, log_weights, underflow, labels, &mut far, rng),
    );
    // Points at which all densities are tiny are few, but at the beginning of a chain.
    if !far.is_empty() {
        let largest = log_weights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let weights: Vec<f64> = log_weights.iter().map(|weight| (weight - largest).exp()).collect();
        let total: f64 = weights.iter().sum();
        for (i, before) in far {
            let row = points.row(i);
            let weigh =
                |(gaussian, weight): (&Gaussian, &f64)| gaussian.log_density(row).exp() * (weight / total);
            let products = gaussians.iter().zip(&weights).map(weigh);
            let drawn = WeightedIndex::new(products);
            labels[i] = drawn.map_or(before, |drawn| rng.sample(drawn));
        }
    }
}

/// Does the work of [`draw_labels`], with whichever vector instructions it is compiled for; `far` gets the points whose
/// densities may underflow, with the labels that they had.
///
/// It is long because the loop over a block of points must stay one function that the compiler vectorises: calls
/// between its steps would pass whole blocks through memory.
#[inline(always)]
fn draw_labels_in_lanes(
    points: &Points,
    gaussians: &[Gaussian],
    log_weights: &[f64],
    underflow: bool,
    labels: &mut [usize],
    far: &mut Vec<(usize, usize)>,
    rng: &mut impl Rng,
) {
    // The components that matter to some point of the block, with its log weights.
    let mut near: Vec<(usize, Block)> = Vec::with_capacity(gaussians.len());
    let mut cumulative = vec![0.0; gaussians.len()];
    for ((at, block), labels) in points.blocks().enumerate().zip(labels.chunks_mut(BLOCK)) {
        near.clear();
        let mut largest = [f64::NEG_INFINITY; BLOCK];
        // First one that is likely close, so that the others are left early.
        let first = labels[labels.len() / 2];
        for k in std::iter::once(first).chain((0..gaussians.len()).filter(|k| *k != first)) {
            let peak = gaussians[k].log_peak + log_weights[k];
            let mut limits = [0.0; BLOCK];
            for lane in 0..BLOCK {
                limits[lane] = 2.0 * (peak - largest[lane] - NEGLIGIBLE);
            }
            if let Some(squares) = squares(block, &gaussians[k], &limits) {
                let mut logs = [0.0; BLOCK];
                for lane in 0..BLOCK {
                    logs[lane] = peak - 0.5 * squares[lane];
                    largest[lane] = if logs[lane] > largest[lane] { logs[lane] } else { largest[lane] };
                }
                near.push((k, logs));
            }
        }
        if underflow {
            let lanes = labels.iter().enumerate().filter(|(lane, _)| largest[*lane] < MAY_UNDERFLOW);
            far.extend(lanes.map(|(lane, label)| (at * BLOCK + lane, *label)));
        }
        // Nothing is left to chance in most blocks of a body: 8 % of a sweep.
        if let [(only, _)] = near[..] {
            labels.fill(only);
            continue;
        }
        for (lane, label) in labels.iter_mut().enumerate() {
            let mut total = 0.0;
            for (sum, (_, logs)) in cumulative.iter_mut().zip(&near) {
                let below = logs[lane] - largest[lane];
                if below > NEGLIGIBLE {
                    total += below.exp();
                }
                *sum = total;
            }
            let threshold = rng.random::<f64>() * total;
            let drawn = cumulative[..near.len()].partition_point(|sum| *sum <= threshold);
            *label = near[drawn.min(near.len() - 1)].0;
        }
    }
}

/// log N(x_i; μ, Σ) of each point.
pub(crate) fn log_densities(points: &Points, gaussian: &Gaussian) -> Vec<f64> {
    let mut densities = Vec::with_capacity(points.count.next_multiple_of(BLOCK));
    vectorised(
        #[inline(always)]
        || {
            for block in points.blocks() {
                let squares = squares(block, gaussian, &[f64::INFINITY; BLOCK]).expect("nothing is above");
                densities.extend(squares.map(|square| gaussian.log_peak - 0.5 * square));
            }
        },
    );
    densities.truncate(points.count);
    densities
}

/// |P (x − μ)|² for each point of a block; `None` as soon as it is known to exceed the limit of every point.
#[inline(always)]
fn squares(block: &[Block], gaussian: &Gaussian, limits: &Block) -> Option<Block> {
    let mut squares = [0.0; BLOCK];
    for i in 0..block.len() {
        let (root, shift) = gaussian.root_row(i);
        let mut whitened = [shift; BLOCK];
        for (root, x) in root.iter().zip(block) {
            for lane in 0..BLOCK {
                whitened[lane] = root.mul_add(x[lane], whitened[lane]);
            }
        }
        for lane in 0..BLOCK {
            squares[lane] = whitened[lane].mul_add(whitened[lane], squares[lane]);
        }
        // Asking after every row would cost more than it spares.
        if i % 2 == 1 || i + 1 == block.len() {
            let mut above = true;
            for lane in 0..BLOCK {
                above &= squares[lane] > limits[lane];
            }
            if above {
                return None;
            }
        }
    }
    Some(squares)
}

#[cfg(test)]
mod tests;
