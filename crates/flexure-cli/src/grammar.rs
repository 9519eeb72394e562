//! The command line as it is parsed and described: what [`args`](crate::args) says, with `--set` offered where there is a scenario.

use clap::{Command, CommandFactory, FromArgMatches};

use crate::args::Cli;

/// Commands that take no scenario: `--set` is refused with a word on that, and not offered.
const WITHOUT_SCENARIO: [&str; 8] =
    ["reproduce", "model", "import", "excite", "identify", "list", "completions", "man"];

/// The grammar.
pub fn command() -> Command {
    let program = Cli::command();
    let set = program.get_arguments().find(|argument| argument.get_id() == "set").cloned();
    let hidden = set.map(|set| set.hide(true));
    WITHOUT_SCENARIO
        .iter()
        .fold(program, |program, name| program.mut_subcommand(*name, |command| command.args(hidden.clone())))
}

/// What the program is called with.
///
/// # Errors
/// Where that is not in the grammar, or asks for help.
pub fn parsed() -> Result<Cli, clap::Error> {
    Cli::from_arg_matches(&command().try_get_matches()?)
}
