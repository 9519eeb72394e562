//! How the errors move over a slab of time and a tube, whatever the robot's numbers are within their tolerances and whatever torque it
//! feels.
//!
//! Errors z = (q̃_l, q̃_m, s_l, s_m) are functions of the state and of time, made with the numbers of the model. Along a motion of
//! the robot that is there, exactly,
//!
//! q̃̇_l = −φ_l + s_l,
//! q̃̇_m = −φ_m − Π_m⁻¹ K s_l + s_m − (∂q_md/∂q̇_l) M'_l⁻¹ d_l,
//! M_l ṡ_l = −Π_l q̃_l − (C_l + D_l + K_ld) s_l + K q̃_m, and M'_l⁻¹ d_l beside it,
//! M_m ṡ_m = −Π_m q̃_m − (D_m + K_md) s_m, and M'_m⁻¹ d_m + (∂s_m/∂q̇_l) M'_l⁻¹ d_l beside it,
//!
//! where primes are the numbers of that robot and, with the accelerations that the model has at this state and torque,
//!
//! d_l = (K' − K) ζ − (D'_l − D_l) q̇_l − Σ μ_i (M_i q̈_l + C_i q̇_l + g_i) + unknown torque,
//! d_m = −(K' − K) ζ − (D'_m − D_m) q̇_m − (M'_m − M_m) q̈_m + unknown torque.
//!
//! for links i with masses that are by a part μ_i off: M'_l = M_l + Σ μ_i M_i. What M_l q̈_l of this has of the errors, M_l ṡ_l above, goes together with
//! M'_l⁻¹: with B what accelerations of the links enter by and F z = M_l ṡ_l,
//!
//! ż = … + M_l⁻¹ F z in the rows of s_l + B (M'_l⁻¹ − M_l⁻¹) F z + B M'_l⁻¹ d'_l,
//!
//! where d'_l has loads M_i q̈_lr + C_i q̇_l + g_i with the acceleration that the errors ask for, q̇_lr = q̇_ld − φ_l. Inverse masses are known about a number
//! N = L Lᵀ as L (c + E) Lᵀ with ‖E‖ ≤ r (`masses.rs`): the E are causes of their own, of n numbers each, that grow with the errors.
//!
//! [`Flow`] has numbers for A and for how it changes with time, for the columns that torques enter by, and bounds for all that is left.

use std::iter::repeat;

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::Dense;
use crate::prove::engine::envelope::closed_loop::TrackingLoop;
use crate::prove::engine::envelope::deviation::Spread;
use crate::prove::engine::envelope::seen::{Force, Seen, norm};
use crate::prove::engine::envelope::slab::Way;
use crate::prove::engine::envelope::tube::Tube;

/// ż = (A + (t − t_c) Ȧ) z + Σ n w + δ at all times t of a slab and all errors of a tube, one n for each [`Channel`].
#[derive(Clone, Debug, PartialEq)]
pub struct Flow {
    /// t_c in s: the middle of the slab.
    pub time: f64,
    /// A.
    pub matrix: Dense<f64>,
    /// Ȧ.
    pub drift: Dense<f64>,
    /// By what the errors are driven.
    pub channels: Vec<Channel>,
    /// How many causes there are, with those that nothing goes through here.
    pub causes: usize,
    /// Bounds of |δ_i|: what the numbers of A and of the columns leave open.
    pub rest: Vec<f64>,
}

/// Σ (n_k + (t − t_c) ṅ_k) w_k, with |w| at most |w_0| + |C z|.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Its place among all causes.
    pub cause: usize,
    /// n_k: one for each number of w.
    pub columns: Vec<Vec<f64>>,
    /// ṅ_k; none if they do not change.
    pub drifts: Vec<Vec<f64>>,
    /// |w_0|, from above.
    pub size: f64,
    /// Rows of C; none if w does not depend on the errors.
    pub slopes: Vec<Vec<f64>>,
    /// Whether numbers leave it open, and not the robot.
    pub is_open: bool,
}

impl Flow {
    /// A + (t − t_c) Ȧ at the time `t` in s.
    pub fn at(&self, t: Interval) -> Dense<Interval> {
        let late = t - Interval::point(self.time);
        let (rows, columns) = (self.rest.len(), self.matrix.columns());
        Dense::from_fn(rows, columns, |i, j| {
            Interval::point(self.matrix[(i, j)]) + Interval::point(self.drift[(i, j)]) * late
        })
    }

    /// What `gradient`ᵀ ż may be at the times `time` in s and all errors of `tube`, both of the slab and tube that it is of, or within them.
    pub fn along(&self, gradient: &[Interval], tube: &dyn Tube, time: Interval) -> Interval {
        let dot = |column: &[Interval]| {
            gradient.iter().zip(column).fold(Interval::ZERO, |sum, (&g, &x)| sum + g * x)
        };
        let matrix = self.at(time);
        let pulled: Vec<_> = (0..matrix.columns())
            .map(|j| dot(&(0..self.rest.len()).map(|i| matrix[(i, j)]).collect::<Vec<_>>()))
            .collect();
        let late = time - Interval::point(self.time);
        let driven = self.channels.iter().fold(Interval::ZERO, |sum, channel| {
            let slope = |row: &Vec<f64>| {
                let row: Vec<_> = row.iter().map(|&c| Interval::point(c)).collect();
                Interval::point(tube.reach(&row).magnitude())
            };
            let size = Interval::point(channel.size) + norm(channel.slopes.iter().map(slope));
            sum + norm(channel.at(late).iter().map(|column| dot(column))) * size
        });
        let open = gradient
            .iter()
            .zip(&self.rest)
            .fold(driven, |sum, (g, &rest)| sum + Interval::point(g.magnitude()) * Interval::point(rest));
        let most = open.hi();
        tube.reach(&pulled) + Interval::new(-most, most).unwrap_or(Interval::ENTIRE)
    }

