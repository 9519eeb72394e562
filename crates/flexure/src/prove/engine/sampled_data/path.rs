//! Polynomials near motions, and what is left of the robot's equations along them.

use flexure_core::scalar::{Interval, Jet, Over, Scalar};

use crate::linalg::Dense;
use crate::prove::engine::envelope::closed_loop::{Drive, Slope, TrackingLoop};
use crate::prove::engine::sampled_data::links::values;

/// q_l and δ = q_m − q_l as polynomials of degree 4 in time, from a motion on.
#[derive(Clone, Debug)]
pub struct Path {
    /// Coefficients of tᵏ, k from 0 to 4, one list for each link, then for each spring.
    coefficients: Vec<[f64; 5]>,
}

impl Path {
    /// Near the motion of `system` from (q_l, δ, q̇_l, q̇_m) = `x` under the motor torques `u_m` [N m], M_l⁻¹ about `inverse_mass`.
    pub fn from(system: &dyn TrackingLoop, inverse_mass: &Dense<f64>, x: &[f64], u_m: &[f64]) -> Self {
        let n = u_m.len();
        let drive = system.drive();
        let speed = |i: usize| if i < n { x[2 * n + i] } else { x[2 * n + i] - x[n + i] };
        let mut path = Self { coefficients: (0..2 * n).map(|i| [x[i], speed(i), 0.0, 0.0, 0.0]).collect() };
        let u_m: Vec<_> = u_m.iter().map(|&u| Interval::point(u)).collect();
        for k in 0..3_u8 {
            // What the equations leave over in tᵏ, the next coefficient times (k + 1) (k + 2) makes up for.
            let left = path.left(system, &drive, &u_m, Interval::ZERO);
            let left: Vec<f64> = left.iter().map(|x| x.coefficient(usize::from(k)).midpoint()).collect();
            let factor = f64::from((k + 1) * (k + 2));
            for (i, link) in inverse_mass.apply(&left).into_iter().enumerate() {
                path.coefficients[i][usize::from(k) + 2] = link / factor;
                path.coefficients[n + i][usize::from(k) + 2] =
                    left[n + i] / (factor * drive.motor_inertia[i].midpoint()) - link / factor;
            }
        }
        path
    }

    /// The `order`-th derivatives as series about the times `t` in s.
    fn series(&self, order: u8, t: Interval) -> Vec<Slope> {
        let coefficient = |all: &[f64; 5], k: usize| {
            // Horner's rule for the k-th derivative over k!, of the order-th.
            let at = |i: usize| {
                let falling: f64 = (0..usize::from(order)).map(|m| (i - m) as f64).product();
                let choose: f64 =
                    (0..k).map(|m| (i - usize::from(order) - m) as f64 / (m + 1) as f64).product();
                Interval::point(all[i]) * Interval::point(falling * choose.round())
            };
            (k + usize::from(order)..5).rev().fold(Interval::ZERO, |sum, i| sum * t + at(i))
        };
        self.coefficients.iter().map(|all| Jet::from_fn(|k| coefficient(all, k))).collect()
    }

    /// The torques that the equations of links, then motors leave over on it [N m], as series about the times `t` in s.
    fn left(&self, system: &dyn TrackingLoop, drive: &Drive, u_m: &[Interval], t: Interval) -> Vec<Slope> {
        let n = u_m.len();
        let [x, v, a] = [0, 1, 2].map(|order| self.series(order, t));
        let load = system.link_load(&x[..n], &v[..n], &a[..n]);
        let spring = |i: usize| x[n + i].scale(drive.stiffness[i]);
        let link = load.into_iter().enumerate().map(|(i, load)| spring(i) - load);
        let motor = |i: usize| {
            Slope::value(u_m[i])
                - spring(i)
                - (v[i] + v[n + i]).scale(drive.motor_damping[i])
                - (a[i] + a[n + i]).scale(drive.motor_inertia[i])
        };
        link.chain((0..n).map(motor)).collect()
    }

    /// The same at its start and over the times from 0 to `length`, by Taylor's theorem.
    pub fn left_over(
        &self,
        system: &dyn TrackingLoop,
        u_m: &[Interval],
        length: Interval,
    ) -> [Vec<Interval>; 2] {
        let drive = system.drive();
        let meanwhile = Interval::ZERO.hull(length);
        let start = self.left(system, &drive, u_m, Interval::ZERO);
        let all = self.left(system, &drive, u_m, meanwhile);
        let over = |(start, all): (&Slope, &Slope)| {
            start.coefficient(0) + meanwhile * (start.coefficient(1) + meanwhile * all.coefficient(2))
        };
        let later = start.iter().zip(&all).map(over).collect();
        [values(&start), later]
    }

    /// The `order`-th derivatives of q_l and q_m at the times `t` in s.
    fn of_both(&self, order: u8, t: Interval) -> Vec<Interval> {
        let all = values(&self.series(order, t));
        let n = all.len() / 2;
        let motor = |i: usize| all[i] + all[n + i];
        all[..n].iter().copied().chain((0..n).map(motor)).collect()
    }

    /// (q_l, δ, q̇_l, q̇_m) at the times `t` in s.
    pub fn at(&self, t: Interval) -> Vec<Interval> {
        [values(&self.series(0, t)), self.of_both(1, t)].concat()
    }

    /// How fast those change.
    pub fn rates(&self, t: Interval) -> Vec<Interval> {
        [values(&self.series(1, t)), self.of_both(2, t)].concat()
    }
}
