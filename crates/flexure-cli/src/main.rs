//! The command `flexure`: arguments, printing, exit codes, progress. Everything else is in the library.

mod args;
mod commands;
mod failure;
mod progress;

use std::process::ExitCode;

use clap::Parser;

use args::{Cli, Command};

fn main() -> ExitCode {
    failure::install();
    let cli = Cli::parse();
    let json = cli.json;
    let done = match cli.command {
        Command::Reproduce(output) => commands::reproduce(&output.out, json),
        Command::Run { scenario, output } => commands::run(&scenario, &output.out, json),
        Command::Compare(options) => commands::compare(&options, json),
        Command::Eval { scenario, states } => commands::eval(&scenario, &states, json),
        Command::Model { robot, states } => commands::model(&robot, &states, json),
        Command::Certify(options) => commands::certify(&options, json),
        Command::Check { files } => commands::check(&files, json),
        Command::Import { urdf, lock } => commands::import(&urdf, &lock, json),
        Command::Verify { certificate } => commands::verify(&certificate, json),
        Command::Margins(options) => commands::margins(&options, json),
        Command::List { kind } => commands::list(kind, json),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}
