//! Reproduce an experiment of the paper: a folder with its draws, figures, verdicts, manifest and report.

mod experiment;
mod reading;
mod rejudge;
mod run;
mod scenes;

pub use self::experiment::reproduce;
pub use self::rejudge::rejudge;
pub use self::run::Run;
