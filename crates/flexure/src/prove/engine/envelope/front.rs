//! One more slab of a funnel.
//!
//! Two ways on are looked at. One *follows* the flow by steps of an implicit recursion. Where springs and motors swing much faster than slabs are
//! long, such a step says little about them, and the ellipsoids grow without end. The other takes the ellipsoid that would *stay* if time stood
//! still, as wide as it takes to hold what came before, and lets it come down. The first is taken as long as it gets no farther from what stays.

use flexure_core::scalar::Interval;

use crate::prove::engine::envelope::closed_loop::TrackingLoop;
use crate::prove::engine::envelope::flow::Flow;
use crate::prove::engine::envelope::funnel::{FunnelRequest, Open, Piece};
use crate::prove::engine::envelope::inequality::holds;
use crate::prove::engine::envelope::recursion::{Multipliers, covering, joined, next, staying};
use crate::prove::engine::envelope::shape::{Passage, Shape, part};

/// A slab is tried so often, with wider and wider ellipsoids.
const TRIED: usize = 8;

/// Parts of a slab over which X is linear.
const PARTS: usize = 4;

/// How much wider than the last one an ellipsoid is taken to be.
pub const ROOM: f64 = 1.01;

/// Causes are taken to be so much larger, as a part, for a checker that bounds some of them less closely.
const SPARE: f64 = 0.005;

/// Slack of an ellipsoid's growth [1/s], from the least on.
const SLACK: [f64; 4] = [1e-2, 3e-2, 1e-1, 1.0];

/// Slack with which an ellipsoid stays, at least and at most, over Σ α: with less it changes too quickly, with more it is too wide.
const STILL: [f64; 2] = [0.02, 0.5];

/// Within this of what stays, the flow is followed wherever it leads.
const NEAR: f64 = 1.1;

/// How quickly an ellipsoid that is too wide comes down, over what its slack allows.
const COMES_DOWN: [f64; 3] = [0.9, 0.5, 0.0];

/// Rounding of what is computed in floats is less.
const ROUNDING: f64 = 1e-6;

/// Where a funnel has come to.
pub struct Front {
    /// The errors there.
    pub shape: Shape,
    /// Those of the last slab, to begin with.
    pub multipliers: Option<Multipliers>,
    /// What stays, as the last slab had it.
    pub still: Option<Still>,
}

/// An ellipsoid that stays as it is if time stands still.
pub struct Still {
    shape: Shape,
    /// With so much more growth than there is [1/s].
    slack: f64,
}

impl Front {
    /// The funnel over the slab `time`, and what stays there; none if `goes_on` breaks it off.
    ///
    /// # Errors
    /// Where none is found.
    pub fn piece(
        &self,
        system: &dyn TrackingLoop,
        request: &FunnelRequest,
        time: Interval,
        goes_on: &dyn Fn() -> bool,
    ) -> Option<Result<(Piece, Option<Still>), Open>> {
        let mut guess = self.shape.times(ROOM);
        // No less than its decimal.
        let room = Interval::point(request.room.next_up());
        for _ in 0..TRIED {
            let around = guess.times(request.room);
            let flow = Flow::over(system, &request.spread, &Passage(vec![around.clone()]), time, goes_on)?;
            let larger = flow.with_larger_causes(SPARE);
            let Some((multipliers, _)) = Multipliers::best(&larger, &self.shape, self.multipliers.as_ref())
            else {
                break;
            };
            let Some((passage, still)) = self.onwards(&larger, &multipliers, time) else { break };
            if passage.0.iter().all(|shape| shape.widened_lies_in(room, &around)) {
                return Some(Ok((Piece { time, passage, around, flow, multipliers }, still)));
            }
            let all = passage.0.into_iter().map(Some).reduce(|a, b| joined(&a?, &b?));
            let Some(all) = all.flatten() else { break };
            guess = all.times(ROOM);
        }
        Some(Err(Open::of(&guess, time)))
    }

    /// Ellipsoids from the front on, and the one that stays if there is one.
    fn onwards(&self, flow: &Flow, with: &Multipliers, time: Interval) -> Option<(Passage, Option<Still>)> {
        let followed = verified(flow, with, &self.shape, time);
        let slack = self.slack(flow, with, time);
        let with_slack = |slack: f64| kept(flow, with, &self.shape, time, slack);
        let Some((kept, still)) = [slack, 4.0 * slack].into_iter().find_map(with_slack) else {
            return followed.map(|followed| (followed, None));
        };
        let from = covering(&still.shape, &self.shape);
        let comes_back =
            followed.filter(|way| covering(&still.shape, &way.0[way.0.len() - 1]) < from.max(NEAR));
        Some((comes_back.unwrap_or(kept), Some(still)))
    }

    /// Slack of what stays [1/s]: with more of it that may change more quickly, and is wider.
    fn slack(&self, flow: &Flow, with: &Multipliers, time: Interval) -> f64 {
        let growth = with.growth();
        let of = |still: &Still| {
            let now = staying(flow, with, &self.shape, still.slack)?;
            let quick = 2.0 * covering(&now, &still.shape).max(1.0).ln() / (time.hi() - time.lo());
            Some((quick * growth).sqrt())
        };
        self.still.as_ref().and_then(of).unwrap_or(0.0).clamp(STILL[0] * growth, STILL[1] * growth)
    }
}

/// An ellipsoid that stays as it is, as wide as it takes to hold `from` and narrower at the end of the slab `time`.
fn kept(
    flow: &Flow,
    with: &Multipliers,
    from: &Shape,
    time: Interval,
    slack: f64,
) -> Option<(Passage, Still)> {
    let step = time.hi() - time.lo();
    let shape = staying(flow, with, from, slack)?;
    let wide = covering(&shape, from).max(1.0) * (1.0 + ROUNDING);
    let begin = shape.times(wide);
    if !from.lies_in(&begin) {
        return None;
    }
    COMES_DOWN.into_iter().find_map(|share| {
        let end = shape.times((wide * (1.0 - 0.5 * share * slack * step)).max(1.0));
        holds(flow, with, [&begin, &end], time)
            .then(|| (Passage(vec![begin.clone(), end]), Still { shape: shape.clone(), slack }))
    })
}

/// Ellipsoids over the slab `time` with which the inequality holds, after one another.
fn verified(flow: &Flow, with: &Multipliers, from: &Shape, time: Interval) -> Option<Passage> {
    let mut shapes = vec![from.clone()];
    for k in 0..PARTS {
        let from = &shapes[shapes.len() - 1];
        let part = part(time, k, PARTS);
        let suggested = |slack: &f64| next(flow, with, from, part, *slack);
        let to = SLACK.iter().filter_map(suggested).find(|to| holds(flow, with, [from, to], part))?;
        shapes.push(to);
    }
    Some(Passage(shapes))
}
