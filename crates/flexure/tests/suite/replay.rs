//! A log over the simulation: nothing is missed where nothing differs, and what differs is found.
#![expect(clippy::float_cmp, reason = "exactness where it is promised")]

use flexure::Scenario;
use flexure::logs::Log;
use flexure::progress::unwatched;
use flexure::replay::{HORIZON, Replay, Residual, replay};
use flexure::simulate::Trace;

fn rows(trace: &Trace, name: &str) -> Vec<f64> {
    let columns = trace.joints(name);
    (0..trace.len()).flat_map(|k| columns.iter().map(move |column| column[k])).collect()
}

/// A log of both sides, from the signals of a trace with these names.
fn log(scenario: &Scenario, names: [&str; 3]) -> Log {
    let trace = scenario.simulate().unwrap().trace;
    let [q_l, q_m, u_m] = names.map(|name| rows(&trace, name));
    let (period, joints) = (scenario.control_period, scenario.robot.joint_count());
    Log {
        name: "log".to_owned(),
        period,
        joints,
        q_l: Some(q_l),
        q_m: Some(q_m),
        dq_l: None,
        dq_m: None,
        u_m,
    }
}

fn short(name: &str, duration: f64) -> Scenario {
    let mut scenario = Scenario::load(name).unwrap();
    scenario.duration = duration;
    scenario
}

fn laid(scenario: &Scenario, log: &Log, horizon: f64) -> Replay {
    replay(scenario, log, horizon, &unwatched).unwrap_or_else(|problems| panic!("{problems}"))
}

fn rms(residual: Option<Residual>) -> f64 {
    residual.expect("measured").rms
}

#[test]
fn a_run_is_its_own_replay() {
    let scenario = short("two-link-tanh-smooth", 3.0);
    let log = log(&scenario, ["q_l", "q_m", "u_m"]);
    let found = laid(&scenario, &log, HORIZON);
    assert_eq!((found.samples, found.joints.len()), (3001, 2));
    for joint in &found.joints {
        for residual in [joint.loop_q_l, joint.loop_q_m, joint.loop_deflection, joint.loop_u_m] {
            assert_eq!(rms(residual), 0.0);
            assert!(residual.unwrap().signal > 1e-3);
        }
        // Where a window starts is a cubic through samples: as exact as the motion is one.
        for residual in [joint.predicted_q_l, joint.predicted_q_m, joint.predicted_deflection] {
            assert!(rms(residual) < 2e-5, "{residual:?}");
        }
    }
    // A window as long as the log: the robot alone under the torques of its loop.
    let open = laid(&scenario, &log, 10.0);
    assert!(open.joints.iter().all(|joint| rms(joint.predicted_q_l) < 1e-3), "{:?}", open.joints);
    let residual = rows(&open.trace, "q_l_residual");
    let difference: Vec<f64> = rows(&open.trace, "q_l_predicted")
        .iter()
        .zip(log.q_l.as_ref().unwrap())
        .map(|(predicted, logged)| predicted - logged)
        .collect();
    assert_eq!(residual, difference);
}

/// The loop's residual of a log with encoders is their rounding: a count over √12.
#[test]
fn encoders_leave_their_rounding() {
    const COUNT: f64 = 1.533_980_787_885_641_2e-3;
    let scenario = short("two-link-hardware", 20.0);
    let found = laid(&scenario, &log(&scenario, ["q_l_measured", "q_m_measured", "u_m_measured"]), HORIZON);
    for joint in &found.joints {
        for residual in [joint.loop_q_l, joint.loop_q_m] {
            let share = rms(residual) / (COUNT / 12.0_f64.sqrt());
            // A thousand roundings that hardly depend on each other: 3 %.
            assert!((share - 1.0).abs() < 0.04, "{share}");
            assert!(residual.unwrap().max <= 0.5 * COUNT * (1.0 + 1e-9));
        }
    }
}

/// A spring that is softer than the model's shows in the deflection, in the joint that it is in.
#[test]
fn a_soft_spring_is_seen() {
    let scenario = short("two-link-tanh-smooth", 3.0);
    let mut robot = scenario.clone();
    robot.robot.stiffness[1] *= 0.8;
    let right = laid(&robot, &log(&robot, ["q_l", "q_m", "u_m"]), HORIZON);
    let wrong = laid(&scenario, &log(&robot, ["q_l", "q_m", "u_m"]), HORIZON);
    let deflection = |replay: &Replay, i: usize| rms(replay.joints[i].predicted_deflection);
    assert!(deflection(&wrong, 1) > 100.0 * deflection(&right, 1));
    let share = |i: usize| deflection(&wrong, i) / wrong.joints[i].predicted_deflection.unwrap().signal;
    assert!(share(1) > 0.03 && share(1) > 2.0 * share(0), "{} {}", share(0), share(1));
}

