//! Nasty robot and scenario files: each is refused at the right line, with a message and a hint.

use std::fs;
use std::path::Path;

use flexure::files::{Problem, Problems};
use flexure::robot::load_robot;
use flexure::robot::robot_from_text;
use flexure::scenario::load_scenario;
use flexure::scenario::scenario_from_text;

use crate::common::place;

const ARM: &str = r#"name = "arm"
gravity = [0.0, 0.0, -9.81]
[links]
kind = "planar-two-link"
mass = [1.5, 0.9]
length = [0.3, 0.2]
com = [0.1, 0.05]
inertia = [0.04, 0.008]
[joints]
stiffness = [9.0, 4.0]
motor_inertia = [0.2, 0.01]
link_damping = [0.8, 0.55]
motor_damping = 0.2
torque_limit = [8.4, 1.7]
[sources]
stiffness = "assumed: by eye"
"#;

const TREE: &str = r#"name = "tree"
[links]
kind = "tree"
[[links.joint]]
name = "base"
kind = "revolute"
axis = [0, 0, 1]
mass = 1
com = [0.1, 0, 0]
inertia = [0.01, 0, 0, 0.01, 0, 0.01]
[[links.joint]]
name = "slide"
parent = "base"
kind = "prismatic"
xyz = [0.3, 0, 0]
mass = 2
com = [0, 0, 0]
inertia = [0.02, 0, 0, 0.03, 0, 0.04]
[[links.joint]]
name = "tool"
parent = "slide"
kind = "fixed"
mass = 0
[joints]
stiffness = 100
motor_inertia = 0.1
link_damping = 0
motor_damping = 0
"#;

const SCENARIO: &str = r#"robot = "quanser-2dof"
duration = 10.0
control_period = 0.001
[initial]
q_l = [0.0, 0.0]
[reference]
kind = "sine"
amplitude = [1.0, 1.0]
frequency = [1.0, 1.0]
[controller]
kind = "vcbc"
phi = "tanh"
[controller.link]
metric = [55.0, 30.0]
damping = [15.0, 10.0]
[controller.motor]
metric = [70.0, 60.0]
damping = [10.0, 5.0]
"#;

/// What is replaced, by what, the text that the problem must point at, and a part of the message.
type Case = (&'static str, &'static str, &'static str, &'static str);

