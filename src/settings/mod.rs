//! All settings of a run, composed of those of each stage; their defaults are in `reproduce/paper.toml` alone.

mod error;
mod experiment;
mod file;
mod sections;
mod sources;

pub use self::error::SettingsError;
pub use self::experiment::{ExperimentSettings, MAX_LISTED};
pub(crate) use self::file::toml_message;
pub use self::file::{Base, PAPER, read_toml};
pub use self::sections::Settings;
pub(crate) use self::sections::{MAX_PRESSURES, MAX_SAMPLES};
pub use self::sources::{Described, described};
