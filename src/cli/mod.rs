//! The command line: one subcommand for each stage, experiment, and look at results.

mod experiments;
mod options;
mod output;
mod program;
mod results;
mod stages;

pub use self::program::main;
