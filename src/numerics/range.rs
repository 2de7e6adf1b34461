//! Check that a setting is in its range, and name the one that is not.

use std::fmt::Debug;

/// A setting outside its range.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("setting `{key}` is {value}, but must be {range}")]
pub struct OutOfRange {
    /// The setting, `section.key`.
    pub key: &'static str,
    /// Its value.
    pub value: String,
    /// The values it may have, in words.
    pub range: &'static str,
}

/// The outcome of a check.
pub type Checked = Result<(), OutOfRange>;

/// Accepts a value that is `within` its range.
///
/// # Errors
/// [`OutOfRange`] with `key`, the value and `range` if it is not. The other checks of this file return the same error.
pub fn check(key: &'static str, value: impl Debug, within: bool, range: &'static str) -> Checked {
    if within { Ok(()) } else { Err(OutOfRange { key, value: format!("{value:?}"), range }) }
}

/// A number above 0 that is finite.
pub fn positive(key: &'static str, value: f64) -> Checked {
    check(key, value, value.is_finite() && value > 0.0, "a positive, finite number")
}

/// Whether a length in m is within 1 mm to 1 km.
pub fn is_length(value: f64) -> bool {
    (1e-3..=1e3).contains(&value)
}

/// Whether a number is positive and within a factor of a million of 1.
pub fn is_moderate(value: f64) -> bool {
    (1e-6..=1e6).contains(&value)
}

/// A length in m: 1 mm to 1 km. The physics engine computes with it without overflow, and a picture can show it.
pub fn length(key: &'static str, value: f64) -> Checked {
    check(key, value, is_length(value), "0.001 to 1000")
}

/// A positive number within a factor of a million of 1.
pub fn moderate(key: &'static str, value: f64) -> Checked {
    check(key, value, is_moderate(value), "0.000001 to 1000000")
}

/// A gain of a controller, which may be 0.
pub fn gain(key: &'static str, value: f64) -> Checked {
    check(key, value, (0.0..=1e6).contains(&value), "0 to 1000000")
}

/// A number of things, at least one.
pub fn count(key: &'static str, value: usize) -> Checked {
    check(key, value, value >= 1, "at least 1")
}
