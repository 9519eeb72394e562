//! Nasty robot and scenario files: each is refused at the right line, with a message and a hint.

mod cases;

use std::fs;
use std::path::Path;

use flexure::files::{Problem, Problems};
use flexure::robot::load_robot;
use flexure::robot::robot_from_text;
use flexure::scenario::load_scenario;
use flexure::scenario::scenario_from_text;

use crate::common::place;

use self::cases::{ARM, ARM_CASES, Case, SCENARIO, SCENARIO_CASES, TREE, TREE_CASES};

/// Every case of `cases`, made from `good` and refused by `read`.
fn sweep<T: std::fmt::Debug>(good: &str, cases: &[Case], read: impl Fn(&str) -> Result<T, Problems>) {
    read(good).unwrap_or_else(|problems| panic!("{problems}"));
    for &(from, to, at, fragment) in cases {
        assert!(good.contains(from), "'{from}' is there");
        let text = good.replacen(from, to, 1);
        let problems = read(&text).err().unwrap_or_else(|| panic!("accepted: {to}"));
        let problem = problems.iter().find(|problem| problem.to_string().contains(fragment));
        let problem = problem.unwrap_or_else(|| panic!("no '{fragment}' in\n{problems}"));
        let (line, column) = place(&text, at);
        let found = problem.line_column().unwrap_or_else(|| panic!("no place: {problem}"));
        assert_eq!(found.0, line, "{to}: {problem}");
        // Where in a line bad syntax is seen is the parser's choice.
        let syntax = ["array", "string", "basic string", "key with no value"].contains(&fragment);
        assert!(syntax || found.1 == column, "{to}: {problem} at {found:?} instead of column {column}");
        assert!(problem.hint().len() > 3, "{to}: no hint");
        assert!(problem.file().is_some(), "{to}: no file");
    }
}

#[test]
fn bad_arms() {
    sweep(ARM, ARM_CASES, |text| robot_from_text("arm.toml", text, ".".as_ref()));
}

#[test]
fn bad_trees() {
    sweep(TREE, TREE_CASES, |text| robot_from_text("tree.toml", text, ".".as_ref()));
}

#[test]
fn bad_scenarios() {
    let folder = tempfile::tempdir().unwrap();
    sweep(SCENARIO, SCENARIO_CASES, |text| scenario_from_text("s.toml", text, folder.path()));
}

#[test]
fn independent_errors_come_together_and_name_the_nearest_key() {
    let text =
        ARM.replace("[9.0, 4.0]", "[-9.0, 0]").replace("[1.5, 0.9]", "[0, 1]").replace("com =", "con =");
    let problems = robot_from_text("arm.toml", &text, ".".as_ref()).unwrap_err();
    assert_eq!(problems.iter().count(), 5, "{problems}");
    assert!(problems.iter().any(|problem| problem.hint().starts_with("did you mean 'com'?")));
}

#[test]
fn after_bad_syntax_nothing_else_is_looked_at() {
    let problems = robot_from_text(
        "arm.toml",
        &ARM.replace("gravity =", "gravity").replace("[9.0", "[-9.0"),
        ".".as_ref(),
    )
    .unwrap_err();
    assert!(
        problems.iter().all(|problem| problem.line_column().is_some_and(|(line, _)| line == 2)),
        "{problems}"
    );
}

#[test]
fn a_bad_robot_is_reported_in_its_own_file() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("arm.toml"), ARM.replace("[9.0, 4.0]", "[9.0, -4.0]")).unwrap();
    let text = SCENARIO.replace("quanser-2dof", "arm.toml").replace("[55.0, 30.0]", "[55.0, -30.0]");
    let problems = scenario_from_text("s.toml", &text, folder.path()).unwrap_err();
    let files: Vec<_> = problems.iter().filter_map(Problem::file).collect();
    assert!(files[0].ends_with("arm.toml") && files[1] == "s.toml", "{problems}");
    assert_eq!(problems.iter().next().and_then(Problem::line_column), Some((10, 19)));
}

/// Without the robot nobody knows how many numbers there must be: arrays of any length are looked at.
#[test]
fn lengths_that_disagree_with_each_other_do_no_harm() {
    let text =
        SCENARIO.replace("quanser-2dof", "none").replace("amplitude = [1.0, 1.0]", "amplitude = [1.0]");
    let text = text.replace(
        "[reference]",
        "q_m = 0\ndq_l = [0]\ndq_m = [0, 0, 0]\n[reference]\noffset = [0, 0, 0]\nphase = [0, 0]",
    );
    for q_m in ["0", "[0]"] {
        let text = text.replace("q_m = 0\n", &format!("q_m = {q_m}\n"));
        let problems = scenario_from_text("s.toml", &text, Path::new("")).unwrap_err();
        assert_eq!(problems.iter().count(), 1, "{problems}");
    }
}

/// The input is accepted with a warning whose message or hint has `fragment`.
fn warned(good: &str, from: &str, to: &str, fragment: &str) {
    let text = good.replacen(from, to, 1);
    assert_ne!(text, good);
    let warnings = if good == SCENARIO {
        scenario_from_text("s.toml", &text, Path::new(""))
            .unwrap_or_else(|problems| panic!("{problems}"))
            .warnings
    } else {
        robot_from_text("r.toml", &text, ".".as_ref())
            .unwrap_or_else(|problems| panic!("{problems}"))
            .warnings
    };
    let said = |warning: &&Problem| format!("{warning} {}", warning.hint()).contains(fragment);
    let found = warnings.iter().find(said).unwrap_or_else(|| panic!("{to}: {warnings:?}"));
    assert!(found.is_warning() && found.line_column().is_some());
}