    /// Over `tube` and the times `time` in s, with what `spread` leaves open; none if it no longer `goes_on`.
    pub fn over(
        system: &dyn TrackingLoop,
        spread: &Spread,
        tube: &dyn Tube,
        time: Interval,
        goes_on: &dyn Fn() -> bool,
    ) -> Option<Self> {
        let way = Way::new(system, tube, &system.reference(time), time, goes_on);
        let errors = tube.errors();
        let seen = Seen::new(system, spread, &way)?;
        let matrices = seen.matrices(system, &errors);
        let mut flow = Self {
            time: time.midpoint(),
            matrix: matrices[0].map(Interval::midpoint),
            drift: matrices[1].map(Interval::midpoint),
            channels: Vec::new(),
            causes: 0,
            rest: left_of(&matrices, way.offset, &errors),
        };
        for force in seen.forces(system, spread) {
            flow.add(&force, tube, &errors, way.offset);
            flow.causes += 1;
        }
        Some(flow)
    }

    /// The same with causes that are larger by a `part` of what they are, but for what goes with the errors.
    pub fn with_larger_causes(&self, part: f64) -> Self {
        let mut larger = self.clone();
        larger.channels.iter_mut().for_each(|channel| channel.size *= 1.0 + part);
        larger.rest.iter_mut().for_each(|rest| *rest *= 1.0 + part);
        larger
    }

    /// One more channel, if anything goes through it, at times that are `late` after the middle.
    fn add(&mut self, force: &Force, tube: &dyn Tube, errors: &[Interval], late: Interval) {
        let point = |rows: &[Vec<Interval>]| -> Vec<Vec<f64>> {
            rows.iter().map(|row| row.iter().map(|x| x.midpoint()).collect()).collect()
        };
        let left = |slope: &Vec<Interval>| {
            slope.iter().zip(errors).fold(Interval::ZERO, |sum, (c, error)| {
                sum + Interval::point(radius(*c)) * Interval::point(error.magnitude())
            })
        };
        let size = Interval::point(force.size.magnitude()) + norm(force.slopes.iter().map(left));
        let all = Interval::point(force.size.magnitude())
            + norm(force.slopes.iter().map(|slope| Interval::point(tube.reach(slope).magnitude())));
        if all.magnitude() == 0.0 {
            return;
        }
        let late = Interval::point(late.magnitude());
        for (column, late) in
            force.columns.iter().zip(repeat(Interval::ONE)).chain(force.drifts.iter().zip(repeat(late)))
        {
            for (rest, n) in self.rest.iter_mut().zip(column) {
                *rest = (Interval::point(*rest) + Interval::point(radius(*n)) * late * all).hi();
            }
        }
        let slopes = point(&force.slopes);
        let depends = slopes.iter().flatten().any(|&c| c != 0.0);
        self.channels.push(Channel {
            cause: self.causes,
            columns: point(&force.columns),
            drifts: point(&force.drifts),
            size: size.hi(),
            slopes: if depends { slopes } else { Vec::new() },
            is_open: force.is_open,
        });
    }
}

impl Channel {
    /// The columns `late` s after the middle of the slab.
    pub fn at(&self, late: Interval) -> Vec<Vec<Interval>> {
        let still: Vec<Vec<_>> =
            self.columns.iter().map(|n| n.iter().map(|&x| Interval::point(x)).collect()).collect();
        if self.drifts.is_empty() {
            return still;
        }
        let moved = |(n, drift): (Vec<Interval>, &Vec<f64>)| {
            n.into_iter().zip(drift).map(|(x, &d)| x + Interval::point(d) * late).collect()
        };
        still.into_iter().zip(&self.drifts).map(moved).collect()
    }
}

/// What the middles of A and Ȧ leave open of (A + (t − t_c) Ȧ) z, with t − t_c in `offset` and z in `errors`.
fn left_of([matrix, drift]: &[Dense<Interval>; 2], offset: Interval, errors: &[Interval]) -> Vec<f64> {
    let late = Interval::point(offset.magnitude());
    let row = |(a, b): (&[Interval], &[Interval])| {
        let left = a.iter().zip(b).zip(errors).fold(Interval::ZERO, |sum, ((&a, &b), error)| {
            let wide = Interval::point(radius(a)) + Interval::point(radius(b)) * late;
            sum + wide * Interval::point(error.magnitude())
        });
        left.hi()
    };
    matrix.rows().zip(drift.rows()).map(row).collect()
}

/// How far the ends of `x` are from its middle, from above.
fn radius(x: Interval) -> f64 {
    (x - Interval::point(x.midpoint())).magnitude()
}
