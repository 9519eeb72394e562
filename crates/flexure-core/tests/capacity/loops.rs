//! A controlled robot with room: estimators, guard and plant over many periods.

use flexure_core::control::{ControlLaw, Tanh};
use flexure_core::estimate::{
    DisturbanceObserver, Estimator, FilteredDifference, LowPass, MotorObserver, Observer,
};
use flexure_core::guard::{Age, Guard, Plausible, Rejoin, Seen, Settings};
use flexure_core::linalg::Vector;
use flexure_core::model::{Links, Motion};
use flexure_core::reference::{Reference, Sine};
use flexure_core::scalar::Jet;

use super::{fit, fit_motion, robot, same, tree};
use crate::common::{Numbers, flexible, motion_rate};

const PERIOD: f64 = 1e-3;
const JOINTS: usize = 3;

/// A loop of period after period (Euler in between: any plant will do), observed: what happened to the first three joints,
/// and the last motion and torque of all.
fn course<E: Estimator<f64, N>, const N: usize>(
    make: impl Fn(&Vector<f64, N>) -> E,
) -> (Vec<String>, Motion<f64, N>, Vector<f64, N>) {
    let r = &mut Numbers(31);
    let data = flexible(tree::<f64, JOINTS, JOINTS>(6, crate::FLOAT), r);
    let robot = robot::<f64, JOINTS, N>(6, &data, crate::FLOAT);
    let three = |r: &mut Numbers, fill: f64| fit::<f64, JOINTS, N>(&r.between(5.0, 20.0), fill);
    let law = flexure_core::control::RigidVcbc {
        link: flexure_core::control::LinkGains {
            metric: flexure_core::control::Metric::Constant(three(r, 1.0)),
            shaping: Tanh { gain: three(r, 1.0) },
            damping: three(r, 1.0),
        },
    };
    let path = Sine { amplitude: three(r, 0.0).scaled(0.02), frequency: three(r, 0.0), ..Sine::ZERO };
    let ones = Vector([1.0; N]);
    let mut estimator = make(&three(r, 1.0));
    let mut residual = DisturbanceObserver::new(&ones, PERIOD).expect("positive");
    let mut guard = Guard::new(Settings {
        torque_limit: ones.scaled(50.0),
        torque_rate_limit: ones.scaled(1e4),
        stop_damping: ones,
        rejoin: Rejoin { after: 3, ..Settings::open(PERIOD).rejoin },
        plausible: Plausible { speed: ones.scaled(100.0), ..Plausible::ANYTHING },
        ..Settings::open(PERIOD)
    })
    .expect("sound");
    let start = fit::<f64, JOINTS, N>(&r.vector(0.1), 0.0);
    let mut x =
        Motion { q_l: start, q_m: robot.motors_at_rest(&start), v_l: Vector::ZERO, v_m: Vector::ZERO };
    estimator.start(&x);
    let mut u = Vector::ZERO;
    let mut seen = Vec::new();
    for k in 0..200 {
        let t = PERIOD * f64::from(k);
        let hat = estimator.update(&robot, &x.q_l, &x.q_m, &u);
        let found = residual.update(&robot, &hat, &u);
        let age = Age { link: u32::from(k == 50), motor: 0 };
        let q_ld: Vector<Jet<f64, 5>, N> = path.at(t);
        let torque = |x: &Motion<f64, N>| law.torque(&robot, x, &q_ld);
        let holding = |q: &Vector<f64, N>| robot.links.gravity_torque(q);
        u = guard.step(&Seen { age, ..Seen::fresh(&hat) }, &mut (torque, holding)).torque;
        let rate = motion_rate(&robot, &x, &u);
        x = Motion {
            q_l: x.q_l + rate.q_l.scaled(PERIOD),
            q_m: x.q_m + rate.q_m.scaled(PERIOD),
            v_l: x.v_l + rate.v_l.scaled(PERIOD),
            v_m: x.v_m + rate.v_m.scaled(PERIOD),
        };
        let real = |v: &Vector<f64, N>| fit::<f64, N, JOINTS>(v, 0.0);
        seen.push(format!(
            "{:?}",
            (fit_motion::<f64, N, JOINTS>(&hat), real(&found.link), real(&u), real(&x.q_l))
        ));
    }
    (seen, x, u)
}

fn with_room<E3: Estimator<f64, 3>, E8: Estimator<f64, 8>>(
    exact: impl Fn(&Vector<f64, 3>) -> E3,
    roomy: impl Fn(&Vector<f64, 8>) -> E8,
) {
    let ((small, ..), (large, x, u)) = (course(exact), course(roomy));
    same(&small, &large);
    let phantoms = |v: &Vector<f64, 8>| v.0[3..].iter().all(|x| *x == 0.0);
    assert!([&x.q_l, &x.q_m, &x.v_l, &x.v_m, &u].iter().all(|v| phantoms(v)), "phantoms stay where they are");
    assert!(u.0[..3].iter().all(|u| *u != 0.0), "the others do not");
}

#[test]
fn with_an_observer() {
    with_room(
        |w| Observer::new(w, PERIOD).expect("positive"),
        |w| Observer::new(w, PERIOD).expect("positive"),
    );
}

#[test]
fn with_a_motor_observer() {
    with_room(
        |w| MotorObserver::new(w, PERIOD).expect("positive"),
        |w| MotorObserver::new(w, PERIOD).expect("positive"),
    );
}

#[test]
fn with_filtered_differences() {
    let filter = LowPass::second_order(40.0, 0.9, PERIOD).expect("below half the sampling frequency");
    with_room(|_| FilteredDifference::new(filter), |_| FilteredDifference::new(filter));
}
