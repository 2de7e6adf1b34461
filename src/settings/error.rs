//! Say in one line why settings cannot be used.

use std::io;
use std::path::PathBuf;

use crate::files::one_line;
use crate::numerics::range::OutOfRange;

/// A settings file or value that cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum SettingsError {
    /// The file cannot be read.
    #[error("{}: cannot read the settings: {reason}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: io::Error,
    },
    /// The file is not TOML, or a value has the wrong type.
    #[error("{origin}: {message}")]
    Malformed {
        /// The file.
        origin: String,
        /// What is wrong, on one line.
        message: String,
    },
    /// A key that does not exist.
    #[error("{origin}: unknown setting `{key}`; reproduce/paper.toml lists all of them")]
    Unknown {
        /// The file.
        origin: String,
        /// The key, with its section.
        key: String,
    },
    /// A value outside its range.
    #[error(transparent)]
    OutOfRange(OutOfRange),
}

impl From<OutOfRange> for SettingsError {
    fn from(error: OutOfRange) -> Self {
        // A list can be as long as its file.
        Self::OutOfRange(OutOfRange { value: one_line(&error.value), ..error })
    }
}
