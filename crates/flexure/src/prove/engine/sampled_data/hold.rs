//! The robot while torques are held: motions about a motion, validated.

use std::ops::Range;

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::Dense;
use crate::prove::engine::envelope::closed_loop::TrackingLoop;
use crate::prove::engine::sampled_data::curvature::{Curvature, Off};
use crate::prove::engine::sampled_data::flow::{Slopes, flow};
use crate::prove::engine::sampled_data::links::Links;
use crate::prove::engine::sampled_data::norm::around_zero;
use crate::prove::engine::sampled_data::path::Path;
use crate::prove::engine::sampled_data::spread::{Sizes, Spread};
use crate::prove::engine::sampled_data::stretch::{enclosed, stretch};

/// The robot whose motions (q_l, q_m, q̇_l, q̇_m) are `motion` when the torques `torque` begin to be held, `length` in s after that, by so many equal
/// `pieces`; none where a piece is too long.
///
/// In a piece every motion x is in a box, by Picard's theorem. A polynomial p(t) near the middle one leaves r(t) of the equations over. With the rates of change
/// ∂f/∂x, ∂f/∂u where motions and the path are at a time t, d/dt (x − p) = J(t) (x − p) + J_u (u − u_p) + r(t) with J(t) in those intervals (mean values, row by row);
/// two motions of the same readings differ by a solution of the same equation without r(t), and so do those of y = 0 with and without readings that are off: there J(t) is its mean
/// over the way from the one to the other.
pub fn held(
    system: &dyn TrackingLoop,
    motion: &Spread,
    torque: &Spread,
    sizes: &Sizes,
    length: Interval,
    pieces: usize,
) -> Option<Spread> {
    let length = length / Interval::point(pieces as f64);
    let u_m = torque.ranges(sizes);
    let mut curvature = None;
    let end = (0..pieces).try_fold(bent(motion, -1.0), |motion, k| {
        piece(system, &motion, torque, (sizes, &u_m), (length, pieces - 1 - k), &mut curvature)
    })?;
    Some(bent(&end, 1.0))
}

/// The second quarter of the numbers, and `times` the first: (q_l, δ, …) of (q_l, q_m, …) with −1, and back with 1.
fn bent(motion: &Spread, times: f64) -> Spread {
    let n = motion.center.len() / 4;
    let by = Interval::point(times);
    let of = |i: usize, at: &dyn Fn(usize) -> Interval| {
        if (n..2 * n).contains(&i) { at(i) + by * at(i - n) } else { at(i) }
    };
    let all = &motion.deviations;
    Spread {
        center: (0..4 * n).map(|i| of(i, &|i| motion.center[i])).collect(),
        deviations: Dense::from_fn(4 * n, all.columns(), |i, j| of(i, &|i| all[(i, j)])),
    }
}

