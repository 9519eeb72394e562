//! Plants that are not as their model: coupled rotors and hardening springs, through the integrator.

use std::f64::consts::PI;

use differential_equations::prelude::{ExplicitRungeKutta, IVP, ODE};
use flexure::plant::Plant;
use flexure::simulate::{Integrator, Ledger, Order};
use flexure_core::linalg::Vector;
use flexure_core::model::{Fjr, Motion, RotorCoupling};
use flexure_core::robots::{Body, JointKind, Pendulum, PlanarTwoLink, Tree};

use crate::common::distance;

/// A two-link arm, nearly direct drive: the second rotor has 0.09 kg m² about its axis, of about 0.3 kg m² that the
/// first link feels, and its springs harden by a factor of nine at 0.2 rad.
fn arm() -> Plant<PlanarTwoLink<f64>, 2> {
    let motor_inertia = Vector([0.23, 0.09]);
    Plant {
        spring_hardening: Vector([1800.0, 800.0]),
        rotor_coupling: Some(RotorCoupling::new(&motor_inertia, &Vector([5.0, -1.0]))),
        ..Plant::from(Fjr {
            links: PlanarTwoLink::new([3.0, 0.873], 0.343, [0.159, 0.055], [0.14, 0.00808]),
            motor_inertia,
            stiffness: Vector([9.0, 4.0]),
            link_damping: Vector([0.08, 0.05]),
            motor_damping: Vector([0.2, 0.1]),
        })
    }
}

/// Four joints about axes at right angles under gravity, gears between 1 and 5, hardening springs, no damping.
fn chain() -> Plant<Tree<f64, 4>, 4> {
    let bodies = std::array::from_fn(|i: usize| Body {
        parent: i.checked_sub(1),
        kind: JointKind::Revolute,
        axis: [[0.0, 0.0, 1.0], [0.0, 0.6, 0.8]][i % 2],
        rotation: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        translation: [0.0, 0.0, if i == 0 { 0.0 } else { 0.3 }],
        mass: [4.0, 3.0, 2.0, 1.0][i],
        com: [0.02, 0.01, 0.1],
        inertia: [[0.08, 0.0, 0.0], [0.0, 0.09, 0.0], [0.0, 0.0, 0.07]],
    });
    let motor_inertia = Vector([0.3, 0.2, 0.5, 0.05]);
    Plant {
        spring_hardening: Vector([1e4, 2e4, 5e3, 5e3]),
        rotor_coupling: Some(RotorCoupling::new(&motor_inertia, &Vector([5.0, 2.5, -4.0, 1.0]))),
        ..Plant::from(Fjr {
            links: Tree::new(&bodies, [0.0, 0.0, -9.81]).expect("a chain"),
            motor_inertia,
            stiffness: Vector([300.0, 300.0, 100.0, 60.0]),
            link_damping: Vector::ZERO,
            motor_damping: Vector::ZERO,
        })
    }
}

/// The plant as a first-order system for the reference solver.
struct System(Plant<PlanarTwoLink<f64>, 2>, Vector<f64, 2>);

impl ODE<f64, [f64; 8]> for System {
    fn diff(&self, _: f64, y: &[f64; 8], dy: &mut [f64; 8]) {
        let x = unflat(y);
        let [a_l, a_m] = self.0.accelerations(&x, &self.1);
        *dy = [x.v_l[0], x.v_l[1], x.v_m[0], x.v_m[1], a_l[0], a_l[1], a_m[0], a_m[1]];
    }
}

fn unflat(y: &[f64; 8]) -> Motion<f64, 2> {
    let pair = |i: usize| Vector([y[i], y[i + 1]]);
    Motion { q_l: pair(0), q_m: pair(2), v_l: pair(4), v_m: pair(6) }
}

#[test]
fn an_independent_solver_agrees() {
    let system = System(arm(), Vector([5.0, -2.0]));
    let start = [0.2, -0.4, 0.4, -0.6, 2.0, -3.0, 1.0, 8.0];
    let solution = IVP::ode(&system, 0.0, 0.5, start)
        .method(ExplicitRungeKutta::dop853().rtol(1e-13).atol(1e-13))
        .solve()
        .expect("the reference solver converges");
    let (_, reference) = solution.iter().next_back().expect("an end point");
    let mut integrator = Integrator::new(1e-10);
    let end = integrator
        .advance(&system.0, unflat(&start), 0.0, 0.5, &|_, _: &_| system.1, &mut Ledger::default())
        .expect("a benign motion");
    // Speeds up to 20 rad/s through two hundred steps with errors of 1e-10 relative.
    let error = distance(&end, &unflat(reference));
    assert!(error < 1e-7, "{error}: {end:?} against {reference:?}");
    // Steps are as long as accuracy allows, not as the iteration does.
    assert!(integrator.steps() < 250, "{} steps", integrator.steps());
}

