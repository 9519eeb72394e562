//! Inverse dynamics of the whole flexible-joint robot: from a trajectory of the links to what the motors must do.

use super::{Fjr, Links};
use crate::linalg::Vector;
use crate::scalar::{Jet, Over, Scalar};

/// Motor motion and motor torque under which the links follow a trajectory exactly, as Taylor series in time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FeedForward<T, const N: usize, const U: usize, const U2: usize> {
    /// Spring torque on the links, K (q_m − q_l) [N m].
    pub spring: Vector<Jet<T, U2>, N>,
    /// Motor position q_m in rad, on the link side of the gear.
    pub q_m: Vector<Jet<T, U2>, N>,
    /// Motor torque u_m [N m].
    pub u_m: Vector<Jet<T, U>, N>,
}

impl<C: Scalar, L: Links<C, N>, const N: usize> Fjr<C, L, N> {
    /// Inverse dynamics of links, springs and motors: the robot is flat, so the trajectory of the links decides
    /// everything else. De Luca & Book, *Robots with flexible elements*, Springer Handbook of Robotics, 2nd ed., 2016,
    /// section 11.1.
    ///
    /// The springs must give M q̈_l + C q̇_l + g + D_l q̇_l, which says where the motors are, and the motors that and their
    /// own inertia and damping. Each side costs two orders: `U` coefficients of u_m need `U2 = U + 2` of the spring torque
    /// and `U4 = U + 4` of q_l. With `U = 1` q_l is needed to order 4; with `U = 3`, to order 6, u_m comes with u̇_m and
    /// ü_m. O(n) for any `U`.
    #[inline]
    pub fn inverse_dynamics<T: Over<C>, const U: usize, const U2: usize, const U4: usize>(
        &self,
        q_l: &Vector<Jet<T, U4>, N>,
    ) -> FeedForward<T, N, U, U2> {
        let v_l = q_l.map(|x| x.differentiate());
        let spring = self.links.torque_along(q_l) + self.link_damping.diag_mul(&v_l);
        let q_m = q_l.map(|x| x.truncate()) + self.stiffness.map(C::recip).diag_mul(&spring);
        let (v_m, a_m) = (q_m.map(|x| x.differentiate()), q_m.map(|x| x.differentiate_twice()));
        let u_m = self.motor_inertia.diag_mul(&a_m)
            + self.motor_damping.diag_mul(&v_m)
            + spring.map(|x| x.truncate());
        FeedForward { spring, q_m, u_m }
    }
}
