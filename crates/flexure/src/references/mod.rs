//! References: where the links shall be, in files and as functions of time with exact derivatives.
//!
//! A reference is a file here and a line in the list below; most of the functions of time are those of
//! [`flexure_core::reference`].

mod any;
mod clock;
pub(crate) mod document;
mod point_to_point;
mod registry;
mod sampled;
mod samples;
mod samples_file;
mod septic;
mod sines;

use flexure_core::linalg::Vector;
use flexure_core::reference;
use flexure_core::scalar::{Interval, Jet, Over, Piecewise};

use crate::files::{Entry, Places, Problem};
use registry::{Name, Named, ReferenceKind, references};

pub use any::{AnyReference, Plan};
pub(crate) use clock::when;
pub use document::{SmoothStart, Speed, TimeScaling};
pub use point_to_point::{PointToPoint, Profile};
pub use registry::{Instant, Jump};
pub use sampled::Sampled;
pub use samples::{Samples, SamplesError};
pub use samples_file::samples_from_text;
pub use sines::{Sines, Term};

// One line a reference, in the order in which lists show them.
references! {
    sines::Sines,
    point_to_point::PointToPoint,
    sampled::Sampled,
}

/// The registered references.
pub const REFERENCES: &[Entry] = &{
    let mut entries = [NAMES[0].entry; NAMES.len()];
    let mut i = 0;
    while i < NAMES.len() {
        entries[i] = NAMES[i].entry;
        i += 1;
    }
    entries
};
