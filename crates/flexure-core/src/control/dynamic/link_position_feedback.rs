//! Tracking from link encoders alone: any static law on an observer of the whole motion.

use super::{Applied, DynamicLaw};
use crate::control::{ControlLaw, Signals};
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Float, Jet, Over, Scalar};

/// A reconstruction of the idea of Nicosia and Tomei, *A tracking controller for flexible joint robots using only link position feedback*, IEEE Trans.
/// Automatic Control 40, 1995, not their formula: link positions are all that is measured, an observer with the model of the robot estimates the rest, and
/// a law for the whole motion goes by the estimate and the measured positions.
///
/// With y = q − q̂: q̂̇ = v̂ + L_1 y, v̂̇ = M(q)⁻¹ (K (θ̂ − q) − C(q, v̂) v̂ − D_l v̂ − g(q)) + L_2 y, θ̂̇ = ŵ + K⁻¹ M(q) L_3 y,
/// ŵ̇ = B⁻¹ (u − D_m ŵ − K (θ̂ − q)) + K⁻¹ M(q) L_4 y, u the torque that the motors got. In M⁻¹ K (θ − θ̂) the errors are a chain with the poles that
/// [`observer_gains`] gives, up to terms that are bounded where velocities are: semi-global exponential for poles fast enough. Memory: q̂, v̂, θ̂, ŵ.
#[derive(Clone, Copy, Debug)]
pub struct LinkPositionFeedback<C, F, const N: usize> {
    /// The law that goes by the estimate.
    pub law: F,
    /// L_1 to L_4 [1/s, 1/s², 1/s³, 1/s⁴].
    pub observer: [Vector<C, N>; 4],
}

/// L_1 to L_4 of [`LinkPositionFeedback`] for a joint whose observer shall have its poles at −ℓ, ℓ = `bandwidth` [1/s]. `motor_rate` is D_m/B [1/s]: a
/// motor whose own damper is faster than the observer answers at once, and the chain is one shorter, (3ℓ, 3ℓ², ℓ³, 0) instead of (4ℓ, 6ℓ², 4ℓ³, ℓ⁴).
#[inline]
pub fn observer_gains<C: Float>(bandwidth: C, motor_rate: C) -> [C; 4] {
    let (l, l2) = (bandwidth, bandwidth * bandwidth);
    let times = |n: i32, x: C| C::from_ratio(n, 1) * x;
    if motor_rate < bandwidth {
        [times(4, l), times(6, l2), times(4, l * l2), l2 * l2]
    } else {
        [times(3, l), times(3, l2), l * l2, C::ZERO]
    }
}

/// The measured link positions with the estimate of the rest.
#[inline]
fn seen<T: Scalar, const N: usize>(q_l: &Vector<T, N>, [_, v, theta, w]: &[Vector<T, N>; 4]) -> Motion<T, N> {
    Motion { q_l: *q_l, q_m: *theta, v_l: *v, v_m: *w }
}

impl<C: Scalar, F: ControlLaw<C, N>, const N: usize> DynamicLaw<C, N, 4> for LinkPositionFeedback<C, F, N> {
    const READS: Signals = Signals::LINK_POSITIONS;
    const JOINTWISE: bool = false;

    /// For a robot that rests on its springs.
    #[inline]
    fn start<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        _: &Vector<Jet<T, 5>, N>,
    ) -> [Vector<T, N>; 4] {
        [x.q_l, Vector::ZERO, robot.motors_at_rest(&x.q_l), Vector::ZERO]
    }

    /// An estimate without errors.
    #[inline]
    fn settled<T: Over<C>, L: Links<C, N>>(
        &self,
        _: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        _: &Vector<Jet<T, 5>, N>,
    ) -> [Vector<T, N>; 4] {
        [x.q_l, x.v_l, x.q_m, x.v_m]
    }

    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
        z: &[Vector<T, N>; 4],
    ) -> Vector<T, N> {
        self.law.torque(robot, &seen(&x.q_l, z), q_ld)
    }

    #[inline]
    fn rate<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        _: &Vector<Jet<T, 5>, N>,
        z: &[Vector<T, N>; 4],
        applied: &Applied<T, N>,
    ) -> [Vector<T, N>; 4] {
        let [q, v, _, w] = z;
        let estimate = seen(&x.q_l, z);
        let y = x.q_l - *q;
        let [l_1, l_2, l_3, l_4] = self.observer.map(|l| l.diag_mul(&y));
        let compliance = robot.stiffness.map(C::recip);
        let through = |l: &Vector<T, N>| compliance.diag_mul(&robot.links.mass_mul(&x.q_l, l));
        [
            *v + l_1,
            robot.link_acceleration(&estimate) + l_2,
            *w + through(&l_3),
            robot.motor_acceleration(&estimate, &applied.given) + through(&l_4),
        ]
    }
}
