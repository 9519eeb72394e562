//! A funnel: an ellipsoid of errors for every time of a run that no motion leaves, whatever the robot's numbers are within their
//! tolerances and whatever torque its links and motors feel.
//!
//! With V = zᵀ X(t)⁻¹ z and y = X⁻¹ z, along ż = A z + Σ n w + δ
//!
//! V̇ = −yᵀ Ẋ y + 2 yᵀ (A X y + Σ n w + δ),
//!
//! and 2 yᵀ n w ≤ α + (D²/α) (yᵀ n)² + τ (yᵀ n)² + (cᵀ X y)²/τ for |w| ≤ D + |c·z|, where α = α yᵀ X y on the surface V = 1. So no
//! motion leaves {V ≤ 1} if
//!
//! Ẋ − A X − X Aᵀ − Σ α X − Σ (D²/α + τ) n nᵀ − Σ X c cᵀ X / τ ≻ 0
//!
//! at all times. Where A, n and the bounds are those of larger errors too, V̇ ≤ −Σ α (V − 1) there: they come back. X is linear in time over each slab, and this concave in X: its ends are enough. [`recursion`] suggests ellipsoids and
//! multipliers in floats; here they are checked in intervals. A, n and the bounds are those of all times of the slab and of all errors
//! between its ends ([`Flow`]).
//!
//! [`recursion`]: super::recursion

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::{Dense, Symmetric, lower_inverse};
use crate::progress::Progress;
use crate::prove::engine::envelope::closed_loop::TrackingLoop;
use crate::prove::engine::envelope::deviation::Spread;
use crate::prove::engine::envelope::flow::{Channel, Flow};
use crate::prove::engine::envelope::recursion::{Multipliers, drives, joined, next};
use crate::prove::engine::envelope::shape::{Passage, Shape, congruent};
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
    /// Number of slabs.
    pub slabs: usize,
    /// Errors up to so many times those of the funnel are to come back into it, 1 or more.
    pub room: f64,
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
    /// Ellipsoids at times that are evenly spaced, from the first to the last.
    pub passage: Passage,
    /// How errors move there.
    pub flow: Flow,
    /// What the inequality holds with.
    pub multipliers: Multipliers,
}

impl Piece {
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
}

/// What W is at least where a run begins, in J: rounding is more.
const LEAST: f64 = 1e-14;

/// Link errors that a funnel begins with room for, over the largest that were seen at so many times of the run.
const PART: f64 = 0.01;
const LOOKED: usize = 8;

/// How often a slab is tried, with wider and wider ellipsoids.
const TRIED: usize = 24;

/// Parts of a slab over which X is linear.
const PARTS: usize = 4;

/// How much wider than the last one an ellipsoid is taken to be.
const ROOM: f64 = 1.01;

/// Slack of an ellipsoid's growth [1/s], from the least on.
const SLACK: [f64; 4] = [1e-3, 1e-2, 1e-1, 1.0];

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
        let count = request.slabs.max(1);
        let cut = |i: usize| {
            if i == count { request.duration } else { request.duration * (i as f64 / count as f64) }
        };
        let goes_on = |k: usize| move || progress(k as f64 / count as f64).is_continue();
        let slab = |k: usize| Interval::new(cut(k), cut(k + 1)).unwrap_or(Interval::ENTIRE);
        let first = match first(system, request, slab(0), &goes_on(0))? {
            Ok(first) => first,
            Err(open) => return Some(Err(open)),
        };
        let mut pieces: Vec<Piece> = Vec::with_capacity(count);
        let mut at = Front { shape: first, grown: ROOM, multipliers: None };
        for k in 0..count {
            match at.piece(system, request, slab(k), &goes_on(k))? {
                Ok(piece) => {
                    at = Front {
                        shape: piece.end().clone(),
                        grown: ROOM,
                        multipliers: Some(piece.multipliers.clone()),
                    };
                    pieces.push(piece);
                }
                Err(open) => return Some(Err(open)),
            }
        }
        Some(Ok(Self { pieces }))
    }

    /// Σ α from below [1/s]: V − 1 decays at this rate where errors are up to `room` times those of the funnel.
    pub fn rate(&self) -> f64 {
        let of = |piece: &Piece| {
            piece.multipliers.alpha.iter().fold(Interval::ZERO, |sum, &a| sum + Interval::point(a))
        };
        self.pieces.iter().map(|piece| of(piece).lo()).fold(f64::INFINITY, f64::min)
    }

    /// Bounds of |z_i| over the whole run.
    pub fn extents(&self) -> Vec<f64> {
        let of = |piece: &Piece| piece.passage.errors().iter().map(|e| e.magnitude()).collect::<Vec<_>>();
        let larger = |a: Vec<f64>, b: Vec<f64>| a.iter().zip(b).map(|(a, b)| a.max(b)).collect();
        self.pieces.iter().map(of).reduce(larger).unwrap_or_default()
    }
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
        return Some(Err(Open { time: time.lo(), error }));
    };
    let beginning = Interval::point(time.lo());
    for _ in 0..TRIED {
        let passage = Passage(vec![guess.times(request.room)]);
        let flow = Flow::over(system, &request.spread, &passage, beginning, goes_on)?;
        let Some((_, stays)) = Multipliers::best(&flow, &guess, None) else { break };
        let Some(found) = with_start(&stays) else { break };
        if found.lies_in(&guess) && guess.holds(&request.start) {
            return Some(Ok(guess));
        }
        guess = found.times(ROOM);
    }
    Some(Err(Open { time: time.lo(), error: guess.extents()[..size / 4].to_vec() }))
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

