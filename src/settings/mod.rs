//! All settings of a run: what each stage owns, composed, with `reproduce/paper.toml` as the one place of defaults.

mod error;
mod experiment;
mod file;
mod sections;

pub use self::error::SettingsError;
pub use self::experiment::{ExperimentSettings, MAX_LISTED};
pub use self::file::{PAPER, read_toml};
pub use self::sections::Settings;
