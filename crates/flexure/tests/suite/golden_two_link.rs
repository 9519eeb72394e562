//! The law and the model against `golden/two_link.json`: 72 states, three shaping functions, several gain sets, from
//! an independent symbolic implementation.

use flexure_core::control::{CoupledTanh, Input, Linear, LinkGains, Metric, MotorGains, Shaping, Tanh, Vcbc};
use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::{Fjr, LinkMatrices, Motion};
use flexure_core::robots::PlanarTwoLink;
use flexure_core::scalar::{Jet, Scalar};
use serde::Deserialize;

/// Largest relative error: the reference was computed in double precision through products of gains that reach 1e6,
/// the issue asks for 1e-10.
const TOLERANCE: f64 = 1e-10;

#[derive(Deserialize)]
struct Golden {
    cases: Vec<Case>,
}

#[derive(Deserialize)]
#[expect(non_snake_case, reason = "field names of the file")]
struct Case {
    phi: String,
    K: [f64; 2],
    M_m: [f64; 2],
    D_l: [f64; 2],
    D_m: [f64; 2],
    Lambda_l: [f64; 2],
    Lambda_m: [f64; 2],
    K_ld: [f64; 2],
    K_md: [f64; 2],
    kappa: [f64; 4],
    samples: Vec<Sample>,
}

#[derive(Deserialize)]
struct Sample {
    t: f64,
    q_l: [f64; 2],
    q_m: [f64; 2],
    dq_l: [f64; 2],
    dq_m: [f64; 2],
    p_l: [f64; 2],
    p_m: [f64; 2],
    u_test: [f64; 2],
    expect: Expect,
}

#[derive(Deserialize)]
#[expect(non_snake_case, reason = "field names of the file")]
struct Expect {
    u_m: [f64; 2],
    u_l: [f64; 2],
    q_md: [f64; 2],
    e_l: [f64; 2],
    e_m: [f64; 2],
    sigma_l: [f64; 2],
    sigma_m: [f64; 2],
    H: f64,
    M_l: [[f64; 2]; 2],
    E_l: [[f64; 2]; 2],
    S_l: [[f64; 2]; 2],
    dM_l: [[f64; 2]; 2],
    dx_with_u_test: [f64; 8],
}

/// Relative to the largest entry of the expected value; values that are all zero must be zero to 1e-15.
fn close(what: &str, got: &[f64], expected: &[f64]) {
    let scale = expected.iter().fold(1e-5, |m: f64, x| m.max(x.abs()));
    for (g, e) in got.iter().zip(expected) {
        assert!((g - e).abs() <= TOLERANCE * scale, "{what}: got {got:?}, expected {expected:?}");
    }
}

fn matrix(m: &Matrix<f64, 2, 2>) -> Vec<f64> {
    m.0.concat()
}

fn check<P: Shaping<f64, 2>>(case: &Case, sample: &Sample, phi_l: P, phi_m: P) {
    let robot = Fjr {
        links: PlanarTwoLink::new([1.510, 0.873], 0.343, [0.159, 0.055], [0.0392, 0.00808]),
        motor_inertia: Vector(case.M_m),
        stiffness: Vector(case.K),
        link_damping: Vector(case.D_l),
        motor_damping: Vector(case.D_m),
    };
    let law = Vcbc {
        link: LinkGains {
            metric: Metric::Constant(Vector(case.Lambda_l)),
            shaping: phi_l,
            damping: Vector(case.K_ld),
        },
        motor: MotorGains { metric: Vector(case.Lambda_m), shaping: phi_m, damping: Vector(case.K_md) },
    };
    let x = Motion {
        q_l: Vector(sample.q_l),
        q_m: Vector(sample.q_m),
        v_l: Vector(sample.dq_l),
        v_m: Vector(sample.dq_m),
    };
    let expect = &sample.expect;
    let q_ld = Vector([Jet::variable(sample.t).sin(); 2]);
    let state = robot.state(&x);
    close("p_l", &state.p_l.0, &sample.p_l);
    close("p_m", &state.p_m.0, &sample.p_m);
    for command in [
        law.command(&robot, &x, &q_ld, &Input::ZERO),
        law.virtual_command(&robot, &x, &x, &q_ld, &Input::ZERO),
    ] {
        close("u_m", &command.u_m.0, &expect.u_m);
        close("u_l", &command.u_l.0, &expect.u_l);
        close("q_md", &command.q_md.0, &expect.q_md);
        close("e_l", &command.e_l.0, &expect.e_l);
        close("e_m", &command.e_m.0, &expect.e_m);
        let sigma = robot.state(&Motion { v_l: command.s_l, v_m: command.s_m, ..x });
        close("sigma_l", &sigma.p_l.0, &expect.sigma_l);
        close("sigma_m", &sigma.p_m.0, &expect.sigma_m);
    }
    close("H", &[robot.hamiltonian(&state)], &[expect.H]);
    let matrices = LinkMatrices::new(&robot.links, &x.q_l, &x.v_l);
    close("M_l", &matrix(&matrices.mass), &expect.M_l.concat());
    close("E_l", &matrix(&matrices.workless()), &expect.E_l.concat());
    close("S_l", &matrix(&matrices.skew), &expect.S_l.concat());
    close("dM_l", &matrix(&matrices.mass_rate), &expect.dM_l.concat());
    let u = Vector(sample.u_test);
    for dx in [robot.hamiltonian_dynamics(&state, &u), robot.workless_dynamics(&state, &u)] {
        close("dx", &[dx.q_l.0, dx.q_m.0, dx.p_l.0, dx.p_m.0].concat(), &expect.dx_with_u_test);
    }
}

#[test]
fn two_link_golden_file() {
    let golden: Golden =
        serde_json::from_str(include_str!("../golden/two_link.json")).expect("golden file parses");
    let mut count = 0;
    for case in &golden.cases {
        let (gain_l, gain_m) = (Vector(case.Lambda_l), Vector(case.Lambda_m));
        let [k1, k2, k3, k4] = case.kappa;
        for sample in &case.samples {
            match case.phi.as_str() {
                "tanh" => check(case, sample, Tanh { gain: gain_l }, Tanh { gain: gain_m }),
                "linear" => check(case, sample, Linear { gain: gain_l }, Linear { gain: gain_m }),
                "coupled-tanh" => check(
                    case,
                    sample,
                    CoupledTanh::new(Vector([k1, k2]), &gain_l),
                    CoupledTanh::new(Vector([k3, k4]), &gain_m),
                ),
                other => panic!("unknown shaping function {other}"),
            }
            count += 1;
        }
    }
    assert_eq!(count, 72);
}
