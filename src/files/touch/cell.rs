//! Read a number from a cell of a table, as different programs write it.

use super::format::Decimal;

/// What programs write where there is no value.
const MISSING: [&str; 8] = ["na", "n/a", "#n/a", "null", "none", "-nan", "nan(ind)", "-nan(ind)"];

/// A cell as float32: NaN where there is no value, 1 and 0 of true and false; `None` if it is no number.
pub(super) fn number(cell: &[u8], decimal: Decimal) -> Option<f32> {
    if cell.is_empty() { Some(f32::NAN) } else { parsed(cell, decimal) }
}

/// The same with all digits.
pub(super) fn exact(cell: &[u8], decimal: Decimal) -> Option<f64> {
    if cell.is_empty() { Some(f64::NAN) } else { parsed(cell, decimal) }
}

/// Whether a cell looks like a date or a time of day.
pub(super) fn is_date(cell: &[u8]) -> bool {
    cell.first().is_some_and(u8::is_ascii_digit)
        && cell.iter().any(|byte| b":-/.".contains(byte))
        && cell.iter().all(|byte| byte.is_ascii_digit() || b":-/.,+ TZ".contains(byte))
}

fn parsed<T: std::str::FromStr + From<bool> + Nan>(cell: &[u8], decimal: Decimal) -> Option<T> {
    let text = str::from_utf8(cell).ok()?;
    let found = match decimal {
        Decimal::Point => text.parse(),
        // A point would be one of thousands, or a mistake.
        Decimal::Comma if text.contains('.') => return None,
        Decimal::Comma => text.replacen(',', ".", 1).parse(),
    };
    found.ok().or_else(|| word(text))
}

/// What a word says.
fn word<T: From<bool> + Nan>(text: &str) -> Option<T> {
    let is = |word: &str| text.eq_ignore_ascii_case(word);
    match text {
        _ if is("true") => Some(T::from(true)),
        _ if is("false") => Some(T::from(false)),
        _ => MISSING.iter().any(|word| is(word)).then_some(T::NAN),
    }
}

/// A type that has a value for none.
trait Nan {
    const NAN: Self;
}

impl Nan for f32 {
    const NAN: Self = f32::NAN;
}

impl Nan for f64 {
    const NAN: Self = f64::NAN;
}

#[cfg(test)]
mod tests;
