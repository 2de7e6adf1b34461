//! Sample the second point of a split–merge move: half of the time anywhere, half of the time near the first.
//!
//! That depends on the points alone, not on the state of a chain, so that it does not enter the acceptance ratio. Clusters
//! that should be one lie side by side, and a pair of neighbours is likely to have a point in each.

use rand::seq::IndexedRandom;
use rand::{Rng, RngExt};

use crate::stages::mixture::Points;

/// Neighbours of a point.
const NEAR: usize = 60;

/// The nearest points of each point.
pub(crate) struct Neighbours {
    near: Vec<Vec<u32>>,
}

impl Neighbours {
    /// Of some points.
    pub(crate) fn of(points: &Points) -> Self {
        let near = |i: usize| {
            let mut others: Vec<(f64, u32)> = (0..points.count)
                .filter(|&j| j != i)
                .map(|j| {
                    let pairs = points.row(i).iter().zip(points.row(j));
                    (pairs.map(|(x, y)| (x - y).powi(2)).sum(), j as u32)
                })
                .collect();
            let kept = NEAR.min(others.len());
            if kept < others.len() {
                others.select_nth_unstable_by(kept, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            }
            let mut near: Vec<u32> = others[..kept].iter().map(|(_, j)| *j).collect();
            near.sort_unstable();
            near
        };
        Self { near: (0..points.count).map(near).collect() }
    }

    /// Draws another point than `first`; `None` if there is none.
    pub(crate) fn second(&self, first: usize, rng: &mut impl Rng) -> Option<usize> {
        let near = self.near[first].choose(rng)?;
        if rng.random::<bool>() {
            return Some(*near as usize);
        }
        let other = rng.random_range(0..self.near.len() - 1);
        Some(if other < first { other } else { other + 1 })
    }
}
