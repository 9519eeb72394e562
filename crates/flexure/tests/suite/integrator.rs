//! The plant integrator: order, stiff damping, stiff springs, energy, and an independent solver.

use differential_equations::prelude::{ExplicitRungeKutta, IVP, ODE};
use flexure::simulate::{Integrator, Ledger, Order};
use flexure_core::linalg::{Matrix, Vector};
use flexure_core::model::{Fjr, Links, Motion};
use flexure_core::robots::{Body, JointKind, Pendulum, PlanarTwoLink, Tree};

use crate::common::{Random, distance, exponential};

/// The paper's arm: motor damping over motor inertia is 9000 1/s.
fn quanser() -> Fjr<f64, PlanarTwoLink<f64>, 2> {
    Fjr {
        links: PlanarTwoLink::new([1.510, 0.873], 0.343, [0.159, 0.055], [0.0392, 0.00808]),
        motor_inertia: Vector([0.23, 0.01]),
        stiffness: Vector([9.0, 4.0]),
        link_damping: Vector([0.8, 0.55]),
        motor_damping: Vector([0.2, 90.0]),
    }
}

/// One joint without gravity: linear, so that a matrix exponential is its exact solution.
fn joint(inertia: f64, motor: f64, stiffness: f64, damping: [f64; 2]) -> Fjr<f64, Pendulum<f64>, 1> {
    Fjr {
        links: Pendulum { inertia, weight_moment: 0.0 },
        motor_inertia: Vector([motor]),
        stiffness: Vector([stiffness]),
        link_damping: Vector([damping[0]]),
        motor_damping: Vector([damping[1]]),
    }
}

/// The exact motion of a linear joint under a constant torque after `t`.
fn exact(robot: &Fjr<f64, Pendulum<f64>, 1>, x: &Motion<f64, 1>, u: f64, t: f64) -> [f64; 4] {
    let (m, b, k) = (robot.links.inertia, robot.motor_inertia[0], robot.stiffness[0]);
    let (d_l, d_m) = (robot.link_damping[0], robot.motor_damping[0]);
    let a = Matrix([
        [0.0, 0.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 1.0, 0.0],
        [-k / m, k / m, -d_l / m, 0.0, 0.0],
        [k / b, -k / b, 0.0, -d_m / b, u / b],
        [0.0; 5],
    ]);
    let y = exponential(&a.scaled(t)) * Vector([x.q_l[0], x.q_m[0], x.v_l[0], x.v_m[0], 1.0]);
    [y[0], y[1], y[2], y[3]]
}

fn flat(x: &Motion<f64, 1>) -> [f64; 4] {
    [x.q_l[0], x.q_m[0], x.v_l[0], x.v_m[0]]
}

fn advance<L: Links<f64, N> + Copy, const N: usize>(
    robot: &Fjr<f64, L, N>,
    x: Motion<f64, N>,
    interval: f64,
    u: Vector<f64, N>,
) -> (Motion<f64, N>, Ledger, u64) {
    let (mut integrator, mut ledger) = (Integrator::new(1e-10), Ledger::default());
    let end = integrator
        .advance(&(*robot).into(), x, 0.0, interval, &|_, _: &_| u, &mut ledger)
        .expect("a benign motion");
    (end, ledger, integrator.steps())
}

#[test]
fn the_order_is_eight() {
    let robot = Fjr { motor_damping: Vector([0.2, 0.5]), ..quanser() };
    let x =
        Motion { v_l: Vector([3.0, -5.0]), v_m: Vector([1.0, 4.0]), ..Motion::at_rest(Vector([0.3, 1.2])) };
    let run = |count| {
        let torque = |t: f64, _: &Motion<f64, 2>| Vector([2.0 * t.cos(), 1.0]);
        Integrator::new(1.0)
            .advance_uniformly(&robot.into(), x, 1.0, (Order::Eight, count), &torque)
            .expect("smooth")
    };
    let reference = run(1024);
    let errors = [16, 32, 64].map(|count| distance(&run(count), &reference));
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        // The asymptotic order is 8; these steps are long enough for errors far above rounding.
        assert!((7.0..9.0).contains(&order), "order {order}, errors {errors:?}");
    }
    assert!(errors[2] < 1e-9, "{errors:?}");
}

