//! The v-CBC law at many motions, several to a SIMD register.

use std::array;

use flexure_core::control::Input;
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::scalar::{Jet, Scalar};

use crate::lanes::{Several, WIDTH};
use crate::laws::Law;

/// What `law` asks of the motors of `robot`, of `n` joints, at each of the `motions` (4n numbers each), into `u_m` (n numbers each)
/// [N m]: what it asks at one of them, but for the last digits of sines and tanh ([`Several`]), wherever among the others it stands.
#[inline(never)]
pub(crate) fn torques<L: Links<f64, N>, const N: usize>(
    law: &Law<f64, N>,
    robot: &Fjr<f64, L, N>,
    q_ld: &Vector<Jet<f64, 5>, N>,
    n: usize,
    motions: &[f64],
    u_m: &mut [f64],
) {
    let q_ld = q_ld.map(|jet| Jet::from_fn(|k| Several::splat(jet.coefficient(k))));
    for (motions, u_m) in motions.chunks(4 * n * WIDTH).zip(u_m.chunks_mut(n * WIDTH)) {
        // Where the last register is not full, its first motion is there several times.
        let number = |i: usize| {
            Several::from_array(array::from_fn(|lane| {
                motions.get(4 * n * lane + i).copied().unwrap_or(motions[i])
            }))
        };
        let part = |k: usize| Vector::from_fn(|i| if i < n { number(k * n + i) } else { Several::ZERO });
        let x = Motion { q_l: part(0), q_m: part(1), v_l: part(2), v_m: part(3) };
        let torque = law.command(robot, &x, &q_ld, &Input::ZERO).u_m;
        for (i, torque) in torque.iter().take(n).enumerate() {
            for (u_m, torque) in u_m.chunks_exact_mut(n).zip(torque.to_array()) {
                u_m[i] = torque;
            }
        }
    }
}
