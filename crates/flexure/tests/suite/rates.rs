//! Reference rates of the two-link arm with the paper's gains: theory, section 5.

use flexure::laws::BlockRates;
use flexure_core::control::{CoupledTanh, Input, Linear, LinkGains, Metric, MotorGains, Shaping, Tanh, Vcbc};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Motion};
use flexure_core::robots::PlanarTwoLink;
use flexure_core::scalar::Jet;

fn rates<P: Shaping<f64, 2>>(phi_l: P, phi_m: P, error: f64) -> BlockRates {
    let robot = Fjr {
        links: PlanarTwoLink::new([1.510, 0.873], 0.343, [0.159, 0.055], [0.0392, 0.00808]),
        motor_inertia: Vector([0.23, 0.01]),
        stiffness: Vector([9.0, 4.0]),
        link_damping: Vector([0.8, 0.55]),
        motor_damping: Vector([0.2, 90.0]),
    };
    let law = Vcbc {
        link: LinkGains {
            metric: Metric::Constant(Vector([55.0, 30.0])),
            shaping: phi_l,
            damping: Vector([15.0, 10.0]),
        },
        motor: MotorGains { metric: Vector([70.0, 60.0]), shaping: phi_m, damping: Vector([10.0, 5.0]) },
    };
    // Arm stretched out (the worst case of the links), reference `error` away.
    let x = Motion::at_rest(Vector([0.0, 0.0]));
    let q_ld = Vector([Jet::value(-error); 2]);
    let command = law.command(&robot, &x, &q_ld, &Input::ZERO);
    BlockRates::at(&robot, &law, &x.q_l, &command)
}

fn close(got: f64, expected: f64) {
    // Eigenvalues of 2 × 2 matrices: a few roundings.
    assert!((got - expected).abs() < 1e-13 * expected.abs(), "{got} against {expected}");
}

#[test]
fn the_paper_s_gains() {
    let linear = rates(Linear { gain: Vector([55.0, 30.0]) }, Linear { gain: Vector([70.0, 60.0]) }, 3.0);
    close(linear.sigma_l, 69.013_154_939_393_06);
    close(linear.sigma_m, 44.347_826_086_956_52);
    close(linear.phi_l, 30.0);
    close(linear.overall(), 30.0);
    let tanh = rates(Tanh { gain: Vector([55.0, 30.0]) }, Tanh { gain: Vector([70.0, 60.0]) }, 3.0);
    close(tanh.phi_l, 0.295_981_114_963_205_7);
    let kappa = Vector([10.0, 8.0]);
    let coupled = rates(
        CoupledTanh::new(kappa, &Vector([55.0, 30.0])),
        CoupledTanh::new(kappa, &Vector([70.0, 60.0])),
        0.0,
    );
    close(coupled.phi_l, 10.0 - std::f64::consts::SQRT_2);
}
