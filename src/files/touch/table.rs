//! Read a table of numbers as people have them: a row for each sample, with or without names, times and comments.

use std::io::Read;
use std::path::Path;

use csv::ByteRecord;

use super::cell::{exact, is_date, number};
use super::columns::Columns;
use super::dialect::Dialect;
use super::format::{Decimal, Format, Separator, TimeColumn};
use super::recorded::{Recorded, without};
use crate::files::error::FileError;
use crate::files::npy::check_sensors;
use crate::stages::clock::may_rise;
use crate::stages::sense::Tactile;

/// Rows after which a column that does not rise is taken for a sensor.
const FIRST: usize = 64;
/// Fewest columns of a first row 0, 1, 2, … that are names.
const COUNTED: usize = 3;

/// Reads the table that a text in UTF-8 holds.
pub(super) fn read(
    file: &Path,
    text: impl Read,
    dialect: Dialect,
    format: &Format,
) -> Result<Recorded, FileError> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .trim(csv::Trim::All)
        .delimiter(dialect.separator.byte())
        .from_reader(text);
    let mut record = ByteRecord::new();
    let mut head = Head { file, dialect, format, names: None, comment: None, guesses: Vec::new() };
    let mut body: Option<Body> = None;
    loop {
        let more = reader.read_byte_record(&mut record);
        if !more.map_err(|error| FileError::new(file, format!("cannot be read: {error}")))? {
            break;
        }
        let row = record.position().map_or(0, csv::Position::line);
        let mut cells: Vec<&[u8]> = record.iter().collect();
        if dialect.separator == Separator::Blank {
            cells.retain(|cell| !cell.is_empty());
        }
        // A line of blanks.
        if cells.iter().all(|cell| cell.is_empty()) && cells.len() < 2 {
            continue;
        }
        match &mut body {
            Some(body) => body.add(row, &cells)?,
            None if head.takes(&cells) => (),
            None => body = Some(head.begin(row, &cells)?),
        }
    }
    let Some(body) = body else {
        let message = "has no row of numbers; each row must be a sample in time, and each column a sensor";
        return Err(FileError::new(file, message));
    };
    Ok(body.finish(head.guesses))
}

/// What comes before the first row of numbers.
struct Head<'a> {
    file: &'a Path,
    dialect: Dialect,
    format: &'a Format,
    /// The row of names, and of the last comment before the numbers, which may have names, too.
    names: Option<Vec<String>>,
    comment: Option<Vec<String>>,
    /// What was guessed, a line each.
    guesses: Vec<String>,
}

impl<'a> Head<'a> {
    /// Whether a row is no sample, but has names or a comment.
    fn takes(&mut self, cells: &[&[u8]]) -> bool {
        let text = |cell: &&[u8]| String::from_utf8_lossy(cell).into_owned();
        let mut names: Vec<String> = cells.iter().map(text).collect();
        let is_comment = names[0].starts_with(['#', '%']);
        if is_comment {
            names[0] = names[0].trim_start_matches(['#', '%', ' ']).to_owned();
            if names[0].is_empty() && self.dialect.separator == Separator::Blank {
                names.remove(0);
            }
            self.comment = Some(names);
            return true;
        }
        if self.names.is_some()
            || !self.format.header.unwrap_or_else(|| !self.is_named(cells) && self.has_names(cells))
        {
            return false;
        }
        self.names = Some(names);
        true
    }

    /// Whether a comment has named the cells of a row that has a number: its words are values, not names.
    fn is_named(&self, cells: &[&[u8]]) -> bool {
        let is_number =
            |cell: &&[u8]| number(cell, self.dialect.decimal).is_some_and(|value| !value.is_nan());
        self.comment.as_ref().is_some_and(|names| names.len() == cells.len()) && cells.iter().any(is_number)
    }

