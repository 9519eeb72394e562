//! What is wrong with a file: one problem, and all of them.

use std::fmt;
use std::ops::Range;

use miette::{Diagnostic, LabeledSpan, Severity, SourceCode};

use crate::files::source::{self, Source};

/// One thing wrong with a file, or suspicious about it: what, where, and what to do.
#[derive(Clone, Debug, thiserror::Error)]
#[error("{message}")]
pub struct Problem {
    message: String,
    code: &'static str,
    help: String,
    severity: Severity,
    place: Option<Box<(Source, Range<usize>)>>,
}

impl Problem {
    /// An error that concerns no place in a file.
    pub(crate) fn new(code: &'static str, message: impl Into<String>, help: impl Into<String>) -> Self {
        // Libraries quote what they read.
        let (message, help) = (source::harmless(message.into()), source::harmless(help.into()));
        Self { message, code, help, severity: Severity::Error, place: None }
    }

    /// The same problem, at the bytes `span` of `source`.
    pub(crate) fn at(self, source: &Source, span: Range<usize>) -> Self {
        Self { place: Some(Box::new(source.part_with(span))), ..self }
    }

    /// The same problem, at `span` of `source` if it has no place yet.
    pub(crate) fn or_at(self, source: &Source, span: Range<usize>) -> Self {
        if self.place.is_some() { self } else { self.at(source, span) }
    }

    /// The same problem as a warning.
    #[must_use]
    pub fn warning(self) -> Self {
        Self { severity: Severity::Warning, ..self }
    }

    /// Whether the file can be used all the same.
    pub fn is_warning(&self) -> bool {
        self.severity == Severity::Warning
    }

    /// Name of the file that the problem is in.
    pub fn file(&self) -> Option<&str> {
        self.place.as_deref().map(|(source, _)| &*source.name)
    }

    /// Line and column, counted from 1; the column in characters.
    pub fn line_column(&self) -> Option<(usize, usize)> {
        let (source, span) = self.place.as_deref()?;
        source.line_column(span.start)
    }

    /// What kind of problem it is, in one word that stays the same: docs/files.md lists them.
    pub fn code_word(&self) -> &'static str {
        self.code
    }

    /// A hint: what to do about it.
    pub fn hint(&self) -> &str {
        &self.help
    }
}

impl Diagnostic for Problem {
    fn code<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        Some(Box::new(format!("{}[{}]", if self.is_warning() { "warning" } else { "error" }, self.code)))
    }
    fn severity(&self) -> Option<Severity> {
        Some(self.severity)
    }
    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        Some(Box::new(&self.help))
    }
    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.place.as_deref().map(|(source, _)| source as &dyn SourceCode)
    }
    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let (source, span) = self.place.as_deref()?;
        Some(Box::new(std::iter::once(LabeledSpan::underline(source.in_view(span)))))
    }
}

/// Why a file cannot be used: at least one [`Problem`]. As a diagnostic it is the first one, with the others related.
#[derive(Clone, Debug)]
pub struct Problems {
    first: Box<Problem>,
    rest: Vec<Problem>,
}

impl Problems {
    /// All of them, in the order they were found.
    pub fn iter(&self) -> impl Iterator<Item = &Problem> {
        std::iter::once(&*self.first).chain(&self.rest)
    }

    /// Errors if there are any, else the warnings.
    pub(crate) fn or_warnings(problems: Vec<Problem>) -> Result<Vec<Problem>, Self> {
        let (warnings, errors): (Vec<_>, Vec<_>) = problems.into_iter().partition(Problem::is_warning);
        let mut errors = errors.into_iter();
        match errors.next() {
            None => Ok(warnings),
            Some(first) => Err(Self { first: Box::new(first), rest: errors.chain(warnings).collect() }),
        }
    }
}

/// The code of the problem of a job that was broken off.
pub(crate) const INTERRUPTED: &str = "interrupted";

impl Problems {
    /// That a long job was broken off by whoever watched it.
    pub fn interrupted() -> Self {
        Problem::new(INTERRUPTED, "broken off before anything was finished", "nothing is written").into()
    }

    /// Whether this says that a job was [broken off](Self::interrupted).
    pub fn is_interrupted(&self) -> bool {
        self.first.code == INTERRUPTED
    }
}

impl From<Problem> for Problems {
    fn from(first: Problem) -> Self {
        Self { first: Box::new(first), rest: Vec::new() }
    }
}

impl IntoIterator for Problems {
    type Item = Problem;
    type IntoIter = std::iter::Chain<std::iter::Once<Problem>, std::vec::IntoIter<Problem>>;

    fn into_iter(self) -> Self::IntoIter {
        std::iter::once(*self.first).chain(self.rest)
    }
}

impl fmt::Display for Problems {
    /// One line a problem: `robots/arm.toml:12:14: message`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, problem) in self.iter().enumerate() {
            if i > 0 {
                writeln!(f)?;
            }
            if let (Some(file), Some((line, column))) = (problem.file(), problem.line_column()) {
                write!(f, "{file}:{line}:{column}: ")?;
            }
            write!(f, "{problem}")?;
        }
        Ok(())
    }
}

impl std::error::Error for Problems {}

impl Diagnostic for Problems {
    fn code<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        self.first.code()
    }
    fn severity(&self) -> Option<Severity> {
        self.first.severity()
    }
    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        self.first.help()
    }
    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.first.source_code()
    }
    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        self.first.labels()
    }
    fn related<'a>(&'a self) -> Option<Box<dyn Iterator<Item = &'a dyn Diagnostic> + 'a>> {
        (!self.rest.is_empty())
            .then(|| Box::new(self.rest.iter().map(|problem| problem as &dyn Diagnostic)) as Box<_>)
    }
}
