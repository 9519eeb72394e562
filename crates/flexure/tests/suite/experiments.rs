//! What an honest simulation of the paper's loop shows: theory, section 7.

use flexure::core::control::Input;
use flexure::core::linalg::Vector;
use flexure::core::model::{Fjr, Motion};
use flexure::core::robots::Tree;
use flexure::feasible;
use flexure::laws::law;
use flexure::plant;
use flexure::reproduce::REPRODUCED;
use flexure::robot::Links;
use flexure::scenario::load_scenario;
use flexure::scenario::{Hold, Integration, Scenario};
use flexure::simulate::Run;
use flexure::simulate::run;
use flexure::simulate::{Controller, Simulation, Timing};

/// To the last digits that runs are compared in.
const TIGHT: Integration = Integration::Collocation { tolerance: 1e-12 };

fn simulate(change: impl Fn(&mut Scenario), name: &str) -> Run {
    let mut scenario = load_scenario(name).expect("built in");
    change(&mut scenario);
    run(&scenario, &flexure::progress::unwatched).expect("a robot of two joints")
}

/// Largest |e_l| of any joint from `t` on [rad].
fn error_after(run: &Run, t: f64) -> f64 {
    let times = run.trace.column("t").expect("time");
    let errors = run.trace.joints("e_l");
    let late = (0..times.len()).filter(|&i| times[i] >= t);
    late.flat_map(|i| errors.iter().map(move |e| e[i].abs())).fold(0.0, f64::max)
}

#[test]
fn the_ideal_loop_tracks_at_one_kilohertz() {
    let run = simulate(|_| (), "two-link-tanh");
    assert!(run.divergence.is_none());
    // The hold leaves an error of first order in the period.
    assert!(error_after(&run, 4.0) < 1e-6, "{}", error_after(&run, 4.0));
    assert!((run.trace.column("t").expect("time").last().expect("an end") - 10.0).abs() < 1e-12);
}

#[test]
fn the_continuous_loop_tracks_to_rounding() {
    for name in ["two-link-tanh", "two-link-linear", "two-link-coupled-tanh"] {
        let run = simulate(|s| (s.hold, s.duration, s.integration) = (Hold::Continuous, 6.0, TIGHT), name);
        assert!(error_after(&run, 4.0) < 1e-11, "{name}: {}", error_after(&run, 4.0));
    }
}

#[test]
fn the_error_left_by_the_hold_shrinks_with_the_period() {
    let error = |period: f64| error_after(&simulate(|s| s.control_period = period, "two-link-tanh"), 4.0);
    let (coarse, fine) = (error(1e-3), error(5e-4));
    let order = (coarse / fine).log2();
    assert!((0.8..2.3).contains(&order), "order {order}: {coarse}, {fine}");
}

#[test]
fn power_balances_in_every_experiment() {
    for name in REPRODUCED {
        let run = simulate(|_| (), name);
        assert!(run.summary.energy_drift < 1e-9, "{name}: {}", run.summary.energy_drift);
        assert!(run.divergence.is_none(), "{name}");
    }
}

#[test]
fn a_smooth_start_needs_a_hundredth_of_the_torque() {
    let (rough, smooth) = (simulate(|_| (), "two-link-tanh"), simulate(|_| (), "two-link-tanh-smooth"));
    assert!(rough.summary.max_abs_u_m > 1e3, "thousands of N m: {}", rough.summary.max_abs_u_m);
    assert!(smooth.summary.max_abs_u_m < 0.01 * rough.summary.max_abs_u_m, "{}", smooth.summary.max_abs_u_m);
    assert!(smooth.summary.max_abs_e_l < 1e-4, "{}", smooth.summary.max_abs_e_l);
}

#[test]
fn five_hundred_hertz_is_too_slow_for_the_paper_s_gains() {
    let run = simulate(|s| s.control_period = 2e-3, "two-link-tanh");
    let divergence = run.divergence.expect("the loop diverges");
    assert!(divergence.time > 0.0 && divergence.time < 10.0, "{divergence:?}");
    // What was recorded before is kept, and finite.
    assert!(!run.trace.is_empty());
    assert!(run.trace.columns().iter().all(|c| c.values.iter().all(|x| x.is_finite())));
    assert_eq!(run.summary.settling_time, None);
}

