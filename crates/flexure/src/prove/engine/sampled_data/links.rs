//! The links over boxes: how their accelerations depend on where they are, how springs pull and how they move.
//!
//! Motions are (q_l, δ, q̇_l, q̇_m) here, δ = q_m − q_l: springs pull by δ alone, which changes little where links and motors move far.

use std::ops::Range;

use flexure_core::scalar::{Interval, Jet, Scalar};

use crate::linalg::{Dense, Symmetric};
use crate::prove::engine::envelope::closed_loop::{Slope, TrackingLoop};
use crate::prove::engine::sampled_data::norm::around_zero;
use crate::prove::engine::sampled_data::second::second_derivatives;

/// The links over a box: M_l⁻¹, with which their accelerations a_l(q_l, δ, q̇_l), their slopes and second derivatives follow from loads.
#[derive(Clone, Debug)]
pub struct Links {
    /// M_l⁻¹ [1/(kg m²)].
    pub inverse_mass: Dense<Interval>,
    /// About the same, in the middle.
    pub middle: Dense<f64>,
}

/// Numbers of which those `moving` are what slopes are by, together.
fn slopes(all: &[Interval], moving: &[usize]) -> Vec<Slope> {
    let slope = |(i, &x): (usize, &Interval)| {
        if moving.contains(&i) { Slope::variable(x) } else { Slope::value(x) }
    };
    all.iter().enumerate().map(slope).collect()
}

/// The numbers themselves.
pub fn values(all: &[Slope]) -> Vec<Interval> {
    all.iter().map(|x| x.coefficient(0)).collect()
}

/// Their torques [N m] where they are bent by `bent` in rad.
pub fn springs(system: &dyn TrackingLoop, bent: &[Interval]) -> Vec<Interval> {
    system.drive().stiffness.iter().zip(bent).map(|(&stiffness, &bent)| stiffness * bent).collect()
}

impl Links {
    /// Where the links are at `q_l` in rad; none where M_l is not known to be regular.
    ///
    /// With R about the inverse of the middle of M and E = 1 − R M, M⁻¹ = R + (1 − E)⁻¹ E R (Rump, *Verification methods*, Acta Numerica 19 (2010), section 10): no
    /// elimination, in which boxes widen.
    pub fn over(system: &dyn TrackingLoop, q_l: &[Interval]) -> Option<Self> {
        let n = q_l.len();
        let (at, still) = (slopes(q_l, &[]), vec![Slope::ZERO; n]);
        let column = |j: usize| -> Vec<Interval> {
            let load = system.link_load(&at, &still, &slopes(&vec![Interval::ZERO; n], &[j]));
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
        let [at, moving] = [q_l, v_l].map(|x| slopes(x, &[]));
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

    /// ∂a_l/∂(q_l, δ, q̇_l), n rows, where the links are at `q_l`, move at `v_l` and speed up by `a_l`: −M⁻¹ times what the load changes by.
    pub fn rates(
        &self,
        system: &dyn TrackingLoop,
        q_l: &[Interval],
        v_l: &[Interval],
        a_l: &[Interval],
    ) -> Dense<Interval> {
        let (n, stiffness) = (q_l.len(), system.drive().stiffness);
        let a_l = slopes(a_l, &[]);
        let load = |q: &[usize], v: &[usize]| -> Vec<Interval> {
            let load = system.link_load(&slopes(q_l, q), &slopes(v_l, v), &a_l);
            load.iter().map(|x| x.coefficient(1)).collect()
        };
        let positions: Vec<_> = (0..n).map(|j| load(&[j], &[])).collect();
        let speeds: Vec<_> = (0..n).map(|j| load(&[], &[j])).collect();
        let torque = Dense::from_fn(n, 3 * n, |i, j| match (j / n, j % n) {
            (0, j) => -positions[j][i],
            (1, j) if i == j => stiffness[i],
            (1, _) => Interval::ZERO,
            (_, j) => -speeds[j][i],
        });
        &self.inverse_mass * &torque
    }

    /// ∂²a_l/∂(q_l, δ, q̇_l)², a matrix for each link, where the links are at `q_l`, move at `v_l` and speed up by `a_l`.
    ///
    /// With a(t) along a line, load(q(t), q̇(t), a(t)) = K δ(t): a'' is −M⁻¹ times what the load's second derivative is where a has the first alone.
    pub fn bends(
        &self,
        system: &dyn TrackingLoop,
        q_l: &[Interval],
        v_l: &[Interval],
        a_l: &[Interval],
    ) -> Vec<Symmetric<Interval>> {
        let n = q_l.len();
        let rates = self.rates(system, q_l, v_l, a_l);
        // Loads are linear in accelerations, and those in δ.
        let apart = |i: usize, k: usize| {
            let bent = |i: usize| (n..2 * n).contains(&i);
            bent(i) && k >= n || bent(k) && i >= n
        };
        let among = |all: Range<usize>, directions: &[usize]| -> Vec<usize> {
            directions.iter().filter(|&i| all.contains(i)).map(|i| i - all.start).collect()
        };
        second_derivatives(3 * n, &apart, &|directions| {
            let [q, v] =
                [(q_l, 0..n), (v_l, 2 * n..3 * n)].map(|(x, all)| slopes(x, &among(all, directions)));
            let rate = |i: usize| directions.iter().fold(Interval::ZERO, |sum, &k| sum + rates[(i, k)]);
            let a: Vec<_> = (0..n).map(|i| Jet::new([a_l[i], rate(i), Interval::ZERO])).collect();
            let load: Vec<_> = system.link_load(&q, &v, &a).iter().map(|x| -x.coefficient(2)).collect();
            self.inverse_mass.apply(&load)
        })
    }
}