/// Where the funnel has come to.
struct Front {
    shape: Shape,
    /// By how much the next ellipsoid may be wider.
    grown: f64,
    multipliers: Option<Multipliers>,
}

impl Front {
    /// The funnel over one more slab.
    fn piece(
        &self,
        system: &dyn TrackingLoop,
        request: &FunnelRequest,
        time: Interval,
        goes_on: &dyn Fn() -> bool,
    ) -> Option<Result<Piece, Open>> {
        let mut guess = self.shape.times(self.grown);
        for _ in 0..TRIED {
            let wide = [&self.shape, &guess].map(|shape| shape.times(request.room));
            let flow = Flow::over(system, &request.spread, &Passage(wide.into()), time, goes_on)?;
            let Some((multipliers, _)) = Multipliers::best(&flow, &self.shape, self.multipliers.as_ref())
            else {
                break;
            };
            let Some(passage) = verified(&flow, &multipliers, &self.shape, time) else { break };
            if passage.0.iter().all(|shape| shape.lies_in(&guess)) {
                return Some(Ok(Piece { time, passage, flow, multipliers }));
            }
            let all = passage.0.into_iter().map(Some).reduce(|a, b| joined(&a?, &b?));
            let Some(all) = all.flatten() else { break };
            guess = all.times(ROOM);
        }
        let error = guess.extents()[..guess.size() / 4].to_vec();
        Some(Err(Open { time: time.lo(), error }))
    }
}

/// Ellipsoids over the slab `time` with which the inequality holds, after one another.
fn verified(flow: &Flow, with: &Multipliers, from: &Shape, time: Interval) -> Option<Passage> {
    let parts = Interval::point(PARTS as f64);
    let step = (Interval::point(time.hi()) - Interval::point(time.lo())) / parts;
    let mut shapes = vec![from.clone()];
    for _ in 0..PARTS {
        let from = &shapes[shapes.len() - 1];
        let suggested = |slack: &f64| next(flow, with, from, step.midpoint(), *slack);
        let to = SLACK.iter().filter_map(suggested).find(|to| holds(flow, with, [from, to], step))?;
        shapes.push(to);
    }
    Some(Passage(shapes))
}

/// Whether the inequality holds at both ends of a slab that lasts `step` s.
pub fn holds(flow: &Flow, with: &Multipliers, ends: [&Shape; 2], step: Interval) -> bool {
    let squares = ends.map(Shape::square);
    let rate = squares[1].minus(&squares[0], Interval::ONE).map(|x| x / step);
    let drives = drives(flow);
    let positive = |x: &f64| *x >= 0.0 && x.is_finite();
    let fit = with.alpha.len() == drives.len() && with.tau.len() == drives.len();
    fit && with.alpha.iter().chain(&with.tau).all(positive)
        && ends.iter().zip(&squares).all(|(end, square)| {
            let left = residual(flow, with, &drives, &rate, square);
            congruent(&lower_inverse(&end.lower), &left).smallest_pivot() > 0.0
        })
}

/// Ẋ − A X − X Aᵀ − Σ α X − Σ (D²/α + τ) n nᵀ − Σ X c cᵀ X / τ.
fn residual(
    flow: &Flow,
    with: &Multipliers,
    drives: &[Channel],
    rate: &Symmetric<Interval>,
    x: &Symmetric<Interval>,
) -> Symmetric<Interval> {
    let n = x.size();
    let point = Interval::point;
    let moved = Dense::from_fn(n, n, |i, j| {
        (0..n).fold(Interval::ZERO, |sum, k| sum + point(flow.matrix[(i, k)]) * x.at(k, j))
    });
    let growth = with.alpha.iter().fold(Interval::ZERO, |sum, &alpha| sum + point(alpha));
    let mut left =
        Symmetric::from_fn(n, |i, j| rate.at(i, j) - moved[(i, j)] - moved[(j, i)] - growth * x.at(i, j));
    let mut less = |column: &[Interval], weight: Interval| {
        let outer = |i: usize, j: usize| if i == j { column[i].square() } else { column[i] * column[j] };
        left = Symmetric::from_fn(n, |i, j| left.at(i, j) - outer(i, j) * weight);
    };
    for ((drive, &alpha), &tau) in drives.iter().zip(&with.alpha).zip(&with.tau) {
        let column: Vec<_> = drive.column.iter().map(|&x| point(x)).collect();
        let constant =
            if drive.size > 0.0 { point(drive.size).square() / point(alpha) } else { Interval::ZERO };
        less(&column, constant + point(tau));
        if let Some(slope) = &drive.slope {
            let pulled =
                (0..n).map(|i| (0..n).fold(Interval::ZERO, |sum, k| sum + x.at(i, k) * point(slope[k])));
            less(&pulled.collect::<Vec<_>>(), point(tau).recip());
        }
    }
    left
}
