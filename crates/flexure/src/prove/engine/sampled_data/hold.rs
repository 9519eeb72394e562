//! The robot while torques are held: motions about a motion, validated.

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::Dense;
use crate::prove::engine::envelope::closed_loop::TrackingLoop;
use crate::prove::engine::sampled_data::curvature::Curvature;
use crate::prove::engine::sampled_data::flow::flow;
use crate::prove::engine::sampled_data::norm::around_zero;
use crate::prove::engine::sampled_data::robot::{Links, Path};
use crate::prove::engine::sampled_data::spread::{Sizes, Spread};

/// How often a box is made larger until no motion leaves it.
const WIDENED: u32 = 12;

/// By how much, relatively.
const WIDER: f64 = 0.1;

/// The robot whose motions (q_l, q_m, q̇_l, q̇_m) are `motion` when the torques `torque` begin to be held, `length` in s after that, by so many equal
/// `pieces`; none where a piece is too long.
///
/// In a piece every motion x is in a box, by Picard's theorem. A polynomial p(t) near the middle one leaves r(t) of the equations over. With the rates of change
/// ∂f/∂x, ∂f/∂u over the box, d/dt (x − p) = J(t) (x − p) + J_u(t) (u − u_p) + r(t) with J(t), J_u(t) in those intervals (mean values, row by row); two motions differ by a
/// solution of the same equation without r(t).
pub fn held(
    system: &dyn TrackingLoop,
    motion: Spread,
    torque: &Spread,
    sizes: &Sizes,
    length: Interval,
    pieces: usize,
) -> Option<Spread> {
    let length = length / Interval::point(pieces as f64);
    let u_m = torque.ranges(sizes);
    let mut curvature = None;
    (0..pieces).try_fold(motion, |motion, _| {
        piece(system, &motion, torque, (sizes, &u_m), (length, pieces), &mut curvature)
    })
}

/// One of so many equal pieces of `length` in s, whose second derivatives are those of `curvature` as long as that covers them.
fn piece(
    system: &dyn TrackingLoop,
    motion: &Spread,
    torque: &Spread,
    (sizes, u_m): (&Sizes, &[Interval]),
    (length, pieces): (Interval, usize),
    curvature: &mut Option<Curvature>,
) -> Option<Spread> {
    let (size, half, n) = (motion.center.len(), motion.center.len() / 2, u_m.len());
    let (ranges, about) = enclosed(system, &motion.ranges(sizes), u_m, length)?;
    let middle = |all: &[Interval]| all.iter().map(|x| x.midpoint()).collect::<Vec<_>>();
    let u_p = middle(&torque.center);
    let path = Path::from(system, &about.middle, &middle(&motion.center), &u_p);
    // Mean values are taken between motions and the path.
    let meanwhile = path.at(Interval::ZERO.hull(length));
    let ranges: Vec<_> = ranges.iter().zip(&meanwhile).map(|(x, p)| x.hull(*p)).collect();
    let (links, accelerations) = accelerated(system, &ranges, u_m)?;

    let u_p: Vec<_> = u_p.iter().map(|&u| Interval::point(u)).collect();
    let inertia = system.drive().motor_inertia;
    // Accelerations by torques that are left over.
    let rest = |left: Vec<Interval>| -> Vec<Interval> {
        let of_motors = left[n..].iter().zip(&inertia).map(|(&x, &inertia)| x / inertia);
        links.inverse_mass.apply(&left).into_iter().chain(of_motors).collect()
    };
    let [at_start, later] = path.left_over(system, &u_p, length).map(rest);
    let begin = path.at(Interval::ZERO);
    let mut path_rates = begin[half..].to_vec();
    path_rates.extend(path.accelerations().iter().zip(&at_start).map(|(&a, &r)| a + r));

    // Wide enough for the pieces that follow.
    let of_links = &ranges[..3 * n];
    if !curvature.as_ref().is_some_and(|curvature| curvature.covers(of_links)) {
        let roomy = |x: &Interval| *x + around_zero(pieces as f64 * x.width());
        *curvature = Some(Curvature::over(system, of_links.iter().map(roomy).collect()));
    }
    let everywhere = links.rates(system, &ranges[..n], &ranges[half..half + n], &accelerations[..n]);
    let points: Vec<_> = ranges.iter().map(|x| Interval::point(x.midpoint())).collect();
    let (at_points, a) = accelerated(system, &points, u_m)?;
    let rates = at_points.rates(system, &points[..n], &points[half..half + n], &a[..n]);
    let around = curvature.as_ref()?.around(&rates, of_links);
    // Both enclose them.
    let rates = Dense::from_fn(n, 3 * n, |i, j| {
        everywhere[(i, j)].intersection(around[(i, j)]).unwrap_or(everywhere[(i, j)])
    });

    let flow = flow(system, &rates, &path_rates, length)?;
    let beside = |x: &[Interval], p: &[Interval]| x.iter().zip(p).map(|(&x, &p)| x - p).collect::<Vec<_>>();
    let start = [beside(&motion.center, &begin), beside(&torque.center, &u_p)].concat();
    let (end, moved) = (path.at(length), flow.at_end.apply(&start));
    let late = flow.between.map(Interval::point);
    let later: Vec<_> = later.iter().map(|r| Interval::point(r.magnitude())).collect();
    let late = late.apply(&[vec![Interval::ZERO; half], later].concat());
    let center = |i: usize| {
        let by_path = end[i] + moved[i] + around_zero((length * late[i]).hi());
        // By mean values between motions and where the path begins, instead: better where a damper is faster than a polynomial.
        let by_start = begin[i] + moved[i] + flow.at_end[(i, size + n)];
        by_path.intersection(by_start).unwrap_or(by_path)
    };
    let part = |from: usize, count: usize| Dense::from_fn(size, count, |i, j| flow.at_end[(i, from + j)]);
    let deviations = &(&part(0, size) * &motion.deviations) + &(&part(size, n) * &torque.deviations);
    Some(Spread { center: (0..size).map(center).collect(), deviations })
}

