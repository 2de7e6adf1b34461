//! Say why an experiment or a study could not be finished.

use crate::files::{FileError, one_line};
use crate::settings::SettingsError;

/// An experiment or a study that could not be finished.
#[derive(Debug, thiserror::Error)]
pub(crate) enum ExperimentError {
    /// A design does not say what it must.
    #[error("{origin}: {message}")]
    Design {
        /// The file.
        origin: String,
        /// What is wrong, on one line.
        message: String,
    },
    /// Settings that a design names.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// A file could not be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// A stage failed.
    #[error("{0}")]
    Stage(String),
}

impl ExperimentError {
    /// A design from `origin` that does not say what it must.
    pub(crate) fn design(origin: &str, message: impl ToString) -> Self {
        Self::Design { origin: origin.to_owned(), message: one_line(&message.to_string()) }
    }
}
