//! Traces as CSV.

use std::path::Path;

use crate::files::{WriteError, write_atomic};
use crate::simulate::Trace;

/// Writes a trace as CSV: a header of column names, then a row an instant, numbers with the fewest digits that restore
/// them exactly. Units are those of docs/notation.md.
///
/// # Errors
/// If it cannot be written.
pub fn write_trace(path: &Path, trace: &Trace) -> Result<(), WriteError> {
    write_atomic(path, |out| {
        let mut csv = csv::Writer::from_writer(out);
        csv.write_record(trace.columns().iter().map(|column| &column.name))?;
        let mut digits = ryu::Buffer::new();
        for i in 0..trace.len() {
            for column in trace.columns() {
                csv.write_field(digits.format(column.values[i]))?;
            }
            csv.write_record(None::<&[u8]>)?;
        }
        csv.flush()
    })
}
