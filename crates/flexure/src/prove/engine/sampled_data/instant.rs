//! What the law asks for at an instant, over an ellipsoid of states.

use flexure_core::scalar::{Interval, Scalar};
use rayon::prelude::*;

use crate::linalg::{Dense, Symmetric};
use crate::prove::engine::envelope::closed_loop::TrackingLoop;
use crate::prove::engine::sampled_data::bends::{Bends, along, columns, reference};
use crate::prove::engine::sampled_data::frame::Frame;
use crate::prove::engine::sampled_data::norm::{frobenius, spectral};
use crate::prove::engine::sampled_data::quadratic::{largest_value, reaches};
use crate::prove::engine::sampled_data::spread::{Sizes, Spread};

/// The torque of the law at an instant, and what that depends on.
#[derive(Clone, Debug)]
pub struct Instant {
    middle: Middle,
    /// [N m].
    pub asked: Spread,
    /// Of all numbers z of the instant: how far torques are beside the middle of their slopes [N m], then how far readings are off.
    pub sizes: Sizes,
}

/// The law at the middle of what is seen: its torques [N m] and their slopes by the coordinates of a frame.
#[derive(Clone, Debug)]
pub struct Middle {
    t: Interval,
    at: Vec<Interval>,
    frame: Frame,
    torques: Vec<Interval>,
    slopes: Dense<Interval>,
}

impl Middle {
    /// At the time `t` in s and the motion `x`.
    pub fn of(system: &dyn TrackingLoop, t: Interval, x: &[Interval], frame: Frame) -> Self {
        let q_ld = reference(system, t);
        let one = |directions: &[usize]| along(system, &q_ld, x, &columns(&frame.lower, directions));
        let torques: Vec<_> = one(&[]).iter().map(|u| u.coefficient(0)).collect();
        let first: Vec<_> = (0..x.len()).into_par_iter().map(|k| one(&[k])).collect();
        let slopes = Dense::from_fn(torques.len(), x.len(), |j, k| first[k][j].coefficient(1));
        Self { t, at: x.to_vec(), frame, torques, slopes }
    }

    /// Over all that is `seen`, c + A y + B z, |z_i| ≤ r_i of `sizes.most`: u(c) + J (A y + B z) + η with
    ///
    /// |η_j| ≤ s_j |y| + o_j, s_j = ‖Aᵀ H_j A‖ + | |Aᵀ H_j B| r |, o_j = ½ max |zᵀ Bᵀ G_j B z|,
    ///
    /// and those of the same z differ by s_j |Δy| at most. With w = A y + B z, ∂η_j/∂y is wᵀ H_j A, H_j = ∫ u_j''(c + t w) dt, and η_j for y = 0 is
    /// ½ wᵀ G_j w, G_j = 2 ∫ (1 − t) u_j''(c + t w) dt: t is ½ in the mean there, and ⅓.
    pub fn over(&self, system: &dyn TrackingLoop, seen: &Spread, sizes: &Sizes, bends: &Bends) -> Instant {
        let (n, ball) = (self.torques.len(), sizes.ball);
        let by = bends.coordinates(&seen.deviations);
        let of_ball = Dense::from_fn(seen.center.len(), ball, |i, j| by[(i, j)]);
        let across = of_ball.transposed();
        // Without the columns of all z that are 0, as those of torques beside the law's are.
        let counts: Vec<_> = (0..sizes.most.len()).filter(|&k| sizes.most[k] > 0.0).collect();
        let of_others = Dense::from_fn(seen.center.len(), counts.len().max(1), |i, j| {
            counts.get(j).map_or(Interval::ZERO, |&k| by[(i, ball + k)] * Interval::point(sizes.most[k]))
        });
        let others = reaches(&of_others);
        let both = of_ball.rows().map(|row| Interval::point(frobenius(row.iter().copied())));
        let both: Vec<_> = both.zip(&others).map(|(ball, &others)| ball + others).collect();
        let [one, two, three] = [1.0, 2.0, 3.0].map(Interval::point);
        let at = bends.second_at(system, self.t, &self.at);
        let slopes = bends.mean(&at, &both, one / two);
        let values = bends.mean(&at, &others, one / three);
        let beside = |(slopes, values): (&Symmetric<Interval>, &Symmetric<Interval>)| {
            let half = &across * &Dense::from(slopes);
            let slope = Interval::point(spectral(&(&half * &of_ball)))
                + Interval::point(frobenius(reaches(&(&half * &of_others)).into_iter()));
            [slope.hi(), (largest_value(values, &of_others) / two).hi()]
        };
        let beside: Vec<_> = slopes.par_iter().zip(&values).map(beside).collect();
        let mut sizes = sizes.clone();
        for (j, [slope, most]) in beside.into_iter().enumerate() {
            (sizes.slopes[j], sizes.most[j]) = (slope, most);
        }
        let mut deviations = &self.slopes * &self.frame.coordinates(&seen.deviations);
        for j in 0..n {
            deviations[(j, ball + j)] = Interval::ONE;
        }
        let asked = Spread { center: self.torques.clone(), deviations };
        Instant { middle: self.clone(), asked, sizes }
    }
}

