//! Reproduce an experiment of the paper: a folder with its draws, figures, verdicts, manifest and report.

mod experiment;
mod reading;
mod run;
mod scenes;

pub use self::experiment::{Finished, reproduce};
pub use self::run::Run;
