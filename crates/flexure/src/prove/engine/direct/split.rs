//! Which coordinate of a box to bisect, and where.

use flexure_core::scalar::Interval;

use crate::linalg::Symmetric;
use crate::prove::engine::direct::flow::Flow;

/// Both parts of a range; `None` where there is nothing to gain: a point, neighbouring floats, or an end so far out that
/// what lies beyond will not become decidable.
pub(crate) fn halves(range: Interval) -> Option<(Interval, Interval)> {
    /// Unbounded ranges are not cut beyond this.
    const FAR: f64 = 1e6;
    // Unbounded ranges: first at 0, then at ±1, ±2, ±4, …
    let outwards = |end: f64| if end < 0.0 { 0.0 } else { (2.0 * end).max(1.0) };
    let cut = match (range.lo().is_finite(), range.hi().is_finite()) {
        (true, true) => range.midpoint(),
        (true, false) => outwards(range.lo()),
        (false, true) => -outwards(-range.hi()),
        (false, false) => 0.0,
    };
    let bounded = range.lo().is_finite() && range.hi().is_finite();
    let inside = range.lo() < cut && cut < range.hi() && (bounded || cut.abs() <= FAR);
    if inside { Interval::new(range.lo(), cut).zip(Interval::new(cut, range.hi())) } else { None }
}

/// How far a matrix is from being seen to be positive: how many entries are unbounded, and of the others the widths, weighted, but
/// of those on the diagonal how low they can be: how high those can be does not matter.
type Lack = (usize, f64);

fn lack(a: &Symmetric<Interval>, reach: &[f64]) -> Lack {
    let (mut unbounded, mut sum) = (0, 0.0);
    for i in 0..a.size() {
        for j in 0..=i {
            let entry = a.at(i, j);
            let amount = if i == j { -entry.lo() } else { 2.0 * entry.width() };
            if amount.is_finite() {
                sum += amount * reach[i] * reach[j];
            } else {
                unbounded += 1;
            }
        }
    }
    (unbounded, sum)
}

/// The coordinates that the matrix of the whole region depends on; all of them where it shows none.
pub(crate) fn relevant(flow: &dyn Flow, at: &[Interval]) -> Vec<usize> {
    let whole = flow.enclosure(at);
    let splittable: Vec<usize> = (0..at.len()).filter(|&i| halves(at[i]).is_some()).collect();
    let changes = |&i: &usize| flow.enclosure(&pinned(at, i, at[i].midpoint())) != whole;
    let relevant: Vec<usize> = splittable.iter().copied().filter(changes).collect();
    if relevant.is_empty() { splittable } else { relevant }
}

/// The box with coordinate `i` at `place`.
fn pinned(at: &[Interval], i: usize, place: f64) -> Vec<Interval> {
    let mut pinned = at.to_vec();
    pinned[i] = Interval::point(place);
    pinned
}

/// The coordinate that is best bisected, of those in `candidates`: the one of which `matrix` lacks least once it is known, wherever it then is: at
/// an end or in the middle. Without any effect, the one that is widest as a part of its range. `None` where nothing can be bisected.
pub(crate) fn most_effective(
    flow: &dyn Flow,
    at: &[Interval],
    candidates: &[usize],
    matrix: impl Fn(&[Interval]) -> Symmetric<Interval>,
    reach: &[f64],
) -> Option<usize> {
    let splittable: Vec<usize> = candidates.iter().copied().filter(|&i| halves(at[i]).is_some()).collect();
    if splittable.len() < 2 {
        return splittable.first().copied();
    }
    let order = |a: &Lack, b: &Lack| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1));
    let whole = matrix(at);
    let before = lack(&whole, reach);
    let known = |i: usize| {
        let places = [at[i].lo(), at[i].midpoint(), at[i].hi()].into_iter().filter(|x| x.is_finite());
        let worst = places.map(|x| lack(&matrix(&pinned(at, i, x)), reach)).max_by(order);
        worst.map(|worst| (i, worst))
    };
    let tried = splittable.iter().filter_map(|&i| known(i));
    let (best, after) = tried.min_by(|(_, a), (_, b)| order(a, b))?;
    let size: f64 = (0..whole.size()).map(|i| whole.at(i, i).lo().abs() * reach[i] * reach[i]).sum();
    let better = after.0 < before.0 || (after.0 == before.0 && after.1 < before.1 - 1e-9 * size);
    let part = |i: usize| match at[i].width() / flow.coordinates()[i].range.width() {
        part if part.is_finite() => part,
        _ => f64::INFINITY,
    };
    if better { Some(best) } else { splittable.into_iter().max_by(|&i, &j| part(i).total_cmp(&part(j))) }
}

#[cfg(test)]
mod tests {
    use super::{Interval, halves};

    #[test]
    fn unbounded_ranges_are_cut_where_something_happens() {
        let range = |lo, hi| Interval::new(lo, hi).unwrap();
        let cut = |lo, hi| halves(range(lo, hi)).map(|(left, _)| left.hi());
        let inf = f64::INFINITY;
        assert_eq!(cut(-inf, inf), Some(0.0));
        assert_eq!(cut(0.0, inf), Some(1.0));
        assert_eq!(cut(3.0, inf), Some(6.0));
        assert_eq!(cut(-3.0, inf), Some(0.0));
        assert_eq!(cut(-inf, -3.0), Some(-6.0));
        assert_eq!(cut(1e6, inf), None);
        assert_eq!(cut(1.0, 2.0), Some(1.5));
        assert_eq!(cut(1.0, 1.0), None);
        assert_eq!(cut(1.0, 1.0_f64.next_up()), None);
    }
}
