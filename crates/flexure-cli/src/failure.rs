//! Why a command did not succeed, and the exit code that says so.

use std::io;
use std::process::ExitCode;

use flexure::io::{Problem, Problems, WriteError};
use miette::{Diagnostic, Report};

/// What ends a command early.
pub enum Failure {
    /// The input is bad, or an output cannot be written: exit code 2.
    Input(Box<dyn Diagnostic + Send + Sync>),
    /// The input is bad, and it has been said why: exit code 2.
    Bad(String),
    /// The answer is no: exit code 1. The text is for people.
    No(String),
    /// Whoever read the output went away: nothing to say.
    Gone,
}

impl Failure {
    /// Says it on stderr and gives the exit code.
    pub fn report(self) -> ExitCode {
        match self {
            Self::Input(diagnostic) => {
                eprintln!("{:?}", Report::new_boxed(diagnostic));
                ExitCode::from(2)
            }
            Self::Bad(text) => {
                eprintln!("{text}");
                ExitCode::from(2)
            }
            Self::No(text) => {
                eprintln!("{text}");
                ExitCode::from(1)
            }
            Self::Gone => ExitCode::SUCCESS,
        }
    }
}

impl From<Problems> for Failure {
    fn from(problems: Problems) -> Self {
        Self::Input(Box::new(problems))
    }
}

impl From<Problem> for Failure {
    fn from(problem: Problem) -> Self {
        Self::Input(Box::new(problem))
    }
}

impl From<WriteError> for Failure {
    fn from(error: WriteError) -> Self {
        Self::Input(Box::new(error))
    }
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        if error.kind() == io::ErrorKind::BrokenPipe {
            return Self::Gone;
        }
        Self::Input(Report::msg(format!("cannot write to stdout: {error}")).into())
    }
}

/// Shows warnings on stderr.
pub fn warn<'a>(warnings: impl IntoIterator<Item = &'a Problem>) {
    for warning in warnings {
        eprintln!("{:?}", Report::new(warning.clone()));
    }
}
