//! The motion for identification: inside every limit, periodic, every joint with lines of its own; and it tells what it says.

use std::collections::BTreeSet;
use std::path::Path;

use flexure::excite::{Excitation, Settings, excite};
use flexure::feasible;
use flexure::files::{Outside, Problems};
use flexure::progress::unwatched;
use flexure::scenario::{Scenario, scenario_from_text};

const SETTINGS: Settings = Settings {
    duration: 8.0,
    control_period: 0.002,
    budget: 20,
    seed: 1,
    posture: None,
    link_resolution: Some(5e-5),
    motor_resolution: 2e-5,
};

fn designed(robot: &str, settings: &Settings) -> Result<Excitation, Problems> {
    excite(robot, Path::new("motion.toml"), Outside::Refused, settings, &unwatched)
}

fn good(settings: &Settings) -> Excitation {
    designed("two-link-plausible", settings).unwrap_or_else(|problems| panic!("{problems}"))
}

fn scenario(found: &Excitation) -> Scenario {
    scenario_from_text("motion.toml", &found.toml, Path::new("."))
        .unwrap_or_else(|problems| panic!("{problems}"))
}

#[test]
fn it_is_a_scenario_inside_all_limits_that_a_loop_follows() {
    let found = good(&SETTINGS);
    assert!(found.objections.is_empty(), "{:?}", found.objections);
    assert!(found.run.following.follows);
    let scenario = scenario(&found);
    let usage = feasible::usage(&scenario).unwrap();
    assert!(!usage.is_empty());
    assert!(usage.iter().all(|usage| usage.share <= 0.81), "{usage:?}");
    // Not a motion that keeps limits by standing still.
    for joint in 0..2 {
        let most =
            usage.iter().filter(|usage| usage.joint == joint).map(|usage| usage.share).fold(0.0, f64::max);
        assert!(most > 0.25, "joint {joint}: {most}");
    }
}

#[test]
fn joints_have_lines_of_their_own_around_their_swing() {
    let found = good(&SETTINGS);
    let harmonics = |i: usize| -> BTreeSet<i64> {
        let number = |line: &flexure::excite::Line| {
            let number = line.frequency * found.period;
            assert!((number - number.round()).abs() < 1e-9, "whole periods");
            #[expect(clippy::cast_possible_truncation, reason = "small")]
            let whole = number.round() as i64;
            whole
        };
        found.joints[i].lines.iter().map(number).collect()
    };
    assert!(harmonics(0).is_disjoint(&harmonics(1)));
    for joint in &found.joints {
        let (first, last) = (joint.lines.first().unwrap(), joint.lines.last().unwrap());
        assert!(first.frequency < 1.0 && last.frequency > 1.2 * joint.resonance, "{joint:?}");
    }
}

#[test]
fn it_is_repeatable_and_more_phases_give_lower_peaks() {
    let found = good(&SETTINGS);
    assert_eq!(found.toml, good(&SETTINGS).toml);
    assert_ne!(found.toml, good(&Settings { seed: 2, ..SETTINGS }).toml);
    let more = good(&Settings { budget: 300, ..SETTINGS });
    assert!(more.joints.iter().all(|joint| joint.error_bars.stiffness.is_finite()));
}

/// The motion is about the posture that is asked for, and begins there at rest.
#[test]
fn the_posture_is_the_one_that_is_asked_for() {
    let about = |posture: &[f64]| good(&Settings { posture: Some(posture.to_vec()), ..SETTINGS });
    let asked = [-0.75, 0.5];
    let found = about(&asked);
    let initial = scenario(&found).initial;
    assert_eq!((initial.q_l, initial.q_m), (asked.to_vec(), asked.to_vec()), "no gravity bends its springs");
    assert!(found.toml.contains("offset = [-0.75, 0.5]"), "{}", found.toml);
    let usage = feasible::usage(&scenario(&found)).unwrap();
    assert!(usage.iter().all(|usage| usage.share <= 0.81), "{usage:?}");
}

/// Error bars grow with the steps of the encoders, at most as these do: noise of the torque has its part.
#[test]
fn error_bars_grow_with_the_steps_of_encoders() {
    let stiffness = |settings: &Settings| good(settings).joints[1].error_bars.stiffness;
    let steps = |factor: f64| Settings {
        link_resolution: Some(factor * 5e-5),
        motor_resolution: factor * 2e-5,
        ..SETTINGS
    };
    let bars: Vec<f64> = [0.01, 0.1, 1.0, 10.0].map(|factor| stiffness(&steps(factor))).into();
    for pair in bars.windows(2) {
        // Amplitudes are chosen anew: not to the last per cent.
        assert!(pair[1] > 0.99 * pair[0] && pair[1] < 10.5 * pair[0], "{bars:?}");
    }
    assert!(bars[3] > 3.0 * bars[2], "coarse encoders decide: {bars:?}");
    let motors = Settings { link_resolution: None, ..SETTINGS };
    assert!(stiffness(&motors) > bars[2]);
}

#[test]
fn what_cannot_be_moved_is_refused() {
    let code = |robot: &str, settings: &Settings| {
        designed(robot, settings).unwrap_err().iter().next().unwrap().code_word().to_owned()
    };
    let wrong = [
        Settings { duration: 0.5, ..SETTINGS },
        Settings { duration: f64::NAN, ..SETTINGS },
        Settings { control_period: 0.0, ..SETTINGS },
        Settings { control_period: 1.0, ..SETTINGS },
        Settings { budget: 0, ..SETTINGS },
        Settings { motor_resolution: 0.0, ..SETTINGS },
        Settings { link_resolution: Some(f64::NAN), ..SETTINGS },
        Settings { posture: Some(vec![0.0, f64::NAN]), ..SETTINGS },
        Settings { posture: Some(vec![0.0, f64::INFINITY]), ..SETTINGS },
    ];
    for settings in &wrong {
        assert_eq!(code("two-link-plausible", settings), "range", "{settings:?}");
    }
    assert_eq!(code("two-link-plausible", &Settings { posture: Some(vec![0.0]), ..SETTINGS }), "joints");
    assert_eq!(code("pendulum-1dof", &SETTINGS), "missing-key");
    assert_eq!(code("none.toml", &SETTINGS), "unreadable");
}
