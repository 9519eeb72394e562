//! The references by name.

use flexure_core::linalg::Vector;
use flexure_core::reference::{Multisine, PointToPoint, Reference, Sine, SmoothStart, Smoothstep, Term};
use flexure_core::scalar::{Jet, Over, Piecewise};

use super::Entry;
use super::robot::vector;
use crate::io;
use crate::reference::Samples;

/// The registered references.
pub const REFERENCES: &[Entry] = &[
    Entry { name: "sine", summary: "offset + amplitude sin(frequency t + phase), per joint" },
    Entry { name: "multisine", summary: "offset + a sum of sines, per joint" },
    Entry { name: "quintic", summary: "rest to rest, continuous up to the acceleration" },
    Entry { name: "septic", summary: "rest to rest, continuous up to the jerk" },
    Entry { name: "nonic", summary: "rest to rest, continuous up to the fourth derivative" },
    Entry { name: "samples", summary: "a path from a CSV file through a septic spline" },
];

/// Any registered reference for `N` joints.
#[derive(Clone, Debug)]
pub enum AnyReference<const N: usize> {
    /// Sines.
    Sine(Sine<f64, N>),
    /// Sums of sines.
    Multisine(Multisine<f64, Vec<Term<f64, N>>, N>),
    /// Rest to rest.
    PointToPoint(PointToPoint<f64, N>),
    /// Through samples.
    Samples(Samples<N>),
    /// Any other, joined from rest.
    SmoothStart(Box<SmoothStart<f64, AnyReference<N>, N>>),
}
