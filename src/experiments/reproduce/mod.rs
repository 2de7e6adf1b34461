//! Reproduce an experiment of the paper: a folder with its posterior samples, figures, verdicts, manifest and report.

mod beginnings;
mod experiment;
mod interpretation;
mod rejudge;
mod run;
mod scenes;

pub use self::experiment::reproduce;
pub use self::rejudge::rejudge;
pub use self::run::Run;
