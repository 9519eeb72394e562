//! References: where the links shall be, in files and as functions of time with exact derivatives.

mod any;
mod clock;
pub(crate) mod document;
mod samples;
mod samples_file;
mod septic;

pub use any::{AnyReference, REFERENCES};
pub(crate) use clock::when;
pub use document::{Profile, Reference, SmoothStart, Speed, Term, TimeScaling};
pub use samples::{Samples, SamplesError};
