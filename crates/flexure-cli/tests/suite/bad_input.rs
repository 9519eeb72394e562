//! Bad input: exit code 2, one clear message with place and hint, nothing on stdout and no files.

use std::fs;

use crate::command::{Place, ROBOT};

/// Text of the scenario that is replaced, by what, and what the message must have.
type Case = (&'static str, &'static str, &'static [&'static str]);

const SCENARIOS: &[Case] = &[
    ("duration = 10.0", "", &["s.toml:1:1", "missing key duration"]),
    (
        "duration = 10.0",
        "durations = 10.0",
        &["s.toml:4:1", "unknown key 'durations'", "did you mean 'duration'?"],
    ),
    ("duration = 10.0", "duration = -1", &["s.toml:4:12", "duration is -1 s, must be > 0"]),
    ("duration = 10.0", "duration = nan", &["s.toml:4:12", "must be a number"]),
    ("duration = 10.0", "duration = inf", &["s.toml:4:12", "must be a finite number"]),
    ("duration = 10.0", "duration = 1e400", &["s.toml:4:12", "must be a finite number"]),
    ("duration = 10.0", "duration = \"10 s\"", &["s.toml:4:12", "must be a number", "duration in s"]),
    (
        "duration = 10.0",
        "duration = 1e9",
        &["s.toml:5:18", "control periods in 1000000000 s", "may take 5000 s"],
    ),
    ("control_period = 0.001", "control_period = 1e-9", &["s.toml:5:18", "must be <= 5e6"]),
    ("control_period = 0.001", "control_period = 11.0", &["s.toml:5:18", "must be <= duration"]),
    ("control_period = 0.001", "control_period = 0", &["s.toml:5:18", "must be > 0"]),
    ("q_l = [0.0, 0.0]", "q_l = [0.0]", &["s.toml:8:7", "2 numbers expected", "got 1"]),
    ("q_l = [0.0, 0.0]", "q_l = [3.0, 0.0]", &["s.toml:13:", "3.000 rad apart", "smooth_start"]),
    ("kind = \"sine\"", "kind = \"sin\"", &["s.toml:14:8", "did you mean 'sine'?"]),
    ("phi = \"tanh\"", "phi = \"coupled-tanh\"", &["s.toml:", "missing key controller.link.kappa"]),
    ("damping = [15.0, 10.0]", "damping = [15.0, -10.0]", &["s.toml:25:18", "must be > 0", "N m s/rad"]),
    ("metric = [55.0, 30.0]", "metric = [55.0, 30.0", &["s.toml:", "not valid TOML"]),
    ("robot = \"quanser-2dof\"", "robot = \"quanser-2dfo\"", &["s.toml:3:9", "did you mean 'quanser-2dof'?"]),
    ("robot = \"quanser-2dof\"", "robot = \"none.toml\"", &["s.toml:3:9", "cannot read", "none.toml"]),
    ("robot = \"quanser-2dof\"", "robot = \"../none.toml\"", &["s.toml:3:9", "'../none.toml' is outside"]),
    (
        "[sources]",
        "[[imperfection]]\nkind = \"delay\"\n[sources]",
        &["s.toml:", "neither computation nor actuation"],
    ),
    ("[sources]", "[sources]\nstiffness = \"assumed\"", &["s.toml:", "'stiffness' names no key"]),
];

#[test]
fn scenarios() {
    for (from, to, fragments) in SCENARIOS {
        let place = Place::new();
        place.scenario("s.toml", &[(from, to)]);
        for outcome in [place.run(&["run", "s.toml"]), place.run(&["run", "s.toml", "--json"]).error_taken()]
        {
            outcome.refused(fragments);
            assert_eq!(place.names("."), ["s.toml"], "{to}: nothing is left behind");
        }
        place.run(&["check", "s.toml"]).refused(fragments);
        place.fed(&["eval", "s.toml", "--states", "-"], "").refused(fragments);
    }
}

