//! Weigh on which part a sensor is that feels something at a few samples only.
//!
//! With no more felt samples than c has numbers, any motion explains a sensor. But the many samples at which it feels nothing tell, too:
//! there c · w is not above 0. And its c is like those of the other sensors of its part. So the part of the largest *evidence* counts
//! (MacKay 1992): the probability of what the sensor feels if it is on that part. Its c is taken as normal, with the second moments of the c
//! of the part's sensors. The integral over c is by Laplace's approximation.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::{Cluster, LOADING_ITERATIONS};

/// Least variance of c in any direction, as a share of the mean one.
const RIDGE: f64 = 1e-6;

/// What the sensors of a part say of another one that may be on it.
pub(in super::super) struct Evidence {
    /// w, k × samples.
    motion: DMatrix<f64>,
    /// The inverse of the second moments of c, k × k.
    precision: DMatrix<f64>,
    /// Of the precision.
    log_determinant: f64,
    /// Residual variance of a root.
    variance: f64,
}

impl Cluster {
    /// Of this part, in the units that these scales take roots to: one for each sensor that was searched. Its errors have at least this variance.
    pub(in super::super) fn evidence(&self, scales: &[f64], tolerance: f64) -> Option<Evidence> {
        let (count, k) = self.loadings.shape();
        let own: Vec<f64> = self.representatives.iter().map(|&sensor| scales[sensor]).collect();
        let c = DMatrix::from_fn(count, k, |sensor, at| own[sensor] * self.loadings[(sensor, at)]);
        let mut moments = c.tr_mul(&c) / count as f64;
        let ridge = RIDGE * moments.trace() / k as f64;
        (0..k).for_each(|at| moments[(at, at)] += ridge);
        let factor = Cholesky::new(moments)?;
        let size = own.iter().map(|scale| scale * scale).sum::<f64>() / count as f64;
        Some(Evidence {
            motion: DMatrix::from_fn(k, self.motion.nrows(), |at, t| self.motion[(t, at)]),
            log_determinant: -log_determinant(&factor),
            precision: factor.inverse(),
            variance: size * self.variance().max(tolerance),
        })
    }
}

impl Evidence {
    /// The negative logarithm of the evidence that a sensor with these roots is on the part, but for what is the same for all parts.
    /// `thresholds`: at each sample, the least root that is felt. A root that is NaN is missing.
    pub(in super::super) fn surprise(&self, roots: &[f64], thresholds: &[f64]) -> Option<f64> {
        let w = |t: usize| self.motion.column(t);
        let is_felt = |t: usize| roots[t] >= thresholds[t];
        let mut c = DVector::zeros(self.motion.nrows());
        let mut informative = Vec::new();
        let mut found = None;
        // Each updates which samples are informative.
        for _ in 0..LOADING_ITERATIONS[1] {
            let counts = |t: &usize| is_felt(*t) || w(*t).dot(&c) > roots[*t];
            let now: Vec<usize> = (0..roots.len()).filter(counts).collect();
            if found.is_some() && now == informative {
                break;
            }
            informative = now;
            let (mut squares, mut products) = (self.precision.clone(), DVector::zeros(c.len()));
            for &t in &informative {
                squares.ger(1.0 / self.variance, &w(t), &w(t), 1.0);
                products.axpy(roots[t] / self.variance, &w(t), 1.0);
            }
            let factor = Cholesky::new(squares)?;
            c = factor.solve(&products);
            found = Some(factor);
        }
        let residual: f64 = informative.iter().map(|&t| (roots[t] - w(t).dot(&c)).powi(2)).sum();
        let felt = (0..roots.len()).filter(|&t| is_felt(t)).count();
        let unlikely = residual / self.variance + c.dot(&(&self.precision * &c));
        let spread = log_determinant(&found?) - self.log_determinant;
        Some(0.5 * (unlikely + felt as f64 * self.variance.ln() + spread))
    }
}

fn log_determinant(factor: &Cholesky<f64, Dyn>) -> f64 {
    2.0 * factor.l_dirty().diagonal().iter().map(|value| value.ln()).sum::<f64>()
}

#[cfg(test)]
mod tests;
