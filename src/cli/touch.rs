//! Options of subcommands that read a recording, and what is said of it.

use std::path::{Path, PathBuf};

use anyhow::Result;
use clap::{Args, ValueEnum};

use super::options::seconds;
use crate::files::touch::{Column, Decimal, Format, Recorded, Separator, TimeColumn, read_recorded};
use crate::files::{FrontEnd, one_line};
use crate::recording::{Cleaning, Recording};
use crate::stages::sense::Tactile;

/// A file of pressures, and how to read it.
#[derive(Args)]
pub(super) struct TouchFile {
    /// Pressures, a row for each sample: table, .npy or .npz; - is a pipe
    tactile: PathBuf,
    #[command(flatten)]
    format: FormatOptions,
    /// Time between two samples, s, for the report
    #[arg(long, help_heading = HEADING, value_name = "SECONDS", value_parser = seconds)]
    interval: Option<f64>,
    /// Values at the end of a sensor's range count
    #[arg(long, help_heading = HEADING)]
    keep_saturated: bool,
    /// Whether values below 0 count: yes or no
    #[arg(long, help_heading = HEADING, value_name = "WORD", hide_possible_values = true)]
    signed: Option<YesOrNo>,
}

/// The heading of these options.
const HEADING: &str = "The file";

/// How to read a file of pressures.
#[derive(Args)]
pub(super) struct FormatOptions {
    /// Column that holds the time: a name, a number from 1, or none
    #[arg(long, help_heading = HEADING, value_name = "COLUMN")]
    time: Option<String>,
    /// Columns that are no sensors: names or numbers, with commas
    #[arg(long, help_heading = HEADING, value_name = "COLUMNS", value_delimiter = ',')]
    leave_out: Vec<String>,
    /// Between cells: comma, semicolon, tab or blank
    #[arg(long, help_heading = HEADING, value_name = "WORD", hide_possible_values = true)]
    separator: Option<SeparatorName>,
    /// Decimals begin with a point or a comma
    #[arg(long, help_heading = HEADING, value_name = "WORD", hide_possible_values = true)]
    decimal: Option<DecimalName>,
    /// Whether the first row has names: yes or no
    #[arg(long, help_heading = HEADING, value_name = "WORD", hide_possible_values = true)]
    header: Option<YesOrNo>,
    /// Array of an .npz archive
    #[arg(long, help_heading = HEADING, value_name = "NAME")]
    array: Option<String>,
}

#[derive(Clone, Copy, ValueEnum)]
enum SeparatorName {
    Comma,
    Semicolon,
    Tab,
    Blank,
}

#[derive(Clone, Copy, ValueEnum)]
enum DecimalName {
    Point,
    Comma,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum YesOrNo {
    Yes,
    No,
}

impl YesOrNo {
    fn is_yes(self) -> bool {
        self == Self::Yes
    }
}

/// A recording that was read but not cleaned.
pub(super) struct Read {
    /// The file, as messages name it.
    pub name: String,
    pub tactile: Tactile,
    /// Time between two samples, s, if it is known.
    pub interval: Option<f64>,
    cleaning: Cleaning,
}

impl TouchFile {
    /// Reads the file, and says what was guessed.
    pub(super) fn read(&self) -> Result<Read> {
        let path = &self.tactile;
        let Recorded { tactile, interval, guesses } = read_recorded(path, &self.format.format())?;
        let name =
            if path == Path::new("-") { "standard input".to_owned() } else { path.display().to_string() };
        say_guesses(&name, &guesses);
        let interval = self.interval.or(interval);
        let signed = self.signed.map(YesOrNo::is_yes);
        let cleaning = Cleaning { keep_saturated: self.keep_saturated, signed };
        Ok(Read { name, tactile, interval, cleaning })
    }
}

/// Says what was guessed of a file.
pub(super) fn say_guesses(name: &str, guesses: &[String]) {
    guesses.iter().for_each(|guess| eprintln!("bodyschema: {name}: {}", one_line(guess)));
}

impl FormatOptions {
    /// What the user says.
    pub(super) fn format(&self) -> Format {
        let time = match self.time.as_deref() {
            None => TimeColumn::Guess,
            Some("none") => TimeColumn::None,
            Some(column) => TimeColumn::Is(Column::of_word(column)),
        };
        let separator = self.separator.map(|name| match name {
            SeparatorName::Comma => Separator::Comma,
            SeparatorName::Semicolon => Separator::Semicolon,
            SeparatorName::Tab => Separator::Tab,
            SeparatorName::Blank => Separator::Blank,
        });
        let decimal = self.decimal.map(|name| match name {
            DecimalName::Point => Decimal::Point,
            DecimalName::Comma => Decimal::Comma,
        });
        Format {
            separator,
            decimal,
            header: self.header.map(YesOrNo::is_yes),
            time,
            leave_out: self.leave_out.iter().map(|word| Column::of_word(word)).collect(),
            array: self.array.clone(),
            front_end: FrontEnd::CommandLine,
        }
    }
}

impl Read {
    /// Cleans the recording, and says what that changed.
    pub(super) fn cleaned(self) -> Recording {
        let Self { name, tactile, cleaning, .. } = self;
        let recording = Recording::cleaned(tactile, cleaning);
        changes(&recording).iter().for_each(|line| eprintln!("bodyschema: {name}: {line}"));
        recording
    }
}

/// What cleaning changed, a line each.
fn changes(Recording { tactile, lost_samples, noisy, missing, .. }: &Recording) -> Vec<String> {
    let mut lines = Vec::new();
    if missing.saturated > 0 {
        lines.push(format!(
            "{} values of {} sensors are at the end of the range for three samples or more, and count as missing; \
             --keep-saturated uses them",
            missing.saturated, missing.saturated_sensors
        ));
    }
    if missing.infinite > 0 {
        lines.push(format!("{} values are infinite, and count as missing", missing.infinite));
    }
    if *lost_samples > 0 {
        lines.push(format!("{lost_samples} samples are left out, because most sensors have no value there"));
    }
    if missing.values > 0 {
        let share = 100.0 * missing.values as f64 / tactile.pressures.len() as f64;
        lines.push(format!(
            "{} values ({share:.2} %) are missing of the sensors that are used; they are not interpolated",
            missing.values
        ));
    }
    if *noisy > 0 {
        lines.push(format!(
            "{noisy} of {} sensors are noisy; they are smoothed, and pressures within the noise count as no touch",
            tactile.sensors()
        ));
    }
    lines
}
