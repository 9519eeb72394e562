//! Estimators in the loop, compared on the plausible arm at 500 Hz.

use flexure::estimators::DisturbanceObserver;
use flexure::scenario::Scenario;
use flexure::simulate::Run;

use super::{ideal, simulate, with, with_these};

const COARSE: &str = "[[imperfection]]\nkind = \"encoder\"\nresolution = 1.534e-3\n";
const FILTER: &str =
    "[[imperfection]]\nkind = \"velocity-filter\"\norder = 2\ncutoff = 40.0\ndamping = 0.9\n";

fn scenario(text: &str) -> Scenario {
    with_these(ideal(8.0), with("two-link-tanh-smooth", 1.0, text).imperfections)
}

fn observed(text: &str, encoders: &str, bandwidth: f64) -> Scenario {
    let observer =
        format!("[estimator]\nkind = \"observer\"\nencoders = \"{encoders}\"\nbandwidth = {bandwidth}");
    let parts = with("two-link-tanh-smooth", 1.0, &format!("{text}{observer}"));
    let mut scenario = with_these(ideal(8.0), parts.imperfections);
    scenario.estimator = parts.estimator;
    scenario
}

/// Root mean square of the difference between the velocities that the law sees and those of the robot, from 2 s on [rad/s].
fn velocity_error(run: &Run) -> f64 {
    let t = run.trace.column("t").unwrap();
    let mut squares = Vec::new();
    for (seen, real) in ["dq_l_seen", "dq_m_seen"].iter().zip(["dq_l", "dq_m"]) {
        for (seen, real) in run.trace.joints(seen).iter().zip(run.trace.joints(real)) {
            squares.extend((0..t.len()).filter(|&k| t[k] > 2.0).map(|k| (seen[k] - real[k]).powi(2)));
        }
    }
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

/// With a good model an observer of 30 1/s sees velocities ten times better than the maker's filter, and with both encoders
/// better than with those of the motors alone.
#[test]
fn observers_see_velocities_that_filters_do_not() {
    let filtered = simulate(&scenario(&format!("{COARSE}{FILTER}")));
    let both = simulate(&observed(COARSE, "both", 30.0));
    let motor = simulate(&observed(
        &COARSE.replace("resolution", "placement = \"motor\"\nresolution"),
        "motor",
        30.0,
    ));
    let [filter, both_error, motor_error] = [&filtered, &both, &motor].map(velocity_error);
    println!(
        "rms velocity error: filter {filter}, observer {both_error}, motor encoders only {motor_error} rad/s"
    );
    assert!(10.0 * both_error < filter && 3.0 * motor_error < filter);
    for run in [&filtered, &both, &motor] {
        assert!(run.divergence.is_none() && run.summary.rms_e_l < 5e-3, "{:?}", run.summary);
    }
}

/// Drives that give too little torque: what the disturbance observer adds leaves less than a third of the error, and the torque that
/// it finds is the one that is missing.
#[test]
fn a_disturbance_observer_finds_what_the_drive_does_not_give() {
    let weak = "[[imperfection]]\nkind = \"torque-gain\"\nfactor = 0.9\n";
    let alone = simulate(&scenario(weak));
    let mut helped = scenario(weak);
    helped.disturbance_observer = Some(DisturbanceObserver { bandwidth: vec![40.0; 2], compensate: true });
    let helped_run = simulate(&helped);
    assert!(
        3.0 * helped_run.summary.rms_e_l < alone.summary.rms_e_l,
        "{} and {}",
        helped_run.summary.rms_e_l,
        alone.summary.rms_e_l
    );
    let mut watched = helped;
    watched.disturbance_observer = Some(DisturbanceObserver { bandwidth: vec![40.0; 2], compensate: false });
    // Only watching changes nothing.
    let watched = simulate(&watched);
    assert_eq!(watched.summary.rms_e_l.to_bits(), alone.summary.rms_e_l.to_bits());
}