#[test]
fn every_built_in_scenario_runs_to_its_end_and_settles() {
    for (name, _) in flexure::files::SCENARIOS {
        let run = simulate(|_| (), name);
        assert!(run.divergence.is_none(), "{name}: {:?}", run.divergence);
        // With its sensors this one stays within millirads, not within one: `practical.rs`.
        let settles = run.summary.settling_time.is_some() || *name == "two-link-coupled-tanh-sensors";
        assert!(settles && run.summary.following.follows, "{name}: {:?}", run.summary);
        assert!(run.summary.rate_pointwise > 0.0, "{name}: {:?}", run.summary);
    }
}

#[test]
fn runs_repeat_bit_by_bit() {
    let (a, b) = (simulate(|_| (), "two-link-coupled-tanh"), simulate(|_| (), "two-link-coupled-tanh"));
    for (x, y) in a.trace.columns().iter().zip(b.trace.columns()) {
        let same = x.values.iter().zip(&y.values).all(|(x, y)| x.to_bits() == y.to_bits());
        assert!(same, "{}", x.name);
    }
}

#[test]
fn trace_and_summary_say_what_happened() {
    let run = simulate(|_| (), "two-link-tanh");
    let column = |name: &str| run.trace.column(name).expect("recorded");
    let (t, q_l, q_ld, e_l) = (column("t"), column("q_l1"), column("q_ld1"), column("e_l1"));
    for i in 0..t.len() {
        assert!((q_ld[i] - t[i].sin()).abs() < 1e-12, "the reference at {}", t[i]);
        assert!((q_l[i] - q_ld[i] - e_l[i]).abs() < 1e-12);
    }
    // The settling time, found again from its definition.
    let errors = run.trace.joints("e_l");
    let unsettled =
        (0..t.len()).rev().find(|&i| errors.iter().any(|e| e[i].abs() >= flexure::simulate::SETTLED));
    let settled = unsettled.map_or(0.0, |i| t[i + 1]);
    assert_eq!(run.summary.settling_time, Some(settled));
    let largest = errors.iter().flat_map(|e| e.iter()).fold(0.0, |m: f64, e| m.max(e.abs()));
    assert!((run.summary.max_abs_e_l - largest).abs() < 1e-15);
    let mean_square = |e: &[f64]| e.iter().map(|x| x * x).sum::<f64>() / e.len() as f64;
    let rms = errors.iter().map(|e| mean_square(e)).fold(0.0, f64::max).sqrt();
    assert!((run.summary.rms_e_l / rms - 1.0).abs() < 1e-12);
}

#[test]
fn the_continuous_loop_starts_from_rest_on_the_reference() {
    // Exactly at rest, corrections of the stage equations are rounding of torques that cancel.
    for name in ["two-link-tanh-smooth", "two-link-linear-smooth", "two-link-coupled-tanh-smooth"] {
        let run = simulate(|s| (s.hold, s.duration, s.integration) = (Hold::Continuous, 5.0, TIGHT), name);
        assert!(run.divergence.is_none(), "{name}: {:?}", run.divergence);
        assert!(error_after(&run, 4.0) < 1e-11, "{name}: {}", error_after(&run, 4.0));
    }
}

#[test]
fn an_arm_that_has_come_to_rest_costs_no_more_than_one_that_moves() {
    use flexure::references::{PointToPoint, Profile, Reference};
    for (name, hold) in [
        ("pendulum-tanh", Hold::ZeroOrder),
        ("panda-tanh-smooth", Hold::ZeroOrder),
        ("two-link-tanh", Hold::Continuous),
    ] {
        let run = simulate(
            |s| {
                let from = s.initial.q_l.clone();
                let to = from.iter().map(|q| q + 0.4).collect();
                (s.smooth_start, s.duration, s.hold) = (None, 4.0, hold);
                s.reference = Reference::PointToPoint(PointToPoint {
                    profile: Profile::Septic,
                    from,
                    to,
                    start: 0.2,
                    duration: 1.0,
                });
            },
            name,
        );
        assert!(run.divergence.is_none(), "{name}: {:?}", run.divergence);
        // 4000 control periods of a few steps each.
        assert!(run.summary.steps < 60_000, "{name}: {} steps", run.summary.steps);
        assert!(run.summary.energy_drift < 1e-9, "{name}: {}", run.summary.energy_drift);
        assert!(run.summary.final_abs_e_l < 1e-5, "{name}: {}", run.summary.final_abs_e_l);
    }
}

