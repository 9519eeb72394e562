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
//! [`Flow`] has numbers for A, for the columns that torques enter by, and bounds for all that is left.

use flexure_core::scalar::{Interval, Scalar};

use crate::linalg::Dense;
use crate::prove::engine::envelope::closed_loop::TrackingLoop;
use crate::prove::engine::envelope::deviation::Spread;
use crate::prove::engine::envelope::seen::{Force, Seen, norm};
use crate::prove::engine::envelope::slab::Way;
use crate::prove::engine::envelope::tube::Tube;

/// ż = A z + Σ n w + δ at all times of a slab and all errors of a tube, one n for each [`Channel`].
#[derive(Clone, Debug, PartialEq)]
pub struct Flow {
    /// A.
    pub matrix: Dense<f64>,
    /// By what the errors are driven.
    pub channels: Vec<Channel>,
    /// Bounds of |δ_i|: what the numbers of A and of the columns leave open.
    pub rest: Vec<f64>,
}

/// Σ n_k w_k, with |w| at most |w_0| + |C z|.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// n_k: one for each number of w.
    pub columns: Vec<Vec<f64>>,
    /// |w_0|, from above.
    pub size: f64,
    /// Rows of C; none if w does not depend on the errors.
    pub slopes: Vec<Vec<f64>>,
    /// Whether numbers leave it open, and not the robot.
    pub is_open: bool,
}

impl Flow {
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
        let mut flow = Self {
            matrix: Dense::zeros(errors.len(), errors.len()),
            channels: Vec::new(),
            rest: vec![0.0; errors.len()],
        };
        flow.take(&seen.matrix(system, &errors), &errors);
        for force in seen.forces(system, spread) {
            flow.add(&force, tube, &errors);
        }
        Some(flow)
    }

    /// A: the middles of `matrix`, and what they leave open of its product with `errors`.
    fn take(&mut self, matrix: &Dense<Interval>, errors: &[Interval]) {
        for (i, row) in matrix.rows().enumerate() {
            let mut left = Interval::ZERO;
            for (j, (entry, error)) in row.iter().zip(errors).enumerate() {
                self.matrix[(i, j)] = entry.midpoint();
                left += Interval::point(radius(*entry)) * Interval::point(error.magnitude());
            }
            self.rest[i] = left.hi();
        }
    }

    /// One more channel, if anything goes through it.
    fn add(&mut self, force: &Force, tube: &dyn Tube, errors: &[Interval]) {
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
        for column in &force.columns {
            for (rest, n) in self.rest.iter_mut().zip(column) {
                *rest = (Interval::point(*rest) + Interval::point(radius(*n)) * all).hi();
            }
        }
        let slopes = point(&force.slopes);
        let depends = slopes.iter().flatten().any(|&c| c != 0.0);
        self.channels.push(Channel {
            columns: point(&force.columns),
            size: size.hi(),
            slopes: if depends { slopes } else { Vec::new() },
            is_open: force.is_open,
        });
    }
}

/// How far the ends of `x` are from its middle, from above.
fn radius(x: Interval) -> f64 {
    (x - Interval::point(x.midpoint())).magnitude()
}
