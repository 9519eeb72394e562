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

impl<const N: usize> AnyReference<N> {
    /// The reference of a scenario, with its smooth start from the robot's initial position.
    ///
    /// # Errors
    /// If there is no spline through the samples.
    pub fn new(scenario: &io::Scenario) -> Result<Self, io::Problems> {
        let reference = match &scenario.reference {
            io::Reference::Sines { offset, terms } => match terms.as_slice() {
                [term] => {
                    let Term { amplitude, frequency, phase } = sine(term);
                    Self::Sine(Sine { offset: vector(offset), amplitude, frequency, phase })
                }
                terms => Self::Multisine(Multisine {
                    offset: vector(offset),
                    terms: terms.iter().map(sine).collect(),
                }),
            },
            io::Reference::PointToPoint { profile, from, to, start, duration } => {
                let step = match profile {
                    io::Profile::Quintic => Smoothstep::Quintic,
                    io::Profile::Septic => Smoothstep::Septic,
                    io::Profile::Nonic => Smoothstep::Nonic,
                };
                let (from, to) = (vector(from), vector(to));
                Self::PointToPoint(PointToPoint { from, to, start: *start, duration: *duration, step })
            }
            io::Reference::Samples { t, q } => {
                let samples: Vec<_> = t.iter().copied().zip(q.iter().map(|q| vector(q))).collect();
                Self::Samples(Samples::new(&samples).map_err(|error| {
                    let help = "the path must be a smooth motion: check the numbers of that sample";
                    io::Problems::from(scenario.places.problem(
                        "reference.file",
                        "samples",
                        error.to_string(),
                        help,
                    ))
                })?)
            }
        };
        Ok(match scenario.smooth_start {
            Some(duration) => {
                let from = vector(&scenario.initial.q_l);
                Self::SmoothStart(Box::new(SmoothStart { from, duration, then: reference }))
            }
            None => reference,
        })
    }
}

fn sine<const N: usize>(term: &io::Term) -> Term<f64, N> {
    Term {
        amplitude: vector(&term.amplitude),
        frequency: vector(&term.frequency),
        phase: vector(&term.phase),
    }
}

impl<const N: usize> Reference<f64, N> for AnyReference<N> {
    fn on<T: Over<f64> + Piecewise>(&self, t: T) -> Vector<T, N> {
        match self {
            Self::Sine(reference) => reference.on(t),
            Self::Multisine(reference) => reference.on(t),
            Self::PointToPoint(reference) => reference.on(t),
            Self::Samples(reference) => reference.on(t),
            Self::SmoothStart(reference) => reference.on(t),
        }
    }

    fn at<const K: usize>(&self, t: f64) -> Vector<Jet<f64, K>, N> {
        match self {
            Self::Sine(reference) => reference.at(t),
            Self::Multisine(reference) => reference.at(t),
            Self::PointToPoint(reference) => reference.at(t),
            Self::Samples(reference) => reference.at(t),
            Self::SmoothStart(reference) => reference.at(t),
        }
    }
}
