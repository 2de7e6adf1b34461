//! Find which share of what a sensor feels the motion of a cluster leaves unexplained.

use faer::{Mat, MatRef};
use rayon::prelude::*;

use super::{Cluster, LOADING_ITERATIONS};
use crate::stages::rigid_parts::als::{Als, by_sensor};
use crate::stages::rigid_parts::regressions::LANES;
use crate::stages::rigid_parts::roots::Roots;

impl Cluster {
    /// The residual of each of any sensors at the same samples: the share of its sum of squares that this motion leaves unexplained, 1 if
    /// it feels nothing.
    pub(in super::super) fn shares(&self, roots: &Roots) -> Vec<f64> {
        let firsts: Vec<usize> = (0..roots.sensors()).step_by(LANES).collect();
        let values = |first: usize| roots.values.subcols(first, LANES.min(roots.sensors() - first));
        firsts
            .into_par_iter()
            .flat_map_iter(|first| self.shares_of(values(first), &roots.thresholds))
            .collect()
    }

    /// The same of some sensors, samples × sensors, which are felt from the threshold of their sample on.
    fn shares_of(&self, roots: MatRef<'_, f64>, thresholds: &[f64]) -> Vec<f64> {
        let als = Als::new(roots, thresholds);
        let mut loadings = Mat::zeros(roots.ncols(), self.rank());
        // An update depends on the loadings alone: where one changes nothing, none does.
        for _ in 0..LOADING_ITERATIONS[1] {
            let before = loadings.clone();
            als.update_loadings(loadings.as_mut(), &self.motion);
            if loadings == before {
                break;
            }
        }
        let residuals = als.residuals(loadings.as_ref(), &self.motion);
        let share = |(own, [residual, _]): (&[f64], [f64; 2])| {
            let felt = own.iter().zip(thresholds).filter(|(root, least)| root >= least);
            let all: f64 = felt.map(|(root, _)| root * root).sum();
            if all > 0.0 { residual / all } else { 1.0 }
        };
        by_sensor(roots).into_iter().zip(residuals).map(share).collect()
    }
}

#[cfg(test)]
mod tests;
