//! The command `flexure`: arguments, printing, exit codes, progress, Ctrl-C. Everything else is in the library.

mod args;
mod commands;
mod complaint;
mod failure;
mod grammar;
mod interrupt;
mod progress;

use std::path::Path;
use std::process::{Command as Program, ExitCode};
use std::{env, io};

use flexure::files::{Outside, Reading};
use flexure::processor;

use args::{Cli, Command};
use commands::print;
use failure::Failure;

fn main() -> ExitCode {
    if let Err(message) = hand_over() {
        eprintln!("flexure: {message}");
        return ExitCode::from(2);
    }
    if let Some(lacking) = processor::lacking() {
        eprintln!(
            "flexure: this processor has no {lacking}, which the program was built for; build it where it is to run, with \
             RUSTFLAGS=\"-C target-cpu=native\""
        );
        return ExitCode::from(2);
    }
    answered()
}

/// The largest set of instructions that may be taken, by the name that compilers have for it; to compare builds of this program.
const AT_MOST: &str = "FLEXURE_INSTRUCTIONS";

/// Has the build of this program for the most of what this processor can do go on in its place, if one lies beside it (`tools/package.sh`).
///
/// # Errors
/// What is wrong with [`AT_MOST`].
fn hand_over() -> Result<(), String> {
    let at_most = env::var_os(AT_MOST).map(|set| set.to_string_lossy().into_owned());
    if let Some(set) = at_most.as_deref().filter(|set| !processor::names().contains(set)) {
        return Err(format!("{AT_MOST} is '{set}', must be one of {}", processor::names().join(", ")));
    }
    let better = env::current_exe().ok().and_then(|own| processor::better(&own, at_most.as_deref()));
    if let Some(program) = better {
        let error = replaced_by(&program);
        let own = processor::BUILT_FOR;
        eprintln!("flexure: {} does not run ({error}); this one, for {own}, goes on", program.display());
    }
    Ok(())
}

/// Comes back only if `program` does not run.
#[cfg(unix)]
fn replaced_by(program: &Path) -> io::Error {
    use std::os::unix::process::CommandExt as _;

    let mut arguments = env::args_os();
    let name = arguments.next().unwrap_or_else(|| "flexure".into());
    Program::new(program).arg0(name).args(arguments).exec()
}

/// No program takes the place of another here.
#[cfg(not(unix))]
fn replaced_by(_: &Path) -> io::Error {
    io::ErrorKind::Unsupported.into()
}

/// Everything else: not a part of [`main`], so that nothing of it comes before the question there.
#[inline(never)]
fn answered() -> ExitCode {
    failure::install();
    let cli = match grammar::parsed() {
        Ok(cli) => cli,
        Err(error) => {
            if env::args_os().any(|argument| argument == "--json") {
                let _ = print::end(failure::usage(&error));
            }
            error.exit()
        }
    };
    let Cli { command, json, allow_outside, set } = cli;
    let outside = if allow_outside { Outside::Allowed } else { Outside::Refused };
    let reading = Reading { outside, changes: &set };
    interrupt::install(json);
    let done = dispatch(command, reading, json);
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

/// Runs a command.
fn dispatch(command: Command, reading: Reading<'_>, json: bool) -> Result<(), Failure> {
    if let Some(name) = command.without_scenario().filter(|_| !reading.changes.is_empty()) {
        let message = format!("--set changes a scenario; {name} takes none");
        return Err(Failure::input("usage", message, "flexure --help lists commands and options"));
    }
    match command {
        Command::Reproduce(output) => commands::reproduce(&output.out, json),
        Command::Run { scenario, beside, traced } => {
            commands::run(&scenario, beside.as_deref(), reading, &traced, json)
        }
        Command::Compare(options) => commands::compare(&options, reading, json),
        Command::Eval { scenario, states } => commands::eval(&scenario, reading, &states, json),
        Command::Model { robot, states } => commands::model(&robot, reading.outside, &states, json),
        Command::Certify(options) => commands::certify(&options, reading, json),
        Command::Check { files, figure } => commands::check(&files, figure.as_deref(), reading, json),
        Command::Import(options) => commands::import(&options, json),
        Command::Verify { certificate, against } => {
            commands::verify(&certificate, against.as_deref(), reading, json)
        }
        Command::Sweep(options) => commands::sweep(&options, reading, json),
        Command::Tune(options) => commands::tune(&options, reading, json),
        Command::Margins(options) => commands::margins(&options, reading, json),
        Command::Excite(options) => commands::excite(&options, reading.outside, json),
        Command::Replay(options) => commands::replay(&options, reading, json),
        Command::Identify(options) => commands::identify(&options, reading.outside, json),
        Command::List { kind } => commands::list(kind, json),
        Command::Completions { shell } => commands::completions(shell, json),
        Command::Man { folder } => commands::man(folder.as_deref(), json),
    }
}