const ROBOTS: &[Case] = &[
    ("[9.0, 4.0]", "[9.0, 0.0]", &["arm.toml:14:19", "joints.stiffness[1] is 0 N m/rad, must be > 0"]),
    ("[1.510, 0.873]", "[1.510, -0.873]", &["arm.toml:8:16", "must be > 0", "kg"]),
    ("[0.0392, 0.00808]", "[0.0392]", &["arm.toml:11:11", "2 numbers expected"]),
    ("\"planar-two-link\"", "\"urdf\"", &["arm.toml:6:1", "missing key links.file"]),
    ("[joints]", "[joints", &["arm.toml:13:", "not valid TOML"]),
];

#[test]
fn robots() {
    for (from, to, fragments) in ROBOTS {
        let place = Place::new();
        place.write("arm.toml", ROBOT.replacen(from, to, 1));
        place.scenario("s.toml", &[("\"quanser-2dof\"", "\"arm.toml\"")]);
        place.fed(&["model", "arm.toml", "--states", "-"], "").refused(fragments);
        place.run(&["run", "s.toml"]).refused(fragments);
        assert_eq!(place.names("."), ["arm.toml", "s.toml"]);
    }
}

#[test]
fn an_indefinite_inertia() {
    let body =
        "[[links.joint]]\nname = \"a\"\nkind = \"revolute\"\naxis = [0, 0, 1]\nmass = 1\ncom = [0.1, 0, 0]\n";
    let joints = "[joints]\nstiffness = 1\nmotor_inertia = 1\nlink_damping = 0\nmotor_damping = 0\n";
    let place = Place::new();
    place.write(
        "arm.toml",
        format!("name = \"arm\"\n[links]\nkind = \"tree\"\n{body}inertia = [0.01, 0.02, 0, 0.01, 0, 0.01]\n{joints}"),
    );
    place.run(&["check", "arm.toml"]).refused(&["arm.toml:10:11", "links.joint[0].inertia is indefinite"]);
}

#[test]
fn files_that_are_no_text() {
    let place = Place::new();
    fs::create_dir(place.path().join("folder.toml")).unwrap();
    place
        .write("empty.toml", "")
        .write("binary.toml", [0, 159, 146, 150, 10, 27, 91, 51])
        .write("nul.toml", [0; 64]);
    place
        .write("escape.toml", "name = \"\u{1b}[31m\"")
        .write("wide.toml", format!("a = [{}", "1, ".repeat(100_000)));
    for (file, fragments) in [
        ("none.toml", &["cannot read none.toml"][..]),
        ("folder.toml", &["cannot read folder.toml"]),
        ("empty.toml", &["empty.toml:1:1", "the file is empty"]),
        ("binary.toml", &["binary.toml:1:2", "not UTF-8"]),
        ("nul.toml", &["nul.toml:1:1"]),
        ("escape.toml", &["escape.toml:1:9"]),
        ("wide.toml", &["wide.toml:1:"]),
    ] {
        for args in [&["run", file][..], &["check", file], &["model", file, "--states", "-"]] {
            let outcome = place.run(args);
            outcome.refused(fragments);
            assert!(outcome.stderr.len() < 5000, "{file} fills the screen");
        }
    }
    assert!(place.names("out").is_empty());
}

#[test]
fn the_other_kind_of_file() {
    let place = Place::new();
    place.write("arm.toml", ROBOT).scenario("s.toml", &[]);
    let outcome = place.run(&["run", "arm.toml"]);
    outcome.refused(&["arm.toml:6:2", "this is a robot file, must be a scenario file"]);
    assert_eq!(outcome.stderr.matches("error[").count(), 1, "{}", outcome.stderr);
    let outcome = place.run(&["model", "s.toml", "--states", "-"]);
    outcome.refused(&["s.toml:18:2", "this is a scenario file, must be a robot file"]);
    assert_eq!(outcome.stderr.matches("error[").count(), 1, "{}", outcome.stderr);
}