impl Instant {
    /// The torques for what is `seen`, in other columns than those of `asked`, but for η.
    pub fn at(&self, seen: &Spread) -> Spread {
        let Middle { at, frame, torques, slopes, .. } = &self.middle;
        let off = Dense::from_fn(at.len(), 1, |i, _| seen.center[i] - at[i]);
        let moved = slopes * &frame.coordinates(&off);
        Spread {
            center: torques.iter().zip(moved.rows()).map(|(&u, row)| u + row[0]).collect(),
            deviations: slopes * &frame.coordinates(&seen.deviations),
        }
    }

    /// Of the largest |u_j| of the joint `j`, that in the middle and what readings that are off may add to it, to first order [N m].
    pub fn parts(&self, j: usize) -> [f64; 2] {
        let others = self.asked.deviations.row(j)[self.sizes.ball..].iter().zip(&self.sizes.most);
        let readings = others.skip(self.asked.center.len()).map(|(x, most)| x.magnitude() * most);
        [self.asked.center[j].magnitude(), readings.sum()]
    }

    /// The largest |u_j| of all those motions [N m], from above.
    pub fn largest(&self) -> Vec<f64> {
        self.asked.ranges(&self.sizes).iter().map(|u| u.magnitude()).collect()
    }
}

#[cfg(test)]
mod tests {
    use flexure_core::scalar::Interval;

    use super::{Bends, Dense, Frame, Instant, Middle, Sizes, Spread, TrackingLoop, along, reference};
    use crate::prove::closed_loop::along_reference;
    use crate::prove::engine::sampled_data::bends::Order;
    use crate::scenario::Scenario;

    /// How large a direction is in positions in rad and velocities [rad/s].
    const SIZE: [f64; 2] = [2e-3, 0.1];

    /// What rounding makes of torques of some N m.
    const ROUNDED: f64 = 1e-13;

    /// Joints, and numbers of a motion.
    const N: usize = 2;
    const ALL: usize = 8;

    /// The law where the arm moves as its reference does, or where it stands still as its reference.
    struct There {
        system: Box<dyn TrackingLoop>,
        t: Interval,
        x: Vec<f64>,
    }

    impl There {
        fn at(t: f64) -> Self {
            let system = along_reference(&Scenario::load("two-link-hardware").unwrap()).unwrap();
            let t = Interval::point(t);
            let jets = system.reference(t);
            let part = |k: usize| jets.iter().map(move |jet| jet[k].midpoint()).collect::<Vec<_>>();
            let x = [part(0), part(0), part(1), part(1)].concat();
            Self { system, t, x }
        }

        fn torques(&self, x: &[f64]) -> Vec<f64> {
            let x: Vec<_> = x.iter().map(|&x| Interval::point(x)).collect();
            let still = vec![Interval::point(0.0); ALL];
            let all = along(&*self.system, &reference(&*self.system, self.t), &x, &still);
            all.iter().map(|u| u.coefficient(0).midpoint()).collect()
        }

        /// Columns of y, of the η_j, of two readings.
        fn seen(&self, deviations: &Dense<f64>) -> (Spread, Sizes) {
            let center = self.x.iter().map(|&x| Interval::point(x)).collect();
            let most = vec![0.0, 0.0, 1.0, 1.0];
            let sizes = Sizes { ball: ALL, slopes: vec![0.0; most.len()], most };
            (Spread { center, deviations: deviations.map(Interval::point) }, sizes)
        }

        /// With derivatives of an `order` by the coordinates of `frame`.
        fn law(&self, deviations: &Dense<f64>, order: Order, frame: &Frame) -> Instant {
            let (seen, sizes) = self.seen(deviations);
            let bends = Bends::over(&*self.system, self.t, seen.ranges(&sizes), frame, order);
            let middle = Middle::of(&*self.system, self.t, &seen.center, Frame::of(deviations));
            middle.over(&*self.system, &seen, &sizes, &bends)
        }

        /// The torques beside those of the slopes at (y, z) = `w` [N m].
        fn beside(&self, law: &Instant, deviations: &Dense<f64>, w: &[f64]) -> Vec<f64> {
            let off = deviations.apply(w);
            let x: Vec<_> = self.x.iter().zip(off).map(|(x, off)| x + off).collect();
            let slopes = law.asked.deviations.map(Interval::midpoint);
            // Not η itself, which has columns, too: w has nothing there.
            let linear = slopes.apply(w);
            let middle = law.asked.center.iter().map(|u| u.midpoint());
            let torques = self.torques(&x);
            torques.iter().zip(middle).zip(linear).map(|((u, middle), linear)| u - middle - linear).collect()
        }
    }

