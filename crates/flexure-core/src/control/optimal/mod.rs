//! Laws that are optimal for the robot linearised at a posture, and their design: work for a start, not for a control period. For 16 joints it takes 1 to 1.5 MB
//! of stack.

mod linear_model;
mod lqr;
mod mpc;
mod regulator;
mod riccati;

pub use linear_model::LinearModel;
pub use lqr::{HInfinity, Lqr};
pub use mpc::Mpc;
pub use regulator::{NoRegulator, QuadraticCost, Regulator};

use crate::linalg::{Matrix, Vector};
use crate::model::{Fjr, Links, Motion};
use crate::scalar::{Jet, Over, Scalar};

/// x − x_d = (q − q_d, θ − θ_d, v − v_d, w − w_d) [rad, rad/s] and u_d [N m], where θ_d, w_d and u_d follow from the reference of the links alone,
/// because the robot is flat.
#[inline]
fn deviation<C: Scalar, T: Over<C>, L: Links<C, N>, const N: usize>(
    robot: &Fjr<C, L, N>,
    x: &Motion<T, N>,
    q_ld: &Vector<Jet<T, 5>, N>,
) -> ([Vector<T, N>; 4], Vector<T, N>) {
    let nominal = robot.inverse_dynamics::<_, 1, 3, 5>(q_ld);
    let ([theta_d, rate_d, _], [u_d]) = (nominal.q_m.derivatives(), nominal.u_m.derivatives());
    let [q_d, v_d, ..] = q_ld.derivatives();
    ([x.q_l - q_d, x.q_m - theta_d, x.v_l - v_d, x.v_m - rate_d], u_d)
}

/// −F e [N m]: gains F [N m/rad, N m s/rad] for the errors of q, θ, v and w.
#[inline]
fn feedback<C: Scalar, T: Over<C>, const N: usize>(
    gain: &[Matrix<C, N, N>; 4],
    error: &[Vector<T, N>; 4],
) -> Vector<T, N> {
    let mut torque = Vector::ZERO;
    for (gain, error) in gain.iter().zip(error) {
        torque -= gain.weigh(error);
    }
    torque
}