#[test]
fn states() {
    let rest = "\"q_m\": [0, 0], \"dq_l\": [0, 0], \"dq_m\": [0, 0]}";
    let good = format!("{{\"q_l\": [0, 0], {rest}");
    let place = Place::new();
    for (line, fragments) in [
        (format!("{{{rest}"), &["missing key q_l"][..]),
        (format!("{{\"q_l\": [0], {rest}"), &["q_l: 2 numbers expected, one per joint; got 1"]),
        (format!("{{\"q_l\": [0, 1e400], {rest}"), &["q_l: number out of range"]),
        (format!("{{\"q_l\": [0, NaN], {rest}"), &["q_l"]),
        (format!("{{\"ql\": [0, 0], {rest}"), &["did you mean 'q_l'?"]),
        (format!("{{\"u_m\": [0], \"q_l\": [0, 0], {rest}"), &["u_m: 2 numbers expected"]),
        (format!("{{\"ddq_l\": [0], \"q_l\": [0, 0], {rest}"), &["ddq_l: 2 numbers expected"]),
        (format!("{{\"ddq_l\": [0, -1e999], \"q_l\": [0, 0], {rest}"), &["ddq_l: number out of range"]),
        (format!("{{\"d3q_l\": [0, 0], \"q_l\": [0, 0], {rest}"), &["d3q_l without ddq_l"]),
        (
            format!("{{\"ddq_l\": [0, 0], \"d4q_l\": [0, 0], \"q_l\": [0, 0], {rest}"),
            &["d4q_l without d3q_l"],
        ),
        (format!("{{\"dddq_l\": [0, 0], \"q_l\": [0, 0], {rest}"), &["did you mean 'ddq_l'?"]),
        (format!("{{\"q_l\": \"0\", {rest}"), &["q_l: invalid type"]),
        ("null".into(), &["expected an object"]),
        ("t,q_l1,q_l2".into(), &["not JSON"]),
        ("{".into(), &["not JSON"]),
        (" ".repeat(2 << 20), &["longer than 1048576 bytes"]),
        ("x".repeat(2000), &["not JSON"]),
    ] {
        // One bad state: no answer for the good ones either, lest half a file pass for all of it.
        place.write("states.jsonl", format!("{good}\n{line}\n{good}\n"));
        for command in [["eval", "two-link-tanh"], ["model", "quanser-2dof"]] {
            let outcome = place.run(&[&command[..], &["--states", "states.jsonl"]].concat());
            outcome.refused(&[&["states.jsonl:2:"], fragments].concat());
            assert!(outcome.stderr.len() < 2000, "{}", outcome.stderr);
        }
    }
    place.write("bytes.jsonl", [0xff, 0xfe, b'\n']).write("empty.jsonl", "\n \n");
    for (file, fragments) in [
        ("bytes.jsonl", &["bytes.jsonl:1:1", "not UTF-8"][..]),
        ("empty.jsonl", &["empty.jsonl:", "no states"]),
        ("none.jsonl", &["cannot read none.jsonl"]),
        (".", &["cannot read .", "directory"]),
    ] {
        place.run(&["eval", "two-link-tanh", "--states", file]).refused(fragments);
    }
}

/// Tests may run as root, whom no permission stops: what is in the way here is a file.
#[test]
fn folders_that_cannot_be_written_into() {
    let place = Place::new();
    place.write("file", "x");
    for args in [&["run", "two-link-tanh"][..], &["reproduce"]] {
        for (out, fragment) in
            [("file", "cannot create files in file"), ("file/sub", "cannot create files in file/sub")]
        {
            place.run(&[args, &["--out", out]].concat()).refused(&[fragment]);
        }
    }
    assert_eq!(place.names("."), ["file"]);
    assert_eq!(place.read("file"), "x");
}

#[test]
fn an_output_that_is_a_folder() {
    let place = Place::new();
    fs::create_dir_all(place.path().join("out/s.csv")).unwrap();
    place.scenario("s.toml", &[("duration = 10.0", "duration = 0.01")]);
    place.run(&["run", "s.toml"]).refused(&["out/s.csv is not a regular file"]);
    assert_eq!(place.names("out"), ["s.csv"]);
}