/// Other rates of the log, other lengths, one side alone.
#[test]
fn what_is_not_there_is_not_compared() {
    let scenario = short("two-link-tanh-smooth", 2.0);
    let whole = log(&scenario, ["q_l", "q_m", "u_m"]);
    let thinned = |values: &[f64]| values.chunks_exact(2).step_by(4).flatten().copied().collect::<Vec<_>>();
    let slow = Log {
        period: 4.0 * whole.period,
        q_l: whole.q_l.as_deref().map(thinned),
        q_m: None,
        u_m: thinned(&whole.u_m),
        ..whole.clone()
    };
    let found = laid(&scenario, &slow, HORIZON);
    assert!(found.joints.iter().all(|joint| rms(joint.loop_q_l) < 1e-12), "the same instants");
    assert!(
        found.joints.iter().all(|joint| joint.loop_q_m.is_none() && joint.predicted_deflection.is_none())
    );
    assert!(found.joints.iter().all(|joint| joint.predicted_q_l.is_some_and(|residual| residual.rms < 5e-2)));
    assert!(found.trace.column("q_m1").is_none() && found.trace.column("q_m_predicted1").is_some());
    // A log that goes on after the scenario's end.
    let found = laid(&short("two-link-tanh-smooth", 1.0), &whole, HORIZON);
    assert_eq!(found.samples, 2001);
    let closed = found.trace.column("q_l_loop1").unwrap();
    assert!(closed[..=1000].iter().all(|x| x.is_finite()) && closed[1001..].iter().all(|x| x.is_nan()));
    assert!(found.joints.iter().all(|joint| rms(joint.loop_q_l) == 0.0));
}

#[test]
fn what_does_not_fit_is_refused() {
    let scenario = short("two-link-tanh-smooth", 0.5);
    let log = log(&scenario, ["q_l", "q_m", "u_m"]);
    let other = Scenario::load("pendulum-tanh").unwrap();
    assert_eq!(
        replay(&other, &log, 0.1, &unwatched).unwrap_err().iter().next().unwrap().code_word(),
        "joints"
    );
    for horizon in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-4] {
        let problems = replay(&scenario, &log, horizon, &unwatched).unwrap_err();
        assert_eq!(problems.iter().next().unwrap().code_word(), "range", "{horizon}");
    }
}

fn refusal(scenario: &Scenario, log: &Log) -> Option<String> {
    let problems = replay(scenario, log, HORIZON, &unwatched).err()?;
    let problem = problems.into_iter().next().unwrap();
    assert_eq!(problem.code_word(), "log-mismatch");
    Some(problem.to_string())
}

/// Robots without limits, under gravity and without it; one with encoders.
const LOGGED: [(&str, [&str; 3]); 4] = [
    ("pendulum-tanh", ["q_l", "q_m", "u_m"]),
    ("planar-3r-tanh", ["q_l", "q_m", "u_m"]),
    ("two-link-tanh-smooth", ["q_l", "q_m", "u_m"]),
    ("two-link-hardware", ["q_l_measured", "q_m_measured", "u_m_measured"]),
];

/// Sides that are swapped and positions in degrees are refused; offsets of encoders and the wrong numbers that robot files have are not.
#[test]
fn logs_that_are_others_than_they_say_are_refused() {
    let mut doubted = 0;
    for (name, signals) in LOGGED {
        let mut scenario = short(name, 6.0);
        let log = log(&scenario, signals);
        assert_eq!(refusal(&scenario, &log), None, "{name}");
        let swapped = Log { q_l: log.q_m.clone(), q_m: log.q_l.clone(), ..log.clone() };
        let said = refusal(&scenario, &swapped).unwrap_or_else(|| panic!("{name}: swapped"));
        assert!(said.contains("links and motors swapped"), "{name}: {said}");
        let degrees = |q: &Option<Vec<f64>>| q.as_ref().map(|q| q.iter().map(|x| x.to_degrees()).collect());
        let in_degrees = Log { q_l: degrees(&log.q_l), q_m: degrees(&log.q_m), ..log.clone() };
        let said = refusal(&scenario, &in_degrees).unwrap_or_else(|| panic!("{name}: degrees"));
        assert!(said.contains("positions in degrees"), "{name}: {said}");
        let moved = log.q_m.as_ref().map(|q| q.iter().map(|x| x + 0.2).collect());
        assert_eq!(refusal(&scenario, &Log { q_m: moved, ..log.clone() }), None, "{name}: an offset");
        for (stiffness, inertia) in [(0.25, 1.0), (4.0, 1.0), (1.0, 0.3), (1.0, 3.0), (3.0, 3.0)] {
            let mut other = scenario.clone();
            other.robot.stiffness.iter_mut().for_each(|k| *k *= stiffness);
            other.robot.motor_inertia.iter_mut().for_each(|m| *m *= inertia);
            // The loop itself need not live with them.
            other.duration = 0.01;
            assert_eq!(
                refusal(&other, &log),
                None,
                "{name}: {stiffness} times stiffness, {inertia} times inertia"
            );
        }
        // Torques of the other sign are likely a mistake, no more.
        scenario.duration = 0.01;
        let against = Log { u_m: log.u_m.iter().map(|u| -u).collect(), ..log.clone() };
        let warnings = laid(&scenario, &against, HORIZON).warnings;
        let as_it_is = laid(&scenario, &log, HORIZON).warnings;
        assert!(as_it_is.is_empty() && warnings.len() <= 1, "{name}: {as_it_is:?} {warnings:?}");
        doubted += warnings.len();
        // So are torques of another scale: of one side of a gear, or in per cent of something.
        for factor in [0.5, 2.0] {
            let scaled = Log { u_m: log.u_m.iter().map(|u| factor * u).collect(), ..log.clone() };
            let warnings = laid(&scenario, &scaled, HORIZON).warnings;
            assert!(
                warnings.iter().any(|warning| warning.to_string().contains("other torques move it")),
                "{name}: {factor}"
            );
        }
    }
    assert!(doubted > 0);
}
