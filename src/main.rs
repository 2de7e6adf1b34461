//! Start the command line `bodyschema`, which has one subcommand for each stage. Exit status, as `diff` has it: 0 done
//! and every claim reproduced, 1 some claim not, 2 an error, 130 interrupted.

use std::process::ExitCode;

fn main() -> ExitCode {
    bodyschema::cli::main()
}
