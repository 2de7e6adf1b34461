//! What a user may say of a file of pressures, so that it is not guessed.

use std::fmt;

use crate::files::front_end::FrontEnd;

/// How a file holds pressures. What is not said is guessed.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Format {
    /// What is between the cells of a table.
    pub separator: Option<Separator>,
    /// What decimals begin with.
    pub decimal: Option<Decimal>,
    /// Whether the first row of a table has names.
    pub header: Option<bool>,
    /// Which column holds the time.
    pub time: TimeColumn,
    /// Columns that are no sensors.
    pub leave_out: Vec<Column>,
    /// The array of an `.npz` archive.
    pub array: Option<String>,
    /// Whose words messages use.
    pub front_end: FrontEnd,
}

impl Format {
    /// That no column holds the time, as the front end has it.
    pub(super) fn no_time(&self) -> String {
        self.front_end.choice("time", ["none", "False"])
    }
}

/// A column of a file: by its number, from 1 on, or else by its name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Column {
    /// The number, if it is one.
    pub number: Option<usize>,
    /// The name, if it is one.
    pub name: Option<String>,
}

impl Column {
    /// What a word may be.
    pub fn of_word(word: &str) -> Self {
        Self { number: word.parse().ok(), name: Some(word.to_owned()) }
    }
}

impl fmt::Display for Column {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (&self.name, self.number) {
            (Some(name), _) => f.write_str(name),
            (None, number) => write!(f, "{}", number.unwrap_or_default()),
        }
    }
}

/// What is between the cells of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Separator {
    /// `,`
    Comma,
    /// `;`
    Semicolon,
    /// A tab.
    Tab,
    /// One blank or more.
    Blank,
}

impl Separator {
    /// The byte.
    pub(super) fn byte(self) -> u8 {
        match self {
            Self::Comma => b',',
            Self::Semicolon => b';',
            Self::Tab => b'\t',
            Self::Blank => b' ',
        }
    }

    /// As the command line and Python have it.
    pub(super) fn said(self) -> [&'static str; 2] {
        match self {
            Self::Comma => ["comma", "\",\""],
            Self::Semicolon => ["semicolon", "\";\""],
            Self::Tab => ["tab", "\"\\t\""],
            Self::Blank => ["blank", "\" \""],
        }
    }

    /// In words.
    pub(super) fn in_words(self) -> &'static str {
        match self {
            Self::Comma => "commas",
            Self::Semicolon => "semicolons",
            Self::Tab => "tabs",
            Self::Blank => "blanks",
        }
    }
}

/// What decimals begin with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Decimal {
    /// 1.5
    Point,
    /// 1,5
    Comma,
}

impl Decimal {
    /// As the command line and Python have it.
    pub(super) fn said(self) -> [&'static str; 2] {
        match self {
            Self::Point => ["point", "\".\""],
            Self::Comma => ["comma", "\",\""],
        }
    }
}

/// Which column holds the time, and so is no sensor.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub enum TimeColumn {
    /// One whose name says so, or that rises by even steps.
    #[default]
    Guess,
    /// None: every column is a sensor.
    None,
    /// This one.
    Is(Column),
}
