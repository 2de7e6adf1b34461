//! The command line `bodyschema`: one subcommand a stage. Exit status as `diff` has it: 0 done and every
//! claim reproduced, 1 some claim not, 2 trouble.

mod cli;

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    match cli::Arguments::parse().run() {
        Ok(status) => status,
        Err(error) => {
            eprintln!("bodyschema: {error:#}");
            ExitCode::from(2)
        }
    }
}
