//! The command `flexure`: arguments, printing, exit codes, progress, Ctrl-C. Everything else is in the library.

mod args;
mod commands;
mod complaint;
mod failure;
mod interrupt;
mod progress;

use std::process::ExitCode;

use clap::Parser;

use args::{Cli, Command};
use commands::print;
use failure::Failure;

fn main() -> ExitCode {
    failure::install();
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            if std::env::args_os().any(|argument| argument == "--json") {
                let _ = print::end(failure::usage(&error));
            }
            error.exit()
        }
    };
    let (json, outside) = (cli.json, cli.outside());
    interrupt::install(json);
    let done = match cli.command {
        Command::Reproduce(output) => commands::reproduce(&output.out, json),
        Command::Run { scenario, output } => commands::run(&scenario, outside, &output.out, json),
        Command::Compare(options) => commands::compare(&options, outside, json),
        Command::Eval { scenario, states } => commands::eval(&scenario, outside, &states, json),
        Command::Model { robot, states } => commands::model(&robot, outside, &states, json),
        Command::Certify(options) => commands::certify(&options, outside, json),
        Command::Check { files } => commands::check(&files, outside, json),
        Command::Import(options) => commands::import(&options, json),
        Command::Verify { certificate, against } => {
            commands::verify(&certificate, against.as_deref(), outside, json)
        }
        Command::Tune(options) => commands::tune(&options, outside, json),
        Command::Margins(options) => commands::margins(&options, outside, json),
        Command::Excite(options) => commands::excite(&options, outside, json),
        Command::Replay(options) => commands::replay(&options, outside, json),
        Command::Identify(options) => commands::identify(&options, outside, json),
        Command::List { kind } => commands::list(kind, json),
        Command::Completions { shell } => commands::completions(shell, json),
        Command::Man { folder } => commands::man(folder.as_deref(), json),
    };
    interrupt::speak();
    let errors = done.as_ref().err().and_then(Failure::errors).filter(|_| json);
    match done.and(print::end(errors)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            let code = failure.code();
            failure.say();
            code
        }
    }
}
