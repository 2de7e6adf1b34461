//! Take off what rounding added to numbers on the way.

use crate::stages::agent::Vector3;

/// Without what rounding added on the way: 0.3 for 0.30000000000000004.
pub(super) fn rounded(numbers: impl Into<Vector3>) -> Vector3 {
    numbers.into().map(round)
}

/// A number to twelve places.
pub(super) fn round(number: f64) -> f64 {
    // A negative zero becomes zero.
    (number * 1e12).round() / 1e12 + 0.0
}

/// Without what rounding added to a product: twelve digits.
pub(super) fn significant(number: f64) -> f64 {
    format!("{number:.11e}").parse().unwrap_or(number)
}
