//! The command line: one subcommand for each stage and each experiment, two for finished results, and one that makes bodies.

mod body;
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
