//! Decide which columns of a file are no sensors: those that hold the time, and those that the user leaves out.

use std::path::Path;

use super::format::{Column, Format, TimeColumn};
use crate::files::error::FileError;
use crate::stages::clock::{Clock, is_time};

/// Columns of a file, and which of them are no sensors for what is said or for their name.
pub(super) struct Columns {
    /// The names, if the file has them.
    pub names: Vec<String>,
    /// Columns that hold the time.
    pub times: Vec<usize>,
    /// For each column, whether its cells count as no pressures.
    pub left_out: Vec<bool>,
}

/// What columns of times say.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Found {
    /// Columns that are no sensors, rising.
    pub left_out: Vec<usize>,
    pub interval: Option<f64>,
    /// What was guessed, a line each.
    pub guesses: Vec<String>,
}

impl Columns {
    /// Of so many columns, with these names if there are any.
    pub(super) fn new(
        file: &Path,
        count: usize,
        names: Vec<String>,
        format: &Format,
    ) -> Result<Self, FileError> {
        let find = |wanted: &Column, option: &str| {
            let asked = format.front_end.name(option);
            place(wanted, &names, count)
                .ok_or_else(|| FileError::new(file, absent(wanted, &asked, &names, count)))
        };
        let times = match &format.time {
            TimeColumn::Guess => (0..names.len()).filter(|at| is_time(&names[*at])).collect(),
            TimeColumn::None => Vec::new(),
            TimeColumn::Is(wanted) => vec![find(wanted, "time")?],
        };
        let mut left_out = vec![false; count];
        times.iter().for_each(|at| left_out[*at] = true);
        for wanted in &format.leave_out {
            left_out[find(wanted, "leave-out")?] = true;
        }
        Ok(Self { names, times, left_out })
    }

    /// A column as messages name it.
    pub(super) fn in_words(&self, at: usize) -> String {
        match self.names.get(at).filter(|name| !name.is_empty()) {
            Some(name) => format!("column {} (`{name}`)", at + 1),
            None => format!("column {}", at + 1),
        }
    }

    /// All columns that are no sensors. In: columns that may hold the time, with all their values, and whether these are float32.
    pub(super) fn found(&self, candidates: &[(usize, Vec<f64>)], is_single: bool, format: &Format) -> Found {
        let is_said = format.time != TimeColumn::Guess;
        let mut left_out = self.left_out.clone();
        let (mut intervals, mut guesses) = (Vec::new(), Vec::new());
        for (at, values) in candidates {
            let is_named = self.times.contains(at);
            // A column that the user names is one of times, whatever it is called.
            let name = match self.names.get(*at) {
                Some(name) if is_time(name) => Some(name.as_str()),
                _ => (is_named && is_said).then_some("time"),
            };
            let clock = Clock::of(name, values, is_single).filter(|_| is_named || !is_said);
            let Some(Clock { mark, interval }) = clock else { continue };
            left_out[*at] = true;
            intervals.extend(interval);
            if !is_said {
                let interval = interval.map_or(String::new(), |own| format!(" (interval {own} s)"));
                guesses.push(format!(
                    "{} {mark}, and is no sensor{interval}; {} counts it as one",
                    self.in_words(*at),
                    format.no_time()
                ));
            }
        }
        let left_out = (0..left_out.len()).filter(|at| left_out[*at]).collect();
        Found { left_out, interval: intervals.first().copied(), guesses }
    }
}

/// The place of a column that is given by its number from 1 on, as messages count, or by its name.
fn place(wanted: &Column, names: &[String], count: usize) -> Option<usize> {
    let by_number = wanted.number.and_then(|number| number.checked_sub(1)).filter(|at| *at < count);
    let by_name = || {
        let wanted = wanted.name.as_ref()?;
        let same = names.iter().position(|name| name == wanted);
        same.or_else(|| names.iter().position(|name| name.eq_ignore_ascii_case(wanted)))
    };
    by_number.or_else(by_name)
}

fn absent(wanted: &Column, option: &str, names: &[String], count: usize) -> String {
    let has = match names {
        [] => "which have no names".to_owned(),
        names => format!("such as `{}`", names[0]),
    };
    format!(
        "has no column `{wanted}`; {option} takes a name, or a number from 1 on, of its {count} columns, {has}"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(names: &[&str]) -> Vec<String> {
        names.iter().map(ToString::to_string).collect()
    }

    fn columns(own: &[&str], format: &Format) -> Result<Columns, String> {
        Columns::new(Path::new("t.csv"), own.len(), names(own), format).map_err(|error| error.to_string())
    }

    #[test]
    fn two_clocks_are_both_left_out_and_both_said() {
        let format = Format { leave_out: vec![Column::of_word("id")], ..Format::default() };
        let found = columns(&["%time", "seq", "id", "left"], &format).unwrap();
        assert_eq!((&found.times[..], &found.left_out[..]), (&[0][..], &[true, false, true, false][..]));
        let even = |step: f64| (0..50).map(|t| step * f64::from(t)).collect::<Vec<_>>();
        let found = found.found(&[(0, even(0.25)), (1, even(1.0)), (3, vec![0.0; 50])], false, &format);
        assert_eq!((found.left_out, found.interval), (vec![0, 1, 2], Some(0.25)));
        assert_eq!(
            found.guesses,
            [
                "column 1 (`%time`) is taken for the time by its name, and is no sensor (interval 0.25 s); --time none counts it as one",
                "column 2 (`seq`) counts the rows, and is no sensor; --time none counts it as one",
            ]
        );
    }

    #[test]
    fn what_the_user_says_counts() {
        let even: Vec<f64> = (0..50).map(f64::from).collect();
        let said = |time| Format { time, ..Format::default() };
        let none = said(TimeColumn::None);
        let found = columns(&["time", "a"], &none).unwrap().found(&[(0, even.clone())], false, &none);
        assert_eq!(found, Found::default());
        let second = said(TimeColumn::Is(Column::of_word("2")));
        let found = columns(&["time", "a"], &second).unwrap().found(&[(1, even)], false, &second);
        assert_eq!(found, Found { left_out: vec![1], interval: Some(1.0), guesses: Vec::new() });
        let message = columns(&["a", "b"], &said(TimeColumn::Is(Column::of_word("c")))).err().unwrap();
        assert!(message.contains("t.csv: has no column `c`; --time takes a name"), "{message}");
        // A name that is a number, and a number that is a name.
        let counted = names(&["2", "1"]);
        let place = |number, name: Option<&str>| {
            place(&Column { number, name: name.map(str::to_owned) }, &counted, 2)
        };
        assert_eq!(
            (place(Some(1), None), place(None, Some("1")), place(Some(1), Some("1"))),
            (Some(0), Some(1), Some(0))
        );
        assert_eq!((place(Some(3), None), place(Some(0), None), place(None, Some("3"))), (None, None, None));
    }
}