/// What the links are over the box `x` of motions, and how links and motors speed up there under the torques `u_m` [rad/s²].
fn accelerated(
    system: &dyn TrackingLoop,
    x: &[Interval],
    u_m: &[Interval],
) -> Option<(Links, Vec<Interval>)> {
    let (half, n, drive) = (x.len() / 2, u_m.len(), system.drive());
    let links = Links::over(system, &x[..n])?;
    let spring: Vec<_> = (0..n).map(|i| drive.stiffness[i] * (x[n + i] - x[i])).collect();
    let motor =
        |i: usize| (u_m[i] - spring[i] - drive.motor_damping[i] * x[half + n + i]) / drive.motor_inertia[i];
    let mut all = links.accelerations(system, &x[..n], &x[half..half + n], &spring);
    all.extend((0..n).map(motor));
    Some((links, all))
}

/// A box that no motion from `start` leaves for `length` in s, and the links there; none if none is found.
fn enclosed(
    system: &dyn TrackingLoop,
    start: &[Interval],
    u_m: &[Interval],
    length: Interval,
) -> Option<(Vec<Interval>, Links)> {
    let half = start.len() / 2;
    let meanwhile = Interval::ZERO.hull(length);
    let mut tried = start.to_vec();
    for _ in 0..WIDENED {
        let (links, accelerations) = accelerated(system, &tried, u_m)?;
        let rate = |i: usize| if i < half { tried[half + i] } else { accelerations[i - half] };
        let next: Vec<_> = (0..start.len()).map(|i| start[i] + meanwhile * rate(i)).collect();
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

/// In a piece, the fastest rate of springs and link dampers times its length is at most this, and that of motor dampers at most this.
const PACES: [f64; 2] = [0.15, 0.4];

/// Pieces that `length` in s is to be cut into near `motion`; 1 where the masses there are not known.
pub fn pace(system: &dyn TrackingLoop, motion: &[Interval], length: Interval) -> usize {
    let n = motion.len() / 4;
    let Some(links) = Links::over(system, &motion[..n]) else { return 1 };
    let rates = links.rates(system, &motion[..n], &motion[2 * n..3 * n], &vec![Interval::ZERO; n]);
    let drive = system.drive();
    let spring = |row: &[Interval]| row[..2 * n].iter().fold(0.0, |most: f64, x| most.max(x.magnitude()));
    let damper = |row: &[Interval]| row[2 * n..].iter().fold(0.0, |most: f64, x| most.max(x.magnitude()));
    let of_links = rates.rows().map(|row| damper(row).max(spring(row).sqrt()));
    let of_motor = |i: usize| {
        let inertia = drive.motor_inertia[i];
        let spring = (drive.stiffness[i] / inertia).magnitude().sqrt() / PACES[0];
        spring.max((drive.motor_damping[i] / inertia).magnitude() / PACES[1])
    };
    let fastest = of_links.map(|rate| rate / PACES[0]).chain((0..n).map(of_motor)).fold(0.0, f64::max);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 1 to 1e6")]
    let pieces = (length.hi() * fastest).ceil().clamp(1.0, 1e6) as usize;
    pieces
}
