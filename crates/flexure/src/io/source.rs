//! The text of a file, read with care.

use std::fs::File;
use std::io::Read;
use std::path::Path;
use std::sync::Arc;

use miette::{MietteError, MietteSpanContents, SourceCode, SourceSpan, SpanContents};

use super::diagnostic::Problem;

/// Largest file that is read [bytes].
const LIMIT: u64 = 16 << 20;

/// A file's name and text, or a part of it from some line on; cheap to clone.
#[derive(Clone, Debug)]
pub(super) struct Source {
    pub name: Arc<str>,
    pub text: Arc<str>,
    /// Lines of the file before `text`.
    lines_before: usize,
}

impl Source {
    /// From text that is at hand.
    pub fn new(name: &str, text: &str) -> Self {
        Self::part(name, text, 0)
    }

    /// From the text after `lines_before` lines.
    pub fn part(name: &str, text: &str, lines_before: usize) -> Self {
        Self { name: name.into(), text: text.into(), lines_before }
    }

    /// Line and column of the byte at `offset`, counted from 1; the column in characters.
    pub fn line_column(&self, offset: usize) -> Option<(usize, usize)> {
        let before = self.text.get(..offset)?;
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let column = before.get(line_start..)?.chars().count() + 1;
        Some((self.lines_before + before.matches('\n').count() + 1, column))
    }
}

impl SourceCode for Source {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        lines_before: usize,
        lines_after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let found = self.text.read_span(span, lines_before, lines_after)?;
        Ok(Box::new(MietteSpanContents::new_named(
            self.name.to_string(),
            found.data(),
            *found.span(),
            found.line() + self.lines_before,
            found.column(),
            found.line_count(),
        )))
    }
}

/// Reads the text file at `path`.
pub(super) fn read(path: &Path) -> Result<Source, Problem> {
    let name = path.display();
    let unreadable = |error: std::io::Error| {
        Problem::new(
            "unreadable",
            format!("cannot read {name}: {error}"),
            "give the path of a text file (a path inside a file is relative to that file), or the name of a \
             built-in robot or scenario",
        )
    };
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(unreadable)?;
    file.take(LIMIT + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    if bytes.len() as u64 > LIMIT {
        return Err(Problem::new(
            "huge",
            format!("{name} is larger than {} MiB", LIMIT >> 20),
            "robot, scenario and sample files are small; is it the right file?",
        ));
    }
    let text = String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let before = error.as_bytes().get(..valid).unwrap_or_default();
        let line = before.split(|&byte| byte == b'\n').count();
        let clean = String::from_utf8_lossy(error.as_bytes());
        Problem::new(
            "encoding",
            format!("{name} is not UTF-8: invalid byte {valid} in line {line}"),
            "save the file as UTF-8 text",
        )
        .at(&Source::new(&name.to_string(), &clean), valid..valid)
    })?;
    Ok(Source::new(&name.to_string(), &text))
}
