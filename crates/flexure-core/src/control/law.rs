//! What every tracking law has in common.

use super::{Input, Shaping, Vcbc};
use crate::linalg::Vector;
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Scalar};

/// A tracking law: from where the robot is, how it moves and where it shall be, to motor torque.
///
/// Every law of this folder is static: it has no memory, so that the closed loop is an ordinary differential equation and
/// runs on every number type.
pub trait ControlLaw<C: Scalar, const N: usize> {
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
