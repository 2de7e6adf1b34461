//! The command line `bodyschema`: one subcommand a stage. Exit status as `diff` has it: 0 done and every
//! claim reproduced, 1 some claim not, 2 trouble, 130 interrupted.

use std::process::ExitCode;

fn main() -> ExitCode {
    bodyschema::cli::main()
}
