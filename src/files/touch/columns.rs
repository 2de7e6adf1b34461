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
mod tests;