#[test]
fn arguments() {
    let place = Place::new();
    for (args, fragment) in [
        (&[][..], "Usage: flexure"),
        (&["bogus"], "unrecognized subcommand 'bogus'"),
        (&["run"], "<SCENARIO>"),
        (&["run", "a", "b"], "a second scenario is there for the page that shows both"),
        (&["run", "a", "b", "c"], "unexpected argument 'c'"),
        (&["run", "two-link-tanh", "--fast"], "unexpected argument '--fast'"),
        (&["eval", "two-link-tanh"], "--states <FILE>"),
        (&["check"], "<FILE>"),
        (&["list", "bogus"], "possible values: robots, scenarios"),
        (&["run", "two-link-tahn"], "did you mean 'two-link-tanh'?"),
        (&["run", ""], "no built-in scenario is called ''"),
        (&["certify", "two-link-linear", "--out", "/dev/full"], "exists and is no certificate"),
        (&["certify", "two-link-linear", "--out", "/dev/zero"], "exists and is no certificate"),
        (&["model", "quanser", "--states", "-"], "no built-in robot is called 'quanser'"),
        (&["excite", "planar-2r", "--posture", "1"], "--posture: 1 given, planar-2r has 2 joints"),
        (&["excite", "planar-2r", "--posture", "a,b"], "invalid value 'a' for '--posture"),
        (&["excite", "planar-2r", "--posture", "0,nan"], "NaN for joint elbow, must be a finite number"),
        (&["excite", "planar-2r", "--duration", "1"], "--duration is 1 s, must be from 2 to 600"),
        (&["identify", "planar-2r"], "--log <FILE>"),
        (&["identify", "planar-2r", "--log", "none.csv"], "cannot read none.csv"),
        (&["identify", "planar-2r", "--log", "/dev/null"], "/dev/null is empty"),
        (&["identify", "planar-2r", "--log", "."], "is a directory"),
        (&["replay", "two-link-tanh"], "--log <FILE>"),
        (&["replay", "two-link-tanh", "--log", "none.csv"], "cannot read none.csv"),
        (&["replay", "two-link-tanh", "--log", "/dev/null"], "/dev/null is empty"),
        (&["tune", "none.toml"], "cannot read none.toml"),
        (&["tune", "two-link-hardware", "--budget", "0"], "the budget is 0 runs"),
        (&["tune", "two-link-hardware", "--spec", "none.toml"], "cannot read none.toml"),
        (&["import", "none.urdf"], "cannot read none.urdf"),
        (&["import", "/dev/null"], "there is no element <robot>"),
        (&["import", "none.urdf", "--assume", "gears"], "no class of drives is called 'gears'"),
        (&["margins", "none.toml"], "cannot read none.toml"),
        (&["compare", "none.toml"], "cannot read none.toml"),
        (&["compare", "task-soft", "--budget", "0"], "the budget is 0 runs"),
        (&["compare", "task-soft", "--controllers", "bogus"], "no controller is called 'bogus'"),
        (&["verify", "none.json"], "cannot read none.json"),
        (&["verify", "/dev/null"], "/dev/null:1:0 is not a certificate"),
        (&["reproduce", "--out", "/dev/null/x"], "cannot create files in /dev/null/x"),
        (&["run", "two-link-tanh", "--set", "duration=x"], "duration is text, must be a number"),
        (&["run", "two-link-tanh", "--set", "nonsense"], "= and a value are missing"),
    ] {
        let outcome = place.run(args);
        assert_eq!((outcome.code, outcome.stdout.as_str()), (Some(2), ""), "{args:?}");
        assert!(outcome.stderr.contains(fragment), "{args:?}: {}", outcome.stderr);
    }
    for args in [&["--help"][..], &["help", "run"], &["--version"], &["run", "--help"]] {
        let outcome = place.run(args).done();
        assert!(outcome.stdout.contains("flexure") && outcome.stderr.is_empty());
    }
    assert!(place.names(".").is_empty());
}
