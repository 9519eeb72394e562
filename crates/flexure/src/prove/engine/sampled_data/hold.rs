//! The robot while torques are held: motions about a motion, validated.

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::Dense;
use crate::prove::engine::envelope::closed_loop::TrackingLoop;
use crate::prove::engine::sampled_data::curvature::Curvature;
use crate::prove::engine::sampled_data::fundamental::fundamental;
use crate::prove::engine::sampled_data::robot::{Links, Path};

/// Numbers c + M (y, η) with |y| ≤ 1 and |η_j| ≤ s_j; of another y and η, they differ by some N (Δy, Δη), N in the same intervals.
#[derive(Clone, Debug)]
pub struct Spread {
    /// c.
    pub center: Vec<Interval>,
    /// M: columns of y, then of η.
    pub deviations: Dense<Interval>,
}

/// What the y and η are.
#[derive(Clone, Debug)]
pub struct Sizes {
    /// Numbers in y.
    pub ball: usize,
    /// s_j, from above.
    pub others: Vec<f64>,
}

impl Sizes {
    /// How far |row·(y, η)| goes, from above.
    pub fn reach(&self, row: &[Interval]) -> f64 {
        let (y, others) = row.split_at(self.ball);
        let square = y.iter().fold(Interval::ZERO, |sum, x| sum + Interval::point(x.magnitude()).square());
        let others = others.iter().zip(&self.others).fold(Interval::ZERO, |sum, (x, &size)| {
            sum + Interval::point(x.magnitude()) * Interval::point(size)
        });
        (square.sqrt() + others).hi()
    }
}

impl Spread {
    /// The box around all of it.
    pub fn ranges(&self, sizes: &Sizes) -> Vec<Interval> {
        let range = |(&c, row): (&Interval, &[Interval])| c + around_zero(sizes.reach(row));
        self.center.iter().zip(self.deviations.rows()).map(range).collect()
    }
}

/// [−radius, radius].
pub(super) fn around_zero(radius: f64) -> Interval {
    Interval::new(-radius, radius).unwrap_or(Interval::ENTIRE)
}

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
    (0..pieces)
        .try_fold(motion, |motion, _| piece(system, &motion, torque, (sizes, &u_m), length, &mut curvature))
}

/// Boxes that second derivatives are bounded over are so many times as wide as those of pieces, on either side.
const ROOMY: f64 = 4.0;

