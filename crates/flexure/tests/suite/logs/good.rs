//! Logs that are read.

use std::f64::consts::TAU;

use flexure::Scenario;
use flexure::logs::{Columns, Log, read_log};
use flexure::simulate::{Trace, write_trace};

use super::{HEADER, read, row, sample, written};

/// The columns `pattern` of `trace`, row by row.
fn rows(trace: &Trace, pattern: &str) -> Vec<f64> {
    let columns: Vec<_> =
        (1..).map_while(|joint| trace.column(&pattern.replace("{}", &joint.to_string()))).collect();
    (0..trace.len()).flat_map(|k| columns.iter().map(move |column| column[k])).collect()
}

/// The log of a built-in scenario's trace, and the trace.
fn logged(name: &str, duration: f64) -> (Log, Trace) {
    let mut scenario = Scenario::load(name).unwrap();
    scenario.duration = duration;
    let trace = scenario.simulate().unwrap().trace;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("trace.csv");
    write_trace(&path, &trace).unwrap();
    let (log, warnings) = read_log(&path, &Columns::default(), &scenario.robot).unwrap();
    assert!(warnings.is_empty(), "{warnings:?}");
    (log, trace)
}

#[test]
fn a_trace_comes_back_to_the_bit() {
    let (log, trace) = logged("two-link-tanh-smooth", 0.3);
    assert_eq!((log.joints, log.samples()), (2, 301));
    assert!((log.period - 1e-3).abs() < 1e-15 && (log.duration() - 0.3).abs() < 1e-12);
    assert_eq!(log.q_l.unwrap(), rows(&trace, "q_l{}"));
    assert_eq!(log.q_m.unwrap(), rows(&trace, "q_m{}"));
    assert_eq!(log.dq_l.unwrap(), rows(&trace, "dq_l{}"));
    assert_eq!(log.dq_m.unwrap(), rows(&trace, "dq_m{}"));
    assert_eq!(log.u_m, rows(&trace, "u_m{}"));
}

/// A log of a real loop has what sensors and drives say, and nothing of the truth.
#[test]
fn a_trace_of_a_real_loop_gives_what_was_measured() {
    let (log, trace) = logged("task-encoder", 2.0);
    let (q_l, true_q_l) = (log.q_l.unwrap(), rows(&trace, "q_l{}"));
    assert_eq!(q_l, rows(&trace, "q_l_measured{}"));
    assert_ne!(q_l, true_q_l);
    // Whole counts: differences are multiples of the least one.
    let first: Vec<f64> = q_l.iter().step_by(2).copied().collect();
    let steps = || first.windows(2).map(|pair| (pair[1] - pair[0]).abs()).filter(|step| *step > 1e-9);
    let count = steps().fold(f64::INFINITY, f64::min);
    assert!(steps().count() > 3);
    assert!(steps().all(|step| (step / count - (step / count).round()).abs() < 1e-6), "{count}");
    assert_eq!(log.dq_m.unwrap(), rows(&trace, "dq_m_seen{}"));
    assert_eq!(log.u_m, rows(&trace, "u_m_measured{}"));
}

/// Drives report the torque that they believe to give, averaged over the period: late by a delay of one period and a half.
#[test]
fn the_reported_torque_is_late_and_believed() {
    let mut scenario = Scenario::load("two-link-tanh-smooth").unwrap();
    scenario.duration = 0.2;
    let text = "[[imperfection]]\nkind = \"delay\"\ncomputation = 0.0015\n[[imperfection]]\nkind = \"torque-gain\"\nfactor = 0.8\n";
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("s.toml");
    let built_in =
        flexure::files::SCENARIOS.iter().find(|(name, _)| *name == "two-link-tanh-smooth").unwrap().1;
    let at = built_in.find("[sources]").unwrap_or(built_in.len());
    std::fs::write(&file, format!("{}{text}{}", &built_in[..at], &built_in[at..])).unwrap();
    let mut late = Scenario::load(file.to_str().unwrap()).unwrap();
    late.duration = 0.2;
    let trace = late.simulate().unwrap().trace;
    let (command, reported) = (rows(&trace, "u_command{}"), rows(&trace, "u_m_measured{}"));
    let given = rows(&trace, "u_m{}");
    for k in 8..command.len() {
        let mean = 0.5 * (command[k - 2] + command[k - 4]);
        assert!(
            (reported[k] - mean).abs() < 1e-12 * (1.0 + mean.abs()),
            "{k}: {} is not {mean}",
            reported[k]
        );
        assert!((given[k] - 0.8 * command[k - 2]).abs() < 1e-12 * (1.0 + mean.abs()), "{k}");
    }
}