/// Accelerations solve the equations of motion that the energy implies: the power balance, instant by instant, along
/// motions in every direction.
#[test]
fn accelerations_balance_power() {
    let (plant, u) = (chain(), Vector([3.0, -2.0, 1.0, 4.0]));
    let x = Motion {
        q_l: Vector([0.1, 0.8, -0.2, 0.9]),
        q_m: Vector([0.2, 0.9, -0.1, 1.1]),
        v_l: Vector([1.0, -2.0, 3.0, 0.5]),
        v_m: Vector([-1.0, 2.0, 4.0, 2.5]),
    };
    let [a_l, a_m] = plant.accelerations(&x, &u);
    // Central differences of fourth order along the motion: 1e-12 truncation, 1e-11 rounding.
    let at = |h: f64| {
        plant.total_energy(&Motion {
            q_l: x.q_l + x.v_l.scaled(h),
            q_m: x.q_m + x.v_m.scaled(h),
            v_l: x.v_l + a_l.scaled(h),
            v_m: x.v_m + a_m.scaled(h),
        })
    };
    let h = 1e-3;
    let rate = (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h);
    let power = plant.power(&x, &u);
    assert!(
        (rate - power.supplied + power.dissipated).abs() < 1e-6 * rate.abs(),
        "{rate} W against {power:?}"
    );
    assert!(rate.abs() > 1.0, "{rate} W");
}

/// Without gravity and damping the deflection of one joint is Duffing's oscillator, whose period is an elliptic
/// integral.
#[test]
fn a_hardening_spring_has_duffing_s_period() {
    let (inertia, motor, stiffness, hardening, amplitude) = (0.1, 0.03, 50.0, 2e4, 0.2);
    let plant = Plant {
        spring_hardening: Vector([hardening]),
        ..Plant::from(Fjr {
            links: Pendulum { inertia, weight_moment: 0.0 },
            motor_inertia: Vector([motor]),
            stiffness: Vector([stiffness]),
            link_damping: Vector([0.0]),
            motor_damping: Vector([0.0]),
        })
    };
    // μ ζ̈ + K ζ + k ζ³ = 0 from rest at A: T = 2π √μ / agm(√(K + ½ k A²), √(K + k A²)).
    let reduced: f64 = inertia * motor / (inertia + motor);
    let square: f64 = hardening * amplitude * amplitude;
    let (mut a, mut b) = ((stiffness + 0.5 * square).sqrt(), (stiffness + square).sqrt());
    for _ in 0..10 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    let period = 2.0 * PI * reduced.sqrt() / a;
    // Links and motor move against each other about a centre of mass that moves evenly.
    let drift = 0.3;
    let share = motor / (inertia + motor);
    let x = Motion {
        q_l: Vector([-share * amplitude]),
        q_m: Vector([(1.0 - share) * amplitude]),
        v_l: Vector([drift]),
        v_m: Vector([drift]),
    };
    let (mut integrator, mut ledger, mut now) = (Integrator::new(1e-10), Ledger::default(), x);
    for _ in 0..100 {
        now = integrator
            .advance(&plant, now, 0.0, period, &|_, _: &_| Vector([0.0]), &mut ledger)
            .expect("bounded");
    }
    let gone = Vector([100.0 * period * drift]);
    let expected = Motion { q_l: x.q_l + gone, q_m: x.q_m + gone, ..x };
    // A phase error of 1e-9 of 4 s where the acceleration is 1700 rad/s².
    let error = distance(&now, &expected);
    assert!(error < 5e-5, "{error}: {now:?} after {} steps", integrator.steps());
    let kept = plant.total_energy(&now) / plant.total_energy(&x);
    assert!((kept - 1.0).abs() < 1e-8, "{kept}");
}

