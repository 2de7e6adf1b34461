//! The command line: one subcommand for each stage and each experiment, and two for finished results.

mod estimate;
mod experiments;
mod options;
mod output;
mod posterior;
mod program;
mod results;
mod stages;
mod tree;

pub use self::program::main;
