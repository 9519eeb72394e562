//! The virtual system of a flexible-joint robot.

use crate::linalg::Vector;
use crate::model::{Fjr, LinkMatrices, Links, MassFactor, Motion, State};
use crate::scalar::{Over, Scalar};

/// ẋ_v under the virtual motor torque `u_mv` [N m], along the real motion `x`. Paper, eq. phmechanical-flexible-virtual.
///
/// M_l, E_l, D_l, M_m and D_m are those of `x`; gravity and springs see the virtual positions. Every solution of the
/// robot solves it with `x_v = x`; the converse does not hold.
#[inline]
pub fn virtual_dynamics<T: Over<C>, C: Scalar, L: Links<C, N>, const N: usize>(
    robot: &Fjr<C, L, N>,
    x_v: &State<T, N>,
    x: &Motion<T, N>,
    u_mv: &Vector<T, N>,
) -> State<T, N> {
    let links = &robot.links;
    let v_lv = links.factor(&x.q_l).solve(&x_v.p_l);
    let v_mv = robot.motor_inertia.map(C::recip).diag_mul(&x_v.p_m);
    let E_l = LinkMatrices::new(links, &x.q_l, &x.v_l).workless();
    let spring = robot.spring_torque(&x_v.q_l, &x_v.q_m);
    State {
        q_l: v_lv,
        q_m: v_mv,
        p_l: spring - E_l * v_lv - robot.link_damping.diag_mul(&v_lv) - links.gravity_torque(&x_v.q_l),
        p_m: *u_mv - spring - robot.motor_damping.diag_mul(&v_mv),
    }
}