#[test]
fn the_lower_order_is_four() {
    let robot = Fjr { motor_damping: Vector([0.2, 0.5]), ..quanser() };
    let x =
        Motion { v_l: Vector([3.0, -5.0]), v_m: Vector([1.0, 4.0]), ..Motion::at_rest(Vector([0.3, 1.2])) };
    let run = |order, count| {
        let torque = |t: f64, _: &Motion<f64, 2>| Vector([2.0 * t.cos(), 1.0]);
        Integrator::new(1.0)
            .advance_uniformly(&robot.into(), x, 1.0, (order, count), &torque)
            .expect("smooth")
    };
    let reference = run(Order::Eight, 1024);
    let errors = [256, 512, 1024].map(|count| distance(&run(Order::Four, count), &reference));
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((3.8..4.2).contains(&order), "order {order}, errors {errors:?}");
    }
    assert!(errors[2] < 1e-8, "{errors:?}");
}

/// What a damper of 9000 1/s takes within one step of 1 ms is exact: a step knows the exponential.
#[test]
fn one_step_goes_through_a_stiff_damper() {
    let robot = joint(0.0107, 0.01, 4.0, [0.55, 90.0]);
    for order in [Order::Four, Order::Eight] {
        let mut x = Motion { v_m: Vector([0.5]), v_l: Vector([0.3]), ..Motion::at_rest(Vector([0.1])) };
        let mut worst = 0.0_f64;
        for k in 0..200 {
            // As much as a torque changes within a period of a loop.
            let u = 20.0 + 5.0 * (0.05 * f64::from(k)).sin();
            let expected = exact(&robot, &x, u, 1e-3);
            x = Integrator::new(1e-7)
                .advance_uniformly(&robot.into(), x, 1e-3, (order, 1), &|_, _: &_| Vector([u]))
                .expect("linear");
            for (got, expected) in flat(&x).iter().zip(expected) {
                worst = worst.max((got - expected).abs());
            }
        }
        let bound = if order == Order::Four { 2e-6 } else { 3e-8 };
        assert!(worst < bound, "{order:?}: {worst:e}");
    }
}

/// What an integrator keeps from step to step is of the plant that it moved.
#[test]
fn a_damper_that_changes_is_the_new_one() {
    let [mut integrator, mut other] = [Integrator::new(1e-10), Integrator::new(1e-10)];
    let start = Motion { v_m: Vector([0.5]), ..Motion::at_rest(Vector([0.1])) };
    let [before, after] = [9.0, 2.0].map(|damping| joint(0.0107, 0.01, 4.0, [0.55, damping]));
    let advance = |integrator: &mut Integrator<1>, robot: &Fjr<_, _, 1>, x| {
        integrator
            .advance(&(*robot).into(), x, 0.0, 1e-3, &|_, _: &_| Vector([0.2]), &mut Ledger::default())
            .expect("linear")
    };
    let x = advance(&mut integrator, &before, start);
    for (got, expected) in flat(&advance(&mut integrator, &after, x)).iter().zip(exact(&after, &x, 0.2, 1e-3))
    {
        assert!((got - expected).abs() < 1e-10, "{got} {expected}");
    }
    // Of another damper it would be seen.
    let [wrong, right] = [&before, &after].map(|robot| flat(&advance(&mut other, robot, x))[3]);
    assert!((wrong - right).abs() > 1e-3, "{wrong} {right}");
}

