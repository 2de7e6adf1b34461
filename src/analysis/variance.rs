//! Say which choices a number depends on: shares of its variance by factor and by pair of factors.
//!
//! A linear model with a constant for each level (analysis of variance with sums of squares of type II) is fitted to all
//! numbers; the share of a factor is ω² (Hays 1963): what the model loses without the factor, less what a factor without
//! effect would take by chance. The share of a pair is that of its interaction, added to all factors alone.

use nalgebra::DVector;
use rayon::prelude::*;

use super::statistics::Estimate;

/// Numbers, and the levels that they were found at.
#[derive(Debug, Clone)]
pub struct Table {
    /// The numbers.
    pub values: Vec<f64>,
    /// What each number shares with others that are not independent of it.
    pub clusters: Vec<usize>,
    /// For each factor the level of each number.
    pub levels: Vec<Vec<usize>>,
}

/// What the variance is shared out to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Source {
    /// A factor.
    Factor(usize),
    /// The interaction of two.
    Pair(usize, usize),
}

impl Table {
    /// The share of the variance of every source, with a 95 % interval by the jackknife over clusters. Without a value
    /// where there are too few numbers, or they do not vary.
    pub fn shares(&self) -> Vec<(Source, Estimate)> {
        let count = self.levels.len();
        let factors = (0..count).map(Source::Factor);
        let pairs = (0..count).flat_map(|a| (a + 1..count).map(move |b| Source::Pair(a, b)));
        let sources: Vec<Source> = factors.chain(pairs).collect();
        sources.par_iter().map(|&source| (source, self.share(source))).collect()
    }

    fn share(&self, source: Source) -> Estimate {
        let mut clusters = self.clusters.clone();
        clusters.sort_unstable();
        clusters.dedup();
        let n = self.values.len();
        let Some(value) = self.omega_squared(source) else { return Estimate::bare(None, n) };
        let left_out: Option<Vec<f64>> =
            clusters.iter().map(|&cluster| self.without(cluster).omega_squared(source)).collect();
        let interval = left_out.filter(|all| all.len() > 1).map(|all| {
            let m = all.len() as f64;
            let mean = all.iter().sum::<f64>() / m;
            let variance = (m - 1.0) / m * all.iter().map(|one| (one - mean).powi(2)).sum::<f64>();
            let half = 1.96 * variance.sqrt();
            ((value - half).max(0.0), (value + half).min(1.0))
        });
        Estimate { value: Some(value), n, interval, ..Estimate::default() }
    }

    fn without(&self, cluster: usize) -> Self {
        let kept: Vec<usize> = (0..self.values.len()).filter(|&at| self.clusters[at] != cluster).collect();
        let of = |all: &[usize]| kept.iter().map(|&at| all[at]).collect::<Vec<_>>();
        Self {
            values: kept.iter().map(|&at| self.values[at]).collect(),
            clusters: of(&self.clusters),
            levels: self.levels.iter().map(|levels| of(levels)).collect(),
        }
    }

    /// ω², not below 0.
    fn omega_squared(&self, source: Source) -> Option<f64> {
        let all: Vec<usize> = (0..self.levels.len()).collect();
        let mut full = self.constant();
        let mut reduced = self.constant();
        for &factor in &all {
            full.extend(self.indicators(factor));
            if source != Source::Factor(factor) {
                reduced.extend(self.indicators(factor));
            }
        }
        if let Source::Pair(a, b) = source {
            let products = |x: &Vec<f64>| {
                self.indicators(b)
                    .into_iter()
                    .map(|y| x.iter().zip(&y).map(|(x, y)| x * y).collect::<Vec<f64>>())
                    .collect::<Vec<_>>()
            };
            full.extend(self.indicators(a).iter().flat_map(products));
        }
        let total = self.residual(&self.constant()).0;
        let (without, rank_without) = self.residual(&reduced);
        let (with, rank) = self.residual(&full);
        let freedom = self.values.len().checked_sub(rank).filter(|left| *left > 0)? as f64;
        if total <= 1e-12 * self.values.iter().map(|value| value * value).sum::<f64>() {
            return None;
        }
        let error = with / freedom;
        let effect = without - with - (rank - rank_without) as f64 * error;
        Some((effect / (total + error)).max(0.0))
    }

    fn constant(&self) -> Vec<Vec<f64>> {
        vec![vec![1.0; self.values.len()]]
    }

    /// A column for each level but the first.
    fn indicators(&self, factor: usize) -> Vec<Vec<f64>> {
        let levels = &self.levels[factor];
        let most = levels.iter().copied().max().unwrap_or(0);
        (1..=most)
            .map(|level| levels.iter().map(|one| f64::from(u8::from(*one == level))).collect())
            .collect()
    }

    /// What least squares leaves of the numbers, Σ of squares, and the rank of the columns.
    fn residual(&self, columns: &[Vec<f64>]) -> (f64, usize) {
        /// A column whose part that the others do not span is shorter than this share of it is spanned by them.
        const SPANNED: f64 = 1e-8;
        let mut left = DVector::from_column_slice(&self.values);
        let mut basis: Vec<DVector<f64>> = Vec::new();
        for column in columns {
            let mut own = DVector::from_column_slice(column);
            let length = own.norm();
            // Twice is enough (Giraud, Langou and Rozloznik 2005).
            for _ in 0..2 {
                for one in &basis {
                    let along = one.dot(&own);
                    own.axpy(-along, one, 1.0);
                }
            }
            if own.norm() > SPANNED * length {
                own /= own.norm();
                let along = own.dot(&left);
                left.axpy(-along, &own, 1.0);
                basis.push(own);
            }
        }
        (left.norm_squared(), basis.len())
    }
}
