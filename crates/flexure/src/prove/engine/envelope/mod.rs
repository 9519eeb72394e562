//! Bounds along a reference: how fast the links move, how far the springs give and what the motors are asked for at any time
//! and at any error in the tube {W ≤ c}.
//!
//! Time is cut into slabs ([`slab`]); those that decide a bound are cut again, until they are tight or the budget is spent.

pub mod closed_loop;
pub mod deviation;
pub mod flow;
pub mod followed;
mod front;
pub mod funnel;
pub mod inequality;
mod masses;
mod pace;
pub mod recursion;
mod response;
mod seen;
pub mod shape;
pub mod slab;
pub mod tube;
pub mod witness;

use std::collections::BTreeSet;
use std::sync::atomic::{AtomicUsize, Ordering};

use closed_loop::TrackingLoop;
use flexure_core::scalar::Interval;
use rayon::prelude::*;
use slab::Slab;

use crate::progress::Progress;

/// What to bound along a reference, and how many pieces of it may be looked at.
#[derive(Clone, Debug, PartialEq)]
pub struct AlongRequest {
    /// Level c of the tube {W ≤ c} around the reference, in J.
    pub level: f64,
    /// End of the reference in s; it begins at 0.
    pub duration: f64,
    /// What must not be exceeded, one per quantity and joint in the order of [`slab::QUANTITIES`]; infinite for no limit.
    pub limits: Vec<Interval>,
    /// Largest number of slabs to look at.
    pub budget: usize,
}

/// Something over a slab of time that has bounds, which may come down where the slab is cut.
pub trait Bounded: Send {
    /// Times in s.
    fn time(&self) -> Interval;
    /// Number of quantities.
    fn quantities(&self) -> usize;
    /// Upper bound of the absolute value of quantity `k`.
    fn bound(&self, k: usize) -> f64;
    /// About the largest absolute value of quantity `k`, which no cut brings the bound below.
    fn seen(&self, k: usize) -> f64;
}

/// Slabs from 0 to the end, and how many were looked at.
#[derive(Clone, Debug)]
pub struct Course {
    /// The pieces of the tube, in the order of time.
    pub slabs: Vec<Slab>,
    /// Number of slabs looked at.
    pub spent: usize,
}

/// Slabs to begin with.
const FIRST: usize = 32;

/// A bound this much, relatively, above what is about taken is tight.
const TIGHT: f64 = 0.01;

/// Halving a slab is worth while as long as the last time lowered its bound by this share.
const GAIN: f64 = 0.002;

/// Bounds everything that `request` asks for. Where `progress` breaks it off no more slabs are cut; none if it does so before
/// all of the time is covered.
pub fn course(system: &dyn TrackingLoop, request: &AlongRequest, progress: Progress<'_>) -> Option<Course> {
    let first = request.budget.clamp(1, FIRST);
    let cut =
        |i: usize| if i == first { request.duration } else { request.duration * (i as f64 / first as f64) };
    // The budget is the end that is known.
    let looked_at = AtomicUsize::new(0);
    let goes_on = || {
        let seen = looked_at.load(Ordering::Relaxed) as f64;
        progress(seen / request.budget.max(1) as f64).is_continue()
    };
    let slab = |(from, to): (f64, f64)| {
        let time = Interval::new(from, to).unwrap_or(Interval::ENTIRE);
        let slab = Slab::watched(system, request.level, time, &goes_on);
        looked_at.fetch_add(1, Ordering::Relaxed);
        slab
    };
    // In parallel, but in the order of time: the outcome does not depend on the number of cores.
    let begin: Vec<_> = (0..first).map(|i| (cut(i), cut(i + 1))).collect();
    let begun = begin.into_par_iter().map(slab).collect::<Option<_>>()?;
    let half = |_: &Slab, half: Interval| slab((half.lo(), half.hi()));
    let (slabs, spent) = refined(begun, &request.limits, request.budget, &half, &goes_on);
    Some(Course { slabs, spent })
}

