//! Why a command did not succeed, the exit code that says so, and how it is said.

use std::fmt::Display;
use std::io::{self, IsTerminal, Write};
use std::process::ExitCode;

use clap::error::ErrorKind;
use flexure::files::{Problem, Problems, Unfinished, WriteError};
use miette::{Diagnostic, MietteHandlerOpts, Report};
use textwrap::WordSplitter;

use crate::complaint::Errors;
use crate::interrupt;

/// Problems beyond these are counted, not shown.
const MOST_SHOWN: usize = 10;

/// What ends a command early.
pub enum Failure {
    /// The input is bad, or an output cannot be written: exit code 2.
    Input(Vec<Report>),
    /// The answer is no: exit code 1.
    No(Vec<Report>),
    /// The answer was not found within the budget: exit code 3.
    Undecided(Vec<Report>),
    /// It was broken off by Ctrl-C; what was printed is a part of the answer: exit code 130.
    Interrupted(Vec<Report>),
    /// Whoever read the output went away: nothing to say.
    Gone,
}

impl Failure {
    /// A bad input that a sentence and a hint tell.
    pub fn input(code: &'static str, message: String, hint: &str) -> Self {
        Self::Input(vec![Said { code, message, hint: hint.to_owned(), place: None }.into()])
    }

    /// The same at a place, which the message names too.
    pub fn input_at(place: Place, code: &'static str, message: String, hint: &str) -> Self {
        Self::Input(vec![Said { code, message, hint: hint.to_owned(), place: Some(place) }.into()])
    }

    /// The answer is no, as a sentence and a hint tell.
    pub fn no(code: &'static str, message: String, hint: &str) -> Self {
        Self::No(vec![Said { code, message, hint: hint.to_owned(), place: None }.into()])
    }

    /// It was broken off, as a sentence and a hint tell.
    pub fn interrupted(message: String, hint: &str) -> Self {
        Self::Interrupted(vec![
            Said { code: "interrupted", message, hint: hint.to_owned(), place: None }.into(),
        ])
    }

    /// What is to be said with `--json`, if there is anything.
    pub fn errors(&self) -> Option<Errors> {
        match self {
            Self::Input(reports) | Self::No(reports) | Self::Undecided(reports) => Errors::of(reports),
            Self::Interrupted(reports) => Errors::of(reports).map(Errors::interrupted),
            Self::Gone => None,
        }
    }

    /// The exit code that says it.
    pub fn code(&self) -> ExitCode {
        ExitCode::from(match self {
            Self::Gone => 0,
            Self::No(_) => 1,
            Self::Input(_) => 2,
            Self::Undecided(_) => 3,
            Self::Interrupted(_) => interrupt::EXIT_CODE,
        })
    }

    /// Says it on stderr.
    pub fn say(self) {
        match self {
            Self::Input(reports)
            | Self::No(reports)
            | Self::Undecided(reports)
            | Self::Interrupted(reports) => say_all(reports),
            Self::Gone => {}
        }
    }
}

impl From<Problems> for Failure {
    fn from(problems: Problems) -> Self {
        let is_interrupted = problems.is_interrupted();
        let reports = problems.into_iter().map(Report::new).collect();
        if is_interrupted { Self::Interrupted(reports) } else { Self::Input(reports) }
    }
}

impl From<Problem> for Failure {
    fn from(problem: Problem) -> Self {
        Self::Input(vec![problem.into()])
    }
}

impl From<WriteError> for Failure {
    fn from(error: WriteError) -> Self {
        Self::Input(vec![error.into()])
    }
}

impl From<Unfinished> for Failure {
    fn from(unfinished: Unfinished) -> Self {
        match unfinished {
            Unfinished::Problems(problems) => problems.into(),
            Unfinished::Unwritten(error) => error.into(),
        }
    }
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        if error.kind() == io::ErrorKind::BrokenPipe {
            return Self::Gone;
        }
        Self::input("write", format!("cannot write to stdout: {error}"), "is the disk full?")
    }
}