    /// Whether the cells of the first row are names: a cell is neither a number nor a date, or they count the columns.
    fn has_names(&mut self, cells: &[&[u8]]) -> bool {
        let decimal = self.dialect.decimal;
        let is_name = |cell: &&[u8]| number(cell, decimal).is_none() && !is_date(cell);
        if cells.iter().any(is_name) {
            return true;
        }
        // As pandas writes a table whose columns have no names, with or without the row number.
        let counted = if cells[0].is_empty() { &cells[1..] } else { cells };
        let first = counted.first().and_then(|cell| str::from_utf8(cell).ok()?.parse::<usize>().ok());
        let counts = counted.len() >= COUNTED
            && first.is_some_and(|first| {
                first <= 1 && (first..).zip(counted).all(|(at, cell)| at.to_string().as_bytes() == *cell)
            });
        if counts {
            let header = self.format.front_end.choice("header", ["no", "False"]);
            let guess =
                format!("row 1 counts the columns and is taken for names; {header} counts it as a sample");
            self.guesses.push(guess);
        }
        counts
    }

    /// The table, from its first row of numbers on.
    fn begin(&mut self, row: u64, cells: &[&[u8]]) -> Result<Body<'a>, FileError> {
        let Self { file, dialect, format, .. } = *self;
        let count = cells.len();
        check_sensors(file, count, "many")?;
        // A separator at the end of every row.
        let ends_empty = cells.last().is_some_and(|cell| cell.is_empty());
        let named = self.names.take().map(|mut names| {
            names.pop_if(|last| last.is_empty() && ends_empty);
            names
        });
        let names = match (named, self.comment.take()) {
            // An empty cell after the last one is none.
            (Some(names), _)
                if names.len() != count && !(names.len() + 1 == count && cells[count - 1].is_empty()) =>
            {
                return Err(FileError::new(
                    file,
                    ragged(row, count, "the row of names", names.len(), dialect, format),
                ));
            }
            (Some(names), _) => names,
            (None, Some(comment)) if comment.len() == count => comment,
            _ => Vec::new(),
        };
        let count = if names.is_empty() { count } else { names.len() };
        if dialect.is_guess {
            let decimals = if dialect.decimal == Decimal::Comma { ", and decimals have commas" } else { "" };
            let [separator, decimal] = ["separator", "decimal"].map(|name| format.front_end.name(name));
            self.guesses.push(format!(
                "cells are separated by {}{decimals}; {separator} and {decimal} say otherwise",
                dialect.separator.in_words()
            ));
        }
        let columns = Columns::new(file, count, names, format)?;
        let candidates = match format.time {
            TimeColumn::Guess => {
                (0..count).filter(|at| !columns.left_out[*at] || columns.times.contains(at)).collect()
            }
            _ => columns.times.clone(),
        };
        let rising = candidates.into_iter().map(|at| (at, Vec::new())).collect();
        let mut body = Body {
            file,
            dialect,
            format,
            columns,
            count,
            rising,
            by_time: Vec::new(),
            samples: 0,
            has_point: false,
        };
        body.add(row, cells)?;
        Ok(body)
    }
}

/// The rows of numbers.
struct Body<'a> {
    file: &'a Path,
    dialect: Dialect,
    format: &'a Format,
    columns: Columns,
    /// How many columns there are.
    count: usize,
    /// Columns that may hold the time, and their values so far.
    rising: Vec<(usize, Vec<f64>)>,
    /// All values, row after row.
    by_time: Vec<f32>,
    samples: usize,
    /// Whether a number has had a point.
    has_point: bool,
}

