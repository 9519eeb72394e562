//! The references by name.

use flexure_core::linalg::Vector;
use flexure_core::reference::{
    Clock, Multisine, PointToPoint, Reference, Retimed, Sine, SmoothStart, Smoothstep, Stop, Term,
};
use flexure_core::scalar::{Interval, Jet, Over, Piecewise, Scalar};

use crate::files::{Entry, Problems};
use crate::references::{self, Samples, when};
use crate::robot::{Arm, vector};
use crate::{feasible, scenario};

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
    /// Any of these, along another clock.
    Retimed(Box<Retimed<C, AnyReference<C, N>>>),
    /// Any of these, joined from the robot's motion.
    SmoothStart(Box<SmoothStart<C, AnyReference<C, N>, N>>),
}

impl<const N: usize> AnyReference<f64, N> {
    /// The reference of a scenario, at the speed of its time scaling, with its smooth start from the robot's initial
    /// motion.
    ///
    /// # Errors
    /// If there is no spline through the samples, the robot has too many joints, or no speed keeps it inside its limits.
    pub fn new(scenario: &scenario::Scenario) -> Result<Self, Problems> {
        Self::at_speed(scenario, feasible::speed(scenario)?)
    }

    /// The reference of a scenario at the speed of its time scaling, if it has one, replaced by `speed`.
    pub(crate) fn at_speed(scenario: &scenario::Scenario, speed: f64) -> Result<Self, Problems> {
        Self::over(scenario, speed, &|x| x, || {
            link_motion(&*scenario.robot.arm()?, &scenario.initial, &|x| x)
        })
    }
}

impl<const N: usize> AnyReference<Interval, N> {
    /// The reference of a scenario with its decimals enclosed, smooth start and initial motion too. A speed that was
    /// searched for is the float that was found.
    ///
    /// # Errors
    /// As for [`new`](AnyReference::new).
    pub fn enclosed(scenario: &scenario::Scenario) -> Result<Self, Problems> {
        let speed = match scenario.time_scaling.map(|scaling| scaling.speed) {
            Some(references::Speed::Given(speed)) => scenario.bounds(speed),
            _ => Interval::point(feasible::speed(scenario)?),
        };
        let start =
            || link_motion(&*scenario.robot.enclosed_arm()?, &scenario.initial, &|x| scenario.bounds(x));
        Self::over(scenario, speed, &|x| scenario.bounds(x), start)
    }
}

/// The links' motion when a scenario begins, to the jerk: what the state says, by the model that the law has.
fn link_motion<C: Scalar>(
    arm: &dyn Arm<C>,
    initial: &scenario::Initial,
    number: &dyn Fn(f64) -> C,
) -> Result<Vec<Jet<C, 4>>, Problems> {
    let scenario::Initial { q_l, q_m, dq_l, dq_m } = initial;
    let motion: Vec<C> = [q_l, q_m, dq_l, dq_m].into_iter().flatten().map(|&x| number(x)).collect();
    let mut series = vec![[C::ZERO; 4]; arm.joints()];
    arm.link_motion(&motion, &mut series).expect("the reader has checked the lengths");
    Ok(series.into_iter().map(Jet::new).collect())
}

impl<C: Scalar, const N: usize> AnyReference<C, N> {
    /// The reference of a scenario with its numbers, but for samples and the speed, through `number`; `motion` says how a
    /// robot that starts somewhere moves there.
    fn over(
        scenario: &scenario::Scenario,
        speed: C,
        number: &dyn Fn(f64) -> C,
        motion: impl FnOnce() -> Result<Vec<Jet<C, 4>>, Problems>,
    ) -> Result<Self, Problems> {
        let path = Self::path(scenario, number)?;
        let timed = match scenario.time_scaling {
            Some(references::TimeScaling { rise, .. }) => {
                let clock = match rise {
                    Some(rise) => Clock::FromRest { speed, rise: number(rise) },
                    None => Clock::Steady { speed },
                };
                Self::Retimed(Box::new(Retimed { clock, path }))
            }
            None => path,
        };
        let Some(references::SmoothStart { duration, settle }) = scenario.smooth_start else {
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

    /// The path of a scenario at its own speed, without smooth start.
    fn path(scenario: &scenario::Scenario, number: impl Fn(f64) -> C) -> Result<Self, Problems> {
        let vector = |values: &[f64]| vector(values).map(&number);
        let sine = |term: &references::Term| Term {
            amplitude: vector(&term.amplitude),
            frequency: vector(&term.frequency),
            phase: vector(&term.phase),
        };
        Ok(match &scenario.reference {
            references::Reference::Sines { offset, terms } => match terms.as_slice() {
                [term] => {
                    let Term { amplitude, frequency, phase } = sine(term);
                    Self::Sine(Sine { offset: vector(offset), amplitude, frequency, phase })
                }
                terms => Self::Multisine(Multisine {
                    offset: vector(offset),
                    terms: terms.iter().map(sine).collect(),
                }),
            },
            references::Reference::PointToPoint { profile, from, to, start, duration } => {
                let step = match profile {
                    references::Profile::Quintic => Smoothstep::Quintic,
                    references::Profile::Septic => Smoothstep::Septic,
                    references::Profile::Nonic => Smoothstep::Nonic,
                };
                Self::PointToPoint(PointToPoint {
                    from: vector(from),
                    to: vector(to),
                    start: number(*start),
                    duration: number(*duration),
                    step,
                })
            }
            references::Reference::Samples { t, q } => {
                Self::Samples(spline(scenario, t, q)?.map(C::from_f64))
            }
        })
    }

    /// The same at another speed: the clock that is there, if any, goes at `speed`.
    pub(crate) fn paced(&self, speed: C) -> Self {
        match self {
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
            path => path.clone(),
        }
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
            Self::Sine(_) | Self::Multisine(_) | Self::Samples(_) => Vec::new(),
            Self::PointToPoint(motion) => vec![motion.start, motion.start + motion.duration],
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

/// The spline through the samples of a scenario.
fn spline<const N: usize>(
    scenario: &scenario::Scenario,
    t: &[f64],
    q: &[Vec<f64>],
) -> Result<Samples<f64, N>, Problems> {
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
            Self::Retimed(reference) => reference.on(t),
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
            Self::Retimed(reference) => reference.at(t),
            Self::SmoothStart(reference) => reference.at(t),
        }
    }
}
