//! A funnel: an ellipsoid of errors for every time of a run that no motion leaves, whatever the robot's numbers are within their
//! tolerances and whatever torque its links and motors feel.
//!
//! It goes slab of time by slab of time (`front.rs`). [`recursion`] suggests ellipsoids and multipliers in floats; [`inequality`] checks them in
//! intervals. A, n and the bounds are those of all times of the slab and of all errors between its ends ([`Flow`]). Each slab's ellipsoids
//! begin with one that holds the last of the slab before.
//!
//! [`recursion`]: super::recursion
//! [`inequality`]: super::inequality

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::{Dense, Symmetric};
use crate::progress::Progress;
use crate::prove::engine::envelope::closed_loop::TrackingLoop;
use crate::prove::engine::envelope::deviation::Spread;
use crate::prove::engine::envelope::flow::Flow;
use crate::prove::engine::envelope::front::{Front, ROOM};
use crate::prove::engine::envelope::pace::Pace;
use crate::prove::engine::envelope::recursion::Multipliers;
use crate::prove::engine::envelope::shape::{Passage, Shape};
use crate::prove::engine::envelope::tube::{ErrorTube, Tube};

/// What a funnel is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct FunnelRequest {
    /// What is not known of the robot, and what it feels.
    pub spread: Spread,
    /// End of the run in s; it begins at 0.
    pub duration: f64,
    /// The errors where it begins.
    pub start: Vec<Interval>,
    /// Length of a slab in s where nothing asks for shorter ones.
    pub slab: f64,
    /// Errors up to so many times those of the funnel are to come back into it, 1 or more.
    pub room: f64,
    /// Slabs that it may have.
    pub most: usize,
}

/// Ellipsoids from the beginning to the end of a run.
#[derive(Clone, Debug)]
pub struct Funnel {
    /// One slab after the other.
    pub pieces: Vec<Piece>,
}

/// The funnel over a slab of time.
#[derive(Clone, Debug)]
pub struct Piece {
    /// Times in s.
    pub time: Interval,
    /// Ellipsoids at times that are evenly spaced, from the first, which holds the last of the piece before, to the last.
    pub passage: Passage,
    /// One that holds errors so many times as large as was asked for.
    pub around: Shape,
    /// How errors move in that.
    pub flow: Flow,
    /// What the inequality holds with.
    pub multipliers: Multipliers,
}

impl Piece {
    /// The part of what drives the errors that is left open at the middle of its times.
    fn at_once(
        &self,
        system: &dyn TrackingLoop,
        request: &FunnelRequest,
        goes_on: &dyn Fn() -> bool,
    ) -> Option<f64> {
        let middle = Interval::point(self.time.midpoint());
        let wide = Passage(self.passage.0.iter().map(|shape| shape.times(request.room)).collect());
        let flow = Flow::over(system, &request.spread, &wide, middle, goes_on)?;
        let best = Multipliers::best(&flow, self.end(), Some(&self.multipliers));
        Some(best.map_or(1.0, |(multipliers, _)| multipliers.open))
    }

    /// The ellipsoid at its end.
    fn end(&self) -> &Shape {
        &self.passage.0[self.passage.0.len() - 1]
    }
}

/// Where no funnel goes on.
#[derive(Clone, Debug, PartialEq)]
pub struct Open {
    /// Time in s.
    pub time: f64,
    /// Link errors there that are not known to stay, in rad.
    pub error: Vec<f64>,
    /// Whether it may go on, with more slabs than were asked for.
    pub is_spent: bool,
}

impl Open {
    /// At the beginning of the slab `time`, where errors were not shown to stay in `shape`.
    pub fn of(shape: &Shape, time: Interval) -> Self {
        Self { time: time.lo(), error: shape.extents()[..shape.size() / 4].to_vec(), is_spent: false }
    }
}

/// What W is at least where a run begins, in J: rounding is more.
const LEAST: f64 = 1e-14;

/// Link errors that a funnel begins with room for, over the largest that were seen at so many times of the run.
const PART: f64 = 0.01;
const LOOKED: usize = 8;

/// The first ellipsoid is tried so often, wider and wider.
const FIRST_TRIED: usize = 24;

impl Funnel {
    /// Over all of the run; none if `progress` breaks it off.
    ///
    /// # Errors
    /// Where it does not go on.
    pub fn along(
        system: &dyn TrackingLoop,
        request: &FunnelRequest,
        progress: Progress<'_>,
    ) -> Option<Result<Self, Open>> {
        let mut pace = Pace::new(request.slab);
        let mut time = pace.next(0.0, request.duration);
        let goes_on = |time: Interval| move || progress(time.lo() / request.duration).is_continue();
        let first = match first(system, request, time, &goes_on(time))? {
            Ok(first) => first,
            Err(open) => return Some(Err(open)),
        };
        let mut pieces: Vec<Piece> = Vec::new();
        let mut at = Front { shape: first, multipliers: None, still: None };
        while time.lo() < request.duration {
            if pieces.len() == request.most {
                return Some(Err(Open { is_spent: true, ..Open::of(&at.shape, time) }));
            }
            match at.piece(system, request, time, &goes_on(time))? {
                Ok((piece, still)) => {
                    pace.saw(piece.multipliers.open, || piece.at_once(system, request, &goes_on(time)))?;
                    at = Front {
                        shape: piece.end().clone(),
                        multipliers: Some(piece.multipliers.clone()),
                        still,
                    };
                    time = pace.next(time.hi(), request.duration);
                    pieces.push(piece);
                }
                Err(open) if !pace.shorter() => return Some(Err(open)),
                Err(_) => time = pace.next(time.lo(), request.duration),
            }
        }
        Some(Ok(Self { pieces }))
    }

