//! The text of a file, read with care.

use std::fs::File;
use std::io::Read;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use miette::{MietteError, MietteSpanContents, SourceCode, SourceSpan, SpanContents};

use crate::files::change::Change;
use crate::files::diagnostic::Problem;

/// A file's name and text, or a part of it from some line on, perhaps with changes appended; cheap to clone.
#[derive(Clone, Debug)]
pub(crate) struct Source {
    pub name: Arc<str>,
    pub text: Arc<str>,
    /// `text` without control characters, byte for byte as long: what a terminal may be shown.
    shown: Arc<str>,
    /// Lines of the file before `text`.
    lines_before: usize,
    /// What `text` is put together from, in order; nothing for a file alone.
    parts: Arc<[Part]>,
    /// Bytes of `text` without changes.
    length: usize,
}

/// A part of a text that comes from elsewhere.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    /// Where it begins in the text.
    pub start: usize,
    /// The file, or the change.
    pub source: Source,
    /// Where it begins there.
    pub at: usize,
}

impl Source {
    /// From text that is at hand.
    pub fn new(name: &str, text: &str) -> Self {
        Self::part(name, text, 0)
    }

    /// From the text after `lines_before` lines.
    pub fn part(name: &str, text: &str, lines_before: usize) -> Self {
        let text: Arc<str> = text.into();
        let shown = if text.contains(is_hostile) { harmless(text.to_string()).into() } else { text.clone() };
        let length = text.len();
        Self { name: name.into(), text, shown, lines_before, parts: Arc::from([]), length }
    }

    /// The same text, put together from `parts`, which are in order.
    pub fn of_parts(self, parts: Vec<Part>) -> Self {
        Self { parts: parts.into(), ..self }
    }

    /// With the texts of `changes` behind that of the file.
    pub fn with(&self, changes: &[Change]) -> Self {
        if changes.is_empty() {
            return self.clone();
        }
        let file = Part { start: 0, source: self.clone(), at: 0 };
        let (mut text, mut parts) = (self.text.to_string(), vec![file]);
        for change in changes {
            text.push('\n');
            let source = Self::new(change.from(), change.text());
            parts.push(Part { start: text.len(), source, at: 0 });
            text.push_str(change.text());
        }
        Self { length: self.text.len(), ..Self::new(&self.name, &text).of_parts(parts) }
    }

    /// The text of the file alone.
    pub fn of_file(&self) -> &str {
        self.text.get(..self.length).unwrap_or_default()
    }

    /// Where the changes begin in the text.
    pub fn changes(&self) -> impl Iterator<Item = usize> {
        self.parts.iter().skip(1).map(|part| part.start)
    }

    /// Whether a change replaced a table that `key` was in.
    pub fn has_replaced(&self, key: &str) -> bool {
        let changed = self
            .parts
            .iter()
            .skip(1)
            .filter_map(|part| Some(part.source.text.split_once('=')?.0.trim().to_owned()));
        changed
            .into_iter()
            .any(|table| key.strip_prefix(&table).is_some_and(|rest| rest.starts_with(['.', '['])))
    }

    /// The part, file or change, that `span` is in, and where in it.
    pub fn part_with(&self, span: Range<usize>) -> (Self, Range<usize>) {
        match self.parts.iter().rfind(|part| part.start <= span.start) {
            Some(Part { start, source, at }) => {
                let there = |byte: usize| source.boundary(byte - start + at);
                (source.clone(), there(span.start)..there(span.end))
            }
            None => (self.clone(), span),
        }
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
        let found = self.shown.read_span(span, lines_before, lines_after)?;
        let (line, column) = self.line_column(span.offset()).ok_or(MietteError::OutOfBounds)?;
        // Without context it is asked where the span is; the column is in characters.
        let place = (lines_before + lines_after == 0).then_some((line - 1, column - 1));
        let named = |data, span, (line, column), count| {
            let name = self.name.to_string();
            Box::new(MietteSpanContents::new_named(name, data, span, line, column, count))
        };
        let wide = found.data().split(|&byte| byte == b'\n').any(|line| line.len() > WIDEST);
        if wide {
            let window = self.window(span.offset());
            let data = self.shown.get(window.clone()).unwrap_or_default().as_bytes();
            return Ok(named(data, window.into(), place.unwrap_or((line - 1, 0)), 1));
        }
        let place = place.unwrap_or((found.line() + self.lines_before, found.column()));
        Ok(named(found.data(), *found.span(), place, found.line_count()))
    }
}

