//! Printing on stdout.

use std::io::{self, BufWriter, Write};
use std::sync::{Mutex, PoisonError};

use serde::Serialize;

use crate::complaint::Errors;
use crate::failure::Failure;

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
    let mut out = BufWriter::new(io::stdout().lock());
    for row in rows {
        serde_json::to_writer(&mut out, row).map_err(io::Error::from)?;
        writeln!(out)?;
    }
    Ok(out.flush()?)
}

/// Text that ends in a newline.
pub fn text(text: &str) -> Result<(), Failure> {
    Ok(write!(io::stdout(), "{text}")?)
}

/// A line of text.
pub fn line(text: &str) -> Result<(), Failure> {
    Ok(writeln!(io::stdout(), "{text}")?)
}
