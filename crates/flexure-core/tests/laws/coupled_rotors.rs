//! Two joints whose second rotor feels the first link: the complete model, and the law for it along whole runs.

use core::array::from_fn;

use flexure_core::control::DynamicFeedbackLinearization;
use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::scalar::Jet;

use crate::common::plant::plausible_arm;

/// q̈ and θ̈ under the motor torque `u`: θ̈_2 moves the first link, q̈_1 the second rotor, both by `coupling` [kg m²].
pub fn accelerations<L: Links<f64, 2>>(
    robot: &Fjr<f64, L, 2>,
    coupling: f64,
    x: &Motion<f64, 2>,
    u: &Vector<f64, 2>,
) -> [Vector<f64, 2>; 2] {
    let left = robot.link_torque(x) - robot.links.inverse_dynamics(&x.q_l, &x.v_l, &x.v_l, &Vector::ZERO);
    let right = *u - robot.spring_torque(&x.q_l, &x.q_m) - robot.motor_damping.diag_mul(&x.v_m);
    let mass = robot.links.mass_matrix(&x.q_l);
    let [b_1, b_2] = robot.motor_inertia.0;
    let reduced =
        Matrix([[mass[(0, 0)] - coupling * coupling / b_2, mass[(0, 1)]], [mass[(1, 0)], mass[(1, 1)]]]);
    let a_l = reduced.ldl().solve(&Vector([left[0] - coupling / b_2 * right[1], left[1]]));
    [a_l, Vector([right[0] / b_1, (right[1] - coupling * a_l[0]) / b_2])]
}

/// q, θ, their rates, and what the law remembers.
type State = [Vector<f64, 2>; 6];

fn motion([q_l, q_m, v_l, v_m, ..]: State) -> Motion<f64, 2> {
    Motion { q_l, q_m, v_l, v_m }
}

fn moved(x: &State, rate: &State, time: f64) -> State {
    from_fn(|k| x[k] + rate[k].scaled(time))
}

/// One step of the classical Runge–Kutta method.
fn stepped(x: &State, t: f64, h: f64, rate: impl Fn(f64, &State) -> State) -> State {
    let a = rate(t, x);
    let b = rate(t + 0.5 * h, &moved(x, &a, 0.5 * h));
    let c = rate(t + 0.5 * h, &moved(x, &b, 0.5 * h));
    let d = rate(t + h, &moved(x, &c, h));
    from_fn(|k| x[k] + (a[k] + (b[k] + c[k]).scaled(2.0) + d[k]).scaled(h / 6.0))
}

const COUPLING: f64 = 0.01; // kg m²
const RATE: f64 = 4.0; // 1/s
const SECONDS: u32 = 9;

/// The largest link error [rad] in the last second, the plant in steps of so many µs, torque and memory's rate held for some of them, or never. Infinite once it leaves
/// 10 rad.
fn error(microseconds: u32, held_for: Option<u32>) -> f64 {
    let (robot, law) = (
        Fjr { stiffness: Vector([9.0, 4.0]), ..plausible_arm() },
        DynamicFeedbackLinearization { rate: Vector([RATE; 2]), coupling: COUPLING },
    );
    // 0.3 sin t and 0.3 sin(t + 1) to order 6.
    let reference = |t: f64| -> Vector<Jet<f64, 7>, 2> {
        let derivatives = from_fn::<_, 7, _>(|k| {
            Vector::from_fn(|i| 0.3 * (t + i as f64 + k as f64 * core::f64::consts::FRAC_PI_2).sin())
        });
        Vector::from_derivatives(&derivatives)
    };
    let planned = |t: f64, x: &State| law.planned(&robot, &motion(*x), &reference(t), &[x[4], x[5]]);
    let moves = |x: &State, u: &Vector<f64, 2>, memory: [Vector<f64, 2>; 2]| -> State {
        let [a_l, a_m] = accelerations(&robot, COUPLING, &motion(*x), u);
        [x[2], x[3], a_l, a_m, memory[0], memory[1]]
    };
    let start = Motion::at_rest(Vector([0.2, -0.1]));
    let [first, second] = law.start(&robot, &start);
    let mut x: State = [start.q_l, start.q_m, start.v_l, start.v_m, first, second];
    let step = 1e-6 * f64::from(microseconds);
    let mut largest = 0.0_f64;
    let mut held = planned(0.0, &x);
    for k in 0..SECONDS * 1_000_000 / microseconds {
        let t = f64::from(k) * step;
        if held_for.is_some_and(|steps| k % steps == 0) {
            held = planned(t, &x);
        }
        x = match held_for {
            Some(_) => stepped(&x, t, step, |_, x| moves(x, &held.torque, held.rate)),
            None => stepped(&x, t, step, |t, x| {
                let now = planned(t, x);
                moves(x, &now.torque, now.rate)
            }),
        };
        let e = x[0] - reference(t + step).map(|q| q.coefficient(0));
        let off = e.iter().map(f64::abs).sum::<f64>();
        if off.is_nan() || off > 10.0 {
            return f64::INFINITY;
        }
        if t > f64::from(SECONDS - 1) {
            largest = largest.max(off);
        }
    }
    largest
}

/// Without a period errors are gone; a held torque acts half a period late on average, and what it leaves falls with the period; of a tenth of a millisecond the loop
/// is lost.
#[test]
fn six_integrators_take_a_short_period() {
    let free = error(50, None);
    assert!(free < 1e-7, "{free}");
    let [short, shorter] = [20, 10].map(|period| error(period, Some(1)));
    assert!(shorter < 0.05 && (short / shorter - 2.0).abs() < 0.05, "{short} {shorter}");
    assert!(error(50, Some(2)).is_infinite());
}