const ARM_CASES: &[Case] = &[
    ("[9.0, 4.0]", "[9.0, -4.0]", "-4.0", "joints.stiffness[1] is -4 N m/rad, must be > 0"),
    ("[9.0, 4.0]", "[9.0, 0.0]", "0.0]\nmotor", "joints.stiffness[1] is 0 N m/rad, must be > 0"),
    ("[9.0, 4.0]", "[9.0, 4.0, 1.0]", "[9.0, 4.0, 1.0]", "2 numbers expected, one per joint of arm; got 3"),
    ("[9.0, 4.0]", "[]", "[]", "got 0"),
    ("[9.0, 4.0]", "[9.0, \"4\"]", "\"4\"", "joints.stiffness[1] is text, must be a number"),
    ("[9.0, 4.0]", "[9.0, nan]", "nan", "joints.stiffness[1] is nan N m/rad, must be a number"),
    ("[9.0, 4.0]", "[-inf, 4.0]", "-inf", "must be a finite number"),
    ("[9.0, 4.0]", "[9.0, 1e999]", "1e999", "joints.stiffness[1] is inf N m/rad"),
    ("[9.0, 4.0]", "[9.0, 1e40]", "1e40", "magnitude between 1e-30 and 1e30"),
    ("[9.0, 4.0]", "[9.0, 4e-320]", "4e-320", "magnitude between 1e-30 and 1e30"),
    ("[9.0, 4.0]", "true", "true", "joints.stiffness is a boolean, must be a number"),
    ("[9.0, 4.0]", "1979-05-27", "1979", "joints.stiffness is a date"),
    ("[9.0, 4.0]", "[[9.0], 4.0]", "[9.0], 4", "joints.stiffness[0] is an array"),
    ("[9.0, 4.0]", "{ a = 9.0 }", "{ a", "joints.stiffness is a table"),
    ("[9.0, 4.0]", "[9.0, 4.0", "= [0.2", "array"),
    ("[9.0, 4.0]", "", "= \nmotor_inertia", "string"),
    ("stiffness = [9", "stifness = [9", "stifness", "unknown key 'stifness' in [joints]"),
    ("stiffness = [9.0, 4.0]\n", "", "[joints]", "missing key joints.stiffness"),
    ("[0.2, 0.01]", "[0.2, 0]", "0]\nlink", "joints.motor_inertia[1] is 0 kg m^2"),
    ("[0.8, 0.55]", "[0.8, -0.55]", "-0.55", "joints.link_damping[1] is -0.55 N m s/rad, must be >= 0"),
    ("damping = 0.2", "damping = -0.2", "-0.2", "joints.motor_damping is -0.2 N m s/rad, must be >= 0"),
    ("[8.4, 1.7]", "[8.4, 0]", "0]\n[sources]", "joints.torque_limit[1] is 0 N m, must be > 0"),
    (
        "[8.4, 1.7]",
        "[8.4, 1.7]\ntorque_rate_limit = [1, -1]",
        "-1]",
        "joints.torque_rate_limit[1] is -1 N m/s, must be > 0",
    ),
    ("[1.5, 0.9]", "[1.5, -0.9]", "-0.9", "links.mass[1] is -0.9 kg, must be > 0"),
    ("[1.5, 0.9]", "1.5", "1.5", "links.mass is a number, must be an array of 2 numbers"),
    ("[0.3, 0.2]", "[0.3]", "[0.3]", "links.length: 2 numbers expected (one per link); got 1"),
    ("[0.04, 0.008]", "[0.04, -0.008]", "-0.008", "links.inertia[1] is -0.008 kg m^2"),
    (
        "\"planar-two-link\"",
        "\"planar-2-link\"",
        "\"planar-2",
        "links.kind is 'planar-2-link', which is not known",
    ),
    ("\"planar-two-link\"", "\"urdf\"", "mass = [1.5", "unknown key 'mass' in [links]"),
    ("kind = \"planar-two-link\"\n", "", "[links]", "missing key links.kind"),
    ("\"planar-two-link\"", "\"pendulum\"", "length", "unknown key 'length' in [links]"),
    ("name = \"arm\"\n", "", "gravity", "missing key name"),
    ("name = \"arm\"", "name = \" \"", "\" \"", "name is empty"),
    ("name = \"arm\"", "name = 3", "3\n", "name is a number, must be text"),
    ("name = \"arm\"", "name = \"arm\"\nname = \"arm\"", "name = \"arm\"\ngravity", "duplicate key"),
    ("-9.81]", "-9.81, 0]", "[0.0, 0.0, -9.81, 0]", "gravity: 3 numbers expected (x, y, z); got 4"),
    (
        "[0.0, 0.0, -9.81]",
        "[0.0, -9.81, 0.0]",
        "[0.0, -9.81",
        "planar-two-link moves in the horizontal plane",
    ),
    ("[joints]", "[joint]", "joint]", "unknown key 'joint'"),
    ("[sources]", "[[sources]]", "[[sources]]", "sources is an array, must be a table"),
    ("stiffness = \"assumed", "stifness = \"assumed", "\"assumed", "'stifness' names no key of this file"),
    ("stiffness = \"assumed: by eye\"", "kind = 3", "3\n", "sources.kind is a number, must be text"),
    ("name = \"arm\"", "name = \"arm", "name", "basic string"),
    ("gravity =", "gravity", "gravity [", "key with no value"),
];

