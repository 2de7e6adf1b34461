//! Write a claim's numbers for people: rates in percent, all else as it is.

use super::markdown::number;
use crate::analysis::published::Unit;

/// A value in its unit; a dash where there is no value.
pub(crate) fn value(value: Option<f64>, unit: Option<Unit>) -> String {
    match (value, unit) {
        (Some(value), Some(Unit::PValue)) if value < 0.001 => "< 0.001".to_owned(),
        (Some(value), Some(Unit::Rate)) => format!("{} %", percent(value)),
        _ => number(value),
    }
}

/// Both ends of a range in their unit; one number if they are equal, and nothing where there is no range.
pub(crate) fn range(ends: Option<(f64, f64)>, unit: Option<Unit>) -> String {
    let Some((low, high)) = ends else { return String::new() };
    let (write, sign): (fn(f64) -> String, &str) = match unit {
        Some(Unit::Rate) => (percent, " %"),
        _ => (|value| number(Some(value)), ""),
    };
    match low == high {
        true => write(low) + sign,
        false => format!("{} to {}{sign}", write(low), write(high)),
    }
}

/// A rate in percent with one decimal, without the sign. Only a rate of exactly 0 or 1 has no decimal, so that a rate
/// that rounds to one of them is told apart.
pub(crate) fn percent(rate: f64) -> String {
    if rate == 0.0 || rate == 1.0 { format!("{}", 100.0 * rate) } else { format!("{:.1}", 100.0 * rate) }
}

/// A whole number with commas between thousands.
pub(crate) fn thousands(number: usize) -> String {
    let digits = number.to_string();
    let groups: Vec<&str> =
        digits.as_bytes().rchunks(3).rev().map(|group| std::str::from_utf8(group).expect("digits")).collect();
    groups.join(",")
}

#[cfg(test)]
mod tests;
