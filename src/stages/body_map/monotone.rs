//! Fit numbers that only keep an order to the distances within a map: the disparities of nonmetric scaling (Kruskal 1964).

use std::iter::repeat_n;
use std::ops::Range;

use rayon::prelude::*;

use crate::stages::distance::Distances;

/// Disparities by monotone regression.
///
/// Pairs at equal distances may have any disparities (Kruskal's primary approach to ties), which is the monotone
/// regression with such pairs in the order of their distances within the map. The sum of squares is that of the
/// distances within the first map: so the scale is that map's, whatever the unit of the given distances, of which only
/// the order matters.
#[derive(Debug)]
pub(super) struct Monotone {
    /// Where each pair i < j stands in an n × n matrix, by rising distance.
    order: Vec<usize>,
    /// n × n: where the pair stands in `order`; on the diagonal, the length of `order`.
    ranks: Vec<usize>,
    /// Where pairs in `order` are at equal distances.
    ties: Vec<Range<usize>>,
    /// Σ d̂² over pairs.
    squares: f64,
    /// Room for the distances within a map in `order`, their pools, and what they are fitted by.
    values: Vec<f64>,
    pools: Vec<Pool>,
    fitted: Vec<f64>,
    /// n × n, d̂.
    pub disparities: Vec<f64>,
    /// Σ (fit − d)² over pairs, of the regression as it is before it is scaled.
    pub residual: f64,
}

impl Monotone {
    /// In: the given distances, which must be symmetric; those within the first map, n × n, and the sum of their squares over
    /// pairs.
    pub(super) fn new(distances: &Distances, within: &[f64], squares: f64) -> Self {
        let (n, given) = (distances.sensors, &distances.values);
        let mut order: Vec<usize> = (0..n).flat_map(|i| (i + 1..n).map(move |j| i * n + j)).collect();
        order.par_sort_unstable_by(|&a, &b| given[a].total_cmp(&given[b]).then(a.cmp(&b)));
        let mut ranks = vec![order.len(); n * n];
        (0..order.len()).for_each(|rank| rank_pair(&mut ranks, order[rank], rank));
        let mut ties = Vec::new();
        let mut start = 0;
        for block in order.chunk_by(|&a, &b| given[a] == given[b]) {
            if block.len() > 1 {
                ties.push(start..start + block.len());
            }
            start += block.len();
        }
        let [values, fitted] = [Vec::new(), Vec::new()];
        let (pools, disparities) = (Vec::new(), vec![0.0; n * n]);
        let mut monotone =
            Self { order, ranks, ties, squares, values, pools, fitted, disparities, residual: 0.0 };
        monotone.fit(within);
        monotone
    }

    /// Regresses the distances within a map on the order of the given ones.
    pub(super) fn fit(&mut self, within: &[f64]) {
        for tie in &self.ties {
            let by_distance = |a: &usize, b: &usize| within[*a].total_cmp(&within[*b]).then(a.cmp(b));
            self.order[tie.clone()].sort_unstable_by(by_distance);
            tie.clone().for_each(|rank| rank_pair(&mut self.ranks, self.order[rank], rank));
        }
        self.order.par_iter().map(|&pair| within[pair]).collect_into_vec(&mut self.values);
        self.values.par_iter().map(|value| Pool::of(*value)).collect_into_vec(&mut self.pools);
        let fitted = &mut self.fitted;
        fitted.clear();
        isotonic(&mut self.pools).iter().for_each(|pool| fitted.extend(repeat_n(pool.mean, pool.count)));
        self.residual = fitted.iter().zip(&self.values).map(|(fit, value)| (fit - value).powi(2)).sum();
        let squares: f64 = fitted.iter().map(|fit| fit.powi(2)).sum();
        let scale = if squares > 0.0 { (self.squares / squares).sqrt() } else { 0.0 };
        // The ranks of the diagonal point one beyond the last pair.
        fitted.push(0.0);
        let pairs = self.disparities.par_iter_mut().zip(&self.ranks);
        pairs.for_each(|(disparity, rank)| *disparity = scale * fitted[*rank]);
    }
}

/// Notes the rank of a pair, at both places that it has.
fn rank_pair(ranks: &mut [usize], pair: usize, rank: usize) {
    let n = ranks.len().isqrt();
    (ranks[pair], ranks[pair % n * n + pair / n]) = (rank, rank);
}

/// Values that share a mean.
#[derive(Debug, Clone, Copy)]
struct Pool {
    sum: f64,
    count: usize,
    mean: f64,
}

impl Pool {
    fn of(value: f64) -> Self {
        Self { sum: value, count: 1, mean: value }
    }

    fn with(self, other: Self) -> Self {
        let (sum, count) = (self.sum + other.sum, self.count + other.count);
        Self { sum, count, mean: sum / count as f64 }
    }
}

/// Pools of the rising sequence that is nearest to these by least squares: neighbours that fall are pooled, first those
/// of each stretch, then what comes of these. They stand where those that were given began.
fn isotonic(pools: &mut [Pool]) -> &[Pool] {
    /// Pools of a stretch; threads may take one each.
    const STRETCH: usize = 1 << 14;
    let counts: Vec<usize> = pools.par_chunks_mut(STRETCH).map(pooled).collect();
    let mut end = 0;
    for (stretch, count) in counts.into_iter().enumerate() {
        let start = stretch * STRETCH;
        pools.copy_within(start..start + count, end);
        end += count;
    }
    let count = pooled(&mut pools[..end]);
    &pools[..count]
}

/// Pools neighbours that fall; returns how many pools there are at the beginning, which rise.
fn pooled(pools: &mut [Pool]) -> usize {
    let mut count = 0;
    for at in 0..pools.len() {
        let mut pool = pools[at];
        while count > 0 && pools[count - 1].mean > pool.mean {
            pool = pools[count - 1].with(pool);
            count -= 1;
        }
        pools[count] = pool;
        count += 1;
    }
    count
}

#[cfg(test)]
mod tests;