const TREE_CASES: &[Case] = &[
    ("axis = [0, 0, 1]", "axis = [0, 0, 0]", "[0, 0, 0]", "links.joint[0].axis is zero"),
    ("mass = 1\n", "mass = -1\n", "-1\n", "links.joint[0].mass is -1 kg, must be >= 0"),
    (
        "0.01, 0, 0, 0.01, 0,",
        "0.01, 0, 0, -0.01, 0,",
        "[0.01, 0, 0, -",
        "links.joint[0].inertia is indefinite",
    ),
    (
        "0.01, 0, 0, 0.01, 0,",
        "0.01, 0.02, 0, 0.01, 0,",
        "[0.01, 0.02",
        "links.joint[0].inertia is indefinite",
    ),
    (
        "0.01, 0, 0, 0.01, 0, 0.01",
        "0.01, 0.01, 0.01",
        "[0.01, 0.01",
        "6 numbers expected (ixx, ixy, ixz, iyy, iyz, izz)",
    ),
    (
        "parent = \"slide\"",
        "parent = \"slid\"",
        "\"slid\"",
        "links.joint[2].parent is 'slid', which is no joint above",
    ),
    (
        "parent = \"base\"",
        "parent = \"tool\"",
        "\"tool\"",
        "links.joint[1].parent is 'tool', which is no joint above",
    ),
    ("parent = \"base\"", "parent = \"slide\"", "\"slide\"\nkind", "links.joint[1].parent is 'slide'"),
    (
        "name = \"slide\"",
        "name = \"base\"",
        "[[links.joint]]\nname = \"base\"\nparent",
        "a second joint is called 'base'",
    ),
    ("kind = \"prismatic\"", "kind = \"slider\"", "\"slider\"", "links.joint[1].kind is 'slider'"),
    (
        "kind = \"fixed\"",
        "kind = \"fixed\"\naxis = [0, 0, 1]",
        "axis = [0, 0, 1]\nmass = 0",
        "unknown key 'axis'",
    ),
    ("mass = 0\n", "mass = 0.5\n", "[[links.joint]]\nname = \"tool\"", "missing key links.joint[2].com"),
    (
        "mass = 2\ncom = [0, 0, 0]\ninertia = [0.02, 0, 0, 0.03, 0, 0.04]",
        "mass = 0",
        "[[links.joint]]\nname = \"slide\"",
        "(slide) moves 0e0 kg, must be > 0",
    ),
    ("mass = 2\n", "", "[[links.joint]]\nname = \"slide\"", "missing key links.joint[1].mass"),
    ("stiffness = 100", "stiffness = [1]", "[1]", "2 numbers expected, one per joint of tree; got 1"),
];

