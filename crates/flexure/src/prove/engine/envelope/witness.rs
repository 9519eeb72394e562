//! Where in the tube a quantity is about as large as it gets: places to look at in plain `f64`.

use flexure_core::scalar::Interval;

use crate::prove::engine::envelope::Bounded;
use crate::prove::engine::envelope::Course;
use crate::prove::engine::envelope::closed_loop::TrackingLoop;
use crate::prove::engine::envelope::slab::Slab;

/// A time and an error in the tube.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// Time in s.
    pub time: f64,
    /// q̃_l, q̃_m in rad, s_l, s_m [rad/s].
    pub error: Vec<f64>,
}

/// How far towards the tube's surface to go, so that rounding does not lead outside.
const INSIDE: f64 = 1.0 - 1e-9;

/// How many slabs to try.
const TRIED: usize = 3;

/// Where quantity `k` is about largest: on the reference, then where the gradient of W's dual norm points.
pub fn candidates(system: &dyn TrackingLoop, level: f64, course: &Course, k: usize) -> Vec<Candidate> {
    let best = |value: &dyn Fn(&Slab) -> f64| {
        let mut order: Vec<&Slab> = course.slabs.iter().collect();
        order.sort_by(|a, b| value(b).total_cmp(&value(a)));
        order.into_iter().take(TRIED).map(|slab| slab.time.midpoint()).collect::<Vec<_>>()
    };
    let on_reference = best(&|slab| slab.nominal[k].midpoint().abs())
        .into_iter()
        .map(|time| Candidate { time, error: vec![0.0; 4 * system.joints()] });
    let corners = best(&|slab| slab.seen(k)).into_iter().map(|time| corner(system, level, time, k));
    on_reference.chain(corners).collect()
}

/// Where the derivatives g of quantity `k` at `time` in s point, away from zero.
fn corner(system: &dyn TrackingLoop, level: f64, time: f64, k: usize) -> Candidate {
    let slab = Slab::new(system, level, Interval::point(time));
    let gradient: Vec<_> = slab.gradients.row(k).iter().map(|g| g.midpoint()).collect();
    let scale = INSIDE.copysign(slab.nominal[k].midpoint());
    Candidate { time, error: slab.tube.farthest(&gradient).iter().map(|x| x * scale).collect() }
}
