//! Reproduce an experiment of the paper: a folder with its draws, figures, verdicts, manifest and report.

mod experiment;
mod run;

pub use self::experiment::reproduce;
pub use self::run::{Run, preamble};
