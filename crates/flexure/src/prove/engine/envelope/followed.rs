//! A slab of a funnel as its file has it, and whether it is one.

use flexure_core::scalar::Interval;

use crate::prove::engine::envelope::closed_loop::TrackingLoop;
use crate::prove::engine::envelope::deviation::Spread;
use crate::prove::engine::envelope::flow::Flow;
use crate::prove::engine::envelope::funnel::Piece;
use crate::prove::engine::envelope::inequality::holds;
use crate::prove::engine::envelope::recursion::{Multipliers, drives};
use crate::prove::engine::envelope::shape::{Passage, Shape, part};

/// Ellipsoids over a slab of time, and what the inequality is looked at with.
#[derive(Clone, Debug, PartialEq)]
pub struct Given {
    /// When the ellipsoids are there in s, one after the other; between two of them X is linear in time.
    pub times: Vec<f64>,
    /// The ellipsoids, the first of which holds the last of the slab before.
    pub passage: Passage,
    /// One that holds errors so many times as large as are to come back.
    pub around: Shape,
    /// α of all causes \[1/s\], then of what is left open of each error; 0 where there is nothing.
    pub alpha: Vec<f64>,
    /// τ of the same.
    pub tau: Vec<f64>,
}

/// What a slab lacks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lacks {
    /// It does not begin where the slab before ends, or with an ellipsoid that is known to hold the last one there.
    Joint,
    /// Errors so many times as large are not known to lie in the ellipsoid around them.
    Around,
    /// From this ellipsoid to the next errors are not known to stay.
    Way(usize),
}

/// How many multipliers α, or τ, a slab of `joints` joints has: torques, springs, dampers and motors of each joint, loads of masses that
/// are off, two of inverse masses, and one of each error.
pub fn count(joints: usize, has_masses: bool) -> usize {
    let of_masses = if has_masses { 2 * joints } else { 0 };
    6 * joints + of_masses + 2 + 4 * joints
}

impl Given {
    /// What there is to give of `piece`.
    pub fn of(piece: Piece) -> Self {
        let parts = piece.passage.0.len() - 1;
        let begins = [piece.time.lo()].into_iter();
        let times = begins.chain((0..parts).map(|k| part(piece.time, k, parts).hi())).collect();
        let size = piece.flow.causes + piece.flow.rest.len();
        let (mut alpha, mut tau) = (vec![0.0; size], vec![0.0; size]);
        for (k, drive) in drives(&piece.flow).iter().enumerate() {
            alpha[drive.cause] = piece.multipliers.alpha[k];
            tau[drive.cause] = piece.multipliers.tau[k];
        }
        Self { times, passage: piece.passage, around: piece.around, alpha, tau }
    }

    /// Times in s.
    pub fn time(&self) -> Interval {
        let ends = self.times.first().zip(self.times.last());
        ends.and_then(|(&from, &to)| Interval::new(from, to)).unwrap_or(Interval::ENTIRE)
    }

    /// That errors stay in its ellipsoids if those of `before` are in the first, and that V − 1 falls at the rate that this is \[1/s\] for errors
    /// up to `room` times as large; none if it no longer `goes_on`.
    ///
    /// # Errors
    /// What is not known.
    pub fn check(
        &self,
        before: Option<&Self>,
        system: &dyn TrackingLoop,
        spread: &Spread,
        room: Interval,
        goes_on: &dyn Fn() -> bool,
    ) -> Option<Result<f64, Lacks>> {
        let shapes = &self.passage.0;
        let joins = before.is_none_or(|before| {
            let last = before.passage.0.last();
            before.times.last() == self.times.first()
                && last.is_some_and(|last| *last == shapes[0] || last.lies_in(&shapes[0]))
        });
        if !joins {
            return Some(Err(Lacks::Joint));
        }
        if !shapes.iter().all(|shape| shape.widened_lies_in(room, &self.around)) {
            return Some(Err(Lacks::Around));
        }
        let wide = Passage(vec![self.around.clone()]);
        let flow = Flow::over(system, spread, &wide, self.time(), goes_on)?;
        let of = |all: &[f64]| drives(&flow).iter().map(|drive| all[drive.cause]).collect();
        let with = Multipliers { alpha: of(&self.alpha), tau: of(&self.tau), open: 0.0 };
        let way = (0..self.times.len() - 1).find(|&k| {
            let time = Interval::new(self.times[k], self.times[k + 1]);
            !time.is_some_and(|time| holds(&flow, &with, [&shapes[k], &shapes[k + 1]], time))
        });
        Some(way.map_or(Ok(with.rate()), |k| Err(Lacks::Way(k))))
    }
}
