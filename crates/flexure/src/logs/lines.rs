//! The lines of a text file as they come, and their cells: never more than a line at a time in memory.

use std::io::{BufRead, Read};
use std::ops::Range;

use crate::files::source::Source;
use crate::files::{Problem, suggest};

/// Longest line that is read \[bytes\].
const LONGEST: usize = 1 << 20;

/// Lines with something in them, one by one. Lines that begin with `#` are passed over.
pub(super) struct Lines<R> {
    reader: R,
    name: String,
    bytes: Vec<u8>,
    number: usize,
}

/// A line of the file.
pub(super) struct Line<'a> {
    name: &'a str,
    /// Counted from 1.
    pub number: usize,
    pub text: &'a str,
}

impl<R: BufRead> Lines<R> {
    pub fn new(reader: R, name: &str) -> Self {
        Self { reader, name: name.to_owned(), bytes: Vec::new(), number: 0 }
    }

    /// The next line; none at the end.
    pub fn next(&mut self) -> Result<Option<Line<'_>>, Problem> {
        loop {
            self.number += 1;
            self.bytes.clear();
            let limit = LONGEST as u64 + 1;
            let read = (&mut self.reader).take(limit).read_until(b'\n', &mut self.bytes);
            let length =
                read.map_err(|error| self.problem("unreadable", &format!("cannot be read: {error}")))?;
            if length == 0 {
                return Ok(None);
            }
            if length > LONGEST {
                return Err(self.problem("huge", &format!("the line is longer than {LONGEST} bytes")));
            }
            if self.number == 1 && self.bytes.starts_with(b"\xef\xbb\xbf") {
                self.bytes.drain(..3);
            }
            let is_blank = self.bytes.iter().all(u8::is_ascii_whitespace);
            if !is_blank && !self.bytes.starts_with(b"#") {
                break;
            }
        }
        match std::str::from_utf8(&self.bytes) {
            Ok(text) => Ok(Some(Line {
                name: &self.name,
                number: self.number,
                text: text.trim_end_matches(['\n', '\r']),
            })),
            Err(_) => Err(self.problem("encoding", "the line is not UTF-8")),
        }
    }

    /// A problem with the current line, which is not shown.
    fn problem(&self, code: &'static str, what: &str) -> Problem {
        let help = "a log is a CSV file: a line of column names, then a row of numbers per sample";
        Problem::new(code, what, help).at(&Source::part(&self.name, "", self.number - 1), 0..0)
    }
}

impl Line<'_> {
    /// A problem with the bytes `span` of it.
    pub fn problem(
        &self,
        span: Range<usize>,
        code: &'static str,
        what: impl Into<String>,
        help: impl Into<String>,
    ) -> Problem {
        Problem::new(code, what, help).at(&Source::part(self.name, self.text, self.number - 1), span)
    }

    /// A problem with all of it.
    pub fn whole(&self, code: &'static str, what: impl Into<String>, help: impl Into<String>) -> Problem {
        self.problem(0..self.text.len(), code, what, help)
    }

    /// What its cells are separated by: what there is most of.
    pub fn separator(&self) -> char {
        let count = |separator: &char| self.text.matches(*separator).count();
        // Of equals the comma.
        ['\t', ';', ','].into_iter().max_by_key(count).unwrap_or(',')
    }

    /// Its cells without blanks and quotes around them, and where they stand.
    pub fn cells(&self, separator: char) -> impl Iterator<Item = (Range<usize>, &str)> {
        let mut next = 0;
        self.text.split(separator).map(move |cell| {
            let start = next;
            next += cell.len() + separator.len_utf8();
            let around = |c: char| c.is_whitespace() || c == '"';
            let inner = cell.trim_matches(around);
            let from = start + (cell.len() - cell.trim_start_matches(around).len());
            (from..from + inner.len(), inner)
        })
    }

    /// The number `cell`, which stands at `span` in the column `name`.
    pub fn number(&self, span: Range<usize>, name: &str, cell: &str) -> Result<f64, Problem> {
        let name = suggest::quoted(name);
        let problem = |what: String, help: &str| Err(self.problem(span, "number", what, help));
        match cell.parse::<f64>() {
            Ok(x) if x.is_finite() => Ok(x),
            Ok(x) => problem(
                format!("column {name} is {x}, must be a finite number"),
                "samples are missing here: cut the log into parts without holes, or leave the channel out",
            ),
            Err(_) if cell.is_empty() => problem(
                format!("column {name} is empty, must be a number"),
                "samples are missing here: cut the log into parts without holes, or leave the channel out",
            ),
            Err(_) => problem(
                format!("column {name} is {}, must be a number", suggest::quoted(cell)),
                "numbers like 0.5 or 1e-3, with a point",
            ),
        }
    }
}