    /// Numbers from −1 to 1.
    fn wave(i: usize) -> f64 {
        (1.7 * i as f64 + 0.4 * (i as f64).powi(2)).sin()
    }

    fn size(i: usize) -> f64 {
        SIZE[i / (2 * N)]
    }

    /// In all directions of y and of readings, with frames of its own and of others: torques are as far from their slopes as is said, and change as slowly; of third derivatives far
    /// less is said than of second ones.
    #[test]
    fn torques_are_as_near_their_slopes_as_is_said() {
        for t in [0.0, 1.9] {
            let there = There::at(t);
            let columns = ALL + N + 2;
            let entry =
                |i: usize, j: usize| if j < ALL && j > i { 0.0 } else { size(i) * wave(columns * i + j) };
            let deviations = Dense::from_fn(ALL, columns, entry);
            let mixed = |i: usize, j: usize| 0.3 * wave(100 + ALL * i + j) + if i == j { 1.0 } else { 0.0 };
            let other = Frame::of(&Dense::from_fn(ALL, ALL, |i, j| size(i) * mixed(i, j)));
            let own = Frame::of(&deviations);
            let second = there.law(&deviations, Order::Second, &own);
            for frame in [&own, &other] {
                let third = there.law(&deviations, Order::Third, frame);
                for j in 0..N {
                    let [near, far] = [&third, &second].map(|law| law.sizes.slopes[j] + law.sizes.most[j]);
                    // By a factor of 29 and 39 where the arm is at rest, 13 and 3 where it moves.
                    let least = if t == 0.0 { 20.0 } else { 2.5 };
                    assert!(frame.lower != own.lower || least * near < far, "{t} {j}: {near} {far}");
                }
                for law in [&second, &third] {
                    for k in 0..200 {
                        let mut w: Vec<_> = (0..columns).map(|j| wave(columns * k + j)).collect();
                        w[ALL..ALL + N].fill(0.0);
                        let length = w[..ALL].iter().map(|y| y * y).sum::<f64>().sqrt();
                        w[..ALL].iter_mut().for_each(|y| *y /= length);
                        w[ALL + N..].iter_mut().for_each(|z| *z = z.signum());
                        let ends = there.beside(law, &deviations, &w);
                        w[..ALL].iter_mut().for_each(|y| *y *= 0.9);
                        let nearer = there.beside(law, &deviations, &w);
                        for j in 0..N {
                            let [slope, most] = [law.sizes.slopes[j], law.sizes.most[j]];
                            assert!(ends[j].abs() <= slope + most + ROUNDED, "{t} {j}: {}", ends[j]);
                            assert!((ends[j] - nearer[j]).abs() <= 0.1 * slope + ROUNDED, "{t} {j}");
                        }
                    }
                }
            }
        }
    }

    /// Of a single direction what is said is what is so, nearly.
    #[test]
    fn no_more_is_said_than_is_so() {
        let columns = ALL + N + 2;
        for t in [0.0, 1.9] {
            let there = There::at(t);
            let (mut slopes, mut values) = (0.0_f64, 0.0_f64);
            for i in 0..ALL {
                let along = |column: usize| {
                    Dense::from_fn(ALL, columns, |row, j| {
                        let own = if row == i && j == column { 1.0 } else { 0.0 };
                        // All directions are there, to have a frame.
                        size(row) * (own + if row == j { 1e-6 } else { 0.0 })
                    })
                };
                let deviations = along(0);
                let law = there.law(&deviations, Order::Third, &Frame::of(&deviations));
                let mut w = vec![0.0; columns];
                let mut at = |y: f64| {
                    w[0] = y;
                    there.beside(&law, &deviations, &w)
                };
                let [far, near] = [at(1.0), at(0.98)];
                for j in 0..N {
                    slopes = slopes.max(((far[j] - near[j]).abs() - ROUNDED) / (0.02 * law.sizes.slopes[j]));
                }
                let deviations = along(ALL + N);
                let law = there.law(&deviations, Order::Third, &Frame::of(&deviations));
                let mut w = vec![0.0; columns];
                w[ALL + N] = 1.0;
                let off = there.beside(&law, &deviations, &w);
                for (off, most) in off.iter().zip(&law.sizes.most) {
                    values = values.max((off.abs() - ROUNDED) / most);
                }
            }
            assert!((0.9..=1.0).contains(&slopes), "{t}: {slopes}");
            assert!((0.9..=1.0).contains(&values), "{t}: {values}");
        }
    }
}
