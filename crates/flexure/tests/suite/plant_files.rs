//! `[plant]` of scenario files: refused at the right place, run as written, and said in the results.

use std::fs;

use flexure::files::{Problem, Problems};
use flexure::report::html;
use flexure::report::{WIDTH, summary_table};
use flexure::reproduce::{Experiment, report};
use flexure::scenario::{Plant, Scenario, scenario_from_text};
use flexure::simulate::preload;
use flexure::simulate::run;
use tempfile::TempDir;

use crate::common::place;

const QUANSER: &str = include_str!("../../../../robots/quanser-2dof.toml");
const PENDULUM: &str = include_str!("../../../../robots/pendulum-1dof.toml");

const GEARS: &str = "gear_ratio = [100.0, -50.0]";

const SCENARIO: &str = r#"robot = "arm.toml"
duration = 0.5
control_period = 0.001
[reference]
kind = "sine"
amplitude = 0.3
frequency = 3.0
[reference.smooth_start]
duration = 0.3
[plant]
rotor_coupling = true
spring_hardening = [100.0, 50]
[controller]
kind = "vcbc"
phi = "tanh"
[controller.link]
metric = 50.0
shaping = 50.0
damping = 10.0
[controller.motor]
metric = 60.0
shaping = 60.0
damping = 10.0
"#;

/// A folder with the paper's arm, with `gears` between its joints.
fn folder(gears: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let robot = QUANSER.replace("[joints]\n", &format!("[joints]\n{gears}\n"));
    fs::write(folder.path().join("arm.toml"), robot).unwrap();
    folder
}

fn read_with(gears: &str, scenario: &str) -> Result<Scenario, Problems> {
    scenario_from_text("s.toml", scenario, folder(gears).path())
}

fn read(scenario: &str) -> Result<Scenario, Problems> {
    read_with(GEARS, scenario)
}

fn simulated(scenario: &Scenario) -> flexure::simulate::Run {
    run(scenario, &flexure::progress::unwatched).unwrap_or_else(|problems| panic!("{problems}"))
}

#[test]
fn options_are_read() {
    let plant = |text: &str| read(text).unwrap_or_else(|problems| panic!("{problems}")).plant;
    let both = plant(SCENARIO);
    assert_eq!(both.rotor_coupling.as_deref(), Some(&[100.0, -50.0][..]));
    assert_eq!(both.spring_hardening.as_deref(), Some(&[100.0, 50.0][..]));
    assert_eq!(both.options(), ["rotor_coupling", "spring_hardening"]);
    // One number stands for all joints; false is the default, and no plant at all is the ideal one.
    let scalar = plant(&SCENARIO.replace("[100.0, 50]", "70").replace("true", "false"));
    assert_eq!(scalar, Plant { spring_hardening: Some(vec![70.0; 2]), ..Plant::default() });
    let (before, rest) = SCENARIO.split_once("[plant]").unwrap();
    let (_, after) = rest.split_once("[controller]").unwrap();
    for ideal in [format!("{before}[plant]\n[controller]{after}"), format!("{before}[controller]{after}")] {
        assert_eq!(plant(&ideal), Plant::default());
    }
}

#[test]
fn bad_plants() {
    for (from, to, at, fragment) in [
        ("rotor_coupling", "rotor_couplings", "rotor_couplings", "unknown key 'rotor_couplings' in [plant]"),
        ("= true", "= \"yes\"", "\"yes\"", "plant.rotor_coupling is text, must be true or false"),
        ("= true", "= 1", "1\nspring", "plant.rotor_coupling is a number, must be true or false"),
        ("= true", "= [true, true]", "[true", "plant.rotor_coupling is an array"),
        ("50]", "-50]", "-50]", "plant.spring_hardening[1] is -50 N m/rad^3, must be >= 0"),
        ("50]", "nan]", "nan]", "plant.spring_hardening[1] is nan N m/rad^3, must be a number"),
        ("50]", "inf]", "inf]", "plant.spring_hardening[1] is inf N m/rad^3"),
        ("50]", "50, 0]", "[100.0, 50, 0]", "2 numbers expected, one per joint of quanser-2dof; got 3"),
        ("[100.0, 50]", "\"stiff\"", "\"stiff\"", "plant.spring_hardening is text, must be a number"),
        ("[plant]", "[[plant]]", "[[plant]]", "plant is an array, must be a table"),
        ("[plant]", "[plants]", "plants", "unknown key 'plants'"),
    ] {
        assert!(SCENARIO.contains(from));
        let text = SCENARIO.replacen(from, to, 1);
        let problems = read(&text).err().unwrap_or_else(|| panic!("accepted: {to}"));
        let problem = problems.iter().find(|problem| problem.to_string().contains(fragment));
        let problem = problem.unwrap_or_else(|| panic!("no '{fragment}' in\n{problems}"));
        assert_eq!(problem.line_column(), Some(place(&text, at)), "{to}: {problem}");
        assert!(problem.hint().len() > 3 && problem.file() == Some("s.toml"), "{to}");
    }
}