/// After each jump of the torque the motor's speed is another within a ninth of the step, and what its spring gives to the link
/// meanwhile adds up over the run.
#[test]
fn the_spring_feels_a_speed_that_is_damped_within_the_step() {
    let robot = joint(0.0107, 0.01, 4.0, [0.55, 90.0]);
    let mut integrator = Integrator::new(1e-7);
    let start = Motion::at_rest(Vector([0.1]));
    let (mut x, mut expected) = (start, start);
    for k in 0..1000 {
        let u = 20.0 * (5e-3 * f64::from(k)).sin();
        x = integrator
            .advance_uniformly(&robot.into(), x, 1e-3, (Order::Four, 1), &|_, _: &_| Vector([u]))
            .expect("linear");
        let [q_l, q_m, v_l, v_m] = exact(&robot, &expected, u, 1e-3).map(|x| Vector([x]));
        expected = Motion { q_l, q_m, v_l, v_m };
    }
    // With what the spring gives at the stages alone it is 2.2e-8 rad/s.
    let error = x.v_l[0] - expected.v_l[0];
    assert!(error.abs() < 1e-8, "{error:e} rad/s");
}

#[test]
fn stiff_damping_is_accurate_at_one_kilohertz() {
    // 90 N m s/rad on 0.01 kg m²: 9000 1/s, a transient that is over within the first of the 1 ms periods.
    let robot = joint(0.0107, 0.01, 4.0, [0.55, 90.0]);
    let x = Motion { v_m: Vector([10.0]), v_l: Vector([1.0]), ..Motion::at_rest(Vector([0.1])) };
    for (interval, u) in [(1e-4, 50.0), (1e-3, 50.0), (5e-3, -300.0)] {
        let (end, _, steps) = advance(&robot, x, interval, Vector([u]));
        for (got, expected) in flat(&end).iter().zip(exact(&robot, &x, u, interval)) {
            // Local errors of 1e-10 relative to speeds of 10 rad/s, a few dozen steps.
            assert!((got - expected).abs() < 1e-9, "{end:?} in {steps} steps, u = {u}");
        }
    }
}

#[test]
fn a_stiff_spring_on_a_light_wrist_neither_blows_up_nor_loses_energy() {
    // 5000 N m/rad on 1e-3 kg m² and an equally light rotor: 500 Hz, sampled at 1 kHz.
    let robot = joint(1e-3, 1e-3, 5000.0, [0.0, 0.0]);
    let x = Motion { q_m: Vector([0.01]), ..Motion::at_rest(Vector([0.0])) };
    let start = robot.total_energy(&x);
    let (mut integrator, mut ledger) = (Integrator::new(1e-10), Ledger::default());
    let mut now = x;
    for _ in 0..2000 {
        now = integrator
            .advance(&robot.into(), now, 0.0, 1e-3, &|_, _: &_| Vector([0.0]), &mut ledger)
            .expect("bounded");
    }
    // 1000 oscillations: amplitude and phase stay.
    assert!(
        (robot.total_energy(&now) / start - 1.0).abs() < 1e-9,
        "{} J of {start} J",
        robot.total_energy(&now)
    );
    for (got, expected) in flat(&now).iter().zip(exact(&robot, &x, 0.0, 2.0)) {
        assert!((got - expected).abs() < 1e-6 * 30.0, "{now:?} after {} steps", integrator.steps());
    }
}

#[test]
fn a_seven_joint_arm_keeps_its_energy() {
    // A chain with a light wrist, 5000 N m/rad everywhere, no damping: swings freely under gravity for a second.
    let bodies = std::array::from_fn(|i: usize| {
        let mass = 4.0 / f64::from(1 << i);
        let r = mass * 1e-3;
        Body {
            parent: i.checked_sub(1),
            kind: JointKind::Revolute,
            axis: [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0]][i % 2],
            rotation: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            translation: [0.0, 0.0, if i == 0 { 0.0 } else { 0.2 }],
            mass,
            com: [0.02, 0.01, 0.1],
            inertia: [[3.0 * r, 0.0, 0.0], [0.0, 3.0 * r, 0.0], [0.0, 0.0, r]],
        }
    });
    let robot = Fjr {
        links: Tree::new(&bodies, [0.0, 0.0, -9.81]).expect("a chain"),
        motor_inertia: Vector([0.6, 0.6, 0.4, 0.4, 0.2, 0.2, 0.2]),
        stiffness: Vector([5000.0; 7]),
        link_damping: Vector([0.0; 7]),
        motor_damping: Vector([0.0; 7]),
    };
    let x = Motion::at_rest(Vector([0.1, 0.8, -0.2, 0.9, 0.3, -0.7, 0.2]));
    let start = robot.total_energy(&x);
    let (mut integrator, mut ledger) = (Integrator::new(1e-10), Ledger::default());
    let (mut now, mut drift) = (x, 0.0_f64);
    for _ in 0..1000 {
        now = integrator
            .advance(&robot.into(), now, 0.0, 1e-3, &|_, _: &_| Vector::ZERO, &mut ledger)
            .expect("bounded");
        drift = drift.max((robot.total_energy(&now) - start).abs());
    }
    let speed = now.v_l.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    assert!(speed > 1.0, "the arm moves: {speed} rad/s");
    // Against the tens of joules that gravity turns into motion.
    assert!(drift < 1e-9 * start.abs(), "drift {drift} J of {start} J, {} steps", integrator.steps());
}

