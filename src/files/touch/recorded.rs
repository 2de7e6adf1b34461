//! What a file of pressures holds.

use crate::stages::sense::Tactile;

/// Pressures that were read, and what the file says besides.
#[derive(Debug, Clone, PartialEq)]
pub struct Recorded {
    /// M × T, of any sign; NaN where there is no value, and infinite where there is no finite float32.
    pub tactile: Tactile,
    /// Time between two samples, s, if a column of times tells it.
    pub interval: Option<f64>,
    /// What was guessed, a line each, with the option that says otherwise.
    pub guesses: Vec<String>,
}

/// 0, …, n − 1 without some.
pub(super) fn without(count: usize, left_out: &[usize]) -> Vec<usize> {
    (0..count).filter(|at| !left_out.contains(at)).collect()
}
