//! The robot over boxes: how its accelerations depend on motion and torque, and what is left of its equations along a polynomial.

use flexure_core::scalar::{Interval, Jet, Over, Scalar};

use crate::linalg::Dense;
use crate::prove::engine::envelope::closed_loop::{Drive, Slope, TrackingLoop};
use crate::prove::engine::sampled_data::norm::around_zero;

/// The links over a box: M_l⁻¹, with which their accelerations a_l(q_l, q_m, q̇_l) and slopes of them follow from loads.
#[derive(Clone, Debug)]
pub struct Links {
    /// M_l⁻¹ [1/(kg m²)].
    pub inverse_mass: Dense<Interval>,
    /// About the same, in the middle.
    pub middle: Dense<f64>,
}

/// Numbers of which `moving`, if any, is what slopes are by.
fn slopes(all: &[Interval], moving: Option<usize>) -> Vec<Slope> {
    let slope = |(i, &x): (usize, &Interval)| {
        if Some(i) == moving { Slope::variable(x) } else { Slope::value(x) }
    };
    all.iter().enumerate().map(slope).collect()
}

fn values(all: &[Slope]) -> Vec<Interval> {
    all.iter().map(|x| x.coefficient(0)).collect()
}

impl Links {
    /// Where the links are at `q_l` in rad; none where M_l is not known to be regular.
    ///
    /// With R about the inverse of the middle of M and E = 1 − R M, M⁻¹ = R + (1 − E)⁻¹ E R (Rump, *Verification methods*, Acta Numerica 19 (2010), section 10): no
    /// elimination, in which boxes widen.
    pub fn over(system: &dyn TrackingLoop, q_l: &[Interval]) -> Option<Self> {
        let n = q_l.len();
        let (at, still) = (slopes(q_l, None), vec![Slope::ZERO; n]);
        let column = |j: usize| -> Vec<Interval> {
            let load = system.link_load(&at, &still, &slopes(&vec![Interval::ZERO; n], Some(j)));
            load.iter().map(|x| x.coefficient(1)).collect()
        };
        let mass = Dense::from_columns(&(0..n).map(column).collect::<Vec<_>>());
        let middle = mass.map(Interval::midpoint).solved(Dense::identity(n));
        let R = middle.map(Interval::point);
        let off = &R * &mass;
        let off = Dense::from_fn(n, n, |i, j| {
            let one = if i == j { Interval::ONE } else { Interval::ZERO };
            Interval::point((one - off[(i, j)]).magnitude())
        });
        let norm = off.rows().map(|row| row.iter().fold(Interval::ZERO, |sum, &x| sum + x).hi());
        let norm = Interval::point(norm.fold(0.0, f64::max));
        if norm.hi().is_nan() || norm.hi() >= 1.0 {
            return None;
        }
        let first = &off * &R.map(|x| Interval::point(x.magnitude()));
        let later = norm / (Interval::ONE - norm);
        let largest = |j: usize| (0..n).fold(0.0, |most: f64, i| most.max(first[(i, j)].hi()));
        let inverse_mass = Dense::from_fn(n, n, |i, j| {
            let radius = (first[(i, j)] + later * Interval::point(largest(j))).hi();
            R[(i, j)] + around_zero(radius)
        });
        Some(Self { inverse_mass, middle })
    }

    /// a_l under the torques `spring` [N m] of the springs, where the links move at `v_l` [rad/s].
    ///
    /// Any a and what it leaves over of the torque: a_l = a + M⁻¹ (torque − load(a)).
    pub fn accelerations(
        &self,
        system: &dyn TrackingLoop,
        q_l: &[Interval],
        v_l: &[Interval],
        spring: &[Interval],
    ) -> Vec<Interval> {
        let [at, moving] = [q_l, v_l].map(|x| slopes(x, None));
        let left = |a: &[f64]| {
            let a: Vec<_> = a.iter().map(|&a| Slope::value(Interval::point(a))).collect();
            let load = values(&system.link_load(&at, &moving, &a));
            spring.iter().zip(load).map(|(&torque, load)| torque - load).collect::<Vec<_>>()
        };
        let middle =
            |torque: &[Interval]| self.middle.apply(&torque.iter().map(|x| x.midpoint()).collect::<Vec<_>>());
        let a = middle(&left(&vec![0.0; q_l.len()]));
        let rest = self.inverse_mass.apply(&left(&a));
        a.iter().zip(rest).map(|(&a, rest)| Interval::point(a) + rest).collect()
    }

