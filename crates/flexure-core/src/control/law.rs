//! What every tracking law has in common.

use super::{Input, LoadedLaw, Shaping, Signals, Vcbc};
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Scalar};

/// A tracking law: from where the robot is, how it moves and where it shall be, to motor torque.
///
/// It is static: it has no memory. Laws with one are [`DynamicLaw`](super::DynamicLaw)s.
///
/// A law of one's own:
///
/// ```
/// use flexure_core::control::ControlLaw;
/// use flexure_core::linalg::Vector;
/// use flexure_core::model::{Fjr, Links, Motion};
/// use flexure_core::robots::Pendulum;
/// use flexure_core::scalar::{Jet, Over, Scalar};
///
/// /// u = −D θ̇ + g(q_l): motors that brake, links that do not fall.
/// struct Brake<C, const N: usize> {
///     /// The diagonal of D [N m s/rad].
///     damping: Vector<C, N>,
/// }
///
/// impl<C: Scalar, const N: usize> ControlLaw<C, N> for Brake<C, N> {
///     fn torque<T: Over<C>, L: Links<C, N>>(
///         &self,
///         robot: &Fjr<C, L, N>,
///         x: &Motion<T, N>,
///         _: &Vector<Jet<T, 5>, N>,
///     ) -> Vector<T, N> {
///         robot.links.gravity_torque(&x.q_l) - self.damping.diag_mul(&x.v_m)
///     }
/// }
///
/// let one = Vector([1.0]);
/// let robot = Fjr {
///     links: Pendulum { inertia: 0.1, weight_moment: 5.0 },
///     motor_inertia: one,
///     stiffness: one,
///     link_damping: one,
///     motor_damping: one,
/// };
/// let x = Motion { q_l: Vector([0.0]), q_m: one, v_l: one, v_m: Vector([3.0]) };
/// let u = Brake { damping: Vector([2.0]) }.torque(&robot, &x, &Vector::ZERO);
/// assert_eq!(u, Vector([-6.0]));
/// ```
pub trait ControlLaw<C: Scalar, const N: usize> {
    /// What it reads of the motion.
    const READS: Signals = Signals::ALL;

    /// Motor torque [N m] at the motion `x`; `q_ld` is the reference of the links in rad to order 4.
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> Vector<T, N>;
}

impl<C: Scalar, Pl: Shaping<C, N>, Pm: Shaping<C, N>, const N: usize> ControlLaw<C, N>
    for Vcbc<C, Pl, Pm, N>
{
    #[inline]
    fn torque<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
    ) -> Vector<T, N> {
        self.command(robot, x, q_ld, &Input::ZERO).u_m
    }
}

impl<C: Scalar, Pl: Shaping<C, N>, Pm: Shaping<C, N>, const N: usize> LoadedLaw<C, N> for Vcbc<C, Pl, Pm, N> {
    #[inline]
    fn torque_under<T: Over<C>, L: Links<C, N>>(
        &self,
        robot: &Fjr<C, L, N>,
        x: &Motion<T, N>,
        q_ld: &Vector<Jet<T, 5>, N>,
        load: &Vector<T, N>,
    ) -> Vector<T, N> {
        self.command_under(robot, x, q_ld, &Input::ZERO, load).u_m
    }
}
