//! Feedback linearisation by static state feedback.

use super::ControlLaw;
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Scalar};

/// Makes the links a chain of four integrators per joint, e⁗ + k_3 e⃛ + k_2 ë + k_1 ė + k_0 e = 0: the torque is the
/// inverse dynamics of the robot at the fourth derivative ν = q_d⁗ − Σ k_i e⁽ⁱ⁾, with acceleration and jerk from the model.
/// Spong, *Modeling and control of elastic joint robots*, ASME J. Dynamic Systems, Measurement and Control 109, 1987; by
/// recursions: Buondonno and De Luca, *Efficient computation of inverse dynamics and feedback linearization for VSA-based
/// robots*, IEEE Robotics and Automation Letters 1, 2016.
///
/// Stable if and only if every joint's polynomial is Hurwitz.
#[derive(Clone, Copy, Debug)]
pub struct FeedbackLinearization<C, const N: usize> {
    /// k_0, k_1, k_2, k_3 of the link error and its first three derivatives [1/s⁴, 1/s³, 1/s², 1/s].
    pub gains: [Vector<C, N>; 4],
}

/// The inverse dynamics of the robot at the fourth derivative `wanted`(q_d⁗, (e, ė, ë, e⃛)), with acceleration and jerk from the model: motor torque [N m].
#[inline]
pub(super) fn chain<C: Scalar, T: Over<C>, L: Links<C, N>, const N: usize>(
    robot: &Fjr<C, L, N>,
    x: &Motion<T, N>,
    q_ld: &Vector<Jet<T, 5>, N>,
    wanted: impl FnOnce(Vector<T, N>, [Vector<T, N>; 4]) -> Vector<T, N>,
) -> Vector<T, N> {
    let motion = robot.link_motion(&robot.links.factor(&x.q_l), x);
    let [q, v, a, jerk] = motion.derivatives();
    let error = (motion - q_ld.map(|x| x.truncate::<4>())).derivatives();
    let [.., snap] = q_ld.derivatives();
    let series = Vector::from_derivatives(&[q, v, a, jerk, wanted(snap, error)]);
    let [u_m] = robot.inverse_dynamics::<_, 1, 3, 5>(&series).u_m.derivatives();
    u_m
}

impl<C: Scalar, const N: usize> ControlLaw<C, N> for FeedbackLinearization<C, N> {
    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> Vector<T, N> {
        chain(robot, x, q_ld, |snap, errors| {
            self.gains.iter().zip(&errors).fold(snap, |snap, (gain, e)| snap - gain.diag_mul(e))
        })
    }
}
