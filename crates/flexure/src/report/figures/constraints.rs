//! What a tuned loop leaves of each limit, as a picture.

use crate::design::{Constraint, Design};
use crate::files::number::short;
use crate::report::draw::range::Range;
use crate::report::draw::scene::Scene;
use crate::report::draw::style::{HOLDS, INK, LIMIT, STOPPED, Stroke};
use crate::report::draw::ticks;
use crate::report::draw::tracks::{Bar, Track, swatch, tracks};

/// Beyond this share of a limit an axis ends.
const FARTHEST: f64 = 200.0;

/// A bar a constraint: the share of the limit that the loop takes, the limit at 100 %.
pub fn constraints_figure(design: &Design) -> Scene {
    let subtitle = "share of each limit that the loop takes, in %, the worst joint and run; what is wished for may be missed, what is asked may not";
    let legend =
        [swatch("kept", HOLDS), swatch("beyond its limit", STOPPED), ("the limit".to_owned(), LIMIT)];
    let most = design.constraints.iter().map(taken).fold(100.0, f64::max);
    let axis = Range { low: 0.0, high: 1.1 * most };
    let rows = design.constraints.iter().map(|constraint| track(constraint, axis)).collect();
    tracks(&format!("{}: what is left of each limit", design.name), subtitle, &legend, rows)
}

/// The share of the limit that the loop takes, in %; none of what may not be at all and is not.
fn taken(constraint: &Constraint) -> f64 {
    let Constraint { slack, value, limit, .. } = constraint;
    match (slack.is_finite(), *value == 0.0 && *limit == 0.0) {
        (_, true) => 0.0,
        (true, _) => (100.0 * (1.0 - slack)).clamp(0.0, FARTHEST),
        (false, _) => FARTHEST,
    }
}

fn track(constraint: &Constraint, axis: Range) -> Track {
    let Constraint { what, joint, value, limit, unit, slack, asked, .. } = constraint;
    let taken = taken(constraint);
    let amount = |x: f64| format!("{} {unit}", short(x, 5)).trim_end().to_owned();
    let of = joint.as_ref().map_or(String::new(), |joint| format!(" of {joint}"));
    let wished = if *asked { "" } else { ", wished" };
    Track {
        name: what.clone(),
        axis,
        ticks: ticks::even(axis, 6.0),
        bars: vec![Bar::whole(0.0, taken, if *slack < 0.0 { STOPPED } else { HOLDS })],
        marks: vec![(100.0, LIMIT), (0.0, Stroke::solid(INK, 1.0))],
        words: vec![format!("{}{of}", amount(*value)), format!("limit {}{wished}", amount(*limit))],
    }
}