#[test]
fn springs_give_what_they_are_asked_for() {
    let plant = arm();
    for torque in [[0.0, 0.0], [1e-3, -1e-3], [20.0, -30.0], [-1e6, 1e9]].map(Vector) {
        let held = Motion { q_m: plant.deflection_under(&torque), ..Motion::at_rest(Vector::ZERO) };
        let given = plant.spring_torque(&held);
        for i in 0..2 {
            assert!((given[i] - torque[i]).abs() <= 1e-14 * torque[i].abs(), "{given:?} for {torque:?}");
        }
    }
}

#[test]
fn an_undamped_chain_keeps_its_books_for_ten_seconds() {
    let plant = chain();
    let q_l = Vector([0.1, 0.8, -0.2, 0.9]);
    let x = Motion { q_m: q_l + Vector([0.1, -0.1, 0.1, -0.1]), ..Motion::at_rest(q_l) };
    assert!(plant.carries_its_rotors(&x.q_l));
    let torque =
        |t: f64, _: &Motion<f64, 4>| Vector([0.6 * t.sin(), 0.4 * (3.0 * t).cos(), -0.5 * t.cos(), 0.2]);
    let start = plant.total_energy(&x);
    let (mut integrator, mut ledger) = (Integrator::new(1e-10), Ledger::default());
    let (mut now, mut worst, mut bent) = (x, 0.0_f64, 0.0_f64);
    for k in 0..10_000 {
        let t = 1e-3 * f64::from(k);
        now = integrator.advance(&plant, now, t, 1e-3, &torque, &mut ledger).expect("bounded");
        worst = worst.max((plant.total_energy(&now) - start - ledger.supplied + ledger.dissipated).abs());
        bent = bent.max(now.deflection().iter().fold(0.0, |m: f64, x| m.max(x.abs())));
    }
    assert!(worst < 1e-9 * (start.abs() + ledger.throughput), "{worst} J of {start} J and {ledger:?}");
    // Hardening matters, and the steps are those of the control period.
    assert!(bent > 0.08, "{bent} rad");
    assert!(integrator.steps() < 12_000, "{} steps", integrator.steps());
}

#[test]
fn the_order_is_still_eight() {
    let plant = Plant { spring_hardening: Vector([90.0, 40.0]), ..arm() };
    let x =
        Motion { v_l: Vector([1.0, -2.0]), v_m: Vector([1.0, 1.0]), ..Motion::at_rest(Vector([0.3, 1.2])) };
    let run = |count| {
        let torque = |t: f64, _: &Motion<f64, 2>| Vector([2.0 * t.cos(), 1.0]);
        Integrator::new(1.0)
            .advance_uniformly(&plant, x, 1.0, (Order::Eight, count), &torque)
            .expect("smooth")
    };
    let reference = run(2048);
    let errors = [32, 64, 128].map(|count| distance(&run(count), &reference));
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((7.5..8.5).contains(&order), "order {order}, errors {errors:?}");
    }
    assert!(errors[2] < 1e-11, "{errors:?}");
}

/// Rotors that weigh more than the link that carries them are no robot.
#[test]
fn rotors_that_do_not_fit_are_seen() {
    let plant = arm();
    let light = Fjr { links: PlanarTwoLink::new([0.1, 0.1], 0.1, [0.05; 2], [1e-3; 2]), ..plant.robot };
    assert!(!Plant { robot: light, ..plant }.carries_its_rotors(&Vector::ZERO));
    assert!(Plant { robot: light, rotor_coupling: None, ..plant }.carries_its_rotors(&Vector::ZERO));
}

/// Options that are all zero are no options.
#[test]
fn an_ideal_plant_moves_as_its_model() {
    let plant = chain();
    let ideal = Plant::from(plant.robot);
    let still = Plant { rotor_coupling: Some(RotorCoupling { spin: Vector::ZERO }), ..ideal };
    let x = Motion { v_l: Vector([1.0, -2.0, 3.0, 0.5]), ..Motion::at_rest(Vector([0.1, 0.8, -0.2, 0.9])) };
    let u = Vector([1.0; 4]);
    let robot = &plant.robot;
    let exact = [robot.link_acceleration(&x), robot.motor_acceleration(&x, &u)];
    assert_eq!(ideal.accelerations(&x, &u), exact);
    for (side, exact) in still.accelerations(&x, &u).iter().zip(&exact) {
        assert!((*side - *exact).iter().all(|d| d.abs() < 1e-11), "{side:?} against {exact:?}");
    }
}
