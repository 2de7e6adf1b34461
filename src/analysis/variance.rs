//! Say which choices a number depends on: shares of its variance by factor and by pair of factors.
//!
//! A linear model with a constant for each level (analysis of variance with sums of squares of type II) is fitted to all
//! numbers; the share of a factor is ω² (Hays 1963): what the model loses without the factor, less what a factor without
//! effect would take by chance. The share of a pair is that of its interaction, added to all factors alone.
//!
//! Numbers of one unit, such as a movement, are alike for more reasons than the factors, and a factor whose level all numbers
//! of a unit share takes of that by chance, too. So its chance is measured between units, as in a split-plot design.

use std::collections::{HashMap, HashSet};

use nalgebra::DVector;
use rayon::prelude::*;

use super::statistics::Estimate;

/// Numbers, and the levels that they were found at.
#[derive(Debug, Clone)]
pub(crate) struct Table {
    /// The numbers.
    pub values: Vec<f64>,
    /// What each number shares with others that are not independent of it.
    pub clusters: Vec<usize>,
    /// For each factor what each number belongs to, within which the factor has one level.
    pub units: Vec<Vec<usize>>,
    /// For each factor the level of each number.
    pub levels: Vec<Vec<usize>>,
}

/// What the variance is shared out to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Source {
    /// A factor.
    Factor(usize),
    /// The interaction of two.
    Pair(usize, usize),
}

impl Table {
    /// The share of the variance of every source, with a 95 % interval by the jackknife over clusters. Without a value
    /// where there are too few numbers, or they do not vary.
    pub(crate) fn shares(&self) -> Vec<(Source, Estimate)> {
        let count = self.levels.len();
        let factors = (0..count).map(Source::Factor);
        let pairs = (0..count).flat_map(|a| (a + 1..count).map(move |b| Source::Pair(a, b)));
        let sources: Vec<Source> = factors.chain(pairs).collect();
        let mut clusters = self.clusters.clone();
        clusters.sort_unstable();
        clusters.dedup();
        let all = self.omega_squared(&sources);
        let left_out: Vec<Vec<Option<f64>>> =
            clusters.par_iter().map(|&cluster| self.without(cluster).omega_squared(&sources)).collect();
        let share = |(at, value): (usize, &Option<f64>)| {
            let others: Option<Vec<f64>> = left_out.iter().map(|shares| shares[at]).collect();
            let interval = value.zip(others).and_then(|(value, others)| jackknife(value, &others));
            Estimate {
                value: value.map(|value| value.max(0.0)),
                n: self.values.len(),
                interval,
                ..Estimate::default()
            }
        };
        sources.into_iter().zip(all.iter().enumerate().map(share)).collect()
    }

    fn without(&self, cluster: usize) -> Self {
        let kept: Vec<usize> = (0..self.values.len()).filter(|&at| self.clusters[at] != cluster).collect();
        let of = |all: &[usize]| kept.iter().map(|&at| all[at]).collect::<Vec<_>>();
        Self {
            values: kept.iter().map(|&at| self.values[at]).collect(),
            clusters: of(&self.clusters),
            units: self.units.iter().map(|units| of(units)).collect(),
            levels: self.levels.iter().map(|levels| of(levels)).collect(),
        }
    }

    /// ω² of each source; below 0 where it takes less than by chance.
    fn omega_squared(&self, sources: &[Source]) -> Vec<Option<f64>> {
        let mut constant = Fit::new(&self.values);
        constant.add(&vec![1.0; self.values.len()]);
        let indicators: Vec<Vec<Vec<f64>>> =
            (0..self.levels.len()).map(|factor| self.indicators(factor)).collect();
        let without = |left_out: Option<usize>| {
            let mut fit = constant.clone();
            let kept = indicators.iter().enumerate().filter(|(factor, _)| Some(*factor) != left_out);
            kept.flat_map(|(_, columns)| columns).for_each(|column| fit.add(column));
            fit
        };
        let main = without(None);
        let total = constant.squares();
        let varies = total > 1e-12 * self.values.iter().map(|value| value * value).sum::<f64>();
        let share = |source: &Source| {
            let (reduced, full) = match *source {
                Source::Factor(factor) => (without(Some(factor)), main.clone()),
                Source::Pair(a, b) => {
                    let mut full = main.clone();
                    for x in &indicators[a] {
                        for y in &indicators[b] {
                            full.add(&x.iter().zip(y).map(|(x, y)| x * y).collect::<Vec<_>>());
                        }
                    }
                    (main.clone(), full)
                }
            };
            let freedom = self.values.len().checked_sub(full.rank()).filter(|left| *left > 0 && varies)?;
            let error = full.squares() / freedom as f64;
            let chance = self.chance(source, &full).unwrap_or(error);
            let effect = reduced.squares() - full.squares() - (full.rank() - reduced.rank()) as f64 * chance;
            Some(effect / (total + error))
        };
        sources.iter().map(share).collect()
    }