#[test]
fn suspicious_numbers_are_warned_about() {
    warned(ARM, "[9.0, 4.0]", "[9.0, 4e-4]", "joints.stiffness[1] is 0.0004 N m/rad, is suspicious");
    warned(ARM, "[9.0, 4.0]", "[9.0, 4e7]", "joints.stiffness[1] is 4e7 N m/rad");
    warned(ARM, "[0.3, 0.2]", "[300, 200]", "is it in millimetres?");
    warned(TREE, "axis = [0, 0, 1]", "axis = [0, 0, 2]", "has length 2");
    warned(TREE, "[0.01, 0, 0, 0.01, 0, 0.01]", "[0.01, 0, 0, 0.01, 0, 0.03]", "belongs to no rigid body");
    warned(TREE, "xyz = [0.3, 0, 0]", "xyz = [0.3, 0, 0]\nrpy = [90, 0, 0]", "it looks like degrees");
    warned(SCENARIO, "q_l = [0.0, 0.0]", "q_l = [0.0, 0.0]\nq_m = [45.0, 0.0]", "it looks like degrees");
    warned(SCENARIO, "q_l = [0.0, 0.0]", "q_l = [0.1, 0.0]", "initial.q_m is not given");
    warned(SCENARIO, "duration = 10.0", "duration = 0.0124", "the run takes 12 periods, 0.012 s");
    warned(SCENARIO, "control_period = 0.001", "control_period = 1.0", "is it in milliseconds");
    let midpoint = "control_period = 0.001\nintegration = 'midpoint'";
    let both = format!("{midpoint}\nintegration_tolerance = 1e-6");
    warned(
        SCENARIO,
        "control_period = 0.001",
        &both,
        "steps of at most 1 ms, whatever integration_tolerance is",
    );
    let rubs = format!("imperfection = [{{ kind = 'friction', side = 'link', coulomb = 0.1 }}]\n{midpoint}");
    warned(SCENARIO, "control_period = 0.001", &rubs, "stepped at 0.1 ms, whatever integration is");
}

#[test]
fn what_cannot_be_read_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let refused = |path: &str, fragment: &str| {
        for problems in [load_robot(path).map(drop), load_scenario(path).map(drop)] {
            let problems = problems.unwrap_err();
            assert!(problems.to_string().contains(fragment), "{problems}");
            assert!(problems.iter().all(|problem| problem.hint().len() > 3));
        }
    };
    refused(&file("latin.toml", b"# ok\nname = \"\xe9\""), "is not UTF-8: invalid byte 13 in line 2");
    refused(&file("huge.toml", &vec![b'#'; (1 << 20) + 1]), "is larger than 1 MiB");
    refused(&file("empty.toml", b""), "missing key");
    refused(&file("nul.toml", b"\0\0"), "nul.toml:1:1");
    refused(&file("deep.toml", format!("a = {}", "[".repeat(100_000)).as_bytes()), "deep.toml:1:");
    refused(&format!("{}/none.toml", folder.path().display()), "cannot read");
    refused(&format!("{}/", folder.path().display()), "cannot read");
    refused("no-such-thing", "is called 'no-such-thing'");
    refused("", "is called ''");
}

#[test]
fn samples_are_checked_cell_by_cell() {
    let folder = tempfile::tempdir().unwrap();
    let sine = "\"sine\"\namplitude = [1.0, 1.0]\nfrequency = [1.0, 1.0]";
    let text = SCENARIO.replace(sine, "\"samples\"\nfile = \"q.csv\"");
    let rows: Vec<String> = (0..=10).map(|t| format!("{t}, 0.{t}, -0.{t}\r\n")).collect();
    let good = format!("t, q1,q2\r\n{}", rows.concat());
    let read = |csv: &str| {
        fs::write(folder.path().join("q.csv"), csv).unwrap();
        scenario_from_text("s.toml", &text, folder.path())
    };
    read(&good).unwrap_or_else(|problems| panic!("{problems}"));
    for (from, to, place, fragment) in [
        ("3, 0.3, -0.3", "3, 0.3, -0.3x", Some((5, 9)), "q2 is '-0.3x', must be a number"),
        ("3, 0.3, -0.3", "3, inf, -0.3", Some((5, 4)), "q1 is inf rad, must be a finite number"),
        ("3, 0.3, -0.3", "3, 0.3", Some((5, 1)), "2 numbers in this row, must be 3"),
        ("3, 0.3, -0.3", "2, 0.3, 0.3", Some((5, 1)), "t is 2 s, must be > 2 s"),
        ("t, q1,q2", "t,q1,q2,q3", Some((1, 1)), "must be t,q1,q2"),
        ("t, q1,q2", "q1,q2,t", Some((1, 1)), "must be t,q1,q2"),
        ("10, 0.10, -0.10", "", None, "ends at t = 9 s, before the run does at 10 s"),
        ("0, 0.0, -0.0\r\n", "", None, "begins at t = 1 s"),
        ("0, 0.0, -0.0\r\n", "0, 9.0, -0.0\r\n", None, "starts at 9 rad"),
        (&*good, "", Some((1, 1)), "the header is ''"),
        (&*good, "t,q1,q2\n0,0,0\n", Some((1, 1)), "1 rows of samples, must be at least 8"),
    ] {
        let problems = read(&good.replacen(from, to, 1)).err().unwrap_or_else(|| panic!("accepted: {to}"));
        let problem = problems.iter().next().unwrap();
        assert!(problem.to_string().contains(fragment), "{problems}");
        match place {
            Some(place) => {
                assert!(problem.file().unwrap().ends_with("q.csv"), "{problems}");
                assert_eq!(problem.line_column(), Some(place), "{problems}");
            }
            None => assert_eq!(problem.file(), Some("s.toml"), "{problems}"),
        }
    }
}