/// The plant as a first-order system for the reference solver.
struct Plant {
    robot: Fjr<f64, PlanarTwoLink<f64>, 2>,
    u: Vector<f64, 2>,
}

impl ODE<f64, [f64; 8]> for Plant {
    fn diff(&self, _: f64, y: &[f64; 8], dy: &mut [f64; 8]) {
        let x = unflat(y);
        let (a, b) = (self.robot.link_acceleration(&x), self.robot.motor_acceleration(&x, &self.u));
        *dy = [x.v_l[0], x.v_l[1], x.v_m[0], x.v_m[1], a[0], a[1], b[0], b[1]];
    }
}

fn unflat(y: &[f64; 8]) -> Motion<f64, 2> {
    Motion {
        q_l: Vector([y[0], y[1]]),
        q_m: Vector([y[2], y[3]]),
        v_l: Vector([y[4], y[5]]),
        v_m: Vector([y[6], y[7]]),
    }
}

#[test]
fn an_independent_solver_agrees() {
    let plant = Plant { robot: quanser(), u: Vector([5.0, 120.0]) };
    let start = [0.2, -0.4, 0.3, 0.1, 2.0, -3.0, 1.0, 8.0];
    let solution = IVP::ode(&plant, 0.0, 0.05, start)
        .method(ExplicitRungeKutta::dop853().rtol(1e-13).atol(1e-13))
        .solve()
        .expect("the reference solver converges");
    let (_, reference) = solution.iter().next_back().expect("an end point");
    let (end, _, _) = advance(&plant.robot, unflat(&start), 0.05, plant.u);
    // DOP853 at 1e-13 resolves the 9000 1/s damper with some 300 explicit steps.
    assert!(distance(&end, &unflat(reference)) < 1e-8, "{end:?} against {reference:?}");
}

#[test]
fn the_ledger_balances() {
    let robot = quanser();
    let x = Motion { v_l: Vector([3.0, -5.0]), ..Motion::at_rest(Vector([0.3, 1.2])) };
    let (end, ledger, _) = advance(&robot, x, 0.5, Vector([3.0, 40.0]));
    let stored = robot.total_energy(&end) - robot.total_energy(&x);
    let residual = stored - ledger.supplied + ledger.dissipated;
    assert!(residual.abs() < 1e-9 * ledger.throughput, "{residual} J of {ledger:?}");
    assert!(ledger.dissipated > 0.0 && ledger.supplied > 0.0);
}

/// A motor alone under its damper: what the damper takes is known.
#[test]
fn the_ledger_knows_what_a_stiff_damper_takes() {
    let robot = joint(1.0, 0.01, 1e-9, [0.0, 90.0]);
    let x = Motion { v_m: Vector([10.0]), ..Motion::at_rest(Vector([0.0])) };
    let (end, ledger, steps) = advance(&robot, x, 1e-3, Vector([45.0]));
    // q̇ = v + (w − v) e^(−λ t) with v = u / D: ∫ D q̇² dt and u Δq.
    let (rate, v, excess, t) = (9000.0_f64, 0.5, 9.5, 1e-3);
    let left = (-rate * t).exp();
    let first = excess * (1.0 - left) / rate;
    let dissipated =
        90.0 * (v * v * t + 2.0 * v * first + excess * excess * (1.0 - left * left) / (2.0 * rate));
    assert!((ledger.dissipated / dissipated - 1.0).abs() < 1e-9, "{ledger:?} {dissipated} {steps}");
    assert!((ledger.supplied / (45.0 * (v * t + first)) - 1.0).abs() < 1e-9, "{ledger:?}");
    assert!((end.q_m[0] - (v * t + first)).abs() < 1e-12, "{end:?}");
}

