//! Why a job that writes as it goes has no outcome.

use crate::files::atomic::WriteError;
use crate::files::diagnostic::{Problem, Problems};

/// Why something is not there.
#[derive(Debug)]
pub enum Unfinished {
    /// It could not be computed, or what is there is of another job.
    Problems(Problems),
    /// It could not be written.
    Unwritten(WriteError),
}

impl From<WriteError> for Unfinished {
    fn from(error: WriteError) -> Self {
        Self::Unwritten(error)
    }
}

impl From<Problems> for Unfinished {
    fn from(problems: Problems) -> Self {
        Self::Problems(problems)
    }
}

impl From<Problem> for Unfinished {
    fn from(problem: Problem) -> Self {
        Self::Problems(problem.into())
    }
}
