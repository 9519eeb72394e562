//! Velocities from both encoders and the model of the robot.

use super::prediction::predict;
use super::reading::{at_rest, is_finite, where_read};
use super::{Estimator, positive};
use crate::linalg::Vector;
use crate::memory::{Memory, Port};
use crate::model::{Fjr, Links, Motion};
use crate::scalar::Float;

/// Observer on the flexible-joint model with both encoders: prediction over the period, then correction.
///
/// q̂ += (1 − ρ²) (y − q̂), v̂ += (1 − ρ)²/T (y − q̂), ρ = e^{−ωT}, on either side: the gains that put both poles of a
/// double integrator at ρ. They need not know the robot: springs and inertial coupling turn poles of modulus ρ without
/// changing it, up to modes of frequency ν with (νT/2)² = 1/tanh²(ωT/2) − 1, and dampers make them smaller. That is
/// exact for small velocities and equal bandwidths. docs/estimators.md.
///
/// A constant torque d that the model does not know leaves errors of d / (m ω²) in position and 2 d / (m ω) in velocity.
#[derive(Clone, Copy, Debug)]
pub struct Observer<C, const N: usize> {
    period: C,
    /// 1 − ρ².
    position_gain: Vector<C, N>,
    /// (1 − ρ)² / T [1/s].
    velocity_gain: Vector<C, N>,
    estimate: Motion<C, N>,
}

impl<C: Float, const N: usize> Observer<C, N> {
    /// `bandwidth` is ω per joint [rad/s], `period` the control period T in s. `None` unless all are positive.
    ///
    /// At rest at 0 until it is [started](Estimator::start) elsewhere.
    pub fn new(bandwidth: &Vector<C, N>, period: C) -> Option<Self> {
        if !(positive(period) && bandwidth.iter().all(positive)) {
            return None;
        }
        let kept = bandwidth.map(|w| (-w * period).exp());
        Some(Self {
            period,
            position_gain: kept.map(|rho| C::ONE - rho.square()),
            velocity_gain: kept.map(|rho| (C::ONE - rho).square() / period),
            estimate: Motion::at_rest(Vector::ZERO),
        })
    }
}

/// The estimated [`Motion`].
impl<C: Float, const N: usize> Memory<C> for Observer<C, N> {
    fn memory(&mut self, port: &mut dyn Port<C>) {
        self.estimate.memory(port);
    }
}

impl<C: Float, const N: usize> Estimator<C, N> for Observer<C, N> {
    fn start(&mut self, x: &Motion<C, N>) {
        self.estimate = *x;
    }

    #[inline]
    fn update<L: Links<C, N>>(
        &mut self,
        robot: &Fjr<C, L, N>,
        q_l: &Vector<C, N>,
        q_m: &Vector<C, N>,
        u_m: &Vector<C, N>,
    ) -> Motion<C, N> {
        let mut x = predict(robot, &self.estimate, u_m, self.period, None);
        let residual = |reading: &Vector<C, N>, position: &Vector<C, N>| {
            (*reading - *position).map(|r| if r.is_finite() { r } else { C::ZERO })
        };
        let (r_l, r_m) = (residual(q_l, &x.q_l), residual(q_m, &x.q_m));
        x.q_l += self.position_gain.diag_mul(&r_l);
        x.q_m += self.position_gain.diag_mul(&r_m);
        x.v_l += self.velocity_gain.diag_mul(&r_l);
        x.v_m += self.velocity_gain.diag_mul(&r_m);
        self.estimate = if is_finite(&x) { x } else { at_rest(q_l, q_m) };
        Motion {
            q_l: where_read(&x.q_l, q_l),
            q_m: where_read(&x.q_m, q_m),
            v_l: where_read(&x.v_l, q_l),
            v_m: where_read(&x.v_m, q_m),
        }
    }
}