/// Loops at random: arms and gains of all kinds, from smooth to wild, held and continuous, some with torques that jump within the
/// intervals and with springs that harden.
#[test]
fn achieved_errors_follow_the_tolerance() {
    let mut r = Random(20);
    let mut worst = [0.0_f64; 3];
    for case in 0..60 {
        let mut between = |low: f64, high: f64| low * (high / low).powf(0.5 + 0.5 * r.next());
        let mut pair = |low, high| Vector([between(low, high), between(low, high)]);
        let robot = Fjr {
            motor_inertia: pair(0.005, 0.5),
            stiffness: pair(3.0, 3000.0),
            link_damping: pair(0.01, 1.0),
            motor_damping: pair(0.01, 100.0),
            ..quanser()
        };
        let hardening = if case % 3 == 0 { pair(1.0, 1e4) } else { Vector::ZERO };
        let plant = flexure::plant::Plant { spring_hardening: hardening, ..robot.into() };
        let (gain, rate) = (pair(1.0, 50.0), pair(0.5, 20.0));
        let jump = if case % 2 == 0 { 3.7e-3 * f64::from(case) } else { f64::INFINITY };
        let law = |t: f64, x: &Motion<f64, 2>| {
            let wave = Vector::from_fn(|k| (rate[k] * t).sin() + if t > jump { 0.5 } else { 0.0 });
            gain.diag_mul(&(wave - x.q_m - x.v_m.scaled(0.05)))
        };
        let x = Motion {
            v_l: Vector([r.next(), r.next()]).scaled(3.0),
            ..Motion::at_rest(Vector([r.next(), r.next()]))
        };
        let run = |tolerance: f64| {
            let (mut integrator, mut now) = (Integrator::new(tolerance), x);
            for k in 0..100 {
                let t = 5e-3 * f64::from(k);
                let held = law(t, &now);
                let held = |t: f64, x: &Motion<f64, 2>| if case % 4 < 2 { law(t, x) } else { held };
                now = integrator.advance(&plant, now, t, 5e-3, &held, &mut Ledger::default()).unwrap_or_else(
                    |failure| panic!("{case} {tolerance:e} {t} {failure:?} {robot:?} {gain:?}"),
                );
            }
            now
        };
        let reference = run(1e-13);
        let scale = 1.0 + distance(&reference, &Motion::at_rest(Vector::ZERO));
        for (worst, tolerance) in worst.iter_mut().zip([1e-5, 1e-7, 1e-9]) {
            // A torque that jumps is crossed by a step of 1e-5 of the interval whatever its error.
            let across = if jump.is_finite() { 2e-8 } else { 0.0 };
            *worst = worst.max(distance(&run(tolerance), &reference) / scale / (tolerance + across));
        }
    }
    assert!(worst.iter().all(|&error| error < 10.0), "{worst:?}");
    // Nor are steps much shorter than the tolerance asks for.
    assert!(worst[0] > 0.1, "{worst:?}");
}

#[test]
fn an_explosion_is_reported_where_it_happens() {
    let robot = quanser();
    let mut integrator = Integrator::new(1e-10);
    let torque = |t: f64, _: &Motion<f64, 2>| Vector([if t > 0.25 { f64::NAN } else { 1.0 }, 0.0]);
    let x = Motion::at_rest(Vector([0.0, 0.0]));
    let failure = integrator
        .advance(&robot.into(), x, 0.0, 1.0, &torque, &mut Ledger::default())
        .expect_err("NaN torque");
    // A step whose last stage lies before the explosion may end a little after it.
    assert!((0.24..0.26).contains(&failure.after), "{failure:?}");
}
