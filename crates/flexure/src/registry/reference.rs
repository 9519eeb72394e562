//! The references by name.

use flexure_core::linalg::Vector;
use flexure_core::reference::{Multisine, PointToPoint, Reference, Sine, SmoothStart, Smoothstep, Term};
use flexure_core::scalar::{Interval, Jet, Over, Piecewise, Scalar};

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

/// Any registered reference for `N` joints, with constants of type `C`.
///
/// On intervals it encloses the reference that the decimals of the scenario make exactly. Only a path through samples *is*
/// the spline with the coefficients that floats gave it, which are points on intervals: samples are measured or computed,
/// not meant to the last digit.
#[derive(Clone, Debug)]
pub enum AnyReference<C, const N: usize> {
    /// Sines.
    Sine(Sine<C, N>),
    /// Sums of sines.
    Multisine(Multisine<C, Vec<Term<C, N>>, N>),
    /// Rest to rest.
    PointToPoint(PointToPoint<C, N>),
    /// Through samples.
    Samples(Samples<C, N>),
    /// Any other, joined from rest.
    SmoothStart(Box<SmoothStart<C, AnyReference<C, N>, N>>),
}

impl<const N: usize> AnyReference<f64, N> {
    /// The reference of a scenario, with its smooth start from the robot's initial position.
    ///
    /// # Errors
    /// If there is no spline through the samples.
    pub fn new(scenario: &io::Scenario) -> Result<Self, io::Problems> {
        Self::over(scenario, |x| x)
    }
}

impl<const N: usize> AnyReference<Interval, N> {
    /// The reference of a scenario with its decimals enclosed, smooth start and initial position too.
    ///
    /// # Errors
    /// If there is no spline through the samples.
    pub fn enclosed(scenario: &io::Scenario) -> Result<Self, io::Problems> {
        Self::over(scenario, |x| scenario.bounds(x))
    }
}

impl<C: Scalar, const N: usize> AnyReference<C, N> {
    /// The reference of a scenario with its numbers, but for samples, through `number`.
    fn over(scenario: &io::Scenario, number: impl Fn(f64) -> C) -> Result<Self, io::Problems> {
        let vector = |values: &[f64]| vector(values).map(&number);
        let sine = |term: &io::Term| Term {
            amplitude: vector(&term.amplitude),
            frequency: vector(&term.frequency),
            phase: vector(&term.phase),
        };
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
                Self::PointToPoint(PointToPoint {
                    from: vector(from),
                    to: vector(to),
                    start: number(*start),
                    duration: number(*duration),
                    step,
                })
            }
            io::Reference::Samples { t, q } => Self::Samples(path(scenario, t, q)?.map(C::from_f64)),
        };
        Ok(match scenario.smooth_start {
            Some(duration) => {
                let from = vector(&scenario.initial.q_l);
                let duration = number(duration);
                Self::SmoothStart(Box::new(SmoothStart::from_rest(from, duration, reference)))
            }
            None => reference,
        })
    }
}

impl<const N: usize> AnyReference<Interval, N> {
    /// Times in s at which the fourth derivative may jump; anywhere else it is continuous. Between the samples of a path
    /// derivatives are continuous up to the rounding of its coefficients only, so that all of them count.
    pub fn breaks(&self) -> Vec<Interval> {
        match self {
            Self::PointToPoint(motion) if motion.step != Smoothstep::Nonic => {
                vec![motion.start, motion.start + motion.duration]
            }
            Self::Sine(_) | Self::Multisine(_) | Self::PointToPoint(_) => Vec::new(),
            Self::Samples(path) => path.knots().collect(),
            Self::SmoothStart(joined) => joined.then.breaks(),
        }
    }

    /// Times in s at which the fifth derivative may jump, beside the [`breaks`](Self::breaks); anywhere else all
    /// derivatives are continuous.
    pub fn kinks(&self) -> Vec<Interval> {
        match self {
            Self::Sine(_) | Self::Multisine(_) | Self::Samples(_) => Vec::new(),
            Self::PointToPoint(motion) => vec![motion.start, motion.start + motion.duration],
            Self::SmoothStart(joined) => {
                let ends = [Interval::ZERO, joined.duration];
                joined.then.kinks().into_iter().chain(ends).collect()
            }
        }
    }
}

/// The spline through the samples of a scenario.
fn path<const N: usize>(
    scenario: &io::Scenario,
    t: &[f64],
    q: &[Vec<f64>],
) -> Result<Samples<f64, N>, io::Problems> {
    let samples: Vec<_> = t.iter().copied().zip(q.iter().map(|q| vector(q))).collect();
    Samples::new(&samples).map_err(|error| {
        let help = "the path must be a smooth motion: check the numbers of that sample";
        scenario.places.problem("reference.file", "samples", error.to_string(), help).into()
    })
}

impl<C: Scalar, const N: usize> Reference<C, N> for AnyReference<C, N>
where
    Samples<C, N>: Reference<C, N>,
{
    fn on<T: Over<C> + Piecewise>(&self, t: T) -> Vector<T, N> {
        match self {
            Self::Sine(reference) => reference.on(t),
            Self::Multisine(reference) => reference.on(t),
            Self::PointToPoint(reference) => reference.on(t),
            Self::Samples(reference) => reference.on(t),
            Self::SmoothStart(reference) => reference.on(t),
        }
    }

    fn at<const K: usize>(&self, t: C) -> Vector<Jet<C, K>, N>
    where
        C: Over<C> + Piecewise,
    {
        match self {
            Self::Sine(reference) => reference.at(t),
            Self::Multisine(reference) => reference.at(t),
            Self::PointToPoint(reference) => reference.at(t),
            Self::Samples(reference) => reference.at(t),
            Self::SmoothStart(reference) => reference.at(t),
        }
    }
}
