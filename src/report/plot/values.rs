//! Check values before they are placed on a picture.

use super::canvas::{PlotError, plot_error};
use crate::settings::MAX_LISTED;

/// Whether all values can be placed on a picture.
pub(super) fn check(
    what: &str,
    values: impl IntoIterator<Item = f64>,
    low: f64,
    high: f64,
) -> Result<(), PlotError> {
    match values.into_iter().find(|value| !(low..=high).contains(value)) {
        Some(value) => plot_error(format!("{what} {value} is not between {low} and {high}")),
        None => Ok(()),
    }
}

/// The different values, in order.
pub(super) fn distinct<T: PartialOrd>(values: impl IntoIterator<Item = T>) -> Vec<T> {
    let mut values: Vec<T> = values.into_iter().collect();
    values.sort_by(|a, b| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal));
    values.dedup_by(|a, b| a == b);
    values
}

/// [`distinct`] values that each need a panel, a style or a column of their own.
pub(super) fn few<T: PartialOrd>(
    what: &str,
    values: impl IntoIterator<Item = T>,
) -> Result<Vec<T>, PlotError> {
    let values = distinct(values);
    if values.len() > MAX_LISTED {
        return plot_error(format!(
            "has {} different values of {what}, but a picture can show at most {MAX_LISTED}",
            values.len()
        ));
    }
    Ok(values)
}
