//! The command line `bodyschema`: one subcommand a stage. Exit status as `diff` has it: 0 done and every
//! claim reproduced, 1 some claim not, 2 trouble, 130 interrupted.

mod cli;

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    // Every file appears whole or not at all, so that nothing needs to be put in order before leaving.
    let left = ctrlc::set_handler(|| {
        eprintln!("bodyschema: interrupted; `reproduce` goes on from what it finished if started again");
        std::process::exit(130);
    });
    if let Err(error) = left {
        eprintln!("bodyschema: Ctrl-C cannot be caught: {error}");
    }
    match cli::Arguments::parse().run() {
        Ok(status) => status,
        Err(error) => {
            eprintln!("bodyschema: {error:#}");
            ExitCode::from(2)
        }
    }
}
