//! Say why a body schema cannot be inferred, before memory for it is asked for.

use crate::stages::mixture::Rounding as RoundingError;

/// Maximum number of entries in one matrix of all components together, 80 MB; a chain holds a few such matrices.
const MAX_MATRIX_ENTRIES: usize = 10_000_000;

/// Maximum number of labels in all posterior samples that are kept, 8 GB.
pub(super) const MAX_LABELS: usize = 1_000_000_000;

/// Whether the d × d matrices of K components fit the memory: K d² is at most 10 million.
pub fn matrices_fit(components: usize, dims: usize) -> bool {
    dims.saturating_mul(dims).saturating_mul(components) <= MAX_MATRIX_ENTRIES
}

/// A body map on which no mixture can be inferred.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum InferenceError {
    /// Matrices too large for the memory.
    #[error(
        "schema.components = {components} in {dims} dimensions take matrices of more than 10 million numbers; use fewer \
         of either"
    )]
    TooManyNumbers {
        /// K.
        components: usize,
        /// d.
        dims: usize,
    },
    /// Posterior samples too large for the memory.
    #[error(
        "{samples} posterior samples of {points} points are more than 1 billion labels; keep fewer (schema.chains, schema.sweeps, \
         schema.keep)"
    )]
    TooManyLabels {
        /// Posterior samples that are kept.
        samples: usize,
        /// n.
        points: usize,
    },
    /// A matrix that is positive definite in exact arithmetic, but not in floating point.
    #[error(
        "the covariance of a component is numerically singular; raise schema.scale, schema.extra_freedom or \
         schema.mean_weight, or use fewer dimensions"
    )]
    Rounding,
    /// Coordinates whose squares overflow or underflow.
    #[error(
        "the points spread over {0:e}, which is too large or too small for floating-point arithmetic; rescale them"
    )]
    Scale(f64),
    /// The points span fewer than d dimensions.
    #[error(
        "the {points} points span fewer than {dims} dimensions, so the prior has no scale there; use fewer dimensions"
    )]
    Flat {
        /// n.
        points: usize,
        /// d.
        dims: usize,
    },
}

impl From<RoundingError> for InferenceError {
    fn from(RoundingError: RoundingError) -> Self {
        Self::Rounding
    }
}
