//! Parse the arguments, run the subcommand, and turn its outcome into an exit status.

use std::process::ExitCode;

use anyhow::Result;
use clap::{Parser, Subcommand};

use super::body::Body;
use super::estimate::Estimate;
use super::experiments::{Bodies, Reproduce};
use super::results::{Plot, Verify};
use super::simulate::Simulate;
use super::stages::{Distance, Infer, Map};
use super::study::Study;
use super::tree::Tree;
use super::view::View;

/// Estimates from touch alone how many parts a body has, which part carries each sensor, and how the parts are joined: a
/// replication of Mimura, Hagiwara, Taniguchi and Inamura (2017).
#[derive(Parser)]
#[command(name = "bodyschema", version, arg_required_else_help = true)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Body(Body),
    Simulate(Simulate),
    Distance(Distance),
    Map(Map),
    Infer(Infer),
    Tree(Tree),
    Estimate(Estimate),
    Reproduce(Reproduce),
    Study(Study),
    Bodies(Bodies),
    Plot(Plot),
    Verify(Verify),
    View(View),
}

impl Command {
    fn run(self) -> Result<ExitCode> {
        match self {
            Self::Body(command) => command.run(),
            Self::Simulate(command) => command.run(),
            Self::Distance(command) => command.run(),
            Self::Map(command) => command.run(),
            Self::Infer(command) => command.run(),
            Self::Tree(command) => command.run(),
            Self::Estimate(command) => command.run(),
            Self::Reproduce(command) => command.run(),
            Self::Study(command) => command.run(),
            Self::Bodies(command) => command.run(),
            Self::Plot(command) => command.run(),
            Self::Verify(command) => command.run(),
            Self::View(command) => command.run(),
        }
    }
}

/// Runs the program. Exit status, as `diff` has it: 0 done (of an experiment: the headline is reproduced), 1 it is not, or
/// results differ, 2 an error, 130 interrupted.
pub fn main() -> ExitCode {
    // Every file appears whole or not at all, so nothing needs to be put in order before leaving.
    let handler = ctrlc::set_handler(|| {
        eprintln!("bodyschema: interrupted; start the same command again to continue from what is finished");
        std::process::exit(130);
    });
    if let Err(error) = handler {
        eprintln!("bodyschema: Ctrl-C cannot be caught: {error}");
    }
    match Arguments::parse().command.run() {
        Ok(status) => status,
        Err(error) => {
            eprintln!("bodyschema: {error:#}");
            ExitCode::from(2)
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn the_definition_of_the_command_line_is_sound() {
        Arguments::command().debug_assert();
    }
}