/// A piece of `length` in s from motions (q_l, δ, q̇_l, q̇_m), δ = q_m − q_l, with so many as long `left` after it. Second derivatives are those of `curvature` as long as
/// that covers them.
fn piece(
    system: &dyn TrackingLoop,
    motion: &Spread,
    torque: &Spread,
    (sizes, u_m): (&Sizes, &[Interval]),
    (length, left): (Interval, usize),
    curvature: &mut Option<Curvature>,
) -> Option<Spread> {
    let (size, half, n) = (motion.center.len(), motion.center.len() / 2, u_m.len());
    let starts = motion.ranges(sizes);
    let (ranges, about) = enclosed(system, &starts, u_m, length)?;
    let middle = |all: &[Interval]| all.iter().map(|x| x.midpoint()).collect::<Vec<_>>();
    let u_p = middle(&torque.center);
    let path = Path::from(system, &about.middle, &middle(&motion.center), &u_p);
    // Mean values are taken between motions and the path.
    let begin = path.at(Interval::ZERO);
    let stretch = stretch(system, (&starts, &begin), &ranges, (&path, u_m), length)?;

    let u_p: Vec<_> = u_p.iter().map(|&u| Interval::point(u)).collect();
    let inertia = system.drive().motor_inertia;
    // Accelerations by torques that are left over.
    let rest = |left: Vec<Interval>| -> Vec<Interval> {
        let of_motors = left[n..].iter().zip(&inertia).map(|(&x, &inertia)| x / inertia);
        stretch.links.inverse_mass.apply(&left).into_iter().chain(of_motors).collect()
    };
    let [at_start, later] = path.left_over(system, &u_p, length).map(rest);
    let mut path_rates = path.rates(Interval::ZERO);
    path_rates[half..].iter_mut().zip(&at_start).for_each(|(rate, &left)| *rate += left);

    let of_links = &stretch.ranges[..3 * n];
    if !curvature.as_ref().is_some_and(|curvature| curvature.covers(of_links)) {
        let left = length * Interval::point(left as f64);
        let far = Curvature::over(system, stretch.onwards(3 * n, left));
        *curvature = Some(far.or_else(|| Curvature::over(system, of_links.to_vec()))?);
    }
    // Motions of the same readings lie anywhere beside each other; what readings do to the middle is between it and where they take it.
    let (all, all_columns) = (sizes.ball + n, motion.deviations.columns());
    let by_readings = all < all_columns;
    let columns =
        Dense::from_fn(3 * n, if by_readings { all_columns } else { 0 }, |i, j| motion.deviations[(i, j)]);
    let hull: Vec<_> = motion.center.iter().zip(&begin).map(|(&c, &p)| c.hull(p)).collect();
    let drift = &stretch.off_of(&hull)[..3 * n];
    let between = stretch.off_between(&motion.center, &motion.ranges_of_others(sizes));
    let (of_all, of_half) =
        (|row: &[Interval]| sizes.reach(row), |row: &[Interval]| sizes.reach_of_others(row, 0.5));
    let offs = [
        Off { columns: &columns, reach: &of_all, beside: drift, all: &stretch.off[..3 * n] },
        Off { columns: &columns, reach: &of_half, beside: drift, all: &between[..3 * n] },
    ];
    let [slopes, slopes_of_readings] = stretch.slopes(system, u_m, curvature.as_ref()?, offs)?;

    let beside = |x: &[Interval], p: &[Interval]| x.iter().zip(p).map(|(&x, &p)| x - p).collect::<Vec<_>>();
    let start = [beside(&motion.center, &begin), beside(&torque.center, &u_p)].concat();
    let way = |slopes: &Slopes| flow(system, slopes, &path_rates, &start, length);
    let flow = way(&slopes)?;
    // Columns of y and of what torques are beside the law's are those of all motions.
    let of_readings = if by_readings { Some(way(&slopes_of_readings)?.at_end) } else { None };
    let (end, moved) = (path.at(length), flow.at_end.apply(&start));
    let late = flow.between.map(Interval::point);
    let later: Vec<_> = later.iter().map(|r| Interval::point(r.magnitude())).collect();
    let late = late.apply(&[vec![Interval::ZERO; half], later].concat());
    let center = |i: usize| {
        let by_path = end[i] + moved[i] + around_zero((length * late[i]).hi());
        // By mean values between motions and where the path begins, instead: better where a damper is faster than a polynomial.
        let by_start = begin[i] + flow.carried[i];
        // Both enclose it: where they do not meet, something is wrong, and nothing is known.
        by_path.intersection(by_start)
    };
    let carried = |at_end: &Dense<Interval>, columns: Range<usize>| {
        let part = |from: usize, count: usize| Dense::from_fn(size, count, |i, j| at_end[(i, from + j)]);
        let of = |all: &Dense<Interval>| {
            Dense::from_fn(all.rows().len(), columns.len(), |i, j| all[(i, columns.start + j)])
        };
        &(&part(0, size) * &of(&motion.deviations)) + &(&part(size, n) * &of(&torque.deviations))
    };
    let first = carried(&flow.at_end, 0..all.min(all_columns));
    let rest = of_readings.map(|at_end| carried(&at_end, all..all_columns));
    let deviations = Dense::from_fn(size, all_columns, |i, j| match &rest {
        Some(rest) if j >= all => rest[(i, j - all)],
        _ => first[(i, j)],
    });
    Some(Spread { center: (0..size).map(center).collect::<Option<_>>()?, deviations })
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

#[cfg(test)]
mod tests {
    use flexure_core::scalar::Interval;

    use super::{
        Curvature, Dense, Links, Off, Path, Sizes, Spread, TrackingLoop, enclosed, held, pace, stretch,
    };
    use crate::prove::closed_loop::along_reference;
    use crate::prove::engine::envelope::closed_loop::Slope;
    use crate::prove::engine::sampled_data::links::springs;
    use crate::scenario::Scenario;

    /// How fast a motion (q_l, q_m, q̇_l, q̇_m) changes under the torques `u_m`.
    fn rates(system: &dyn TrackingLoop, x: &[f64], u_m: &[f64]) -> Vec<f64> {
        let (n, drive) = (u_m.len(), system.drive());
        let points: Vec<_> = x.iter().map(|&x| Interval::point(x)).collect();
        let bent: Vec<_> = (0..n).map(|i| Interval::point(x[n + i] - x[i])).collect();
        let spring = springs(system, &bent);
        let links = Links::over(system, &points[..n]).unwrap();
        let links = links.accelerations(system, &points[..n], &points[2 * n..3 * n], &spring);
        let motor = |i: usize| {
            let torque = u_m[i] - spring[i].midpoint() - drive.motor_damping[i].midpoint() * x[3 * n + i];
            torque / drive.motor_inertia[i].midpoint()
        };
        let links = links.iter().map(|a| a.midpoint());
        x[2 * n..].iter().copied().chain(links).chain((0..n).map(motor)).collect()
    }

    /// Where the motion is after `length` in s, by the classical method of Runge and Kutta.
    fn moved(system: &dyn TrackingLoop, x: &[f64], u_m: &[f64], length: f64) -> Vec<f64> {
        let (steps, mut x) = (24, x.to_vec());
        let h = length / f64::from(steps);
        for _ in 0..steps {
            let at = |way: &[f64], part: f64| {
                let there: Vec<_> = x.iter().zip(way).map(|(x, way)| x + part * h * way).collect();
                rates(system, &there, u_m)
            };
            let first = at(&vec![0.0; x.len()], 0.0);
            let second = at(&first, 0.5);
            let third = at(&second, 0.5);
            let fourth = at(&third, 1.0);
            for i in 0..x.len() {
                x[i] += h / 6.0 * (first[i] + 2.0 * second[i] + 2.0 * third[i] + fourth[i]);
            }
        }
        x
    }

    fn points(x: &[f64]) -> Vec<Interval> {
        x.iter().map(|&x| Interval::point(x)).collect()
    }

    fn wide(x: Interval, by: f64) -> Interval {
        x + Interval::new(-by, by).unwrap()
    }

    /// Seven joints, a motion (q_l, q_m, q̇_l, q̇_m) and torques of motors that hold them and their springs, nearly.
    fn arm() -> (Box<dyn TrackingLoop>, Vec<f64>, Vec<f64>) {
        let system = along_reference(&Scenario::load("panda-tanh-smooth").unwrap()).unwrap();
        let n = system.joints();
        let wave = |i: usize, by: f64| (by * (i + 1) as f64).sin();
        let [q_l, v_l] = [1.0, 0.1].map(|size| (0..n).map(|i| size * wave(i, 1.7)).collect::<Vec<_>>());
        let slow = |x: &[f64]| x.iter().map(|&x| Slope::value(Interval::point(x))).collect::<Vec<_>>();
        let load = system.link_load(&slow(&q_l), &slow(&v_l), &slow(&vec![0.1; n]));
        let drive = system.drive();
        let bent: Vec<_> =
            (0..n).map(|i| load[i].coefficient(0).midpoint() / drive.stiffness[i].midpoint()).collect();
        let q_m: Vec<_> = (0..n).map(|i| q_l[i] + bent[i]).collect();
        let u_m: Vec<_> = (0..n).map(|i| load[i].coefficient(0).midpoint() + 0.01 * wave(i, 3.1)).collect();
        (system, [&q_l[..], &q_m, &v_l, &v_l].concat(), u_m)
    }

    /// What is said of a millisecond from the motions `x` and those beside it by `deviations`.
    fn said(system: &dyn TrackingLoop, x: &[f64], u_m: &[f64], deviations: &Dense<f64>) -> Spread {
        let ball = deviations.columns();
        let motion = Spread { center: points(x), deviations: deviations.map(Interval::point) };
        let torque =
            Spread { center: points(u_m), deviations: Dense::zeros(u_m.len(), ball).map(Interval::point) };
        let sizes = Sizes { ball, slopes: Vec::new(), most: Vec::new() };
        let length = Interval::point(LENGTH);
        let pieces = pace(system, &motion.center, length);
        held(system, &motion, &torque, &sizes, length, pieces).unwrap()
    }

    const LENGTH: f64 = 1e-3;

    /// From the corners of a box, at several times of a piece: slopes of the links are where the line has them, which goes about as far as they do.
    #[test]
    fn slopes_follow_their_line() {
        let (system, x, u_m) = arm();
        let (system, n) = (&*system, u_m.len());
        // (q_l, δ, q̇_l, q̇_m), and back.
        let of_springs = |x: &[f64], by: f64| -> Vec<f64> {
            (0..4 * n).map(|i| if i / n == 1 { x[i] + by * x[i - n] } else { x[i] }).collect()
        };
        let x = of_springs(&x, -1.0);
        let size = |i: usize| [1e-5, 1e-7, 1e-4, 1e-4][i / n];
        let starts: Vec<_> = (0..4 * n).map(|i| wide(Interval::point(x[i]), size(i))).collect();
        let (seconds, u) = (LENGTH / 6.0, points(&u_m));
        let length = Interval::point(seconds);
        let (ranges, about) = enclosed(system, &starts, &u, length).unwrap();
        let path = Path::from(system, &about.middle, &x, &u_m);
        let begin = path.at(Interval::point(0.0));
        let stretch = stretch(system, (&starts, &begin), &ranges, (&path, &u), length).unwrap();
        let over = stretch.onwards(3 * n, Interval::point(0.0));
        let curvature = Curvature::over(system, over).unwrap();
        let none = Dense::zeros(3 * n, 0).map(Interval::point);
        let off = Off { columns: &none, reach: &|_| 0.0, beside: &[], all: &stretch.off[..3 * n] };
        let [said] = stretch.slopes(system, &u, &curvature, [off]).unwrap();

        let mut farthest = 0.0_f64;
        for corner in 0..16 {
            let sign = |i: usize| (1.7 * (i + 1) as f64 * f64::from(corner + 1)).sin().signum();
            let start: Vec<_> = (0..4 * n).map(|i| x[i] + sign(i) * size(i)).collect();
            for part in [0.0, 0.5, 1.0] {
                let there = moved(system, &of_springs(&start, 1.0), &u_m, part * seconds);
                let there = points(&of_springs(&there, -1.0));
                let links = Links::over(system, &there[..n]).unwrap();
                let spring = springs(system, &there[n..2 * n]);
                let a_l = links.accelerations(system, &there[..n], &there[2 * n..3 * n], &spring);
                let slopes = links.rates(system, &there[..n], &there[2 * n..3 * n], &a_l);
                for (i, j) in (0..n).flat_map(|i| (0..3 * n).map(move |j| (i, j))) {
                    let slope = slopes[(i, j)].midpoint();
                    let line = said.begin[(i, j)] + Interval::point(part) * said.change[(i, j)];
                    // Rounding of the slopes themselves.
                    assert!(
                        wide(line, 1e-9 * slope.abs()).contains(slope),
                        "{i} {j}: {slope} not in {line:?}"
                    );
                    assert!(said.anywhere[(i, j)].contains(slope), "{i} {j}: {slope}");
                    if line.width() > 1e-6 * slope.abs() {
                        farthest = farthest.max(2.0 * (slope - line.midpoint()).abs() / line.width());
                    }
                }
            }
        }
        assert!(farthest > 0.5, "{farthest}");
    }

    /// Motions end inside, and those beside end beside them as the slopes of the end by the start say, which are known so closely that the robot's slopes half a piece too late
    /// or too early would not do.
    #[test]
    fn motions_of_seven_joints_end_where_they_do() {
        let (system, x, u_m) = arm();
        let (system, n) = (&*system, u_m.len());
        let small = 1e-9;
        let found = said(system, &x, &u_m, &Dense::identity(4 * n).scaled(small));
        let end = moved(system, &x, &u_m, LENGTH);
        for (i, end) in end.iter().enumerate() {
            assert!(wide(found.center[i], 1e-9).contains(*end), "{i}: {end} not in {:?}", found.center[i]);
            assert!(found.center[i].width() < 1e-3, "{i}: {:?}", found.center[i]);
        }
        // Differences over 1e-4 are off by some 1e-7 of the largest slopes, which are 1 for positions and some thousand times as large for velocities by positions.
        let mut widest = 0.0_f64;
        for j in (0..4 * n).step_by(5) {
            let beside = |by: f64| {
                let mut x = x.clone();
                x[j] += by;
                moved(system, &x, &u_m, LENGTH)
            };
            let [ahead, behind] = [1e-4, -1e-4].map(beside);
            let largest = |rows: std::ops::Range<usize>| {
                rows.map(|i| (ahead[i] - behind[i]).abs() / 2e-4).fold(0.0, f64::max)
            };
            let scales = [largest(0..2 * n), largest(2 * n..4 * n)];
            for i in 0..4 * n {
                let slope = (ahead[i] - behind[i]) / 2e-4;
                let scale = scales[i / (2 * n)];
                let slopes = found.deviations[(i, j)] * Interval::point(1.0 / small);
                assert!(wide(slopes, 1e-6 * scale).contains(slope), "{i} {j}: {slope} not in {slopes:?}");
                widest = widest.max(slopes.width() / scale);
            }
        }
        assert!(widest < 2e-4, "{widest}");
    }

    /// What a reading does to the middle is what its column says, closely, where it is off as far as it may be.
    #[test]
    fn a_reading_moves_the_middle_as_its_column_says() {
        let system = along_reference(&Scenario::load("two-link-hardware").unwrap()).unwrap();
        let x = vec![0.3, 0.9, 0.31, 0.88, 0.6, 0.5, 0.58, 0.55];
        let (system, u_m) = (&*system, vec![2.0, 0.7]);
        let n = u_m.len();
        let size = 4 * n;
        let middle = moved(system, &x, &u_m, LENGTH);
        let mut closest = 0.0_f64;
        for k in 0..12 {
            let far =
                |i: usize| [1e-3, 1e-3, 0.1, 0.1][i / n] * (1.7 * (i + 1) as f64 * f64::from(k + 2)).sin();
            // Columns of y and of torques beside the law's have nothing.
            let columns = size + n + 1;
            let entry = |i: usize, j: usize| Interval::point(if j == size + n { far(i) } else { 0.0 });
            let most = [vec![0.0; n], vec![1.0]].concat();
            let sizes = Sizes { ball: size, slopes: vec![0.0; most.len()], most };
            let motion = Spread { center: points(&x), deviations: Dense::from_fn(size, columns, entry) };
            let torque =
                Spread { center: points(&u_m), deviations: Dense::zeros(n, columns).map(Interval::point) };
            let length = Interval::point(LENGTH);
            let pieces = 8 * pace(system, &motion.center, length);
            let found = held(system, &motion, &torque, &sizes, length, pieces).unwrap();
            for sign in [1.0, -1.0] {
                let start: Vec<_> = (0..size).map(|i| x[i] + sign * far(i)).collect();
                let end = moved(system, &start, &u_m, LENGTH);
                for i in 0..size {
                    let off = end[i] - middle[i];
                    let column = found.deviations[(i, size + n)] * Interval::point(sign);
                    assert!(wide(column, 1e-9 * off.abs()).contains(off), "{k} {i}: {off} not in {column:?}");
                    closest = closest.max(2.0 * (off - column.midpoint()).abs() / column.width());
                }
            }
        }
        assert!(closest > 0.9, "{closest}");
    }
}
