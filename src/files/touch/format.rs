//! What a user may say of a file of pressures, so that it is not guessed.

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
    /// Columns that are no sensors, by name or by number, from 1 on.
    pub leave_out: Vec<String>,
    /// The array of an `.npz` archive.
    pub array: Option<String>,
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

/// Which column holds the time, and so is no sensor.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub enum TimeColumn {
    /// One whose name says so, or that rises by even steps.
    #[default]
    Guess,
    /// None: every column is a sensor.
    None,
    /// The one of this name, or of this number, from 1 on.
    Is(String),
}
