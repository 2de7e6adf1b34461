//! All settings of a run, composed of those of each stage; their defaults are in `reproduce/paper.toml` alone.

mod error;
mod experiment;
mod file;
mod sections;
mod sources;

pub use self::error::SettingsError;
pub use self::experiment::{ExperimentSettings, MAX_LISTED};
pub use self::file::{Base, PAPER, read_toml};
pub use self::sections::Settings;
pub use self::sources::{Described, described};