const SCENARIO_CASES: &[Case] = &[
    (
        "\"quanser-2dof\"",
        "\"quanser-2dfo\"",
        "\"quanser-2dfo\"",
        "no built-in robot is called 'quanser-2dfo'",
    ),
    ("\"quanser-2dof\"", "\"none/arm.toml\"", "\"none", "cannot read"),
    ("duration = 10.0", "duration = -10.0", "-10.0", "duration is -10 s, must be > 0"),
    ("period = 0.001", "period = 20", "20\n", "control_period is 20 s, must be <= duration, 10 s"),
    ("period = 0.001", "period = 1e-12", "1e-12", "control periods in 10 s, must be <= 5e6"),
    ("period = 0.001", "period = 0.001\nhold = \"first-order\"", "\"first-order\"", "hold is 'first-order'"),
    (
        "[0.0, 0.0]",
        "[0.0, 0.6]",
        "[reference]",
        "the reference of joint2 starts at 0 rad and the robot at 0.6 rad",
    ),
    ("q_l = [0.0, 0.0]", "ql = [0.0, 0.6]", "ql", "unknown key 'ql' in [initial]"),
    (
        "amplitude = [1.0, 1.0]",
        "amplitude = [1.0, 1.0, 1.0]",
        "[1.0, 1.0, 1.0]",
        "2 numbers expected, one per joint of quanser-2dof; got 3",
    ),
    ("amplitude = [1.0, 1.0]\n", "", "[reference]", "missing key reference.amplitude"),
    ("\"sine\"", "\"sin\"", "\"sin\"", "reference.kind is 'sin'"),
    ("\"sine\"", "\"multisine\"", "amplitude", "unknown key 'amplitude' in [reference]"),
    ("\"sine\"", "\"samples\"\nfile = \"none.csv\"", "\"none.csv\"", "cannot read"),
    (
        "[controller]",
        "[reference.smooth_start]\nduration = 0\n[controller]",
        "0\n[controller]",
        "reference.smooth_start.duration is 0 s, must be > 0",
    ),
    (
        "[controller]",
        "[reference.smooth_start]\nduration = 1\nsettle = -1\n[controller]",
        "-1\n[controller]",
        "reference.smooth_start.settle is -1 s, must be > 0",
    ),
    (
        "[controller]",
        "[reference.time_scaling]\nspeed = 0\n[controller]",
        "0\n[controller]",
        "reference.time_scaling.speed is 0, must be > 0",
    ),
    (
        "[controller]",
        "[reference.time_scaling]\nmargin = 90\n[controller]",
        "90\n[controller]",
        "reference.time_scaling.margin is 90, must be <= 1",
    ),
    (
        "[controller]",
        "[reference.time_scaling]\nspeed = 1\nmargin = 0.9\n[controller]",
        "[reference.time_scaling]",
        "both of speed and margin are given, must be one of them",
    ),
    (
        "[controller]",
        "[reference.time_scaling]\nrise = 1\n[controller]",
        "[reference.time_scaling]",
        "neither of speed and margin are given, must be one of them",
    ),
    (
        "[controller]",
        "[reference.time_scaling]\nspeed = 1\nrise = 0\n[controller]",
        "0\n[controller]",
        "reference.time_scaling.rise is 0 s, must be > 0",
    ),
    (
        "[controller]",
        "[reference.time_scaling]\nspeed = 1\nfactor = 2\n[controller]",
        "factor",
        "unknown key 'factor' in [reference.time_scaling]",
    ),
    ("\"vcbc\"", "\"pid\"", "\"pid\"", "controller.kind is 'pid'"),
    ("phi = \"tanh\"", "phi = \"tan\"", "\"tan\"", "controller.phi is 'tan'"),
    ("phi = \"tanh\"", "phi = \"coupled-tanh\"", "[controller.link]", "missing key controller.link.kappa"),
    (
        "metric = [55.0, 30.0]",
        "metric = 55.0\nkappa = 1",
        "1\ndamping",
        "controller.link.kappa is given, but phi is 'tanh'",
    ),
    (
        "metric = [55.0, 30.0]",
        "metric = [55.0, 0]",
        "0]\ndamping",
        "controller.link.metric[1] is 0 N m/rad, must be > 0",
    ),
    (
        "metric = [55.0, 30.0]",
        "metric = 55\nmetric_hardening = -1",
        "-1\n",
        "controller.link.metric_hardening is -1 N m/rad^3, must be >= 0",
    ),
    ("metric = [70.0, 60.0]", "metric = 70\nmetric_hardening = 1", "1\ndamping", "Π_m must be constant"),
    (
        "damping = [10.0, 5.0]",
        "damping = [10.0, -5.0]",
        "-5.0",
        "controller.motor.damping[1] is -5 N m s/rad, must be > 0",
    ),
    ("[controller.motor]", "[controller.motors]", "motors", "unknown key 'motors' in [controller]"),
    (
        "[controller]",
        "[[imperfection]]\nkind = \"delays\"\n[controller]",
        "\"delays\"",
        "imperfection[0].kind is 'delays', which is not known",
    ),
    (
        "[controller]",
        "[sources]\ndamping = \"assumed: x\"\n[controller]",
        "\"assumed",
        "'damping' may mean controller.link.damping or controller.motor.damping",
    ),
];

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
