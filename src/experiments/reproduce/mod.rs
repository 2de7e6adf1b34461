//! Reproduce an experiment of the paper: a folder with its posterior samples, figures, verdicts, manifest and report.

mod beginnings;
mod experiment;
mod interpretation;
mod rejudge;
mod run;
mod scenes;

pub(crate) use self::experiment::reproduce;
pub(crate) use self::rejudge::rejudge;
pub(crate) use self::run::Run;
