//! Traces as CSV.

use std::io;
use std::ops::ControlFlow;
use std::path::Path;

use crate::files::{Pending, WriteError};
use crate::simulate::excerpt::Excerpt;
use crate::simulate::sink::Sink;
use crate::simulate::trace::Trace;

/// Bytes that are written at once.
const BUFFER: usize = 1 << 16;

/// A trace on its way into a CSV file: a header of column names, then a row an instant, numbers with the fewest digits that restore
/// them exactly. Units are those of docs/notation.md.
///
/// The file has its name once it is [kept](Self::keep); until then it has a temporary one, and it goes with this if that never
/// happens.
#[derive(Debug)]
pub struct TraceFile {
    csv: csv::Writer<Pending>,
    excerpt: Excerpt,
    /// Rows to leave out before the next one that is written.
    left_out: u32,
    /// Why the last row could not be written.
    cause: Option<io::Error>,
}

impl TraceFile {
    /// A file that will be at `path`, with what `excerpt` has of every row; its folder is made if it is missing.
    ///
    /// # Errors
    /// If no file can be created there.
    pub fn create(path: &Path, excerpt: Excerpt) -> Result<Self, WriteError> {
        let mut csv = csv::WriterBuilder::new().buffer_capacity(BUFFER).from_writer(Pending::create(path)?);
        let cause = csv.write_record(excerpt.names()).err().map(io::Error::from);
        Ok(Self { csv, excerpt, left_out: 0, cause })
    }

    /// Where it will be.
    pub fn path(&self) -> &Path {
        self.csv.get_ref().path()
    }

    /// Gives the file its name.
    ///
    /// # Errors
    /// If something could not be written, now or before: there is no file then, or the one that was there.
    pub fn keep(self) -> Result<(), WriteError> {
        let Self { csv, .. } = self.sound()?;
        let path = csv.get_ref().path().to_owned();
        let file =
            csv.into_inner().map_err(|error| WriteError::Content { path, cause: error.into_error() })?;
        file.keep()
    }

    /// The same file, if everything could be written so far.
    ///
    /// # Errors
    /// If not.
    pub fn sound(self) -> Result<Self, WriteError> {
        match self.cause {
            Some(cause) => Err(WriteError::Content { path: self.csv.get_ref().path().to_owned(), cause }),
            None => Ok(self),
        }
    }

    fn write(&mut self, row: &[f64]) -> io::Result<()> {
        let mut digits = ryu::Buffer::new();
        for column in self.excerpt.columns() {
            self.csv.write_field(digits.format(row[column]))?;
        }
        Ok(self.csv.write_record(None::<&[u8]>)?)
    }
}

/// Breaks off when a row cannot be written; [`keep`](TraceFile::keep) says why.
impl Sink for TraceFile {
    fn take(&mut self, row: &[f64]) -> ControlFlow<()> {
        if self.left_out > 0 {
            self.left_out -= 1;
        } else if self.cause.is_none() {
            self.left_out = self.excerpt.every().get() - 1;
            self.cause = self.write(row).err();
        }
        if self.cause.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// Writes a whole trace as CSV, as [`TraceFile`] has it.
///
/// # Errors
/// If it cannot be written.
pub fn write_trace(path: &Path, trace: &Trace) -> Result<(), WriteError> {
    let mut file = TraceFile::create(path, Excerpt::whole(&trace.signals()))?;
    trace.pour(&mut file);
    file.keep()
}
