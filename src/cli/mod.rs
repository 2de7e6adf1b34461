//! The command line: one subcommand for each stage and each experiment, three for finished results, and one that makes bodies.

mod body;
mod estimate;
mod estimate_report;
mod experiments;
mod options;
mod output;
mod placement;
mod posterior;
mod program;
mod repeats;
mod results;
mod simulate;
mod stages;
mod study;
mod touch;
mod tree;
mod view;

pub use self::program::main;