#[track_caller]
fn assert_same(read: &Log, expected: &Log) {
    let close = |a: &Option<Vec<f64>>, b: &Option<Vec<f64>>| match (a, b) {
        (Some(a), Some(b)) => a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12),
        (a, b) => a.is_none() && b.is_none(),
    };
    assert!((read.period - expected.period).abs() < 1e-12, "{} {}", read.period, expected.period);
    assert!(close(&read.q_l, &expected.q_l), "q_l");
    assert!(close(&read.q_m, &expected.q_m), "q_m");
    assert!(close(&Some(read.u_m.clone()), &Some(expected.u_m.clone())), "u_m");
}

/// Other names, units, signs, gears, separators and clocks: the same log.
#[test]
fn every_way_to_write_a_log_is_the_same_log() {
    let (expected, _) = read(&written(HEADER, row), None).unwrap();
    let of_motor = |k: usize| {
        let (_, q_l, q_m, u_m) = sample(k);
        let degrees = q_l.map(f64::to_degrees);
        let counts = [q_m[0] * 100.0 / TAU * 4096.0, q_m[1] * -80.0 / TAU * 4096.0];
        (degrees, counts, [-1e3 * u_m[0] / 100.0, 1e3 * u_m[1] / 80.0])
    };
    let semicolons = written("\u{feff}\"stamp\";a;b;m_1;m_2;\"tau 1\";\"tau 2\";note", |k| {
        let ([a, b], [c, d], [e, f]) = of_motor(k);
        format!("{};{a};{b};{c};{d};{e};{f};x", 1_732_300_000_000_000_000 + 1_000_000 * k as u64)
    });
    let scale = TAU / 4096.0;
    let inline = format!(
        "t=stamp,t.unit=ns,q_m=m_{{}},q_m.scale={scale},q_m.motor_side=true,u_m=tau {{}},u_m.unit=mN m,\
         u_m.motor_side=true,u_m.sign=-1,q_l.unit=deg,q_l=x"
    );
    let folder = tempfile::tempdir().unwrap();
    let map = folder.path().join("map.toml");
    let toml = format!(
        "t = {{ column = \"stamp\", unit = \"ns\" }}\nq_l = {{ columns = [\"a\", \"b\"], unit = \"deg\" }}\n\
         q_m = {{ columns = \"m_{{}}\", scale = {scale}, motor_side = true }}\n\
         u_m = {{ columns = \"tau {{}}\", unit = \"mN m\", motor_side = true, sign = [-1, -1] }}\n"
    );
    std::fs::write(&map, toml).unwrap();
    let (log, _) = read(&semicolons, map.to_str()).unwrap();
    assert_same(&log, &expected);
    // The same on one line, with names that a pattern gives.
    let renamed = semicolons.replacen(";a;b;", ";x1;x2;", 1);
    let (log, _) = read(&renamed, Some(&inline.replace("q_l=x", "q_l=x{}"))).unwrap();
    assert_same(&log, &expected);

    let tabs = written(&HEADER.replace(',', "\t"), |k| row(k).replace(',', "\t"));
    assert_same(
        &read(&format!("# a comment\r\n\r\n{}", tabs.replace('\n', "\r\n")), None).unwrap().0,
        &expected,
    );
    let in_ms = written(HEADER, |k| {
        let (_, rest) = row(k).split_once(',').map(|(t, rest)| (t.to_owned(), rest.to_owned())).unwrap();
        format!("{k},{rest}")
    });
    assert_same(&read(&in_ms, Some("t.unit=ms,q_l=q_l{},q_m=q_m{},u_m=u_m{}")).unwrap().0, &expected);
}

#[test]
fn a_side_that_reads_nothing_is_not_measured() {
    let header = "t,q_l1,q_l2,q_l_measured1,q_l_measured2,q_m_measured1,q_m_measured2,u_m1,u_m2";
    let text = written(header, |k| {
        let (t, [a, b], [c, d], [e, f]) = sample(k);
        format!("{t},{a},{b},NaN,NaN,{c},{d},{e},{f}")
    });
    let (log, _) = read(&text, None).unwrap();
    assert!(log.q_l.is_none() && log.dq_l.is_none());
    assert_eq!(log.q_m.unwrap()[..2], sample(0).2);
}
