//! Measure whether a movement goes on to new states, or repeats itself, and of how many motions it consists.
//!
//! Where all joints keep step in one rhythm, each part's motion is a curve that is passed again and again, and the motions of all parts
//! span nearly the same few functions of its phase. A model of rigid parts then fits well, and says nothing. A loop of a walk repeats
//! itself, too, but of so many motions that parts can be told.

use faer::Mat;
use faer::linalg::matmul::matmul;
use faer::{Accum, Par};

use crate::numerics::eigen::largest;
use crate::stages::rigid_parts::{Roots, median, stratified};
use crate::stages::sense::Tactile;

/// Samples that are compared, spread over all.
const MAX_SAMPLES: usize = 1500;
/// Size below which a sample is left out, as a share of the median: at rest, all samples are alike.
const REST: f64 = 0.1;
/// Squared cosine from which on samples next to each other are of one state.
const SAME: f64 = 0.5;
/// The same of the least alike sample from which on a state has been left.
const LEFT: f64 = 0.9;
/// A movement consists of few motions if at most so many principal components are enough. In one rhythm, 15 were at most (15 bodies of 3 to
/// 13 parts), and in a walk that was looped 55.
const FEW: usize = 30;
/// Share of what sensors feel, each in units of its own, that principal components must explain to be enough.
const EXPLAINED: f64 = 0.99;

/// The median, over samples, of the share of what is felt that the most similar sample leaves: 0 if every state comes again exactly, and 1
/// if none is like another. Samples just before and after, which are of the same state, do not count; speed does not count, either.
///
/// In: M × T pressures, whether negative ones are signal, and some of the sensors. 1 if nothing moves.
pub(super) fn novelty(tactile: &Tactile, signed: bool, sensors: &[usize]) -> f64 {
    let roots = roots(tactile, signed, sensors);
    let size = |t: usize| roots.row(t).norm_l2();
    let sizes: Vec<f64> = (0..roots.nrows()).map(size).collect();
    let least = REST * median(sizes.clone());
    let moving: Vec<(usize, f64)> = sizes.into_iter().enumerate().filter(|(_, size)| *size > least).collect();
    if moving.is_empty() {
        return 1.0;
    }
    let states = Mat::from_fn(sensors.len(), moving.len(), |at, sample| {
        let (t, size) = moving[sample];
        roots[(t, at)] / size
    });
    let mut cosines = Mat::zeros(moving.len(), moving.len());
    matmul(cosines.as_mut(), Accum::Replace, states.transpose(), states.as_ref(), 1.0, Par::Seq);
    let left = |sample: usize| {
        let squares: Vec<f64> =
            (0..moving.len()).map(|other| cosines[(other, sample)] * cosines[(other, sample)]).collect();
        let earlier = other_states(squares[..sample].iter().rev());
        let later = other_states(squares[sample + 1..].iter());
        1.0 - earlier.chain(later).fold(0.0, f64::max)
    };
    median((0..moving.len()).map(left).collect())
}

/// Of the squared cosines of a state with those after it, those of other states: from the first below [`SAME`] on. If none is, from the
/// smallest on, if that is below [`LEFT`]: a slow movement may come back before it has gone that far.
fn other_states<'a>(squares: impl Iterator<Item = &'a f64> + Clone) -> impl Iterator<Item = f64> {
    let smallest = squares.clone().copied().fold(f64::INFINITY, f64::min);
    let ends = move |square: &f64| *square < SAME || (SAME..LEFT).contains(&smallest) && *square == smallest;
    squares.copied().skip_while(move |square| !ends(square))
}

/// Whether few motions explain nearly all of what some sensors feel. In: as for [`novelty`].
pub(super) fn has_few_motions(tactile: &Tactile, signed: bool, sensors: &[usize]) -> bool {
    let mut roots = roots(tactile, signed, sensors);
    for own in roots.col_iter_mut() {
        let size = own.norm_l2().max(f64::MIN_POSITIVE);
        own.iter_mut().for_each(|root| *root /= size);
    }
    let mut products = Mat::zeros(sensors.len(), sensors.len());
    matmul(products.as_mut(), Accum::Replace, roots.transpose(), roots.as_ref(), 1.0, Par::Seq);
    let all: f64 = (0..sensors.len()).map(|at| products[(at, at)]).sum();
    // A quarter of the components of few sensors, which have few in any case.
    let first = largest(products.as_ref(), FEW.min(sensors.len() / 4));
    first.is_ok_and(|first| first.values.iter().sum::<f64>() >= EXPLAINED * all)
}

/// Roots of the pressures on some sensors at some samples, samples × sensors. Where one is missing, the one before.
fn roots(tactile: &Tactile, signed: bool, sensors: &[usize]) -> Mat<f64> {
    let all: Vec<&[f32]> = tactile.series().collect();
    let series: Vec<&[f32]> = sensors.iter().map(|&sensor| all[sensor]).collect();
    let samples: Vec<usize> = stratified(tactile.samples, MAX_SAMPLES).collect();
    let mut roots = Roots::at(&series, &samples, signed).values;
    for own in roots.col_iter_mut() {
        let mut last = 0.0;
        for root in own.iter_mut() {
            if root.is_nan() {
                *root = last;
            }
            last = *root;
        }
    }
    roots
}

#[cfg(test)]
mod tests;
