//! Where motions are for a short time, and how the links' slopes change meanwhile.

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::Dense;
use crate::prove::engine::envelope::closed_loop::TrackingLoop;
use crate::prove::engine::sampled_data::curvature::{Curvature, Off};
use crate::prove::engine::sampled_data::flow::Slopes;
use crate::prove::engine::sampled_data::links::{Links, springs};
use crate::prove::engine::sampled_data::norm::{around_zero, onwards, radius};
use crate::prove::engine::sampled_data::path::Path;

/// How often a box is made larger until no motion leaves it.
const WIDENED: u32 = 12;

/// By how much, relatively.
const WIDER: f64 = 0.1;

/// Where motions and the path are in a piece.
pub struct Stretch {
    /// All of them, all the time, and `middle`.
    pub ranges: Vec<Interval>,
    /// The links where motions and the path are.
    pub links: Links,
    /// Accelerations of motions there, links, then motors [rad/s²].
    accelerations: Vec<Interval>,
    /// A motion in the middle of them.
    middle: Vec<f64>,
    /// With which all move, about [rad/s, rad/s²].
    rates: Vec<f64>,
    /// With which they move.
    all_rates: Vec<Interval>,
    length: Interval,
    /// How far they are off `middle` + (t − ½ length) `rates` at a time t, from above.
    pub off: Vec<f64>,
}

/// From `starts` and the path's `begin`, for `length` in s, motions in `ranges`.
pub fn stretch(
    system: &dyn TrackingLoop,
    (starts, begin): (&[Interval], &[Interval]),
    ranges: &[Interval],
    (path, u_m): (&Path, &[Interval]),
    length: Interval,
) -> Option<Stretch> {
    let meanwhile = Interval::ZERO.hull(length);
    let along = path.at(meanwhile);
    let mut ranges: Vec<_> = ranges.iter().zip(&along).map(|(x, p)| x.hull(*p)).collect();
    let (links, accelerations) = accelerated(system, &ranges, u_m)?;
    let all: Vec<_> =
        rates_of(&ranges, &accelerations).zip(path.rates(meanwhile)).map(|(x, p)| x.hull(p)).collect();
    let rates: Vec<_> = all.iter().map(|x| x.midpoint()).collect();
    let starts: Vec<_> = starts.iter().zip(begin).map(|(x, p)| x.hull(*p)).collect();
    let ahead = 0.5 * length.midpoint();
    let middle: Vec<_> = starts.iter().zip(&rates).map(|(x, rate)| x.midpoint() + ahead * rate).collect();
    ranges.iter_mut().zip(&middle).for_each(|(x, &m)| *x = x.hull(Interval::point(m)));
    let mut stretch =
        Stretch { ranges, links, accelerations, middle, rates, all_rates: all, length, off: Vec::new() };
    stretch.off = stretch.off_of(&starts);
    Some(stretch)
}

impl Stretch {
    /// How far motions from `starts`, which are some of them, are off `middle` + (t − ½ length) `rates` at a time t, from above.
    pub fn off_of(&self, starts: &[Interval]) -> Vec<f64> {
        let (half, meanwhile) = (Interval::point(0.5), Interval::ZERO.hull(self.length));
        let off = |i: usize| {
            let rate = Interval::point(self.rates[i]);
            let begin = starts[i] - Interval::point(self.middle[i]) + self.length * rate * half;
            (begin + meanwhile * (self.all_rates[i] - rate)).magnitude()
        };
        (0..starts.len()).map(off).collect()
    }

    /// The same of what is between a motion from `center` and one from `starts`, in the mean over the way from the one to the other.
    pub fn off_between(&self, center: &[Interval], starts: &[Interval]) -> Vec<f64> {
        let both = self.off_of(center).into_iter().zip(self.off_of(starts));
        both.map(|(a, b)| ((Interval::point(a) + Interval::point(b)) * Interval::point(0.5)).hi()).collect()
    }

    /// A box for the first `count` numbers where motions may be for `left` in s after the piece, too, if they go on about as they do.
    pub fn onwards(&self, count: usize, left: Interval) -> Vec<Interval> {
        let on = |(&x, &rate): (&Interval, &f64)| onwards(x, left * Interval::point(rate));
        self.ranges.iter().zip(&self.rates).take(count).map(on).collect()
    }