    /// ∂a_l/∂(q_l, q_m, q̇_l), n rows, where the links are at `q_l`, move at `v_l` and speed up by `a_l`: −M⁻¹ times what the load changes by.
    pub fn rates(
        &self,
        system: &dyn TrackingLoop,
        q_l: &[Interval],
        v_l: &[Interval],
        a_l: &[Interval],
    ) -> Dense<Interval> {
        let (n, stiffness) = (q_l.len(), system.drive().stiffness);
        let a_l = slopes(a_l, None);
        let load = |q: Option<usize>, v: Option<usize>| -> Vec<Interval> {
            let load = system.link_load(&slopes(q_l, q), &slopes(v_l, v), &a_l);
            load.iter().map(|x| x.coefficient(1)).collect()
        };
        let positions: Vec<_> = (0..n).map(|j| load(Some(j), None)).collect();
        let speeds: Vec<_> = (0..n).map(|j| load(None, Some(j))).collect();
        let spring = |i: usize, j: usize| if i == j { stiffness[i] } else { Interval::ZERO };
        let torque = Dense::from_fn(n, 3 * n, |i, j| match (j / n, j % n) {
            (0, j) => -positions[j][i] - spring(i, j),
            (1, j) => spring(i, j),
            (_, j) => -speeds[j][i],
        });
        &self.inverse_mass * &torque
    }
}

/// Positions q_l, q_m as polynomials of degree 4 in time, from a motion on.
#[derive(Clone, Debug)]
pub struct Path {
    /// Coefficients of tᵏ, k from 0 to 4, one list for each of links and motors.
    coefficients: Vec<[f64; 5]>,
}

impl Path {
    /// Near the motion of `system` from (q_l, q_m, q̇_l, q̇_m) = `x` under the motor torques `u_m` [N m], M_l⁻¹ about `inverse_mass`.
    pub fn from(system: &dyn TrackingLoop, inverse_mass: &Dense<f64>, x: &[f64], u_m: &[f64]) -> Self {
        let n = u_m.len();
        let drive = system.drive();
        let mut path =
            Self { coefficients: (0..2 * n).map(|i| [x[i], x[2 * n + i], 0.0, 0.0, 0.0]).collect() };
        let u_m: Vec<_> = u_m.iter().map(|&u| Interval::point(u)).collect();
        for k in 0..3_u8 {
            // What the equations leave over in tᵏ, the next coefficient times (k + 1) (k + 2) makes up for.
            let left = path.left(system, &drive, &u_m, Interval::ZERO);
            let left: Vec<f64> = left.iter().map(|x| x.coefficient(usize::from(k)).midpoint()).collect();
            let factor = f64::from((k + 1) * (k + 2));
            for (i, link) in inverse_mass.apply(&left).into_iter().enumerate() {
                path.coefficients[i][usize::from(k) + 2] = link / factor;
                path.coefficients[n + i][usize::from(k) + 2] =
                    left[n + i] / (factor * drive.motor_inertia[i].midpoint());
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
        let [q, v, a] = [0, 1, 2].map(|order| self.series(order, t));
        let load = system.link_load(&q[..n], &v[..n], &a[..n]);
        let spring = |i: usize| (q[n + i] - q[i]).scale(drive.stiffness[i]);
        let link = load.into_iter().enumerate().map(|(i, load)| spring(i) - load);
        let motor = |i: usize| {
            Slope::value(u_m[i])
                - spring(i)
                - v[n + i].scale(drive.motor_damping[i])
                - a[n + i].scale(drive.motor_inertia[i])
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

    /// How links, then motors speed up on it at its start [rad/s²].
    pub fn accelerations(&self) -> Vec<Interval> {
        values(&self.series(2, Interval::ZERO))
    }

    /// (q_l, q_m, q̇_l, q̇_m) at the times `t` in s.
    pub fn at(&self, t: Interval) -> Vec<Interval> {
        [0, 1].into_iter().flat_map(|order| values(&self.series(order, t))).collect()
    }
}