/// Cuts those of `slabs` that decide a bound, until they are tight or so many were looked at, or while it `goes_on`; `half` makes a
/// slab of a part of one's time. Returns the slabs, and how many were looked at.
pub fn refined<B: Bounded>(
    slabs: Vec<B>,
    limits: &[Interval],
    budget: usize,
    half: &(dyn Fn(&B, Interval) -> Option<B> + Sync),
    goes_on: &dyn Fn() -> bool,
) -> (Vec<B>, usize) {
    let mut spent = slabs.len();
    let mut pieces: Vec<Piece<B>> = slabs.into_iter().map(|slab| Piece::new(slab, None)).collect();
    loop {
        let marked = marked(&pieces, limits, (budget - spent.min(budget)) / 2);
        if marked.is_empty() || !goes_on() {
            break;
        }
        spent += 2 * marked.len();
        let halves = |(i, piece): (usize, Piece<B>)| {
            if !marked.contains(&i) {
                return vec![piece];
            }
            let (left, right) = piece.slab.time().split();
            let half = |time: Interval| half(&piece.slab, time);
            match half(left).zip(half(right)) {
                Some((left, right)) => [left, right].map(|half| Piece::new(half, Some(&piece))).into(),
                None => vec![piece],
            }
        };
        pieces = pieces.into_par_iter().enumerate().flat_map_iter(halves).collect();
    }
    (pieces.into_iter().map(|piece| piece.slab).collect(), spent)
}

/// Which pieces to cut next: those that are farthest above their goals, at most `most`.
fn marked<B: Bounded>(pieces: &[Piece<B>], limits: &[Interval], most: usize) -> BTreeSet<usize> {
    let goals = goals(pieces, limits);
    let excess = pieces.iter().map(|piece| piece.excess(&goals)).enumerate();
    let mut marked: Vec<(usize, f64)> = excess.filter(|(_, excess)| *excess > 1.0).collect();
    marked.sort_by(|a, b| b.1.total_cmp(&a.1));
    marked.into_iter().take(most).map(|(i, _)| i).collect()
}

impl Course {
    /// Upper bound of the absolute value of quantity `k`, and the middle of the slab that it comes from in s.
    pub fn bound(&self, k: usize) -> (f64, f64) {
        largest(&self.slabs, |slab| slab.bound(k))
    }

    /// About the largest absolute value of quantity `k` on the reference, and when in s.
    pub fn nominal(&self, k: usize) -> (f64, f64) {
        largest(&self.slabs, |slab| slab.nominal[k].midpoint().abs())
    }

    /// About the largest absolute value of quantity `k` in the tube, and when in s.
    pub fn seen(&self, k: usize) -> (f64, f64) {
        largest(&self.slabs, |slab| slab.seen(k))
    }
}

/// The largest of the values of `slabs`, and the middle of the slab that it comes from in s.
pub fn largest<B: Bounded>(slabs: &[B], value: impl Fn(&B) -> f64) -> (f64, f64) {
    slabs.iter().map(|slab| (value(slab), slab.time().midpoint())).fold(
        (f64::NEG_INFINITY, 0.0),
        |best, next| {
            if next.0 > best.0 { next } else { best }
        },
    )
}

/// A slab with its bounds, and those of the one it was cut from.
struct Piece<B> {
    slab: B,
    bounds: Vec<f64>,
    seen: Vec<f64>,
    before: Vec<f64>,
}

impl<B: Bounded> Piece<B> {
    fn new(slab: B, parent: Option<&Self>) -> Self {
        let all = 0..slab.quantities();
        let bounds: Vec<f64> = all.clone().map(|k| slab.bound(k)).collect();
        let before = parent.map_or_else(|| vec![f64::INFINITY; bounds.len()], |parent| parent.bounds.clone());
        Self { bounds, before, seen: all.map(|k| slab.seen(k)).collect(), slab }
    }

    /// How far it is above its goals where halving it can help: above 1 if it is.
    fn excess(&self, goals: &[f64]) -> f64 {
        let ratios = self.bounds.iter().zip(&self.before).zip(goals).map(|((&bound, &before), &goal)| {
            let helps = !bound.is_finite() || bound < before * (1.0 - GAIN);
            if helps { bound / goal } else { 0.0 }
        });
        ratios.fold(0.0, f64::max)
    }
}

/// What each bound is to come down to: nearly the largest value seen, or the limit where that lies in between.
fn goals<B: Bounded>(pieces: &[Piece<B>], limits: &[Interval]) -> Vec<f64> {
    let goal = |(k, limit): (usize, &Interval)| {
        let finite = pieces.iter().map(|piece| piece.seen[k]).filter(|seen| seen.is_finite());
        let seen = finite.fold(0.0, f64::max);
        let tight = (1.0 + TIGHT) * seen;
        if limit.lo() > seen { tight.min(limit.lo()) } else { tight }
    };
    limits.iter().enumerate().map(goal).collect()
}
