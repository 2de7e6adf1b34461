//! Find where a sensor is saturated: it stays at the top of its range, while more is felt than it can say.
//!
//! What a sensor feels peaks for a moment. A range that ends cuts the peaks, so that its last value comes several times in a row, and
//! more often than those just below it.

use rayon::prelude::*;

use crate::stages::sense::Tactile;

/// Fewest samples in a row at the last value.
const RUN: usize = 3;
/// Share of the last value from which on a value is just below it.
const JUST_BELOW: f32 = 0.9;
/// Share of the top of the range that its bottom has at least, if that saturates, too. Less is an offset at rest.
const BOTTOM: f32 = 0.5;
/// Different values up to which nothing is known: near a peak, a sensor of few levels stays at the last one for as long as in the tenth
/// below it. A parabola does so with 40 levels.
const LEVELS: usize = 40;

/// Replaces saturated values by NaN; how many they are, of each sensor.
pub(super) fn without_saturated(tactile: &mut Tactile) -> Vec<usize> {
    let samples = tactile.samples;
    tactile.pressures.par_chunks_exact_mut(samples).map(remove).collect()
}

/// Of one sensor.
fn remove(series: &mut [f32]) -> usize {
    let (top, bottom) = (end(series, 1.0), end(series, -1.0));
    let bottom = bottom.filter(|(value, _)| top.is_none_or(|(top, _)| *value >= BOTTOM * top));
    [(1.0, top), (-1.0, bottom)]
        .into_iter()
        .filter_map(|(sign, end)| Some((sign, end?)))
        .filter(|(sign, end)| is_cut(series, *sign, *end))
        .collect::<Vec<_>>()
        .into_iter()
        .map(|(sign, (value, _))| remove_runs(series, sign * value))
        .sum()
}

/// The last value of the range at one end, times the sign of that end, if it is above 0; and how many of its values are in runs.
fn end(series: &[f32], sign: f32) -> Option<(f32, usize)> {
    let (mut last, mut run, mut in_runs) = (0.0, 0, 0);
    for pressure in series {
        let value = sign * pressure;
        if value > last {
            (last, run, in_runs) = (value, 1, 0);
        } else if value == last && last > 0.0 {
            run += 1;
            in_runs += if run == RUN { RUN } else { usize::from(run > RUN) };
        } else {
            run = 0;
        }
    }
    (last > 0.0).then_some((last, in_runs))
}

/// Whether the range ends there: the last value comes in runs, and more often than those just below.
fn is_cut(series: &[f32], sign: f32, (last, in_runs): (f32, usize)) -> bool {
    let is_below = |pressure: &&f32| (JUST_BELOW * last..last).contains(&(sign * **pressure));
    in_runs > 0 && in_runs > series.iter().filter(is_below).count() && !has_levels(series)
}

/// Whether a sensor has a few different values only.
fn has_levels(series: &[f32]) -> bool {
    let mut levels: Vec<f32> = Vec::new();
    series.iter().filter(|pressure| !pressure.is_nan()).all(|pressure| {
        levels.contains(pressure) || {
            levels.push(*pressure);
            levels.len() <= LEVELS
        }
    })
}

/// Replaces the runs of a value by NaN; how many values they have.
fn remove_runs(series: &mut [f32], value: f32) -> usize {
    let mut removed = 0;
    for own in series.chunk_by_mut(|a, b| a == b).filter(|own| own[0] == value && own.len() >= RUN) {
        removed += own.len();
        own.fill(f32::NAN);
    }
    removed
}

#[cfg(test)]
mod tests;