    /// With second derivatives over all of it in `curvature`: those at the middle, J, and how they change along the way, t in s from the middle of the piece,
    ///
    /// J(ξ) = J + Σ_k H_k ((t rates)_k + ω_k), |ω| ≤ `off`, H_k in the intervals of second derivatives;
    ///
    /// or, entry by entry, those over the box, where that has less beside it. For each of `offs`: with columns, ω is closer than the box around it.
    pub fn slopes<const K: usize>(
        &self,
        system: &dyn TrackingLoop,
        u_m: &[Interval],
        curvature: &Curvature,
        offs: [Off<'_>; K],
    ) -> Option<[Slopes; K]> {
        let Self { ranges, links, accelerations, middle, rates, length, .. } = self;
        let (n, half) = (u_m.len(), ranges.len() / 2);
        let everywhere = links.rates(system, &ranges[..n], &ranges[half..half + n], &accelerations[..n]);
        let points: Vec<_> = middle.iter().map(|&x| Interval::point(x)).collect();
        let (at_points, a) = accelerated(system, &points, u_m)?;
        let at = at_points.rates(system, &points[..n], &points[half..half + n], &a[..n]);
        let reach: Vec<_> = ranges.iter().zip(&points).map(|(&x, &m)| (x - m).magnitude()).collect();
        let around = curvature.around(&at, &reach[..3 * n]);
        // Both enclose them: where they do not meet, something is wrong, and nothing is known.
        let anywhere = Dense::from_fn(n, 3 * n, |i, j| {
            everywhere[(i, j)].intersection(around[(i, j)]).unwrap_or(Interval::ENTIRE)
        });
        let moved: Vec<_> = rates[..3 * n].iter().map(|&rate| *length * Interval::point(rate)).collect();
        let moved = curvature.along(&moved);
        let half = Interval::point(0.5);
        let slopes = |off: Off<'_>| {
            let mut beside = curvature.around(&at, &off.all[..3 * n]);
            if off.columns.columns() > 0 {
                let by_columns = curvature.around_columns(&at, &off);
                beside = Dense::from_fn(n, 3 * n, |i, j| {
                    beside[(i, j)].intersection(by_columns[(i, j)]).unwrap_or(Interval::ENTIRE)
                });
            }
            let better = |i: usize, j: usize| {
                let change = Interval::point(moved[(i, j)].midpoint());
                let open = half * radius(moved[(i, j)]);
                let begin = beside[(i, j)] + around_zero(open.hi()) - half * change;
                if begin.width() < anywhere[(i, j)].width() {
                    (begin, change)
                } else {
                    (anywhere[(i, j)], Interval::ZERO)
                }
            };
            Slopes {
                begin: Dense::from_fn(n, 3 * n, |i, j| better(i, j).0),
                change: Dense::from_fn(n, 3 * n, |i, j| better(i, j).1),
                anywhere: anywhere.clone(),
            }
        };
        Some(offs.map(slopes))
    }
}

/// What the links are over the box `x` of motions (q_l, δ, q̇_l, q̇_m), and how links and motors speed up there under the torques `u_m` [rad/s²].
fn accelerated(
    system: &dyn TrackingLoop,
    x: &[Interval],
    u_m: &[Interval],
) -> Option<(Links, Vec<Interval>)> {
    let (half, n, drive) = (x.len() / 2, u_m.len(), system.drive());
    let links = Links::over(system, &x[..n])?;
    let spring = springs(system, &x[n..half]);
    let motor =
        |i: usize| (u_m[i] - spring[i] - drive.motor_damping[i] * x[half + n + i]) / drive.motor_inertia[i];
    let mut all = links.accelerations(system, &x[..n], &x[half..half + n], &spring);
    all.extend((0..n).map(motor));
    Some((links, all))
}

/// How fast (q_l, δ, q̇_l, q̇_m) change where they are in `x` and speed up by `accelerations`, links, then motors.
fn rates_of<'a>(x: &'a [Interval], accelerations: &'a [Interval]) -> impl Iterator<Item = Interval> + 'a {
    let (links, motors) = x[x.len() / 2..].split_at(x.len() / 4);
    let bent = motors.iter().zip(links).map(|(&motor, &link)| motor - link);
    links.iter().copied().chain(bent).chain(accelerations.iter().copied())
}

/// A box that no motion from `start` leaves for `length` in s, and the links there; none if none is found.
pub fn enclosed(
    system: &dyn TrackingLoop,
    start: &[Interval],
    u_m: &[Interval],
    length: Interval,
) -> Option<(Vec<Interval>, Links)> {
    let meanwhile = Interval::ZERO.hull(length);
    let mut tried = start.to_vec();
    for _ in 0..WIDENED {
        let (links, accelerations) = accelerated(system, &tried, u_m)?;
        let rates = rates_of(&tried, &accelerations);
        let next: Vec<_> = start.iter().zip(rates).map(|(&start, rate)| start + meanwhile * rate).collect();
        if next.iter().zip(&tried).all(|(next, tried)| tried.contains_interval(*next)) {
            // No motion leaves it, nor what it is mapped to.
            return Some((next, links));
        }
        let wider = |(next, tried): (&Interval, &Interval)| {
            tried.hull(*next + around_zero(WIDER * next.width() + f64::MIN_POSITIVE))
        };
        tried = next.iter().zip(&tried).map(wider).collect();
    }
    None
}
