//! The numbers of simulated arms come back.

use flexure::Robot;
use flexure::identify::{Identified, Parameter, Settings, identify};
use flexure::logs::Log;
use flexure::progress::unwatched;

use super::arm;
use super::simulated::{DELAY, Draw, Truth, log};

/// Largest relative errors that are promised, in the order of the parameters.
const PROMISED: [f64; 6] = [0.005, 0.01, 0.1, 0.1, 0.05, 0.05];

fn found(log: Log) -> Identified {
    identify(&arm(), &[log], &Settings::default(), &unwatched).unwrap_or_else(|problems| panic!("{problems}"))
}

fn case(seconds: f64) -> (Truth, Log) {
    let mut draw = Draw::new(3);
    let truth = draw.truth(&arm());
    let log = log::<4>(&arm(), &truth, seconds, 0.0, &mut draw);
    (truth, log)
}

#[test]
fn with_encoders_on_both_sides() {
    let (truth, log) = case(8.0);
    let found = found(log);
    assert!(found.converged && found.missing().is_empty(), "{found:?}");
    for (i, joint) in truth.iter().enumerate() {
        for (parameter, (exact, promised)) in Parameter::ALL.into_iter().zip(joint.iter().zip(PROMISED)) {
            let estimate = found.estimate(i, parameter);
            let off = (estimate.value - exact).abs();
            assert!(off < promised * exact, "{parameter:?} of joint {i}: {estimate:?} for {exact}");
            // Thirteen numbers at once: four standard deviations are left by one in a thousand.
            assert!(off < 4.0 / 3.0 * estimate.error, "{parameter:?} of joint {i}: {estimate:?} for {exact}");
            assert!(estimate.error < exact * 2.0 * promised, "{parameter:?} of joint {i}: {estimate:?}");
        }
    }
    let offset = &found.offsets[0];
    assert!((offset.value - DELAY).abs() < offset.error.max(1e-6) && offset.error < 2e-5, "{offset:?}");
    // What was kept from the fit is predicted as well as what was fitted.
    assert!(found.joints.iter().all(|joint| (0.8..1.25).contains(&joint.held_out.unwrap())), "{found:?}");
}

#[test]
fn with_motor_encoders_alone() {
    let (truth, log) = case(8.0);
    let found = found(Log { q_l: None, ..log });
    for (i, joint) in truth.iter().enumerate() {
        let [stiffness, inertia] =
            [Parameter::Stiffness, Parameter::MotorInertia].map(|parameter| found.estimate(i, parameter));
        assert!((stiffness.value / joint[0] - 1.0).abs() < 0.03, "{stiffness:?} for {}", joint[0]);
        assert!((inertia.value / joint[1] - 1.0).abs() < 0.03, "{inertia:?} for {}", joint[1]);
    }
}

/// Stiffness of every joint, through valleys in which joints about nearly the same axis trade theirs, and past dents in which that
/// of a light last link is another (seeds 0, 2 and 4):
/// `cargo test --release -p flexure --test suite -- --ignored seven_joints_with_motor --nocapture`.
#[test]
#[ignore = "minutes of processor time in release, many without"]
fn seven_joints_with_motor_encoders_alone() {
    let robot = Robot::load("panda").unwrap();
    for seed in 0..5 {
        let mut draw = Draw::new(seed);
        let truth = draw.truth(&robot);
        let log = Log { q_l: None, ..log::<8>(&robot, &truth, 20.0, 0.0, &mut draw) };
        let begun = std::time::Instant::now();
        let found = identify(&robot, &[log], &Settings::default(), &unwatched)
            .unwrap_or_else(|problems| panic!("{problems}"));
        let took = begun.elapsed();
        assert!(found.converged, "seed {seed}");
        let offs = truth.iter().enumerate().map(|(i, joint)| {
            let stiffness = found.estimate(i, Parameter::Stiffness);
            let off = (stiffness.value - joint[0]).abs();
            assert!(off < 0.03 * joint[0], "{stiffness:?} for {}", joint[0]);
            assert!(off < 4.0 / 3.0 * stiffness.error, "{stiffness:?} for {}", joint[0]);
            off / joint[0]
        });
        let most = offs.fold(0.0, f64::max);
        println!("seed {seed}: stiffness within {:.2} % in {:.0} s", 100.0 * most, took.as_secs_f64());
    }
}

/// Sums are in the order of the log, whatever the threads do.
#[test]
fn the_same_bits_on_any_number_of_threads() {
    let (_, log) = case(9.0);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let found = pool.install(|| found(log.clone()));
        found
            .joints
            .iter()
            .flat_map(|joint| joint.parameters.iter().map(|p| p.value.to_bits()))
            .collect::<Vec<_>>()
    };
    assert_eq!(on(1), on(3));
}