/// What a sentence and a hint tell, perhaps in line and column of a file.
#[derive(Debug)]
pub struct Said {
    code: &'static str,
    message: String,
    hint: String,
    pub place: Option<Place>,
}

/// A file, and where in it that is known.
#[derive(Clone, Debug)]
pub struct Place {
    pub file: String,
    pub line: Option<usize>,
    pub column: Option<usize>,
}

impl Display for Said {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Said {}

impl Diagnostic for Said {
    fn code<'a>(&'a self) -> Option<Box<dyn Display + 'a>> {
        Some(Box::new(format!("error[{}]", self.code)))
    }
    fn help<'a>(&'a self) -> Option<Box<dyn Display + 'a>> {
        Some(Box::new(&self.hint))
    }
}

/// Bad arguments, or a wish for help, in clap's words; what is to be said with `--json` of bad ones.
pub fn usage(error: &clap::Error) -> Option<Errors> {
    let text = error.to_string();
    let message = match error.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => return None,
        ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => "no command is given",
        _ => text.split("\n\n").next().unwrap_or_default().trim_start_matches("error: "),
    };
    let hint = "flexure --help lists commands and options".to_owned();
    Errors::of(&[Said { code: "usage", message: message.trim().to_owned(), hint, place: None }.into()])
}

/// Shows problems on stderr.
pub fn say<'a>(problems: impl IntoIterator<Item = &'a Problem>) {
    say_all(problems.into_iter().cloned().map(Report::new).collect());
}

fn say_all(reports: Vec<Report>) {
    // Nobody can be told that stderr is gone.
    let mut err = io::stderr().lock();
    let groups = alike(reports);
    let rest: usize = groups.iter().skip(MOST_SHOWN).map(Vec::len).sum();
    for group in groups.iter().take(MOST_SHOWN) {
        let shown = if group.len() < MANY_ALIKE { group.len() } else { 1 };
        for report in &group[..shown] {
            let _ = writeln!(err, "{report:?}");
        }
        if shown < group.len() {
            let _ = writeln!(err, "  and {} more of this kind:", group.len() - shown);
        }
        for report in group[shown..].iter().take(MOST_SHOWN) {
            let _ = writeln!(err, "    {}", in_a_line(report));
        }
        if group.len() > shown + MOST_SHOWN {
            let _ = writeln!(err, "    …");
        }
    }
    if rest > 0 {
        let _ = writeln!(err, "and {rest} more");
    }
}

/// So many problems of a kind are one message.
const MANY_ALIKE: usize = 3;

/// Problems that have code and hint in common, each beside the first of its kind.
fn alike(reports: Vec<Report>) -> Vec<Vec<Report>> {
    let kind = |report: &Report| {
        (report.code().map(|code| code.to_string()), report.help().map(|help| help.to_string()))
    };
    let mut groups: Vec<Vec<Report>> = Vec::new();
    for report in reports {
        match groups.iter_mut().find(|group| kind(&group[0]) == kind(&report)) {
            Some(group) => group.push(report),
            None => groups.push(vec![report]),
        }
    }
    groups
}

/// A problem with its place, without the line of the file.
fn in_a_line(report: &Report) -> String {
    let place = report.downcast_ref::<Problem>().and_then(|problem| {
        let (line, column) = problem.line_column()?;
        Some(format!("{}:{line}:{column}: ", problem.file()?))
    });
    place.unwrap_or_default() + &report.to_string()
}

/// Decides how problems are drawn: on a terminal in colour and in its width; elsewhere a sentence is a line, so that it
/// can be searched for.
pub fn install() {
    let terminal = io::stderr().is_terminal();
    // Fails only if it was done before.
    let _ = miette::set_hook(Box::new(move |_| {
        let options = MietteHandlerOpts::new()
            .without_cause_chain() // the message has it
            .wrap_lines(terminal)
            .break_words(false)
            .word_splitter(WordSplitter::NoHyphenation); // paths and names stay whole
        // miette takes 80 columns where there is no terminal.
        Box::new(if terminal { options } else { options.width(usize::from(u16::MAX)) }.build())
    }));
}