/// Widest line that is shown whole \[bytes\].
pub(crate) const WIDEST: usize = 160;

impl Source {
    /// As much of `span` as is shown of it.
    pub fn in_view(&self, span: &Range<usize>) -> Range<usize> {
        let part = self.text.get(span.clone()).unwrap_or_default();
        if part.len() <= WIDEST / 4 || part.lines().all(|line| line.len() <= WIDEST / 4) {
            return span.clone();
        }
        let window = self.window(span.start);
        span.start..window.end.min(span.end).min(span.start + WIDEST / 4)
    }

    /// A part around `offset` of the line that it is in.
    fn window(&self, offset: usize) -> Range<usize> {
        let text = &*self.shown;
        let line_start = text[..offset].rfind('\n').map_or(0, |newline| newline + 1);
        let line_end = text[offset..].find('\n').map_or(text.len(), |newline| offset + newline);
        let start = self.boundary(offset.saturating_sub(WIDEST / 2)).max(line_start);
        start..self.boundary(start + WIDEST).min(line_end)
    }

    /// The last place at or before `at` where a character of the text ends.
    fn boundary(&self, at: usize) -> usize {
        (0..=at.min(self.text.len())).rev().find(|&i| self.text.is_char_boundary(i)).unwrap_or(0)
    }
}

/// Whether a terminal might obey `c`.
fn is_hostile(c: char) -> bool {
    c.is_control() && !matches!(c, '\n' | '\r' | '\t')
}

/// `text` with a question mark for every byte of what a terminal might obey.
pub(crate) fn harmless(text: String) -> String {
    if !text.contains(is_hostile) {
        return text;
    }
    text.chars()
        .flat_map(|c| {
            let (shown, count) = if is_hostile(c) { ('?', c.len_utf8()) } else { (c, 1) };
            std::iter::repeat_n(shown, count)
        })
        .collect()
}

/// The text of the file at `path`, of at most `limit` bytes, read once: pipes are files too.
///
/// # Errors
/// `unreadable`, `huge`, or `encoding` if it is not UTF-8.
pub fn read_text(path: &Path, limit: u64) -> Result<String, Problem> {
    Ok(read(path, limit)?.text.to_string())
}

/// Reads the text file at `path`, of at most `limit` bytes.
pub(crate) fn read(path: &Path, limit: u64) -> Result<Source, Problem> {
    read_as(path, path, limit)
}

/// That the file at `path` cannot be read.
pub(crate) fn unreadable(path: &Path, error: &std::io::Error) -> Problem {
    Problem::new(
        "unreadable",
        format!("cannot read {}: {error}", path.display()),
        "give the path of a text file (a path inside a file is relative to that file), or the name of a \
         built-in robot or scenario",
    )
}

/// Reads the text file at `real`, which is called `path`, of at most `limit` bytes.
pub(crate) fn read_as(path: &Path, real: &Path, limit: u64) -> Result<Source, Problem> {
    let name = path.display();
    let unreadable = |error| unreadable(path, &error);
    let mut bytes = Vec::new();
    let file = File::open(real).map_err(unreadable)?;
    file.take(limit + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    if bytes.len() as u64 > limit {
        return Err(Problem::new(
            "huge",
            format!("{name} is larger than {} MiB", limit >> 20),
            "files of this kind are smaller; is it the right file?",
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
