//! Printing on stdout.

use std::io::{self, BufWriter, Write};

use serde::Serialize;

use crate::failure::Failure;

/// One JSON document and a newline.
pub fn json(document: &impl Serialize) -> Result<(), Failure> {
    let mut out = BufWriter::new(io::stdout().lock());
    serde_json::to_writer_pretty(&mut out, document).map_err(io::Error::from)?;
    writeln!(out)?;
    Ok(out.flush()?)
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
