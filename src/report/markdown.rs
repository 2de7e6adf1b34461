//! Write tables and numbers in Markdown.

use std::fmt::Display;

/// A row of a table.
pub fn row<T: Display>(cells: impl IntoIterator<Item = T>) -> String {
    let cells: Vec<String> =
        cells.into_iter().map(|cell| cell.to_string().replace('\n', " ").replace('|', r"\|")).collect();
    format!("| {} |", cells.join(" | "))
}

/// The line between the header and the rows of a table.
pub fn rule(columns: usize) -> String {
    format!("|{}", "---|".repeat(columns))
}

/// A value with three decimals at most; a dash where there is no value.
pub fn number(value: Option<f64>) -> String {
    // Adding zero turns -0 into 0.
    value.map_or("–".to_owned(), |value| format!("{}", (value * 1e3).round() / 1e3 + 0.0))
}