/// The arm of `panda-tanh-smooth` under gravity times `factor` while its law believes in the file's: |e_l| from 2 s on.
fn seven_joints_with_gravity_off_by(factor: f64) -> f64 {
    let scenario = load_scenario("panda-tanh-smooth").expect("built in");
    let robot = |factor: f64| {
        let data = &scenario.robot;
        let Links::Tree(bodies) = &data.links else { panic!("a tree") };
        let vector = |values: &[f64]| Vector::<f64, 7>::from_fn(|i| values[i]);
        Fjr {
            links: Tree::new(&std::array::from_fn(|i| bodies[i]), data.gravity.map(|g| factor * g))
                .expect("a tree"),
            motor_inertia: vector(&data.motor_inertia),
            stiffness: vector(&data.stiffness),
            link_damping: vector(&data.link_damping),
            motor_damping: vector(&data.motor_damping),
        }
    };
    let (plant, model) = (plant::Plant::from(robot(factor)), robot(1.0));
    let (law, reference) =
        (law::<7>(scenario.vcbc().expect("v-CBC")), feasible::reference::<7>(&scenario).expect("a path"));
    let known = model;
    let torque =
        move |_: f64, x: &Motion<f64, 7>, q_ld: &Vector<_, 7>| law.command(&known, x, q_ld, &Input::ZERO).u_m;
    let q = |values: &[f64]| Vector::from_fn(|i| values[i]);
    let (q_l, q_m) = (q(&scenario.initial.q_l), q(&scenario.initial.q_m));
    let start = Motion { q_l, q_m, ..Motion::at_rest(q_l) };
    let controller = Controller::ideal(model, reference, torque);
    let mut simulation = Simulation::new(Timing::sampled(1e-3), plant, start, Vec::new(), controller);
    let mut error = 0.0_f64;
    for _ in 0..=4000 {
        if simulation.step().is_err() {
            return f64::INFINITY;
        }
        let instant = simulation.instant().expect("after a step");
        if instant.t >= 2.0 {
            let e_l = instant.motion.q_l - instant.action.reference.map(|jet| jet.coefficient(0));
            error = e_l.iter().fold(error, |worst, e| worst.max(e.abs()));
        }
    }
    error
}

#[test]
fn a_seven_joint_arm_under_gravity_tracks_to_a_microradian() {
    let run = simulate(|_| (), "panda-tanh-smooth");
    assert!(run.divergence.is_none());
    let error = error_after(&run, 2.0);
    assert!(error < 3e-7, "a third of what is asked for: {error}");
    // It does move, and without effort beyond the motors.
    for (k, q) in run.trace.joints("q_l").iter().enumerate() {
        let (low, high) = q.iter().fold((f64::MAX, f64::MIN), |(low, high), q| (low.min(*q), high.max(*q)));
        assert!((high - low - 0.6).abs() < 0.01, "joint {k}: from {low} to {high}");
    }
    assert_eq!(run.summary.saturated_fraction.to_bits(), 0.0_f64.to_bits());
    // The hold leaves this error: it is proportional to the period.
    let fine = error_after(&simulate(|s| s.control_period = 5e-4, "panda-tanh-smooth"), 2.0);
    assert!((1.8..2.2).contains(&(error / fine)), "{error} at 1 ms, {fine} at 0.5 ms");
}

/// The same error as above in the same loop put together by hand; a law that is wrong about gravity does not reach it.
#[test]
fn a_microradian_needs_the_right_gravity() {
    let exact = seven_joints_with_gravity_off_by(1.0);
    assert!(exact < 3e-7, "{exact}");
    let per_mille = seven_joints_with_gravity_off_by(1.001);
    assert!(per_mille > 1e-6, "a thousandth of gravity is seen: {per_mille}");
    let sign = seven_joints_with_gravity_off_by(-1.0);
    assert!(sign > 1e-4, "{sign}");
}
