//! The law of a rigid robot: with M q̈ + C q̇ + D q̇ + g = u its errors obey
//! d/dt q̃ = −φ + M⁻¹ σ and d/dt σ = −∫Π − (E + D + K_d) M⁻¹ σ + ω.

use flexure_core::control::{RigidVcbc, Shaping};
use flexure_core::linalg::Vector;
use flexure_core::model::{LinkMatrices, Links, MassFactor};
use flexure_core::scalar::{Dual, Jet};

use crate::common::{
    Numbers, branched, close, coupled_tanh, gains, linear, moving, planar, rate, shifting, tanh,
};

fn law_gives_the_closed_loop<L, P, const N: usize>(links: &L, law: &RigidVcbc<f64, P, N>, r: &mut Numbers)
where
    L: Links<f64, N>,
    P: Shaping<f64, N>,
{
    let (q, v, damping, omega) = (r.vector(1.5), r.vector(1.5), r.between(0.1, 1.0), r.vector(2.0));
    let q_d: Vector<Jet<f64, 4>, N> = r.series(1.0);
    let command = law.command(links, &damping, &q, &v, &q_d.map(|x| x.truncate()), &omega);
    let u = command.torque.map(|x| x.coefficient(0));
    let bias = links.inverse_dynamics(&q, &v, &v, &Vector::ZERO) + damping.diag_mul(&v);
    let a = links.factor(&q).solve(&(u - bias));

    // Errors along the motion. ω does not enter them: any constant will do.
    let (moving_q, moving_v) = (moving(&q, &v), moving(&v, &a));
    let along = law.command(links, &damping, &moving_q, &moving_v, &shifting(&q_d), &omega.lift());
    let value = |x: &Vector<Jet<Dual<f64, 1>, 1>, N>| x.map(|x| x.coefficient(0));
    let (error, velocity_error) = (value(&along.error), value(&along.velocity_error));
    let sigma = links.mass_mul(&moving_q, &velocity_error);

    let (e, s) = (error.map(|x| x.value), velocity_error.map(|x| x.value));
    let E = LinkMatrices::new(links, &q, &v).workless();
    // A few hundred operations on torques of 1e3 N m.
    close(&rate(&error), &(s - law.link.shaping.eval(&e)), 1e-12);
    let dissipated = E * s + (damping + law.link.damping).diag_mul(&s);
    close(&rate(&sigma), &(omega - law.link.metric.integral(&e) - dissipated), 1e-10);
}

fn sweep<L: Links<f64, N>, const N: usize>(links: &L, seed: u64) {
    let mut r = Numbers(seed);
    for hardening in [false, true].repeat(5) {
        law_gives_the_closed_loop(links, &RigidVcbc { link: gains(tanh, hardening, &mut r).link }, &mut r);
        law_gives_the_closed_loop(links, &RigidVcbc { link: gains(linear, hardening, &mut r).link }, &mut r);
        let law = RigidVcbc { link: gains(coupled_tanh, hardening, &mut r).link };
        law_gives_the_closed_loop(links, &law, &mut r);
    }
}

#[test]
fn planar_arm() {
    sweep(&planar(), 1);
}

#[test]
fn branched_tree_under_gravity() {
    sweep(&branched::<5>(2), 3);
}
