//! Printing on stdout, and the states that come in on stdin.

use std::fs::File;
use std::io::{self, BufRead, BufReader, BufWriter, Write};
use std::path::Path;

use flexure::io::{StateRow, States};
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

/// A line of text.
pub fn line(text: &str) -> Result<(), Failure> {
    Ok(writeln!(io::stdout(), "{text}")?)
}

/// All states of a file, or of standard input for `-`: everything is read and checked before anything is computed.
pub fn states(path: &Path, joints: usize) -> Result<Vec<StateRow>, Failure> {
    let reader: Box<dyn BufRead> = if path.as_os_str() == "-" {
        Box::new(io::stdin().lock())
    } else {
        let file = File::open(path).map_err(|error| {
            Failure::Bad(format!(
                "cannot read {}: {error}\n  hint: --states takes a file of JSON Lines with q_l, q_m, dq_l, dq_m, or - \
                 for standard input",
                path.display()
            ))
        })?;
        Box::new(BufReader::new(file))
    };
    let name = path.display().to_string();
    Ok(States::new(reader, joints, name).collect::<Result<_, _>>()?)
}
