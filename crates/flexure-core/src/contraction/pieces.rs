//! Bounds over a box, by cutting it up.

use crate::linalg::Vector;
use crate::scalar::Interval;

/// What `f` encloses over a box, as the hull over 2^`cuts` pieces: each cut halves the next of the sides that are no points.
///
/// A function of one's own of a box, such as a matrix measure, overestimates by what its arguments are wide: with each cut of all sides it does
/// half as much.
pub fn over_pieces<const K: usize>(
    region: &Vector<Interval, K>,
    cuts: usize,
    f: &impl Fn(&Vector<Interval, K>) -> Interval,
) -> Interval {
    let wide = region.iter().filter(|side| side.lo() < side.hi()).count();
    let next = (0..K).filter(|i| region[*i].lo() < region[*i].hi()).nth(cuts.checked_rem(wide).unwrap_or(0));
    match (next, cuts.checked_sub(1)) {
        (Some(side), Some(left)) => {
            let (low, high) = region[side].split();
            let half = |part: Interval| Vector::from_fn(|i| if i == side { part } else { region[i] });
            over_pieces(&half(low), left, f).hull(over_pieces(&half(high), left, f))
        }
        _ => f(region),
    }
}
