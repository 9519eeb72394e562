//! Logs that cannot be used.

use flexure::identify::{Parameter, Settings, identify};
use flexure::logs::Log;
use flexure::progress::unwatched;

use super::arm;
use super::simulated::{Draw, log};

fn good() -> Log {
    let mut draw = Draw::new(1);
    let truth = draw.truth(&arm());
    log::<4>(&arm(), &truth, 3.0, 0.0, &mut draw)
}

/// The code of the first problem with `logs`.
fn code(logs: &[Log], settings: &Settings) -> &'static str {
    let problems = identify(&arm(), logs, settings, &unwatched).expect_err("a bad log");
    problems.iter().next().expect("a problem").code_word()
}

fn code_of(log: Log) -> &'static str {
    code(&[log], &Settings::default())
}

fn swapped(signal: &[f64]) -> Vec<f64> {
    signal.chunks_exact(2).flat_map(|pair| [pair[1], pair[0]]).collect()
}

#[test]
fn what_cannot_be_used_is_refused() {
    let log = good();
    let q = |side: &Option<Vec<f64>>| side.clone().unwrap();
    let changed = |change: &dyn Fn(usize, f64) -> f64| -> Vec<f64> {
        log.u_m.iter().enumerate().map(|(k, u)| change(k, *u)).collect()
    };
    // Columns that are others.
    assert_eq!(code_of(Log { u_m: swapped(&log.u_m), ..log.clone() }), "log-mismatch");
    assert_eq!(code_of(Log { q_l: log.q_m.clone(), q_m: log.q_l.clone(), ..log.clone() }), "log-mismatch");
    assert_eq!(code_of(Log { q_l: Some(swapped(&q(&log.q_l))), ..log.clone() }), "log-mismatch");
    let degrees = q(&log.q_m).iter().map(|x| x.to_degrees()).collect();
    assert_eq!(code_of(Log { q_m: Some(degrees), ..log.clone() }), "log-mismatch");
    assert_eq!(code_of(Log { u_m: changed(&|_, u| -u), ..log.clone() }), "log-mismatch");
    // The same where only motors are seen: what is in degrees, of another joint or another sign fits no inertia and friction.
    let motors = Log { q_l: None, ..log.clone() };
    assert_eq!(code_of(Log { u_m: swapped(&log.u_m), ..motors.clone() }), "log-mismatch");
    assert_eq!(code_of(Log { u_m: changed(&|_, u| -u), ..motors.clone() }), "log-mismatch");
    let degrees = q(&log.q_m).iter().map(|x| x.to_degrees()).collect();
    assert_eq!(code_of(Log { q_m: Some(degrees), ..motors }), "log-mismatch");
    assert_eq!(code(&[log.clone(), log.clone()], &Settings::default()), "log");
    // Signals with nothing in them, or too much.
    assert_eq!(code_of(Log { q_m: None, ..log.clone() }), "log");
    let still = q(&log.q_m).iter().enumerate().map(|(k, x)| if k % 2 == 1 { 0.3 } else { *x }).collect();
    assert_eq!(code_of(Log { q_m: Some(still), ..log.clone() }), "log");
    assert_eq!(code_of(Log { u_m: changed(&|_, u| u.clamp(-8.0, 8.0)), ..log.clone() }), "log-saturated");
    assert_eq!(
        code_of(Log { u_m: changed(&|k, u| if k == 77 { f64::NAN } else { u }), ..log.clone() }),
        "not-finite"
    );
    let refused =
        |log: Log| identify(&arm(), &[log], &Settings::default(), &unwatched).unwrap_err().to_string();
    let constant = refused(Log { u_m: changed(&|_, _| 0.0), ..log.clone() });
    assert!(constant.contains("is 0 N m in all samples"), "{constant}");
    // Samples that are too few or too far apart, logs that do not fit together.
    let short = |signal: &[f64]| signal[..800].to_vec();
    let cut = Log {
        q_l: Some(short(&q(&log.q_l))),
        q_m: Some(short(&q(&log.q_m))),
        u_m: short(&log.u_m),
        ..log.clone()
    };
    assert_eq!(code_of(cut), "log");
    assert_eq!(code_of(Log { period: 0.05, ..log.clone() }), "log");
    assert_eq!(code_of(Log { joints: 1, ..log.clone() }), "joints");
    assert_eq!(code(&[], &Settings::default()), "log");
    let other = Log { q_l: None, ..log.clone() };
    assert_eq!(code(&[log.clone(), other.clone()], &Settings::default()), "log");
    // Motors alone want a guess.
    let open = Settings { gaps: vec![(1, Parameter::Stiffness)], ..Settings::default() };
    assert_eq!(code(&[other], &open), "log");
}

#[test]
fn settings_have_ranges() {
    let log = [good()];
    for hold_out in [-0.1, 0.6, f64::NAN] {
        assert_eq!(code(&log, &Settings { hold_out, ..Settings::default() }), "range");
    }
    for accuracy in [0.0, 1.5, f64::NAN] {
        assert_eq!(code(&log, &Settings { accuracy, ..Settings::default() }), "range");
    }
}
