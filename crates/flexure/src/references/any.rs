//! Any reference with what a scenario does to it: another clock, a smooth start.

use flexure_core::linalg::Vector;
use flexure_core::reference::{Clock, Reference, Retimed, SmoothStart, Stop};
use flexure_core::scalar::{Interval, Jet, Over, Piecewise, Scalar};

use crate::files::{Places, Problems};
use crate::references::{self, AnyPath, Instant, TimeScaling, when};

/// A registered reference as it is followed, for `N` joints, with constants of type `C`.
///
/// On intervals it encloses the reference that the decimals of the scenario make exactly. Only a path through samples *is*
/// the spline with the coefficients that floats gave it, which are points on intervals: samples are measured or computed,
/// not meant to the last digit.
#[derive(Clone, Debug, PartialEq)]
pub enum AnyReference<C: Instant, const N: usize> {
    /// As it is registered.
    Path(AnyPath<C, N>),
    /// Along another clock.
    Retimed(Box<Retimed<C, AnyPath<C, N>>>),
    /// Any of these, joined from the robot's motion.
    SmoothStart(Box<SmoothStart<C, AnyReference<C, N>, N>>),
}

/// What a scenario says of its reference.
#[derive(Clone, Copy, Debug)]
pub struct Plan<'a> {
    /// Where the links shall be.
    pub reference: &'a references::Reference,
    /// Another clock for it, if it has one.
    pub time_scaling: Option<TimeScaling>,
    /// How the robot joins it, if it does.
    pub smooth_start: Option<references::SmoothStart>,
    /// Where the keys stand in the scenario's file.
    pub places: &'a Places,
}

impl<C: Instant, const N: usize> AnyReference<C, N> {
    /// The reference of `plan` at the speed of its time scaling, if it has one, replaced by `speed`; with its numbers, but
    /// for samples and the speed, through `number`. `motion` gives the motion of the links when the run begins, to the jerk;
    /// it is asked for a smooth start only.
    ///
    /// # Errors
    /// If there is no spline through the samples, or `motion` has an error.
    pub fn at_speed(
        plan: &Plan<'_>,
        speed: C,
        number: &dyn Fn(f64) -> C,
        motion: impl FnOnce() -> Result<Vec<Jet<C, 4>>, Problems>,
    ) -> Result<Self, Problems> {
        let path = AnyPath::new(plan.reference, number, plan.places)?;
        let timed = match plan.time_scaling {
            Some(TimeScaling { rise, .. }) => {
                let clock = match rise {
                    Some(rise) => Clock::FromRest { speed, rise: number(rise) },
                    None => Clock::Steady { speed },
                };
                Self::Retimed(Box::new(Retimed { clock, path }))
            }
            None => Self::Path(path),
        };
        let Some(references::SmoothStart { duration, settle }) = plan.smooth_start else {
            return Ok(timed);
        };
        let jets = motion()?;
        let from = Stop {
            from: Vector::from_fn(|i| jets.get(i).copied().unwrap_or(Jet::ZERO)),
            start: C::ZERO,
            duration: number(settle),
        };
        Ok(Self::SmoothStart(Box::new(SmoothStart { from, duration: number(duration), then: timed })))
    }

    /// The same at another speed: the clock that is there, if any, goes at `speed`.
    pub(crate) fn paced(&self, speed: C) -> Self {
        match self {
            Self::Path(path) => Self::Path(path.clone()),
            Self::Retimed(retimed) => {
                let clock = match retimed.clock {
                    Clock::Steady { .. } => Clock::Steady { speed },
                    Clock::FromRest { rise, .. } => Clock::FromRest { speed, rise },
                };
                Self::Retimed(Box::new(Retimed { clock, path: retimed.path.clone() }))
            }
            Self::SmoothStart(joined) => {
                let then = joined.then.paced(speed);
                Self::SmoothStart(Box::new(SmoothStart {
                    from: joined.from,
                    duration: joined.duration,
                    then,
                }))
            }
        }
    }
}

impl<const N: usize> AnyReference<Interval, N> {
    /// Times in s at which the fourth derivative may jump; anywhere else it is continuous.
    pub fn breaks(&self) -> Vec<Interval> {
        match self {
            Self::Path(path) => path.breaks(),
            Self::Retimed(retimed) => {
                retimed.path.breaks().into_iter().map(|s| when(&retimed.clock, s)).collect()
            }
            Self::SmoothStart(joined) => joined.then.breaks(),
        }
    }

    /// Times in s at which the fifth derivative may jump, beside the [`breaks`](Self::breaks); anywhere else all
    /// derivatives are continuous.
    pub fn kinks(&self) -> Vec<Interval> {
        match self {
            Self::Path(path) => path.kinks(),
            Self::Retimed(retimed) => {
                let ends = match retimed.clock {
                    Clock::Steady { .. } => Vec::new(),
                    Clock::FromRest { rise, .. } => vec![Interval::ZERO, rise],
                };
                retimed.path.kinks().into_iter().map(|s| when(&retimed.clock, s)).chain(ends).collect()
            }
            Self::SmoothStart(joined) => {
                let ends = [Interval::ZERO, joined.from.duration, joined.duration];
                joined.then.kinks().into_iter().chain(ends).collect()
            }
        }
    }
}

impl<C: Instant, const N: usize> Reference<C, N> for AnyReference<C, N> {
    fn on<T: Over<C> + Piecewise>(&self, t: T) -> Vector<T, N> {
        match self {
            Self::Path(reference) => reference.on(t),
            Self::Retimed(reference) => reference.on(t),
            Self::SmoothStart(joined) if is_over(joined, t) => joined.then.on(t),
            Self::SmoothStart(reference) => reference.on(t),
        }
    }

    fn at<const K: usize>(&self, t: C) -> Vector<Jet<C, K>, N>
    where
        C: Over<C> + Piecewise,
    {
        match self {
            Self::Path(reference) => reference.at(t),
            Self::Retimed(reference) => reference.at(t),
            Self::SmoothStart(joined) if is_over(joined, t) => joined.then.at(t),
            Self::SmoothStart(reference) => reference.at(t),
        }
    }
}

/// Whether the transition is over at `t` in s: from then on it is the reference joined, exactly.
fn is_over<C: Instant, R, const N: usize>(joined: &SmoothStart<C, R, N>, t: impl Piecewise) -> bool {
    t.lowest() >= (joined.from.start + joined.duration).highest()
}