impl Body<'_> {
    fn add(&mut self, row: u64, cells: &[&[u8]]) -> Result<(), FileError> {
        let decimal = self.dialect.decimal;
        let cells = match cells {
            [own @ .., b""] if own.len() == self.count => own,
            cells if cells.len() == self.count => cells,
            cells => {
                let message = ragged(
                    row,
                    cells.len(),
                    "the first row of numbers",
                    self.count,
                    self.dialect,
                    self.format,
                );
                return Err(FileError::new(self.file, message));
            }
        };
        for (at, (cell, left_out)) in cells.iter().zip(&self.columns.left_out).enumerate() {
            let value = if *left_out { Some(f32::NAN) } else { number(cell, decimal) };
            let Some(value) = value else {
                return Err(FileError::new(self.file, self.mistake(row, at, cell)));
            };
            self.by_time.push(value);
        }
        if self.samples < FIRST {
            self.check_decimals(row, cells)?;
        }
        for (at, values) in &mut self.rising {
            // A date is no number, and tells no interval.
            values.push(exact(cells[*at], decimal).unwrap_or(f64::NAN));
        }
        self.samples += 1;
        if self.samples == FIRST {
            let times = &self.columns.times;
            self.rising.retain(|(at, values)| times.contains(at) || may_rise(values));
        }
        Ok(())
    }

    /// Refuses a table whose commas separate cells, and seem to be decimal ones as well: `0,05,1,25`.
    fn check_decimals(&mut self, row: u64, cells: &[&[u8]]) -> Result<(), FileError> {
        let Dialect { separator, decimal, .. } = self.dialect;
        self.has_point |= cells.iter().any(|cell| cell.contains(&b'.'));
        if separator != Separator::Comma
            || decimal != Decimal::Point
            || self.has_point
            || self.format.decimal.is_some()
        {
            return Ok(());
        }
        let is_rest = |cell: &&[u8]| cell.len() > 1 && cell[0] == b'0' && cell.iter().all(u8::is_ascii_digit);
        let Some(at) = cells.iter().position(is_rest) else { return Ok(()) };
        let message = format!(
            "row {row}, {}: `{}` seems to be the decimals of the cell before; write the table with `;` between cells, or say {} \
             if its numbers are whole",
            self.columns.in_words(at),
            String::from_utf8_lossy(cells[at]),
            self.format.front_end.choice("decimal", Decimal::Point.said())
        );
        Err(FileError::new(self.file, message))
    }

    /// What is wrong with a cell, and which option helps.
    fn mistake(&self, row: u64, at: usize, cell: &[u8]) -> String {
        let Dialect { separator, decimal, .. } = self.dialect;
        let has = |byte: u8| cell.contains(&byte);
        let other = |byte: u8, own: Separator| separator != own && has(byte);
        let say = |name: &str, value: [&str; 2]| self.format.front_end.choice(name, value);
        let number = &(at + 1).to_string();
        let help = if is_date(cell) && (has(b':') || has(b'-')) {
            format!("if it is a time, say {}", say("time", [number, number]))
        } else if other(b';', Separator::Semicolon) {
            format!("if `;` is between cells, say {}", say("separator", Separator::Semicolon.said()))
        } else if other(b'\t', Separator::Tab) {
            format!("if tabs are between cells, say {}", say("separator", Separator::Tab.said()))
        } else if decimal == Decimal::Point && has(b',') {
            format!("if decimals have commas, say {}", say("decimal", Decimal::Comma.said()))
        } else if decimal == Decimal::Comma && has(b'.') {
            let point = say("decimal", Decimal::Point.said());
            format!("decimals have commas here; if they have points, say {point}")
        } else {
            let leave_out = say("leave-out", [number, &format!("[{number}]")]);
            format!("empty the cell if a value is missing, or say {leave_out} if the column is no sensor")
        };
        let shown: String = String::from_utf8_lossy(cell).chars().take(40).collect();
        format!("row {row}, {}: `{shown}` is not a number; {help}", self.columns.in_words(at))
    }

    /// All samples, without the columns that are no sensors.
    fn finish(mut self, mut guesses: Vec<String>) -> Recorded {
        let times = &self.columns.times;
        self.rising.retain(|(at, values)| times.contains(at) || may_rise(values));
        let found = self.columns.found(&self.rising, false, self.format);
        guesses.extend(found.guesses);
        let kept = without(self.count, &found.left_out);
        let of = |sensor: usize| self.by_time[sensor..].iter().step_by(self.count).copied();
        let pressures = kept.into_iter().flat_map(of).collect();
        let tactile = Tactile { samples: self.samples, pressures };
        Recorded { tactile, interval: found.interval, guesses }
    }
}

/// What is wrong with a row of another length.
fn ragged(row: u64, has: usize, other: &str, expected: usize, dialect: Dialect, format: &Format) -> String {
    let help = match dialect.separator {
        Separator::Comma if has == 2 * expected => {
            "if commas are decimal ones, write the table with `;` between cells".to_owned()
        }
        separator => {
            let repair = match separator {
                Separator::Blank => "write nan where a value is missing",
                _ => "repair or delete the row",
            };
            format!("{repair}, or say what is between cells with {}", format.front_end.name("separator"))
        }
    };
    format!("row {row} has {has} cells, but {other} has {expected}; {help}")
}
