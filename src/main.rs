//! Start the command line `bodyschema`, which has one subcommand for each stage. Exit status, as `diff` has it: 0 done (of an
//! experiment: the headline is reproduced), 1 it is not, or results differ, 2 an error, 130 interrupted.

use std::process::ExitCode;

fn main() -> ExitCode {
    bodyschema::cli::main()
}