    /// Σ α from below [1/s]: V − 1 decays at this rate where errors are up to `room` times those of the funnel.
    pub fn rate(&self) -> f64 {
        self.pieces.iter().map(|piece| piece.multipliers.rate()).fold(f64::INFINITY, f64::min)
    }

    /// Bounds of |z_i| over the whole run.
    pub fn extents(&self) -> Vec<f64> {
        extents(self.pieces.iter().map(|piece| &piece.passage))
    }
}

/// Bounds of |z_i| over all of `passages`.
pub fn extents<'a>(passages: impl Iterator<Item = &'a Passage>) -> Vec<f64> {
    let of = |passage: &Passage| passage.errors().iter().map(|e| e.magnitude()).collect::<Vec<_>>();
    let larger = |a: Vec<f64>, b: Vec<f64>| a.iter().zip(b).map(|(a, b)| a.max(b)).collect();
    passages.map(of).reduce(larger).unwrap_or_default()
}

/// An ellipsoid that errors stay in at the beginning of the slab `time` as long as it stays the same, and the start in it.
fn first(
    system: &dyn TrackingLoop,
    request: &FunnelRequest,
    time: Interval,
    goes_on: &dyn Fn() -> bool,
) -> Option<Result<Shape, Open>> {
    let least = least(system, request, goes_on)?;
    let size = least.len();
    let floor = diagonal(&least);
    let start: Vec<f64> = request.start.iter().map(|z| z.midpoint()).collect();
    let with_start = |shape: &Shape| {
        let square = shape.square();
        let entry = |i: usize, j: usize| {
            square.at(i, j).midpoint() + start[i] * start[j] + if i == j { least[i] * least[i] } else { 0.0 }
        };
        crate::linalg::cholesky(&Symmetric::from_fn(size, entry)).map(|lower| Shape { lower })
    };
    let Some(mut guess) = with_start(&floor) else {
        // Start and torques are too far apart in size for numbers of one ellipsoid.
        let error = start[..size / 4].iter().map(|e| e.abs()).collect();
        return Some(Err(Open { time: time.lo(), error, is_spent: false }));
    };
    let beginning = Interval::point(time.lo());
    for _ in 0..FIRST_TRIED {
        let passage = Passage(vec![guess.times(request.room)]);
        let flow = Flow::over(system, &request.spread, &passage, beginning, goes_on)?;
        let Some((_, stays)) = Multipliers::best(&flow, &guess, None) else { break };
        let Some(found) = with_start(&stays) else { break };
        if found.lies_in(&guess) && guess.holds(&request.start) {
            return Some(Ok(guess));
        }
        guess = found.times(ROOM);
    }
    Some(Err(Open::of(&guess, time)))
}

/// The errors that a funnel has room for where it begins, if nothing drives it there: a part of what drives it at other times.
fn least(system: &dyn TrackingLoop, request: &FunnelRequest, goes_on: &dyn Fn() -> bool) -> Option<Vec<f64>> {
    let n = system.joints();
    let unit = |level: f64, time: Interval| {
        let q_ld: Vec<_> = system.reference(time).iter().map(|jet| jet[0]).collect();
        ErrorTube::new(system, level, &q_ld).errors().iter().map(|e| e.magnitude()).collect::<Vec<f64>>()
    };
    let mut part = LEAST.sqrt();
    for k in 0..LOOKED {
        let time = Interval::point(request.duration * (k as f64 + 0.5) / LOOKED as f64);
        let shape = diagonal(&unit(LEAST, time));
        let flow = Flow::over(system, &request.spread, &Passage(vec![shape.clone()]), time, goes_on)?;
        if let Some((_, stays)) = Multipliers::best(&flow, &shape, None) {
            let ratios = stays.extents().into_iter().zip(unit(1.0, time)).map(|(e, unit)| e / unit);
            part = ratios.take(n).map(|ratio| PART * ratio).fold(part, f64::max);
        }
    }
    Some(unit(part * part, Interval::ZERO))
}

/// The ellipsoid with these half axes along the errors.
fn diagonal(axes: &[f64]) -> Shape {
    Shape { lower: Dense::from_fn(axes.len(), axes.len(), |i, j| if i == j { axes[i] } else { 0.0 }) }
}
