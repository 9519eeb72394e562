//! What the law asks for at an instant, over an ellipsoid of motions.

use flexure_core::scalar::{Interval, Jet, Scalar};
use rayon::prelude::*;

use crate::linalg::Dense;
use crate::prove::engine::envelope::closed_loop::{Answer, Place, Slope, TrackingLoop};
use crate::prove::engine::sampled_data::norm::{around_zero, frobenius, spectral};
use crate::prove::engine::sampled_data::second::second_derivatives;

/// The torque of the law at an instant at the motions c + L y, |y| ≤ 1: u + G y + η(y), |η_j(y) − η_j(y')| ≤ s_j |y − y'|.
#[derive(Clone, Debug)]
pub struct Instant {
    /// u [N m].
    pub torque: Vec<Interval>,
    /// G: n rows.
    pub slopes: Dense<Interval>,
    /// s_j, from above.
    pub beside: Vec<f64>,
    /// The errors q̃_l, q̃_m in rad, s_l, s_m [rad/s] at c.
    pub errors: Vec<Interval>,
}

impl Instant {
    /// At the time `t` in s, for c and a lower triangular L in `center` and `lower`.
    ///
    /// The gradient of u_j in y is G_j at the middle, and ∫ H_j(θ y) y dθ more at y: s_j is the norm of the second derivatives H_j over the box around
    /// the ellipsoid.
    pub fn over(system: &dyn TrackingLoop, t: Interval, center: &[f64], lower: &Dense<f64>) -> Self {
        let (n, size) = (system.joints(), center.len());
        let jets = system.reference(t);
        let q_ld: Vec<[Slope; 5]> =
            jets.iter().map(|jet| std::array::from_fn(|k| Slope::value(jet[k]))).collect();
        let ranges: Vec<_> = center
            .iter()
            .zip(lower.rows())
            .map(|(&c, row)| {
                let reach = frobenius(row.iter().map(|&x| Interval::point(x)));
                Interval::point(c) + around_zero(reach)
            })
            .collect();
        let points: Vec<_> = center.iter().map(|&c| Interval::point(c)).collect();
        let along = |from: &[Interval], directions: &[usize]| {
            let slope = |i: usize| {
                let rate =
                    directions.iter().fold(Interval::ZERO, |sum, &k| sum + Interval::point(lower[(i, k)]));
                Jet::new([from[i], rate, Interval::ZERO])
            };
            let x: Vec<Slope> = (0..size).map(slope).collect();
            let part = |k: usize| x[k * n..(k + 1) * n].to_vec();
            let x = Place { q_l: part(0), q_m: part(1), v_l: part(2), v_m: part(3) };
            system.command(&x, &q_ld)
        };
        let middle = along(&points, &[]);
        let first: Vec<Vec<Slope>> = (0..size).into_par_iter().map(|k| along(&points, &[k]).u_m).collect();
        let second = second_derivatives(size, &|directions| {
            along(&ranges, directions).u_m.iter().map(|u| u.coefficient(2)).collect()
        });
        Self {
            torque: middle.u_m.iter().map(|u| u.coefficient(0)).collect(),
            slopes: Dense::from_fn(n, size, |j, k| first[k][j].coefficient(1)),
            beside: second.iter().map(|hessian| spectral(&Dense::from(hessian))).collect(),
            errors: errors_of(&middle),
        }
    }
}

impl Instant {
    /// The largest |u_j| of all those motions [N m], from above.
    pub fn largest(&self) -> Vec<f64> {
        let of = |((torque, row), &beside): ((&Interval, &[Interval]), &f64)| {
            (Interval::point(torque.magnitude())
                + Interval::point(frobenius(row.iter().copied()))
                + Interval::point(beside))
            .hi()
        };
        self.torque.iter().zip(self.slopes.rows()).zip(&self.beside).map(of).collect()
    }
}

fn errors_of(answer: &Answer) -> Vec<Interval> {
    let all = [&answer.e_l, &answer.e_m, &answer.s_l, &answer.s_m];
    all.into_iter().flatten().map(|e| e.coefficient(0)).collect()
}
