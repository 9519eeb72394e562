//! Printing on stdout.

use std::io::{self, BufWriter, Write};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use flexure::report::WIDTH;
use serde::Serialize;
use terminal_size::{Width, terminal_size_of};
use textwrap::core::display_width;
use textwrap::{Options, WordSeparator, WordSplitter};

use crate::complaint::Errors;
use crate::failure::Failure;
use crate::interrupt;

/// A terminal that says that it is narrower is not believed.
const NARROWEST: usize = 40;

/// The document of `--json`, kept until it is known how the command ends.
static DOCUMENT: Mutex<Option<String>> = Mutex::new(None);

/// One JSON document and a newline, printed at the [end].
pub fn json(document: &impl Serialize) -> Result<(), Failure> {
    let text = serde_json::to_string_pretty(document).map_err(io::Error::from)?;
    *DOCUMENT.lock().unwrap_or_else(PoisonError::into_inner) = Some(text);
    Ok(())
}

/// Prints the document: the answer, with what is wrong in its key `error`, or only that where there is no answer. An
/// answer that is a list says itself what is wrong with its entries.
pub fn end(errors: Option<Errors>) -> Result<(), Failure> {
    let answer = DOCUMENT.lock().unwrap_or_else(PoisonError::into_inner).take();
    let errors =
        errors.map(|errors| serde_json::to_string_pretty(&errors)).transpose().map_err(io::Error::from)?;
    let document = match (answer, errors) {
        (None, None) => return Ok(()),
        (Some(answer), Some(errors)) => joined(answer, &errors),
        (Some(only), None) | (None, Some(only)) => only,
    };
    let mut out = io::stdout().lock();
    writeln!(out, "{document}")?;
    Ok(out.flush()?)
}

/// An object with the keys of two, the second not empty; the first as it is if it is none or empty.
fn joined(mut first: String, second: &str) -> String {
    if let (true, Some(rest)) = (first.ends_with("\n}"), second.strip_prefix('{')) {
        first.truncate(first.len() - "\n}".len());
        first.push(',');
        first.push_str(rest);
    }
    first
}

/// Rows as JSON Lines, or with `as_one` as one JSON array.
pub fn rows(rows: &[impl Serialize], as_one: bool) -> Result<(), Failure> {
    if as_one {
        return json(&rows);
    }
    interrupt::speak();
    let mut out = BufWriter::new(io::stdout().lock());
    for row in rows {
        serde_json::to_writer(&mut out, row).map_err(io::Error::from)?;
        writeln!(out)?;
    }
    Ok(out.flush()?)
}

/// Text that ends in a newline.
pub fn text(text: &str) -> Result<(), Failure> {
    interrupt::speak();
    Ok(write!(io::stdout(), "{text}")?)
}

/// Lines of text, none wider than the terminal.
pub fn line(text: &str) -> Result<(), Failure> {
    interrupt::speak();
    match terminal_width() {
        Some(width) => Ok(writeln!(io::stdout(), "{}", wrapped(text, width))?),
        None => Ok(writeln!(io::stdout(), "{text}")?),
    }
}

/// Which files were written, a line each.
pub fn wrote<P: AsRef<Path>>(files: &[P]) -> Result<(), Failure> {
    files.iter().try_for_each(|file| line(&format!("wrote {}", file.as_ref().display())))
}

/// Columns that a table may take: those of the terminal; elsewhere those that it is made for.
pub fn columns() -> usize {
    terminal_width().unwrap_or(WIDTH)
}

/// Columns of the terminal that stdout is, if it is one.
fn terminal_width() -> Option<usize> {
    terminal_size_of(io::stdout()).map(|(Width(columns), _)| usize::from(columns).max(NARROWEST))
}

/// Lines wrapped between words; what goes on begins below the text after a label, or two columns in.
fn wrapped(text: &str, width: usize) -> String {
    let lines = text.lines().map(|line| {
        let indent = " ".repeat(hanging(line).min(width / 3));
        let options = Options::new(width)
            .subsequent_indent(&indent)
            .break_words(false)
            .word_separator(WordSeparator::AsciiSpace)
            .word_splitter(WordSplitter::NoHyphenation);
        if display_width(line) <= width { line.to_owned() } else { textwrap::fill(line, options) }
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// Where the text of a line begins: after its label, which two blanks end.
fn hanging(line: &str) -> usize {
    let inside = line.trim_start();
    let begin = line.len() - inside.len();
    let label =
        inside.find("  ").map(|end| &inside[..end + inside[end..].chars().take_while(|c| *c == ' ').count()]);
    begin + label.map_or(2, display_width)
}
