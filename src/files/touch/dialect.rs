//! Guess from the first rows of a table what is between its cells, and what its decimals begin with.

use super::format::{Decimal, Format, Separator};

/// How a table is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Dialect {
    pub separator: Separator,
    pub decimal: Decimal,
    /// Whether one of them was guessed and is none of commas and points.
    pub is_guess: bool,
}

/// Rows that are looked at.
const ROWS: usize = 50;

impl Dialect {
    /// Of a table that begins with this text, as far as the user does not say.
    pub(super) fn of(head: &[u8], format: &Format) -> Self {
        let text = String::from_utf8_lossy(head);
        let mut rows: Vec<&str> = text
            .split(['\r', '\n'])
            .map(str::trim)
            .filter(|row| !row.is_empty() && !row.starts_with(['#', '%']))
            .take(ROWS)
            .collect();
        // The last may be cut off.
        if rows.len() > 2 && !text.ends_with(['\r', '\n']) {
            rows.pop();
        }
        // The first may have names, which have any characters.
        let numbers = if rows.len() > 2 { &rows[1..] } else { &rows[..] };
        let separator = format.separator.unwrap_or_else(|| separator(numbers));
        let decimal = format.decimal.unwrap_or_else(|| decimal(&rows, separator));
        let is_guess = format.separator.is_none() && separator != Separator::Comma
            || format.decimal.is_none() && decimal == Decimal::Comma;
        Self { separator, decimal, is_guess }
    }
}

fn separator(rows: &[&str]) -> Separator {
    let most = |has: &dyn Fn(&str) -> bool| 2 * rows.iter().filter(|row| has(row)).count() > rows.len();
    // `1,5 2,5`: commas within numbers, and blanks between them.
    let has_decimal_commas = |row: &str| {
        let mut cells = row.split_whitespace();
        row.contains(char::is_whitespace) && cells.all(|cell| is_decimal_comma(cell) || is_whole(cell))
    };
    if most(&|row| row.contains('\t')) {
        Separator::Tab
    } else if most(&|row| row.contains(';')) {
        Separator::Semicolon
    } else if most(&has_decimal_commas) {
        Separator::Blank
    } else if most(&|row| row.contains(',')) {
        Separator::Comma
    } else if most(&|row| row.contains(char::is_whitespace)) {
        Separator::Blank
    } else {
        Separator::Comma
    }
}

/// Commas if a number has one and none has a point.
fn decimal(rows: &[&str], separator: Separator) -> Decimal {
    let cells: Vec<&str> = match separator {
        // Only in quotes can a cell have a comma.
        Separator::Comma => rows.iter().flat_map(|row| row.split('"').skip(1).step_by(2)).collect(),
        Separator::Semicolon => rows.iter().flat_map(|row| row.split(';')).collect(),
        Separator::Tab => rows.iter().flat_map(|row| row.split('\t')).collect(),
        Separator::Blank => rows.iter().flat_map(|row| row.split_whitespace()).collect(),
    };
    let cells: Vec<&str> = cells.iter().map(|cell| cell.trim_matches([' ', '"'])).collect();
    let has_point = |cell: &&str| cell.contains('.') && cell.parse::<f64>().is_ok();
    let has_comma = |cell: &&str| is_decimal_comma(cell);
    if cells.iter().any(has_comma) && !cells.iter().any(has_point) { Decimal::Comma } else { Decimal::Point }
}

/// Whether a cell is a number with a comma, such as `-1,5e3`.
fn is_decimal_comma(cell: &str) -> bool {
    cell.split_once(',').is_some_and(|(whole, rest)| {
        let is_first = |text: &str| text.ends_with(|letter: char| letter.is_ascii_digit());
        is_first(whole)
            && is_whole(whole)
            && rest.starts_with(|letter: char| letter.is_ascii_digit())
            && format!("0.{rest}").parse::<f64>().is_ok()
    })
}

/// Whether a cell is a whole number.
fn is_whole(cell: &str) -> bool {
    let digits = cell.trim_start_matches(['+', '-']);
    !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit())
}

#[cfg(test)]
mod tests;