/// One piece.
fn piece(
    system: &dyn TrackingLoop,
    motion: &Spread,
    torque: &Spread,
    (sizes, u_m): (&Sizes, &[Interval]),
    length: Interval,
    curvature: &mut Option<Curvature>,
) -> Option<Spread> {
    let (size, half, n) = (motion.center.len(), motion.center.len() / 2, u_m.len());
    let ranges = enclosed(system, &motion.ranges(sizes), u_m, length)?;
    let middle = |all: &[Interval]| all.iter().map(|x| x.midpoint()).collect::<Vec<_>>();
    let u_p = middle(&torque.center);
    let about = Links::over(system, &ranges[..n])?;
    let path = Path::from(system, &about.middle, &middle(&motion.center), &u_p);
    // Mean values are taken between motions and the path.
    let meanwhile = path.at(Interval::ZERO.hull(length));
    let ranges: Vec<_> = ranges.iter().zip(&meanwhile).map(|(x, p)| x.hull(*p)).collect();
    let (links, accelerations) = accelerated(system, &ranges, u_m)?;

    let u_p: Vec<_> = u_p.iter().map(|&u| Interval::point(u)).collect();
    let inertia = system.drive().motor_inertia;
    let rest = |left: Vec<Interval>| -> Vec<Interval> {
        let of_links = links
            .inverse_mass
            .rows()
            .map(|row| row.iter().zip(&left).fold(Interval::ZERO, |sum, (&a, &x)| sum + a * x));
        of_links.chain(left[n..].iter().zip(&inertia).map(|(&x, &inertia)| x / inertia)).collect()
    };
    let [at_start, later] = path.left_over(system, &u_p, length).map(rest);
    let begin = path.at(Interval::ZERO);
    let mut rates = begin[half..].to_vec();
    rates.extend(path.accelerations().iter().zip(&at_start).map(|(&a, &r)| a + r));

    let of_links = &ranges[..3 * n];
    if !curvature.as_ref().is_some_and(|curvature| curvature.covers(of_links)) {
        let roomy = |x: &Interval| *x + around_zero(ROOMY * x.width());
        *curvature = Some(Curvature::over(system, of_links.iter().map(roomy).collect()));
    }
    let at_middle: Vec<_> = ranges.iter().map(|x| Interval::point(x.midpoint())).collect();
    let (middle, at) = accelerated(system, &at_middle, u_m)?;
    let middle = middle.rates(system, &at_middle[..n], &at_middle[half..half + n], &at[..n]);
    let everywhere = links.rates(system, &ranges[..n], &ranges[half..half + n], &accelerations[..n]);
    let around = curvature.as_ref().map_or_else(|| everywhere.clone(), |c| c.around(&middle, of_links));
    // Both enclose them.
    let link_rates = Dense::from_fn(n, 3 * n, |i, j| {
        everywhere[(i, j)].intersection(around[(i, j)]).unwrap_or(everywhere[(i, j)])
    });
    let flow = flow(system, &link_rates, &rates, length)?;
    let end = path.at(length);
    let beside = |x: &[Interval], p: &[Interval]| x.iter().zip(p).map(|(&x, &p)| x - p).collect::<Vec<_>>();
    let mut start = beside(&motion.center, &begin);
    start.extend(beside(&torque.center, &u_p));
    let moved = |i: usize| {
        let row = flow.at_end.row(i);
        let sum = row.iter().zip(&start).fold(Interval::ZERO, |sum, (&a, &x)| sum + a * x);
        let late = flow.between.row(i)[half..]
            .iter()
            .zip(&later)
            .fold(Interval::ZERO, |sum, (&a, &r)| sum + Interval::point(a) * Interval::point(r.magnitude()));
        let by_path = end[i] + sum + around_zero((length * late).hi());
        // By mean values between motions and where the path begins, instead: better where a damper is faster than a polynomial.
        let by_start = begin[i] + sum + row[size + n];
        by_path.intersection(by_start).unwrap_or(by_path)
    };
    let center = (0..size).map(moved).collect();
    let columns = motion.deviations.columns();
    let deviations = Dense::from_fn(size, columns, |i, j| {
        let (states, torques) = flow.at_end.row(i)[..size + n].split_at(size);
        let of = |slopes: &[Interval], all: &Dense<Interval>| {
            slopes.iter().zip(all.rows()).fold(Interval::ZERO, |sum, (&a, row)| sum + a * row[j])
        };
        of(states, &motion.deviations) + of(torques, &torque.deviations)
    });
    Some(Spread { center, deviations })
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

/// A box that no motion from `start` leaves for `length` in s; none if none is found.
fn enclosed(
    system: &dyn TrackingLoop,
    start: &[Interval],
    u_m: &[Interval],
    length: Interval,
) -> Option<Vec<Interval>> {
    let half = start.len() / 2;
    let meanwhile = Interval::ZERO.hull(length);
    let mut tried = start.to_vec();
    for _ in 0..WIDENED {
        let (_, accelerations) = accelerated(system, &tried, u_m)?;
        let rate = |i: usize| if i < half { tried[half + i] } else { accelerations[i - half] };
        let next: Vec<_> = (0..start.len()).map(|i| start[i] + meanwhile * rate(i)).collect();
        if next.iter().zip(&tried).all(|(next, tried)| tried.contains_interval(*next)) {
            // No motion leaves it, nor what it is mapped to.
            return Some(next);
        }
        let wider = |(next, tried): (&Interval, &Interval)| {
            tried.hull(*next + around_zero(WIDER * next.width() + f64::MIN_POSITIVE))
        };
        tried = next.iter().zip(&tried).map(wider).collect();
    }
    None
}

/// Of ẋ = J x + J_u u with rates over a box, u held.
struct Flow {
    /// What motions and torques at the start make of the motion at the end, and how the path would move on if nothing changed.
    at_end: Dense<Interval>,
    /// From above, what a motion at any time makes of one at any later time.
    between: Dense<f64>,
}

/// For `length` in s, with the slopes `by_links` of the links' accelerations, by X(1) of ξ' = `length` S J S⁻¹ ξ for motions and torques, S a power of two for velocities so that no entry is
/// large; none if that is too long.
fn flow(
    system: &dyn TrackingLoop,
    by_links: &Dense<Interval>,
    path_rates: &[Interval],
    length: Interval,
) -> Option<Flow> {
    let (size, half, n) = (path_rates.len(), path_rates.len() / 2, path_rates.len() / 4);
    let drive = system.drive();
    let by_motors = |i: usize, j: usize| {
        let torque = match j.checked_sub(i) {
            Some(0) => drive.stiffness[i],
            Some(by) if by == n => -drive.stiffness[i],
            Some(by) if by == half + n => -drive.motor_damping[i],
            Some(by) if by == size => Interval::ONE,
            _ => return Interval::ZERO,
        };
        torque / drive.motor_inertia[i]
    };
    let entry = |i: usize, j: usize| match (i, j) {
        (i, _) if i >= size => Interval::ZERO,
        (i, j) if j == size + n => path_rates[i],
        (i, j) if i < half => {
            if j == half + i {
                Interval::ONE
            } else {
                Interval::ZERO
            }
        }
        (i, j) if i < half + n => {
            if j < 3 * n {
                by_links[(i - half, j)]
            } else {
                Interval::ZERO
            }
        }
        (i, j) => by_motors(i - half - n, j),
    };
    let scale = length.midpoint().log2().round().exp2();
    let of = |i: usize| if (half..size).contains(&i) { Interval::point(scale) } else { Interval::ONE };
    let rates = Dense::from_fn(size + n + 1, size + n + 1, |i, j| length * of(i) * entry(i, j) / of(j));
    let found = fundamental(&rates)?;
    let at_end = Dense::from_fn(size, size + n + 1, |i, j| found.at_end[(i, j)] * of(j) / of(i));
    let between =
        Dense::from_fn(size, size, |i, j| (Interval::point(found.between[(i, j)]) * of(j) / of(i)).hi());
    Some(Flow { at_end, between })
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