#[test]
fn coupling_needs_gear_ratios() {
    let problems = read_with("", SCENARIO).unwrap_err();
    let problem = problems.iter().next().unwrap();
    let fragment = "plant.rotor_coupling is true, but robot quanser-2dof has no gear ratios";
    assert!(problem.to_string().contains(fragment), "{problem}");
    assert_eq!(problem.line_column(), Some(place(SCENARIO, "true")));
    assert!(problem.hint().contains("gear_ratio"), "{}", problem.hint());
    assert_eq!(problems.iter().count(), 1);
    read_with("", &SCENARIO.replace("= true", "= false")).expect("nothing couples");
    // A robot that cannot be read is one problem, not two.
    let problems = read_with("gear_ratio = 0", SCENARIO).unwrap_err();
    assert_eq!(problems.iter().count(), 1, "{problems}");
}

#[test]
fn rotors_that_do_not_fit_into_the_links_are_refused() {
    // 0.23 and 0.01 kg m² behind gears of 1 and 0.1: a rotor of 1 kg m² on a link of a fifth of that.
    let scenario = read_with("gear_ratio = [1.0, 0.1]", SCENARIO).unwrap();
    let problems = run(&scenario, &flexure::progress::unwatched).unwrap_err();
    let problem = problems.iter().next().unwrap();
    assert!(problem.to_string().contains("is not positive definite"), "{problem}");
    assert_eq!(problem.line_column(), Some(place(SCENARIO, "true")));
    assert!(problem.hint().contains("gear ratio"));
}

#[test]
fn results_say_what_the_law_does_not_know() {
    let experiment = Experiment::new(read(SCENARIO).unwrap(), &mut [], &flexure::progress::unwatched)
        .unwrap_or_else(|p| panic!("{p}"));
    let summary = &experiment.run.summary;
    assert_eq!(summary.plant, ["rotor_coupling", "spring_hardening"]);
    assert!(summary.energy_drift < 1e-9, "{summary:?}");
    let said = "unknown to the law: rotor coupling, spring hardening";
    assert!(experiment.figure.svg().contains("with rotor coupling, spring hardening"));
    assert!(html(&report(std::slice::from_ref(&experiment), &[], &[]).unwrap()).contains(said));
    let table = summary_table(std::slice::from_ref(summary), WIDTH);
    assert!(table.contains("unknown") && table.contains("rotor coupling"), "{table}");
}

/// Each option changes the motion, and together they change it otherwise; off, nothing changes.
#[test]
fn options_change_the_motion() {
    let error = |to: &str| {
        let from = "rotor_coupling = true\nspring_hardening = [100.0, 50]";
        let scenario = read(&SCENARIO.replace(from, to)).unwrap_or_else(|problems| panic!("{problems}"));
        simulated(&scenario).summary.rms_e_l
    };
    let ideal = error("");
    assert_eq!(ideal.to_bits(), error("spring_hardening = 0\nrotor_coupling = false").to_bits());
    let coupled = error("rotor_coupling = true");
    let hard = error("spring_hardening = [100.0, 50.0]");
    let both = error("rotor_coupling = true\nspring_hardening = [100.0, 50.0]");
    for (a, b) in [(ideal, coupled), (ideal, hard), (coupled, both), (hard, both)] {
        assert!((a - b).abs() > 1e-4 * a, "{a} rad and {b} rad");
    }
}

/// The advice on where to start is about the springs that are there.
#[test]
fn preload_knows_the_hardening() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("arm.toml"), PENDULUM).unwrap();
    let text = SCENARIO
        .replace("rotor_coupling = true\nspring_hardening = [100.0, 50]", "spring_hardening = 200")
        .replace("[plant]", "[initial]\nq_l = 0.5\nq_m = 0.5\n[plant]");
    let said = |text: &str| {
        let scenario = scenario_from_text("s.toml", text, folder.path()).unwrap_or_else(|p| panic!("{p}"));
        preload(&scenario).unwrap_or_else(|problems| panic!("{problems}"))
    };
    let hint = said(&text).as_ref().map(Problem::hint).unwrap_or_default().to_owned();
    // 1.61 ζ + 200 ζ³ = 0.403 · 9.81 · 0.06 sin 0.5 N m.
    let (_, number) = hint.split_once("initial.q_m = [").unwrap_or_else(|| panic!("{hint}"));
    let q_m: f64 = number.split(']').next().unwrap().parse().unwrap();
    let zeta = q_m - 0.5;
    let torque = 1.61 * zeta + 200.0 * zeta.powi(3);
    assert!((torque - 0.403 * 9.81 * 0.06 * 0.5_f64.sin()).abs() < 1e-4, "{hint}");
    assert!(said(&text.replace("q_m = 0.5", &format!("q_m = {q_m}"))).is_none());
}

/// Cuts, flipped bits and stray tokens in `[plant]`: accepted or refused at a place, never a panic.
#[test]
fn mangled_plants_never_panic() {
    let (start, end) = (SCENARIO.find("[plant]").unwrap(), SCENARIO.find("[controller]").unwrap());
    let folder = folder(GEARS);
    let (mut accepted, mut refused) = (0, 0);
    for at in start..end {
        for token in ["", "-", "nan", "[", "]", "=", "\"", "\n", "1e308", "false", "é", "."] {
            for cut in [0, 1, 7] {
                let mut text = SCENARIO.to_owned();
                text.replace_range(at..(at + cut).min(end), token);
                match scenario_from_text("s.toml", &text, folder.path()) {
                    Ok(_) => accepted += 1,
                    Err(problems) => {
                        refused += 1;
                        assert!(problems.iter().all(|p| p.line_column().is_some()), "{problems}");
                    }
                }
            }
        }
    }
    assert!(accepted > 50 && refused > 1000, "{accepted} accepted, {refused} refused");
}
