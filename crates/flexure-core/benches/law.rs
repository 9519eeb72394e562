//! What one control period costs: `cargo bench -p flexure-core`.

use divan::{Bencher, black_box};
use flexure_core::control::{Input, LinkTorque, RigidVcbc, Shaping, Vcbc};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Links, MassFactor};
use flexure_core::scalar::{Jet, Scalar};

#[path = "../tests/suite/common/mod.rs"]
#[allow(dead_code, reason = "shared with the tests")]
mod common;
use common::{Numbers, coupled_tanh, flexible, gains, linear, planar, serial, tanh};

fn main() {
    divan::main();
}

fn reference<const K: usize, const N: usize>() -> Vector<Jet<f64, K>, N> {
    Vector([Jet::variable(0.3).sin(); N])
}

fn law<L, P, const N: usize>(bencher: Bencher, links: L, shaping: fn(&mut Numbers) -> P)
where
    L: Links<f64, N> + Sync,
    P: Shaping<f64, N> + Sync,
{
    let mut r = Numbers(1);
    let robot: Fjr<f64, L, N> = flexible(links, &mut r);
    let law: Vcbc<f64, P, P, N> = gains(shaping, false, &mut r);
    let (x, q_d) = (r.motion(1.0), reference());
    bencher.bench_local(|| {
        black_box(&law)
            .command(black_box(&robot), black_box(&x), black_box(&q_d), black_box(&Input::ZERO))
            .u_m
    });
}

mod two_link {
    use super::{
        Bencher, LinkTorque, Numbers, RigidVcbc, black_box, coupled_tanh, flexible, gains, linear, planar,
        reference, tanh,
    };
    use flexure_core::linalg::Vector;

    #[divan::bench]
    fn law_tanh(bencher: Bencher) {
        super::law(bencher, planar(), tanh);
    }

    #[divan::bench]
    fn law_linear(bencher: Bencher) {
        super::law(bencher, planar(), linear);
    }

    #[divan::bench]
    fn law_coupled_tanh(bencher: Bencher) {
        super::law(bencher, planar(), coupled_tanh);
    }

    #[divan::bench]
    fn rigid_law(bencher: Bencher) {
        let mut r = Numbers(1);
        let robot = flexible(planar(), &mut r);
        let law = RigidVcbc { link: gains(tanh, false, &mut r).link };
        let (x, q_d) = (r.motion::<2>(1.0), reference());
        bencher.bench_local(|| -> LinkTorque<f64, 2, 1> {
            let x = black_box(&x);
            black_box(&law).command(
                &robot.links,
                &robot.link_damping,
                &x.q_l,
                &x.v_l,
                black_box(&q_d),
                &Vector::ZERO,
            )
        });
    }

    #[divan::bench]
    fn link_acceleration(bencher: Bencher) {
        let mut r = Numbers(1);
        let (robot, x) = (flexible(planar(), &mut r), r.motion(1.0));
        bencher.bench_local(|| black_box(&robot).link_acceleration(black_box(&x)));
    }
}

/// Serial arms: everything but the dense mass matrix grows with n.
mod arm {
    use super::{
        Bencher, Links, MassFactor, Numbers, RigidVcbc, Vector, black_box, flexible, gains, reference,
        serial, tanh,
    };

    #[divan::bench(consts = [7, 8, 16, 32, 64])]
    fn law<const N: usize>(bencher: Bencher) {
        super::law(bencher, serial::<N>(), tanh);
    }

    #[divan::bench(consts = [7, 8, 16, 32, 64])]
    fn inverse_dynamics<const N: usize>(bencher: Bencher) {
        let (links, x) = (serial::<N>(), Numbers(1).motion(1.0));
        bencher.bench_local(|| {
            let x = black_box(&x);
            black_box(&links).inverse_dynamics(&x.q_l, &x.v_l, &x.v_m, &x.q_m)
        });
    }

    #[divan::bench(consts = [7, 8, 16, 32, 64])]
    fn torque_with_two_derivatives<const N: usize>(bencher: Bencher) {
        let (links, q) = (serial::<N>(), Numbers(1).series::<5, N>(1.0));
        bencher.bench_local(|| black_box(&links).torque_along::<_, 3, 5>(black_box(&q)));
    }

    #[divan::bench(consts = [7, 8, 16, 32, 64])]
    fn forward_dynamics<const N: usize>(bencher: Bencher) {
        let (links, x) = (serial::<N>(), Numbers(1).motion(1.0));
        bencher.bench_local(|| {
            let x = black_box(&x);
            black_box(&links).forward_dynamics(&x.q_l, &x.v_l, &x.q_m)
        });
    }

    #[divan::bench(consts = [7, 8, 16, 32, 64])]
    fn factor_and_solve<const N: usize>(bencher: Bencher) {
        let (links, x) = (serial::<N>(), Numbers(1).motion(1.0));
        bencher.bench_local(|| {
            let x = black_box(&x);
            black_box(&links).factor(&x.q_l).solve(&x.v_l)
        });
    }

    #[divan::bench(consts = [7])]
    fn rigid_law<const N: usize>(bencher: Bencher) {
        let mut r = Numbers(1);
        let robot = flexible(serial::<N>(), &mut r);
        let law = RigidVcbc { link: gains(tanh, false, &mut r).link };
        let (x, q_d) = (r.motion::<N>(1.0), reference());
        bencher.bench_local(|| {
            let x = black_box(&x);
            let damping = &robot.link_damping;
            black_box(&law).command(&robot.links, damping, &x.q_l, &x.v_l, black_box(&q_d), &Vector::ZERO)
        });
    }

    #[divan::bench(consts = [7])]
    fn link_acceleration<const N: usize>(bencher: Bencher) {
        let mut r = Numbers(1);
        let (robot, x) = (flexible(serial::<N>(), &mut r), r.motion(1.0));
        bencher.bench_local(|| black_box(&robot).link_acceleration(black_box(&x)));
    }

    #[divan::bench(consts = [7])]
    fn mass_matrix<const N: usize>(bencher: Bencher) {
        let (links, q) = (serial::<N>(), Numbers(1).vector(1.0));
        bencher.bench_local(|| black_box(&links).mass_matrix(black_box(&q)));
    }
}