    /// Mean square of what is left between the units within which a source has one level; `None` if each number is one.
    fn chance(&self, source: &Source, fit: &Fit) -> Option<f64> {
        let units = match *source {
            Source::Factor(factor) => &self.units[factor],
            // The finer of the two.
            Source::Pair(a, b) => {
                [a, b].map(|factor| &self.units[factor]).into_iter().max_by_key(|units| count(units))?
            }
        };
        let many = count(units);
        if many == units.len() {
            return None;
        }
        let mut sums: HashMap<usize, (f64, f64)> = HashMap::new();
        for (unit, left) in units.iter().zip(fit.left.iter()) {
            let (sum, n) = sums.entry(*unit).or_default();
            (*sum, *n) = (*sum + left, *n + 1.0);
        }
        // In the order of the units, so that every run adds them alike.
        let mut sums: Vec<(usize, (f64, f64))> = sums.into_iter().collect();
        sums.sort_by_key(|(unit, _)| *unit);
        let between: f64 = sums.iter().map(|(_, (sum, n))| sum * sum / n).sum();
        // Factors that have one level in each of these units take degrees of freedom from them.
        let coarse = (0..self.levels.len()).filter(|factor| count(&self.units[*factor]) <= many);
        let taken: usize = coarse.map(|factor| self.levels[factor].iter().max().copied().unwrap_or(0)).sum();
        many.checked_sub(taken + 1).filter(|left| *left > 0).map(|left| between / left as f64)
    }

    /// A column for each level but the first.
    fn indicators(&self, factor: usize) -> Vec<Vec<f64>> {
        let levels = &self.levels[factor];
        let most = levels.iter().copied().max().unwrap_or(0);
        (1..=most)
            .map(|level| levels.iter().map(|one| f64::from(u8::from(*one == level))).collect())
            .collect()
    }
}

/// How many different ones there are.
fn count(units: &[usize]) -> usize {
    units.iter().collect::<HashSet<_>>().len()
}

/// Half a 95 % interval on both sides of a share, from the shares without each cluster.
fn jackknife(value: f64, left_out: &[f64]) -> Option<(f64, f64)> {
    let count = left_out.len() as f64;
    let mean = left_out.iter().sum::<f64>() / count;
    let variance = (count - 1.0) / count * left_out.iter().map(|one| (one - mean).powi(2)).sum::<f64>();
    let half = 1.96 * variance.sqrt();
    (left_out.len() > 1).then(|| ((value - half).clamp(0.0, 1.0), (value + half).clamp(0.0, 1.0)))
}

/// What least squares leaves of some numbers, column after column.
#[derive(Clone)]
struct Fit {
    left: DVector<f64>,
    /// Orthonormal columns.
    basis: Vec<DVector<f64>>,
}

impl Fit {
    fn new(values: &[f64]) -> Self {
        Self { left: DVector::from_column_slice(values), basis: Vec::new() }
    }

    /// Fits one more column, unless the others span it.
    fn add(&mut self, column: &[f64]) {
        /// A column is spanned if the part that is not is shorter than this share of it.
        const SPANNED: f64 = 1e-8;
        let mut own = DVector::from_column_slice(column);
        let length = own.norm();
        // Twice is enough (Giraud, Langou and Rozloznik 2005).
        for _ in 0..2 {
            for one in &self.basis {
                let along = one.dot(&own);
                own.axpy(-along, one, 1.0);
            }
        }
        if own.norm() > SPANNED * length {
            own /= own.norm();
            let along = own.dot(&self.left);
            self.left.axpy(-along, &own, 1.0);
            self.basis.push(own);
        }
    }

    /// Σ of squares of what is left.
    fn squares(&self) -> f64 {
        self.left.norm_squared()
    }

    fn rank(&self) -> usize {
        self.basis.len()
    }
}

#[cfg(test)]
mod tests;
